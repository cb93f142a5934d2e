#include "coupling/elastic_constants/isotropic.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

// Squared strain of one kind below this share of the whole is rounding (1e-9 in amplitude).
constexpr double least_share = 1e-18;

// A degree-1 fit whose equations are closer to singular than this is undefined.
constexpr double least_pivot = 1e-10;

// Strain (rows 0..1) or stress as pairs that enter the deviator: normal difference and twice the
// shear; the sum of their squares is (xx - yy)^2 + 4 xy^2.
Eigen::Vector2d deviator_of(const Eigen::Vector3d& t) { return {t[0] - t[1], 2 * t[2]}; }

Eigen::VectorXd solve(const StiffnessSums& sums, int degree) {
  const Eigen::Index n = degree == 0 ? 1 : 3;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(least_pivot);
  qr.compute(sums.matrix.topLeftCorner(n, n));
  if (!(sums.matrix(0, 0) > 0) || qr.rank() < n) return Eigen::VectorXd::Constant(n, kNan);
  return qr.solve(sums.right.head(n));
}

}  // namespace

double StiffnessSums::stiffness(int degree) const {
  if (degree == 0) return matrix(0, 0) > 0 ? right[0] / matrix(0, 0) : kNan;
  return solve(*this, degree)[0];
}

double StiffnessSums::share(int degree) const {
  const Eigen::VectorXd k = solve(*this, degree);
  // The residual of least squares is sum y^2 - right . k.
  return stress > 0 ? std::clamp(right.head(k.size()).dot(k) / stress, 0.0, 1.0) : kNan;
}

void IsotropicSums::add(const Sample& sample, double scale) {
  const Eigen::Vector3d place(1, sample.offset.x() / scale, sample.offset.y() / scale);
  const auto enter = [&](StiffnessSums& sums, double e, double y) {
    sums.matrix += 4 * sample.weight * e * e * place * place.transpose();
    sums.right += 2 * sample.weight * e * y * place;
    sums.stress += sample.weight * y * y;
  };
  enter(trace, sample.strain[0] + sample.strain[1], sample.stress[0] + sample.stress[1]);
  const Eigen::Vector2d e = deviator_of(sample.strain), y = deviator_of(sample.stress);
  enter(deviator, e[0], y[0]);
  enter(deviator, e[1], y[1]);
}

bool IsotropicSums::has_volume_change() const {
  return trace.matrix(0, 0) > least_share * (trace.matrix(0, 0) + deviator.matrix(0, 0));
}

bool IsotropicSums::has_shear() const {
  return deviator.matrix(0, 0) > least_share * (trace.matrix(0, 0) + deviator.matrix(0, 0));
}

Eigen::Vector4d IsotropicSums::constants(int degree) const {
  const double k = has_volume_change() ? trace.stiffness(degree) : kNan,
               g = has_shear() ? deviator.stiffness(degree) : kNan;
  return {k, g, 3 * g - g * g / k, (1 - g / k) / 2};
}

namespace {

std::string note_of(const IsotropicSums& all, const Eigen::Vector4d& c, int samples) {
  if (samples == 0) return "no point with both stress and strain: no constants";
  const bool volume = all.has_volume_change(), shear = all.has_shear();
  if (!volume && !shear) return "no strain: no constants";
  if (!volume) return "no change of volume: K, E and nu are undefined";
  if (!shear) return "no shear: G, E and nu are undefined";
  if (std::isnan(c[0]) || std::isnan(c[1]))
    return "the points do not determine constants that vary linearly: use degree 0 or a larger "
           "width";
  if (!(c[0] > 0) || !(c[1] > 0))
    return fmt::format("K {:.4g} N/m, G {:.4g} N/m: not a stable elastic material", c[0], c[1]);
  if (!(c[3] > -1))
    return fmt::format("nu is {:.4g}, below -1: not a stable elastic material", c[3]);
  return "";
}

}  // namespace

