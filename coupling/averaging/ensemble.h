// Realizations to mean and standard error.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/base/field.h"

namespace grainfield::coupling {

/// Collects the same field of several realizations. Add in the order of the realization number:
/// sums run in the order of adding, so that threads or ranks do not change bits.
class Ensemble {
 public:
  /// The points of the first field are the ensemble's; the others must have as many, and the same
  /// columns. Throws std::invalid_argument saying what differs.
  void add(const Field& field);
  int realizations() const { return static_cast<int>(fields_.size()); }
  /// Mean, and standard error s/sqrt(N) of it (nan with one realization). A point that is nan in
  /// any realization is nan. Throws std::invalid_argument without realizations.
  Field mean() const;
  /// The mean with the single values of the stresses, of two realizations or more.
  Field with_samples() const;
  /// points x realizations of one column; for covariances. Throws for an unknown column.
  Eigen::MatrixXd samples(const std::string& column) const;

 private:
  std::vector<Field> fields_;
};

}  // namespace grainfield::coupling
