#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "continuum/constants.h"
#include "coupling/elastic_constants/constants.h"
#include "coupling/elastic_constants/samples.h"

namespace grainfield::coupling {
namespace {

// Squared strain of one kind below this share of the whole is rounding (1e-9 in amplitude).
constexpr double least_share = 1e-18;

// Sums from which K and G follow; they add up over samples and realizations.
// Normal equation of y = 2 e k: y and e are the traces (k is K) or the deviators (k is G).
struct StiffnessSums {
  double strain = 0;  // 4 sum of w e^2
  double right = 0;   // 2 sum of w e y
  double stress = 0;  // sum of w y^2

  void add(const StiffnessSums& other) {
    strain += other.strain;
    right += other.right;
    stress += other.stress;
  }
  // k; nan without strain.
  double stiffness() const;
  // Share of the stress that the fit explains.
  double share() const;
};

struct IsotropicSums {
  StiffnessSums trace, deviator;

  void add(const Sample& sample);
  void add(const IsotropicSums& other) {
    trace.add(other.trace);
    deviator.add(other.deviator);
  }
  bool has_volume_change() const;  // of the strain, above rounding
  bool has_shear() const;
  // K, G, E, nu; nan where undefined.
  Eigen::Vector4d constants() const;
};

// Strain (rows 0..1) or stress as pairs that enter the deviator: normal difference and twice the
// shear; the sum of their squares is (xx - yy)^2 + 4 xy^2.
Eigen::Vector2d deviator_of(const Eigen::Vector3d& t) { return {t[0] - t[1], 2 * t[2]}; }

double StiffnessSums::stiffness() const { return strain > 0 ? right / strain : kNan; }

// The residual of least squares is sum y^2 - right k.
double StiffnessSums::share() const {
  return stress > 0 ? std::clamp(right * stiffness() / stress, 0.0, 1.0) : kNan;
}

void IsotropicSums::add(const Sample& sample) {
  const auto enter = [&](StiffnessSums& sums, double e, double y) {
    sums.strain += 4 * sample.weight * e * e;
    sums.right += 2 * sample.weight * e * y;
    sums.stress += sample.weight * y * y;
  };
  enter(trace, sample.strain[0] + sample.strain[1], sample.stress[0] + sample.stress[1]);
  const Eigen::Vector2d e = deviator_of(sample.strain), y = deviator_of(sample.stress);
  enter(deviator, e[0], y[0]);
  enter(deviator, e[1], y[1]);
}

bool IsotropicSums::has_volume_change() const {
  return trace.strain > least_share * (trace.strain + deviator.strain);
}

bool IsotropicSums::has_shear() const {
  return deviator.strain > least_share * (trace.strain + deviator.strain);
}

Eigen::Vector4d IsotropicSums::constants() const {
  const double k = has_volume_change() ? trace.stiffness() : kNan,
               g = has_shear() ? deviator.stiffness() : kNan;
  return {k, g, 3 * g - g * g / k, (1 - g / k) / 2};
}

std::string note_of(const IsotropicSums& all, const Eigen::Vector4d& c, int samples) {
  if (samples == 0) return "no point with both stress and strain: no constants";
  const bool volume = all.has_volume_change(), shear = all.has_shear();
  if (!volume && !shear) return "no strain: no constants";
  if (!volume) return "no change of volume: K, E and nu are undefined";
  if (!shear) return "no shear: G, E and nu are undefined";
  if (!(c[0] > 0) || !(c[1] > 0))
    return fmt::format("K {:.4g} N/m, G {:.4g} N/m: not a stable elastic material", c[0], c[1]);
  if (!(c[3] > -1))
    return fmt::format("nu is {:.4g}, below -1: not a stable elastic material", c[3]);
  return "";
}

}  // namespace

IsotropicConstants isotropic_constants(const Increments& increments, const Locality& where,
                                       const ElasticOptions& options) {
  const std::vector<Samples> all = gather(increments, where);
  IsotropicConstants result;
  result.realizations = increments.realizations();
  for (const Samples& one : all) result.samples += static_cast<int>(one.size());
  std::vector<IsotropicSums> sums(all.size());
  for (std::size_t r = 0; r < all.size(); ++r)
    for (const Sample& sample : all[r]) sums[r].add(sample);
  const auto reduce = [&](const std::vector<int>& chosen) {
    IsotropicSums drawn;
    for (const int r : chosen) drawn.add(sums[static_cast<std::size_t>(r)]);
    return drawn;
  };
  const auto statistic = [&](const std::vector<int>& chosen) {
    return Eigen::VectorXd(reduce(chosen).constants());
  };
  const auto intervals = bootstrap(result.realizations, statistic, options.bootstrap);
  result.bulk = constant_of(intervals[0]);
  result.shear = constant_of(intervals[1]);
  result.young = constant_of(intervals[2]);
  result.poisson = constant_of(intervals[3]);

  std::vector<int> everyone;
  for (int r = 0; r < result.realizations; ++r) everyone.push_back(r);
  const IsotropicSums whole = reduce(everyone);
  if (whole.has_volume_change()) result.bulk_share = whole.trace.share();
  if (whole.has_shear()) result.shear_share = whole.deviator.share();
  result.note = note_of(whole, whole.constants(), result.samples);
  return result;
}

}  // namespace grainfield::coupling
