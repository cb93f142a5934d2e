// What is fitted: stress components on points, realization by realization.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace grainfield::coupling {

/// Values to fit, one row each: a component at a point. Only rows that every realization has.
struct FitData {
  Eigen::MatrixXd points;               ///< values x 2, m, in the models' frame
  std::vector<int> component;           ///< of each value: index into `components`
  std::vector<int> level;               ///< of each value: the height or depth it belongs to
  std::vector<std::string> components;  ///< of sigma_xx, sigma_yy, sigma_xy
  std::vector<std::string> levels;      ///< names, e.g. "height 0.25"
  Eigen::MatrixXd samples;              ///< values x realizations, N/m
  /// Standard errors of the mean where single realizations are not known (samples: one column, the
  /// mean); else empty.
  Eigen::VectorXd error;
  /// Working unit of every value, N/m: its difference from a model counts in this. A stated, smooth
  /// function of the place, never of the ensemble. Empty: 1.
  Eigen::VectorXd scale;

  /// Components that have values; of a point they may be tied, and count as one then.
  int tied() const;
  int values() const { return static_cast<int>(samples.rows()); }
  int realizations() const { return static_cast<int>(samples.cols()); }
  Eigen::VectorXd mean() const { return samples.rowwise().mean(); }
};

/// The realizations named, in this order, with repetitions.
FitData realizations_of(const FitData& data, const std::vector<int>& chosen);

/// The rows of this component at this level.
std::vector<int> rows_at(const FitData& data, int component, int level);

/// The rows named; points, components, levels and samples together.
FitData rows_of(const FitData& data, const std::vector<int>& rows);

/// Its points, each place once: components share them.
Eigen::MatrixXd places_of(const FitData& data);

/// Places that models are asked for at once, to be found again.
class Places {
 public:
  explicit Places(const Eigen::MatrixXd& points);
  /// The rows of `values` (one per place) that belong to these points, each of which must be one of
  /// the places. Throws std::logic_error otherwise.
  Eigen::MatrixXd pick(const Eigen::MatrixXd& values, const Eigen::MatrixXd& points) const;
  const Eigen::MatrixXd& points() const { return points_; }

 private:
  Eigen::MatrixXd points_;
  std::map<std::pair<double, double>, Eigen::Index> row_;
};

/// Throws std::invalid_argument when sizes differ, a component is none of sigma_xx, sigma_yy,
/// sigma_xy, or a number is not finite.
void check(const FitData& data);

}  // namespace grainfield::coupling
