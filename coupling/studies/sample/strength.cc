#include "coupling/studies/sample/strength.h"

#include <algorithm>
#include <cmath>

#include "continuum/constants.h"
#include "coupling/studies/sample/figures.h"
#include "coupling/studies/sample/simulation/path.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Half the width of a window of slopes, as a share of the states; one state at least.
constexpr double kHalfWindow = 0.1;

double friction_deg(StrengthTest test, double driving, double holding) {
  if (test == StrengthTest::shear) return std::atan2(driving, holding) / kDegree;
  const double sine = (driving - holding) / (driving + holding);
  return std::fabs(sine) <= 1 ? std::asin(sine) / kDegree : kNan;
}

double dilation_deg(StrengthTest test, double slope) {
  if (test == StrengthTest::shear) return std::atan(slope) / kDegree;
  const double sine = slope / (2 + slope);
  return std::fabs(sine) <= 1 ? std::asin(sine) / kDegree : kNan;
}

// The slope of volumetric over strain by least squares, states `from` to `to`, both included.
double fitted_slope(const StrengthPath& path, Index from, Index to) {
  const Index n = to - from + 1;
  if (n < 2) return kNan;
  const VectorXd x = path.strain.segment(from, n).array() - path.strain.segment(from, n).mean();
  return x.dot(path.volumetric.segment(from, n)) / x.squaredNorm();
}

template <double Strength::*angle>
std::optional<double> known(const Strength& s) {
  return std::isfinite(s.*angle) ? std::optional<double>(s.*angle) : std::nullopt;
}

const std::vector<Figure<Strength>>& strength_rows() {
  // clang-format off
  static const std::vector<Figure<Strength>> rows{
      {"peak_friction_deg", "deg", "largest friction angle of the states that bear load: axial sin = (s1 - s3)/(s1 + s3), s3 the mean lateral stress; simple shear tan = tau/sigma of the planes that slide", known<&Strength::peak_friction>},
      {"strain_at_peak", "-", "shortening (logarithmic) or shear of that state", known<&Strength::strain_at_peak>},
      {"residual_friction_deg", "deg", "the same angle, mean of the states in the last quarter of strain", known<&Strength::residual_friction>},
      {"peak_dilation_deg", "deg", "largest dilation angle, from the slope x of the volumetric strain over a fifth of the states: axial sin = x/(2 + x), simple shear under constant stress tan = x", known<&Strength::peak_dilation>},
      {"dilation_at_peak_deg", "deg", "the same about the state of the peak of friction", known<&Strength::dilation_at_peak>},
      {"residual_dilation_deg", "deg", "the same over the last quarter of strain: 0 in the critical state", known<&Strength::residual_dilation>},
  };
  // clang-format on
  return rows;
}

}  // namespace

Strength strength_of(const StrengthPath& path) {
  Strength out{kNan, kNan, kNan, kNan, kNan, kNan};
  const Index last = path.strain.size() - 1;
  const auto bears = [&](Index k) { return path.bears[static_cast<std::size_t>(k)]; };
  Index peak = -1;
  for (Index k = 0; k <= last; ++k) {
    const double angle = friction_deg(path.test, path.driving[k], path.holding[k]);
    if (!bears(k) || std::isnan(angle) || (peak >= 0 && !(angle > out.peak_friction))) continue;
    peak = k;
    out.peak_friction = angle;
    out.strain_at_peak = path.strain[k];
  }
  const Index first = static_cast<Index>(std::ceil(kCriticalFrom * static_cast<double>(last)));
  bool residual = last - first >= 1;
  for (Index k = first; k <= last; ++k) residual = residual && bears(k);
  if (residual) {
    double sum = 0;
    for (Index k = first; k <= last; ++k) {
      sum += friction_deg(path.test, path.driving[k], path.holding[k]);
    }
    out.residual_friction = sum / static_cast<double>(last - first + 1);
  }
  if (path.volumetric.size() == 0) return out;
  const Index half =
      std::max<Index>(1, static_cast<Index>(std::lround(kHalfWindow * static_cast<double>(last))));
  const auto about = [&](Index k) {
    return fitted_slope(path, std::max<Index>(0, k - half), std::min(last, k + half));
  };
  double steepest = kNan;
  for (Index k = half; k + half <= last; ++k) {
    if (bears(k) && !(about(k) <= steepest)) steepest = about(k);
  }
  out.peak_dilation = dilation_deg(path.test, steepest);
  if (peak >= 0) out.dilation_at_peak = dilation_deg(path.test, about(peak));
  if (residual) out.residual_dilation = dilation_deg(path.test, fitted_slope(path, first, last));
  return out;
}

std::vector<StrengthPath> strength_paths(const StateTable& table, const dem::SamplePlan& plan) {
  std::vector<StrengthPath> out;
  const bool shear = dem::shears(plan);
  if (!shear && plan.deformation != "axial") return out;
  const Index n = plan.records + 1;
  const bool plane = table.dim() == 2;
  for (Index r = 0; r < table.realizations(); ++r) {
    const auto column = [&](const std::string& name) -> VectorXd {
      return table.of(name).col(r).head(n);
    };
    StrengthPath path;
    const VectorXd axial = -column(plane ? "sigma_yy" : "sigma_zz");
    if (shear) {
      path.test = StrengthTest::shear;
      path.strain = column("strain");
      path.driving = column(plane ? "sigma_xy" : "sigma_xz");
      path.holding = axial;
    } else {
      path.strain = -column(plane ? "strain_yy" : "strain_zz");
      path.driving = axial;
      path.holding = -column("sigma_xx");
      if (!plane) path.holding = 0.5 * (path.holding - column("sigma_yy"));
    }
    if (!shear || plan.constant != "volume") path.volumetric = column("volumetric_strain");
    const VectorXd p = column("p"), inertia = column("inertial_number");
    for (Index k = 0; k < n; ++k) {
      path.bears.push_back(p[k] > kLeastPressure * p[0] && inertia[k] < kMostInertia);
    }
    out.push_back(std::move(path));
  }
  return out;
}

FigureSamples strength_figures(const std::vector<StrengthPath>& paths) {
  FigureSamples out;
  for (const StrengthPath& path : paths) {
    add_samples(strength_rows(), strength_of(path), out, "strength.");
  }
  std::erase_if(out, [&](const auto& entry) { return entry.second.size() != paths.size(); });
  return out;
}

std::vector<SummaryKey> strength_summary_keys() { return declared(strength_rows(), "strength."); }

}  // namespace grainfield::coupling