IsotropicConstants isotropic_constants(const Increments& increments, const Locality& where,
                                       const ElasticOptions& options) {
  check_options(options);
  const std::vector<Samples> all = gather(increments, where);
  IsotropicConstants result;
  result.realizations = increments.realizations();
  double scale = 0;
  for (const Samples& one : all) {
    result.samples += static_cast<int>(one.list.size());
    for (const Sample& sample : one.list) scale = std::max(scale, sample.offset.norm());
  }
  if (scale == 0) scale = 1;

  std::vector<IsotropicSums> sums(all.size());
  for (std::size_t r = 0; r < all.size(); ++r)
    for (const Sample& sample : all[r].list) sums[r].add(sample, scale);
  const auto reduce = [&](const std::vector<int>& chosen) {
    IsotropicSums drawn;
    if (options.samples == "mean")
      for (const Sample& sample : mean_samples(all, chosen, increments.points.rows()))
        drawn.add(sample, scale);
    else
      for (const int r : chosen) drawn.add(sums[static_cast<std::size_t>(r)]);
    return drawn;
  };
  const auto statistic = [&](const std::vector<int>& chosen) {
    return Eigen::VectorXd(reduce(chosen).constants(options.degree));
  };
  const auto intervals = bootstrap(result.realizations, statistic, options.bootstrap);
  result.bulk = constant_of(intervals[0]);
  result.shear = constant_of(intervals[1]);
  result.young = constant_of(intervals[2]);
  result.poisson = constant_of(intervals[3]);

  std::vector<int> everyone;
  for (int r = 0; r < result.realizations; ++r) everyone.push_back(r);
  const IsotropicSums whole = reduce(everyone);
  if (whole.has_volume_change()) result.bulk_share = whole.trace.share(options.degree);
  if (whole.has_shear()) result.shear_share = whole.deviator.share(options.degree);
  result.note = note_of(whole, whole.constants(options.degree), result.samples);
  return result;
}

Field elastic_constants_field(const Increments& increments, const Eigen::MatrixXd& centres,
                              const std::string& kernel, double width,
                              const ElasticOptions& options) {
  if (centres.cols() != 2)
    throw std::invalid_argument(
        fmt::format("centres have {} coordinates; elastic constants need 2", centres.cols()));
  Field field;
  field.points = centres;
  field.realizations = increments.realizations();
  const std::vector<std::string> names{"bulk", "shear", "young", "poisson"};
  for (const std::string& name : names) {
    const std::string unit = name == "poisson" ? "1" : "N/m";
    Column& column = field.add(name, unit);
    column.error = column.value;
    field.add(name + "_low", unit);
    field.add(name + "_high", unit);
  }
  field.add("bulk_share", "1");
  field.add("shear_share", "1");
  field.add("samples", "1");
  for (Eigen::Index p = 0; p < centres.rows(); ++p) {
    const IsotropicConstants c = isotropic_constants(
        increments, locality(increments.points, centres.row(p).transpose(), kernel, width),
        options);
    const Constant* all[] = {&c.bulk, &c.shear, &c.young, &c.poisson};
    for (std::size_t k = 0; k < names.size(); ++k) {
      field.columns[3 * k].value[p] = all[k]->value;
      field.columns[3 * k].error[p] = all[k]->error;
      field.columns[3 * k + 1].value[p] = all[k]->low;
      field.columns[3 * k + 2].value[p] = all[k]->high;
    }
    field.columns[12].value[p] = c.bulk_share;
    field.columns[13].value[p] = c.shear_share;
    field.columns[14].value[p] = c.samples;
  }
  field.attributes = {
      {"what", "isotropic elastic constants, plane strain"},
      {"kernel", kernel},
      {"width", fmt::format("{} m", width)},
      {"samples", options.samples},
      {"interval", fmt::format("{} {}", options.bootstrap.interval, options.bootstrap.level)}};
  return field;
}

}  // namespace grainfield::coupling
