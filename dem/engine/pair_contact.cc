#include "dem/engine/pair_contact.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>
#include <utility>

#include "dem/engine/combine.h"
#include "dem/engine/turning.h"
#include "dem/engine/turning3.h"
#include "dem/shapes/disk_store.h"
#include "dem/shapes/polygon_store.h"
#include "dem/shapes/sphere_store.h"
#include "dem/shapes/superellipsoid_store.h"
#include "dem/space/kinematics3.h"

namespace grainfield::dem {
namespace {

template <class Store, class Law>
class ContactOf final : public PairContact {
 public:
  static constexpr int dim = Store::dim;
  using Acting = Interaction<Store, Law>;
  using Vector = VectorOf<dim>;
  using Overlap = typename Store::Overlap;

  /// `wall`: null for a second grain.
  ContactOf(const EngineSettings& settings, const NewGrain& first, const NewGrain* second,
            const Wall* wall)
      : acting_(Rules<Law>(settings)) {
    const int kind = add(settings, first);
    if (wall == nullptr) {
      rule_ = acting_.rule(kind, add(settings, *second));
      return;
    }
    if (wall->shape != "plane") {
      throw std::invalid_argument(fmt::format(
          "wall {}: shape: found \"{}\", allowed for a pair: plane", wall->name, wall->shape));
    }
    plane_ = {in_space<dim>(wall->point), in_space<dim>(wall->normal.normalized())};
    acting_.add_wall(
        wall->material.empty() ? -1 : material_index(settings, wall->name, wall->material),
        wall->friction);
    rule_ = acting_.wall_rule(kind, 0);
    is_wall_ = true;
  }

  PairForces at(const PairState& first, const PairState& second, double dt) override {
    move(0, first);
    if (!is_wall_) move(1, second);
    PairForces out;
    if constexpr (dim == 3) out.area = out.chord = std::numeric_limits<double>::quiet_NaN();
    Overlap o;
    if (!overlap<Law::measures>(o)) {
      forget();
      return out;
    }
    const Body<dim>& a = bodies_[0];
    const Body<dim> b = is_wall_ ? wall_body(second, o) : bodies_[1];
    const auto motion = motion_at<Acting::central>(a, b, o);
    ContactForce<dim> f = Acting::force(rule_, a, b, o, dt, memory_);
    if (rule_.rolling.on()) Acting::roll(rule_, a, b, o, dt, rolling_, f);
    out.touching = true;
    out.normal = to_three(Vector(normal_of(o)));
    out.point = to_three(Vector(point_at<Acting::central>(a, o)));
    out.force = to_three(f.force);
    out.torque_first = turning_to_three(f.torque_i);
    if (!is_wall_) out.torque_second = turning_to_three(f.torque_j);
    out.normal_force = repulsion_of(f.force, o);
    out.tangential_force = signed_size_of(tangential_of(f.force, o));
    out.approach = motion.approach;
    out.depth = o.depth;
    out.stored = rule_.law.energy(o, memory_).total() + rule_.rolling.energy(rolling_);
    if constexpr (dim == 2) {
      // A law that reads the depth alone does not ask for the area.
      if (Law::measures == Measures::depth) overlap<Measures::area>(o);
      out.area = o.area;
      out.chord = o.chord;
    }
    return out;
  }

  void forget() override {
    memory_ = {};
    rolling_ = {};
    feature_ = {};
  }
  std::string checkpoint() const override {
    CheckpointWriter w;
    w.put(memory_);
    w.put(rolling_);
    return w.bytes();
  }
  void restore(const std::string& checkpoint) override {
    CheckpointReader r(checkpoint);
    r.get(memory_);
    r.get(rolling_);
    r.finish();
  }

