// What is different of layers in the plane and in space: how they are built and judged, and what
// bounds their time step.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coupling/studies/point_load/simulation.h"
#include "dem/engine/engine.h"
#include "dem/grains/grain_family.h"
#include "dem/grains/packing.h"
#include "dem/run/archive.h"
#include "dem/run/groundwork.h"

namespace grainfield::dem {

/// A layer that is being built. The static functions before it are its Groundwork. `in_phase`: s
/// since it began, or since the last grains were added.
template <int D>
class Layer;

/// What the building of a layer has come to.
enum class Built { no, in_part, yes };

/// Lattices, and rows of disks or pentagons that are dropped one after the other.
template <>
class Layer<2> {
 public:
  using Setup = PointLoadSetup;
  static constexpr const char* kName = "point load";
  static void check(const Setup& setup);
  static GrainSupply draw(const Setup& setup, Random& random, Allowance& allowance);
  static EngineSettings settings(const Setup& setup, const GrainSupply& grains, double reserve);
  static Outlook outlook(const Setup& setup, const EngineSettings& settings);

  /// Share of a run that the building takes.
  static constexpr double kBuilding = 0.4;
  static constexpr const char* kLowerLoad = ", or lower load.force";
  /// Radii about the place of the load within which the highest grain is looked for first.
  static constexpr double kReach = 1;
  static bool falls(const Setup& setup) { return setup.packing.kind == "layered"; }
  static std::vector<Wall> walls(const Setup& setup);
  static std::vector<double> sides(const Setup& setup);
  static double height(const Snapshot& snapshot, const Setup& setup);
  static void add_figures(const Setup&, const Snapshot&, std::map<std::string, double>&) {}

  Layer(const Setup& setup, std::uint64_t seed);
  const GrainSupply& grains() const { return supply_; }
  void begin(Engine& engine);
  /// Drops the next row where that is due.
  Built go_on(Engine& engine, double in_phase);
  double share(const Diagnostics& state, double in_phase) const;
  std::string phase() const;
  void visit(Archive& archive);

 private:
  void drop_row(Engine& engine);

  Setup setup_;
  Random random_;
  GrainSupply supply_;
  int rows_dropped_ = 0;
};

/// The fixed grains of a floor and the grains above it.
struct SpaceGrains {
  std::vector<NewGrain> floor;
  std::vector<ShapedGrain> free;
};

/// Close packings, and grains that settle from random places.
template <>
class Layer<3> {
 public:
  using Setup = PointLoadSetup;
  static constexpr const char* kName = Layer<2>::kName;
  static void check(const Setup& setup);
  /// Superellipsoids; spheres, whose extremes are known, are drawn as they are placed.
  static SpaceGrains draw(const Setup& setup, Random& random, Allowance& allowance);
  static EngineSettings settings(const Setup& setup, const SpaceGrains& grains, double reserve);
  static Outlook outlook(const Setup& setup, const EngineSettings& settings);

  static constexpr double kBuilding = 0.2;
  static constexpr const char* kLowerLoad = ", or lower load.weights or load.force";
  /// Within one radius, as in the plane, there may be a pit alone, whose highest grain lies deep
  /// below the surface.
  static constexpr double kReach = 4;
  static bool falls(const Setup& setup) { return setup.packing.kind == "random"; }
  static std::vector<Wall> walls(const Setup& setup);
  static std::vector<double> sides(const Setup& setup);
  static double height(const Snapshot& snapshot, const Setup& setup);
  static void add_figures(const Setup& setup, const Snapshot& loaded,
                          std::map<std::string, double>& figures);

  Layer(const Setup& setup, std::uint64_t seed);
  const SpaceGrains& grains() const { return grains_; }
  void begin(Engine& engine);
  Built go_on(const Engine& engine, double in_phase) const;
  double share(const Diagnostics& state, double in_phase) const;
  std::string phase() const { return "settle"; }
  void visit(Archive&) {}

 private:
  double fall_time() const;

  Setup setup_;
  Random random_;
  SpaceGrains grains_;  // until they are placed
};

}  // namespace grainfield::dem
