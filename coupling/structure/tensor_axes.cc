#include "coupling/structure/tensor_axes.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

// Principal values nearer than this to each other, relative to the largest: no axis.
constexpr double kCoincide = 1e-12;

const Eigen::VectorXd& need(const Field& field, const std::string& name) {
  const Column* column = field.find(name);
  if (!column) {
    std::string found;
    for (const Column& c : field.columns) found += (found.empty() ? "" : ", ") + c.name;
    throw std::invalid_argument("the field has no column " + name + "; it has: " + found);
  }
  return column->value;
}

// (-90, 90]
double as_axis(double degrees) {
  while (degrees <= -90) degrees += 180;
  while (degrees > 90) degrees -= 180;
  return degrees;
}

}  // namespace

double TensorAxes::trace() const { return values.head(dim).sum(); }

double TensorAxes::deviator() const {
  if (dim == 2) return values[0] - values[1];
  const Eigen::Vector3d s = values.array() - values.mean();
  return std::sqrt(1.5 * s.squaredNorm());
}

double TensorAxes::deviatoric_fraction() const {
  return trace() == 0 ? kNan : deviator() / trace();
}

double TensorAxes::angle_deg(int k) const {
  const double largest = values.head(dim).cwiseAbs().maxCoeff();
  if (dim != 2 || !(deviator() > kCoincide * largest)) return kNan;
  return as_axis(std::atan2(axes(1, k), axes(0, k)) * 180 / std::numbers::pi);
}

TensorAxes tensor_axes(const Eigen::Matrix3d& tensor, int dim) {
  TensorAxes out;
  out.dim = dim;
  const Eigen::Matrix3d symmetric = (tensor + tensor.transpose()) / 2;
  if (!symmetric.topLeftCorner(dim, dim).allFinite()) {
    out.values.head(dim).setConstant(kNan);
    out.axes.setConstant(kNan);
    return out;
  }
  const auto put = [&](const auto& solver) {
    for (int k = 0; k < dim; ++k) {
      out.values[k] = solver.eigenvalues()[dim - 1 - k];
      out.axes.col(k).head(dim) = solver.eigenvectors().col(dim - 1 - k);
    }
  };
  if (dim == 2) {
    const Eigen::Matrix2d plane = symmetric.topLeftCorner<2, 2>();
    put(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(plane));
  } else {
    put(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric));
  }
  return out;
}

TensorAxes tensor_axes(double xx, double yy, double xy) {
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  tensor.topLeftCorner<2, 2>() << xx, xy, xy, yy;
  return tensor_axes(tensor, 2);
}

double angle_between_axes_deg(double a, double b) { return std::abs(as_axis(a - b)); }

void add_tensor_columns(Field& field, const std::string& name, MajorAxis major) {
  const Eigen::VectorXd xx = need(field, name + "_xx"), yy = need(field, name + "_yy");
  Eigen::VectorXd xy = need(field, name + "_xy");
  if (const Column* yx = field.find(name + "_yx")) xy = (xy + yx->value) / 2;
  const std::string unit = field.find(name + "_xx")->unit;
  const Eigen::Index n = xx.size();
  Eigen::MatrixX4d values(n, 4);
  for (Eigen::Index p = 0; p < n; ++p) {
    const TensorAxes axes = tensor_axes(xx[p], yy[p], xy[p]);
    values.row(p) << axes.trace(), axes.deviator(), axes.deviatoric_fraction(),
        axes.angle_deg(major == MajorAxis::largest ? 0 : 1);
  }
  field.add(name + "_trace", unit).value = values.col(0);
  field.add(name + "_deviator", unit).value = values.col(1);
  field.add(name + "_fraction", "1").value = values.col(2);
  field.add(name + "_angle", "deg").value = values.col(3);
}

void add_angle_between(Field& field, const std::string& a, const std::string& b) {
  const Eigen::VectorXd first = need(field, a + "_angle"), second = need(field, b + "_angle");
  Eigen::VectorXd between(first.size());
  for (Eigen::Index p = 0; p < first.size(); ++p)
    between[p] =
        std::isfinite(first[p] - second[p]) ? angle_between_axes_deg(first[p], second[p]) : kNan;
  field.add("angle_" + a + "_" + b, "deg").value = between;
}

}  // namespace grainfield::coupling