 private:
  int add(const EngineSettings& settings, const NewGrain& g) {
    const int kind = material_index(settings, "grain", g.material);
    acting_.add_grain(kind);
    const Solid<dim> solid = shapes_.add({g.radius, g.outline, g.axes, g.exponents});
    Inertia<dim> inertia{g.density * solid.volume, g.density * solid.moments, solid.volume};
    if (g.mass > 0) inertia.mass = g.mass;
    read_moments(g, inertia);
    const int number = count_++;
    Body<dim>& b = bodies_[number];
    b.radius = solid.radius;
    if constexpr (dim == 3) shapes_.place(number, b, read_rotation(g, inertia));
    if (g.fixed) return kind;
    b.inverse_mass = 1 / inertia.mass;
    if (g.rotates) read_spin(g, inertia, b);
    return kind;
  }
  void move(int i, const PairState& state) {
    Body<dim>& b = bodies_[i];
    b.position = in_space<dim>(state.position);
    b.velocity = in_space<dim>(state.velocity);
    b.spin = turning_in_space<dim>(state.spin);
    if constexpr (dim == 2) shapes_.place(i, b, state.angle);
  }
  template <Measures measures>
  bool overlap(Overlap& o) {
    if (is_wall_) return shapes_.template overlap_plane<measures>(0, bodies_[0], plane_, o);
    return shapes_.template overlap<measures>(0, bodies_[0], 1, bodies_[1], feature_, o);
  }
  /// What a wall is to the law: without arm, as heavy as none, with its velocity at the contact.
  Body<dim> wall_body(const PairState& state, const Overlap& o) const {
    Body<dim> body = Acting::wall_body();
    const SpinOf<dim> spin = turning_in_space<dim>(state.spin);
    const Vector at = point_at<Acting::central>(bodies_[0], o);
    body.velocity = in_space<dim>(state.velocity) + velocity_at(spin, Vector(at - plane_.point));
    body.spin = spin;
    return body;
  }

  Acting acting_;
  typename Acting::Rule rule_;
  Store shapes_;
  std::array<Body<dim>, 2> bodies_;
  int count_ = 0;
  bool is_wall_ = false;
  Plane<dim> plane_;
  typename Acting::Feature feature_;
  typename Acting::Memory memory_;
  RollingMemory<dim> rolling_;
};

template <class Store>
std::unique_ptr<PairContact> contact_of(const EngineSettings& settings, const NewGrain& first,
                                        const NewGrain* second, const Wall* wall) {
  const AnyLaw& any =
      settings.material_pairs.empty() ? settings.law : settings.material_pairs.front().law;
  return std::visit(
      [&]<LawEntry Law>(const Law&) -> std::unique_ptr<PairContact> {
        if constexpr (GoesWith<Law, Store>) {
          return std::make_unique<ContactOf<Store, Law>>(settings, first, second, wall);
        } else {
          throw std::invalid_argument(fmt::format(
              "material.law: found \"{}\", allowed for grains of this shape: {}", Law::name,
              fmt::join(words_where<AnyLaw>([]<class L>() { return GoesWith<L, Store>; }), ", ")));
        }
      },
      any);
}

std::unique_ptr<PairContact> make(const EngineSettings& settings, const NewGrain& first,
                                  const NewGrain* second, const Wall* wall) {
  check_materials(settings);
  check_rolling(settings);
  if (settings.resist_rolling() && settings.shape == ShapeKind::polygon) refuse_rolling_polygons();
  if (settings.resist_rolling() && settings.shape == ShapeKind::superellipsoid) {
    refuse_rolling_superellipsoids();
  }
  return settings.shape.visit([&](auto kind) {
    return contact_of<typename decltype(kind)::Store>(settings, first, second, wall);
  });
}

}  // namespace

std::unique_ptr<PairContact> make_pair_contact(const EngineSettings& settings,
                                               const NewGrain& first, const NewGrain& second) {
  return make(settings, first, &second, nullptr);
}

std::unique_ptr<PairContact> make_pair_contact(const EngineSettings& settings,
                                               const NewGrain& grain, const Wall& wall) {
  return make(settings, grain, nullptr, &wall);
}

}  // namespace grainfield::dem
