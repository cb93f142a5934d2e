// What measured stresses carry of the weight above them, or of the load.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/base/field.h"

namespace grainfield::coupling {

/// Shares outside of these are warned of,
inline constexpr double kLeastShare = 0.9, kMostShare = 1.1;
/// and those that differ from what they should be by more than kClearShare and so many of their own
/// errors: a model carries all of the weight.
inline constexpr double kClearShare = 0.02, kClearErrors = 3;

/// A measured heap as its field tells it: a wedge, or in space a cone.
struct MeasuredHeap {
  int dim = 2;
  double left = 0, right = 0;  ///< from the axis to the feet, m
  double weight = 0;           ///< of the wedge, N/m; of the cone, N

  /// Weight of what is above [from, to] of the base of the wedge, N/m.
  double weight_above(double from, double to) const;
  /// Weight of what is above the base of the cone out to this radius, N.
  double weight_within(double radius) const;
};
/// Nothing for another field.
std::optional<MeasuredHeap> measured_heap(const Field& field);

/// A pressure on one level; in space `x` is the distance from the axis.
struct LevelPressure {
  double x = 0, pressure = 0, error = 0;  ///< m; N/m (3D: Pa); nan: unknown
};
/// Those on the base of a heap between its feet, from left to right.
std::vector<LevelPressure> base_pressures(const Field& field, const MeasuredHeap& heap);

/// Share of the weight above the places, or of the load, that the pressures carry.
struct CarriedShare {
  double share = 0;
  double error = 0;     ///< standard error, of the values' own; nan: they have none
  std::string carrier;  ///< "the pressures on the base"
  std::string carried;  ///< "the weight above them", "the load within 0.3 m of it"
  /// Shares at these places of pressures that are right: 1, and that of the weight above each place
  /// (of the half plane's response, which spreads most), straight between the places as they are.
  double least = 1, most = 1;
  std::string instead;  ///< the option with which the share is 1: "--rho-g 13950"
};
/// Share of a measured heap or response; nothing where fewer than five places share a level, or no
/// load is known. Between places the pressures are straight; in space they are those of rings
/// about the axis.
std::optional<CarriedShare> carried_share(const Field& field);

/// "the pressures on the base carry 0.83 +- 0.02 of the weight above them".
std::string share_text(const CarriedShare& share);
/// share_text() with what to do, for a share that is warned of; else empty.
std::string share_doubt(const CarriedShare& share);

}  // namespace grainfield::coupling
