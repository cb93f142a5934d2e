// What a cone is made of: its grains, floor and walls, and the checks of its settings.
#pragma once
#include <array>
#include <map>
#include <vector>

#include "coupling/studies/cone/simulation.h"
#include "dem/grains/grain_family.h"
#include "dem/run/groundwork.h"

namespace grainfield::dem {

/// Fewer grains than this have no cone to speak of.
inline constexpr int kLeastOfCone = 50;
/// Grains start in a column as many of the largest radii high.
inline constexpr double kColumn = 8;

/// Throws ComputationFailed naming cone.mouth when grains would start above the cylinder's rim, m.
void check_cylinder(const ConeSetup& setup, double start);

/// What its run starts from (Groundwork).
struct ConeGroundwork {
  using Setup = ConeSetup;
  static constexpr const char* kName = "cone";
  static void check(const Setup& setup);
  /// In the order in which they are poured.
  static std::vector<ShapedGrain> draw(const Setup& setup, Random& random, Allowance& allowance);
  static EngineSettings settings(const Setup& setup, const std::vector<ShapedGrain>& grains,
                                 double reserve);
  static Outlook outlook(const Setup& setup, const EngineSettings& settings);
};

/// The fixed spheres of a rough floor, of the radius cone.radius in rows that let no grain through,
/// tops at z = 0; none of a smooth one. And their number, about.
std::vector<NewGrain> cone_floor(const ConePlan& plan, double density);
double floor_grains_of(const ConePlan& plan);
/// The plane "floor" (of a rough floor out of reach), and "cylinder".
std::vector<Wall> cone_walls(const ConeSetup& setup, bool with_cylinder);
/// Radius within which grains start, m.
double source_radius(const ConePlan& plan);
/// Height to which the grains fill the cylinder, about, m.
double filled_height(const ConePlan& plan);

NewGrain placed_grain(const ShapedGrain& grain, double x, double y, double z, double density);
/// Top of the free grains that a chain of contacts ties to the floor, m; 0 without any.
double resting_height(const Snapshot& snapshot);
/// Top of the free grains within this distance from the axis, m; 0 without any.
double top_within(const Snapshot& snapshot, double radius);
/// resting_height by place: heights of square cells, `cell` wide or more, m, over the square of
/// half side `half` about the axis.
class LocalTops {
 public:
  LocalTops(const Snapshot& snapshot, double half, double cell);
  /// The highest of the cell at (x, y) and its neighbours; 0 where nothing lies.
  double at(double x, double y) const;

 private:
  int cell_of(double x) const;
  double half_, cell_;
  int count_;
  std::vector<double> top_;
};
/// Places that no ball takes.
class FreePlaces {
 public:
  /// Taken: those of the snapshot's grains. `largest`: radius of any ball to come, m.
  FreePlaces(const Snapshot& snapshot, double largest);
  /// Takes it for a ball; false: another one is there.
  bool take(double x, double y, double z, double radius);

 private:
  struct Ball {
    double x, y, z, radius;
  };
  std::array<std::int64_t, 3> cell_of(double x, double y, double z) const;
  void put(const Ball& ball);
  double cell_;
  std::map<std::array<std::int64_t, 3>, std::vector<Ball>> balls_;
};
/// Whether it lies beyond the floor, or below it: a small grain in a hollow of a rough floor does
/// not.
bool has_left(const Grain& grain, const ConePlan& plan);
/// Takes the grains away that have left, and, unless it is kept, the cylinder; numbers the others
/// anew in their order.
void keep_on_floor(const ConePlan& plan, bool with_cylinder, Snapshot& snapshot);

}  // namespace grainfield::dem
