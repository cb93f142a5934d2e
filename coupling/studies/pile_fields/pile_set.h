// The piles of an ensemble on one grid of scaled points, at rest and under changed gravities.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/case/case.h"
#include "coupling/run/realization_file.h"
#include "coupling/specimen/pile_frame.h"
#include "coupling/strain/strain.h"
#include "coupling/studies/pile_fields/setup.h"

namespace grainfield::coupling {

/// One pile averaged on the grid's points (RVE: a circle, particle-centre averaging).
struct PileFields {
  Field rest;           ///< all quantities of average(); stresses in N/m
  Field stress_change;  ///< stresses of the changed state less those at rest, N/m
  StrainResult strain;  ///< of fields.measure, from rest to the changed state
  Gaps gaps;            ///< points without enough grains
};

class PileSet {
 public:
  /// Measures every pile and lays the grid. Throws std::invalid_argument for a file without a
  /// snapshot "pile" or without a changed gravity, and when the RVE is too large for the heaps.
  PileSet(const Case& value, const std::vector<std::string>& files, int threads);

  int count() const { return static_cast<int>(files_.size()); }
  /// Read from its file at every call.
  Realization realization(int r) const { return read_realization(files_[at(r)]); }
  const PileFrame& frame(int r) const { return frames_[at(r)]; }
  const Case& setup() const { return value_; }
  int threads() const { return threads_; }
  int resamples() const { return static_cast<int>(value_.get<FieldsSetup>().resamples); }

  /// The snapshot with the gravity nearest to the piles' own: small strains.
  const std::string& change() const { return change_; }
  /// All of them, "gravity_G", from the lowest G to the highest.
  const std::vector<std::string>& changes() const { return changes_; }
  /// Their gravities over that of the piles, in the same order.
  const std::vector<double>& gravity_ratios() const { return ratios_; }

  /// Means over the piles.
  double height() const { return mean(&PileFrame::height); }      ///< h, m
  double diameter() const { return mean(&PileFrame::diameter); }  ///< m
  double pressure() const;                                        ///< rho g h, N/m
  double mean(double PileFrame::*member) const;
  double radius() const { return radius_; }  ///< of the RVE, m

  const Eigen::MatrixXd& grid() const { return grid_; }  ///< scaled points, x fastest
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Row of the grid nearest to a height above the base, as share of h.
  int row_at(double height_share) const;
  /// Distance of a scaled point to the nearest flank or the floor, h; negative outside.
  double room(const Eigen::Vector2d& scaled) const;
  /// Grid points whose whole RVE is inside the mean heap.
  const std::vector<Eigen::Index>& inside() const { return inside_; }
  /// Grid points that are inside the mean heap themselves, by half an RVE: shown on maps.
  bool shown(Eigen::Index point) const { return shown_[static_cast<std::size_t>(point)]; }

  /// The pile on the grid; computed at the first call.
  const PileFields& fields(int r) const;
  /// particle_centre, circle of radius `radius`, m.
  AverageOptions average_options(double radius) const;
  /// Strain by `measure` on an element that sees as much as a circle of radius `radius`, m.
  StrainOptions strain_options(const std::string& measure, double radius) const;

  /// An empty field on the grid's points in m, heap's frame (apex at (0, 0), floor y = -h).
  Field on_grid() const;
  /// Mean over piles of scaled fields, in m and, stresses, in N/m of the mean pile.
  Field in_metres(const Ensemble& scaled) const;
  /// Sum over piles of the points without a value, in words; "" if every point inside has one.
  std::string gaps_text() const;

 private:
  static std::size_t at(int r) { return static_cast<std::size_t>(r); }

  const Case& value_;
  const std::vector<std::string>& files_;
  int threads_;
  std::vector<PileFrame> frames_;
  std::string change_;
  std::vector<std::string> changes_;
  std::vector<double> ratios_;
  double radius_ = 0;
  Eigen::MatrixXd grid_;
  int columns_ = 0, rows_ = 0;
  std::vector<Eigen::Index> inside_;
  std::vector<bool> shown_;
  mutable std::vector<std::unique_ptr<PileFields>> fields_;
};

}  // namespace grainfield::coupling
