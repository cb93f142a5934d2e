#include "coupling/fit/weights.h"

#include <fmt/format.h>

#include <cmath>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

constexpr double kCopies = 1e-9;  // of the largest value: copies of one packing differ by that

}  // namespace

Weights weights_of(const FitData& data) {
  check(data);
  const int n = data.values(), r = data.realizations();
  Weights out;
  out.weight =
      data.scale.size() > 0 ? Eigen::VectorXd(data.scale.cwiseInverse()) : Eigen::VectorXd::Ones(n);
  out.error = Eigen::VectorXd::Constant(n, kNan);
  if (r == 1) {
    if (data.error.size() > 0) {
      out.errors_from = ErrorsFrom::data;
      out.error = data.error;
      out.note = "single realizations unknown: errors from the field's standard errors";
    } else {
      out.note = "one realization: no errors, nothing is distinguishable";
    }
    return out;
  }
  const Eigen::MatrixXd off = data.samples.colwise() - data.mean();
  if (off.cwiseAbs().maxCoeff() <= kCopies * data.samples.cwiseAbs().maxCoeff()) {
    out.note = fmt::format("all {} realizations are equal: no errors", r);
    return out;
  }
  out.errors_from = ErrorsFrom::realizations;
  out.error = (off.rowwise().squaredNorm() / (static_cast<double>(r) * (r - 1))).cwiseSqrt();
  return out;
}

}  // namespace grainfield::coupling
