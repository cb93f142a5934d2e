#include "dem/walls/surface.h"

#include <fmt/format.h>

#include <stdexcept>

#include "dem/shared/refuse.h"
#include "dem/walls/mesh.h"
#include "dem/walls/round.h"
#include "dem/words/choice.h"

namespace grainfield::dem {
namespace {

std::string of(const Wall& wall, const char* what) {
  return fmt::format("wall {}: {}", wall.name, what);
}

Eigen::Vector3d axis_of(const Wall& wall) {
  const double size = wall.normal.norm();
  require(size > 0, of(wall, "length of the normal or axis"), size, "above 0");
  return wall.normal / size;
}

template <int D>
class Flat final : public WallSurface<D> {
 public:
  using Vector = VectorOf<D>;
  explicit Flat(const Vector& normal) { plane_.normal = normal; }
  int patches(const Vector& centre, double reach, Patch<D>* found) const override {
    if (!(plane_.height(centre) < reach)) return 0;
    *found = {plane_, 0};
    return 1;
  }

 private:
  Plane<D> plane_;
};

// The kinds: their words, and how one is made of a wall.

struct PlaneKind {
  static constexpr const char* name = "plane";
  template <int D>
  static std::unique_ptr<WallSurface<D>> make(const Wall& wall) {
    return std::make_unique<Flat<D>>(in_space<D>(wall.normal));
  }
};

struct CylinderKind {
  static constexpr const char* name = "cylinder";
  template <int D>
  static std::unique_ptr<WallSurface<D>> make(const Wall& wall) {
    require(wall.radius > 0, of(wall, "radius"), wall.radius, "above 0 m");
    require(wall.length >= 0, of(wall, "length"), wall.length, "0 (without ends) or more, m");
    if constexpr (D == 3) {
      if (wall.length > 0) {
        return std::make_unique<RoundShell>(wall.radius, wall.radius, wall.length, axis_of(wall));
      }
      return std::make_unique<EndlessCylinder<3>>(wall.radius, wall.inside, axis_of(wall));
    } else {
      require(wall.length == 0, of(wall, "length"), wall.length, "0 in 2D");
      return std::make_unique<EndlessCylinder<2>>(wall.radius, wall.inside, Vec3::UnitZ());
    }
  }
};

struct ConeKind {
  static constexpr const char* name = "cone";
  template <int D>
  requires(D == 3) static std::unique_ptr<WallSurface<D>> make(const Wall& wall) {
    require(wall.radius >= 0, of(wall, "radius"), wall.radius, "0 m or more");
    require(wall.end_radius >= 0, of(wall, "end radius"), wall.end_radius, "0 m or more");
    require(wall.radius + wall.end_radius > 0, of(wall, "both radii"), 0, "one of them above 0 m");
    require(wall.length > 0, of(wall, "length"), wall.length, "above 0 m");
    return std::make_unique<RoundShell>(wall.radius, wall.end_radius, wall.length, axis_of(wall));
  }
};

struct MeshKind {
  static constexpr const char* name = "mesh";
  template <int D>
  requires(D == 3) static std::unique_ptr<WallSurface<D>> make(const Wall& wall) {
    Triangles around = wall.triangles;
    for (auto& triangle : around) {
      for (Vec3& corner : triangle) corner -= wall.point;
    }
    return mesh_surface(around, "wall " + wall.name);
  }
};

using AnySurface = std::variant<PlaneKind, CylinderKind, ConeKind, MeshKind>;

template <class Kind, int D>
concept ExistsIn = requires(const Wall& wall) {
  { Kind::template make<D>(wall) } -> std::same_as<std::unique_ptr<WallSurface<D>>>;
};

}  // namespace

template <int D>
std::vector<std::string> surfaces_in() {
  return words_where<AnySurface>([]<class Kind>() { return ExistsIn<Kind, D>; });
}

template <int D>
std::unique_ptr<WallSurface<D>> surface_of(const Wall& wall) {
  std::unique_ptr<WallSurface<D>> made;
  const auto make = [&]<class Kind>() {
    if constexpr (ExistsIn<Kind, D>) made = Kind::template make<D>(wall);
    return AnySurface(Kind{});
  };
  const std::string key = fmt::format("wall {}: shape", wall.name);
  kind_named<AnySurface>(key, wall.shape, make);
  if (!made) refuse_word(key, wall.shape, surfaces_in<D>());
  return made;
}

template std::unique_ptr<WallSurface<2>> surface_of<2>(const Wall& wall);
template std::unique_ptr<WallSurface<3>> surface_of<3>(const Wall& wall);
template std::vector<std::string> surfaces_in<2>();
template std::vector<std::string> surfaces_in<3>();

}  // namespace grainfield::dem
