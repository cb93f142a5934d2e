#include "coupling/fit/covariance.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace grainfield::coupling {
namespace {

constexpr double kNugget = 0.02;  // keeps the whitening from resting on differences of neighbours
constexpr int kBins = 24;         // of distances, for the correlation length
constexpr double kLeastVariance = 1e-4;  // of a component's mean variance
constexpr double kRounding = 1e-9;       // of the largest value
constexpr int kLeastForOwn = 3;          // realizations: below, a value's own variance says nothing

double matern(double s) { return (1 + s) * std::exp(-s); }
double correlation_at(double distance, double length) {
  return distance == 0 ? 1 : (1 - kNugget) * matern(std::sqrt(3) * distance / length);
}

// Deviations from the mean, values x realizations.
Eigen::MatrixXd deviations(const FitData& data) { return data.samples.colwise() - data.mean(); }

Eigen::VectorXd sample_variances(const Eigen::MatrixXd& d) {
  return d.rowwise().squaredNorm() / static_cast<double>(d.cols() - 1);
}

// Mean of every component's variances, value by value.
Eigen::VectorXd of_component(const FitData& data, const Eigen::VectorXd& variance) {
  const auto m = data.components.size();
  std::vector<double> sum(m, 0), count(m, 0);
  for (int k = 0; k < data.values(); ++k) {
    const auto c = static_cast<std::size_t>(data.component[static_cast<std::size_t>(k)]);
    sum[c] += variance[k];
    count[c] += 1;
  }
  Eigen::VectorXd out(data.values());
  for (int k = 0; k < data.values(); ++k) {
    const auto c = static_cast<std::size_t>(data.component[static_cast<std::size_t>(k)]);
    out[k] = sum[c] / count[c];
  }
  return out;
}

// No value may count as exact: at least a small part of its component's mean variance, and of all
// components' where its own has none.
void keep_positive(const FitData& data, Eigen::VectorXd& variance) {
  const Eigen::VectorXd least =
      kLeastVariance * of_component(data, variance).cwiseMax(kLeastVariance * variance.mean());
  variance = variance.cwiseMax(least);
}

// Pooled correlations of one component by distance: mean per bin and pairs in it.
struct Correlogram {
  double bin = 0;
  std::vector<double> sum = std::vector<double>(kBins, 0), pairs = std::vector<double>(kBins, 0);
};

Correlogram correlogram(const FitData& data, const Eigen::MatrixXd& normalised) {
  const int n = data.values();
  Eigen::Vector2d low = data.points.colwise().minCoeff(), high = data.points.colwise().maxCoeff();
  Correlogram out;
  out.bin = 0.5 * (high - low).maxCoeff() / kBins;
  if (!(out.bin > 0)) return out;
  // Most values are far apart: the bins get finer towards 0, d = reach (k/kBins)^2.
  const double reach = 0.5 * (high - low).maxCoeff();
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (data.component[static_cast<std::size_t>(i)] !=
          data.component[static_cast<std::size_t>(j)]) {
        continue;
      }
      const double d = (data.points.row(i) - data.points.row(j)).norm();
      if (!(d < reach) || d == 0) continue;
      const auto k = static_cast<std::size_t>(kBins * std::sqrt(d / reach));
      out.sum[k] += normalised.row(i).dot(normalised.row(j));
      out.pairs[k] += 1;
    }
  }
  out.bin = reach;
  return out;
}

// Length of the Matern correlation nearest to the correlogram, by the pairs' number.
double fitted_length(const Correlogram& c) {
  if (!(c.bin > 0)) return 0;
  double best = 0, least = -1;
  for (int k = 0; k < 200; ++k) {
    const double length = c.bin * std::pow(10, -3 + 3.0 * k / 199);
    double error = 0;
    for (int b = 0; b < kBins; ++b) {
      const auto at = static_cast<std::size_t>(b);
      if (c.pairs[at] == 0) continue;
      const double middle = c.bin * std::pow((b + 0.5) / kBins, 2);
      const double off = c.sum[at] / c.pairs[at] - correlation_at(middle, length);
      error += c.pairs[at] / (1 + middle / c.bin * kBins) * off * off;
    }
    if (least < 0 || error < least) {
      least = error;
      best = length;
    }
  }
  return best;
}

// Correlation of different components at the same point, pooled over the points that have both.
// (Of sigma_xy with the others it is odd across a heap's axis and pools to about 0.)
Eigen::MatrixXd between_components(const FitData& data, const Eigen::MatrixXd& normalised) {
  const auto m = static_cast<Eigen::Index>(data.components.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(m, m), count = Eigen::MatrixXd::Zero(m, m);
  for (int i = 0; i < data.values(); ++i) {
    for (int j = i; j < data.values(); ++j) {
      if (data.points.row(i) != data.points.row(j)) continue;
      const int a = data.component[static_cast<std::size_t>(i)];
      const int b = data.component[static_cast<std::size_t>(j)];
      const double r = normalised.row(i).dot(normalised.row(j));
      sum(a, b) += r;
      count(a, b) += 1;
      if (a != b) {
        sum(b, a) += r;
        count(b, a) += 1;
      }
    }
  }
  Eigen::MatrixXd out = Eigen::MatrixXd::Identity(m, m);
  for (Eigen::Index a = 0; a < m; ++a) {
    for (Eigen::Index b = 0; b < m; ++b) {
      if (a != b && count(a, b) > 0) out(a, b) = std::clamp(sum(a, b) / count(a, b), -0.95, 0.95);
    }
  }
  // Pooled entry by entry it may fail to be positive: shrink until it is.
  for (int k = 0; k < 40; ++k) {
    if (Eigen::LLT<Eigen::MatrixXd>(out).info() == Eigen::Success) break;
    for (Eigen::Index a = 0; a < m; ++a) {
      for (Eigen::Index b = 0; b < m; ++b) {
        if (a != b) out(a, b) *= 0.9;
      }
    }
  }
  return out;
}

void set_whitener(Covariance& c, double scale) {
  const Eigen::LLT<Eigen::MatrixXd> factor(c.of_mean);
  if (factor.info() != Eigen::Success) {
    throw std::invalid_argument("data to fit: their covariance is not positive definite");
  }
  const Eigen::Index n = c.of_mean.rows();
  c.whitener =
      std::sqrt(scale) * Eigen::MatrixXd(factor.matrixL().solve(Eigen::MatrixXd::Identity(n, n)));
}

// Both kinds with variances pooled over neighbours.
Covariance pooled(const FitData& data, bool correlated) {
  const int n = data.values(), realizations = data.realizations();
  const bool own = realizations >= kLeastForOwn;
  const Eigen::MatrixXd d = deviations(data);
  Eigen::VectorXd variance = sample_variances(d);
  keep_positive(data, variance);
  const auto normalised_by = [&](const Eigen::VectorXd& v) {
    return Eigen::MatrixXd((v.cwiseSqrt().cwiseInverse().asDiagonal() * d) /
                           std::sqrt(d.cols() - 1.0));
  };
  Covariance out;
  out.kind = correlated ? "parametric" : "diagonal";
  // Two realizations differ by one number per value, over its own size 1 or -1: the component's
  // mean stands in for it.
  const Eigen::VectorXd first = own ? variance : of_component(data, variance);
  out.correlation_length = fitted_length(correlogram(data, normalised_by(first)));
  const double length = out.correlation_length;
  // Smooth the variances over three correlation lengths.
  Eigen::VectorXd smooth(n);
  for (int i = 0; i < n; ++i) {
    double sum = 0, weight = 0;
    for (int j = 0; j < n; ++j) {
      if (data.component[static_cast<std::size_t>(i)] !=
          data.component[static_cast<std::size_t>(j)]) {
        continue;
      }
      const double s = (data.points.row(i) - data.points.row(j)).norm() / (3 * length + 1e-300);
      if (s > 4) continue;
      const double w = std::exp(-0.5 * s * s);
      sum += w * variance[j];
      weight += w;
    }
    smooth[i] = 0.5 * (first[i] + sum / weight);
  }
  const Eigen::MatrixXd between = between_components(data, normalised_by(smooth));
  out.of_mean.resize(n, n);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = data.component[static_cast<std::size_t>(i)];
      const int b = data.component[static_cast<std::size_t>(j)];
      const double rho =
          between(a, b) * correlation_at((data.points.row(i) - data.points.row(j)).norm(), length);
      sum += rho * rho;
      out.of_mean(i, j) =
          correlated || i == j ? std::sqrt(smooth[i] * smooth[j]) * rho / realizations : 0;
    }
  }
  out.effective_values = static_cast<double>(n) * n / sum;
  out.freedom = (realizations - 1) * out.effective_values;
  const double shared = correlated ? 1 : out.effective_values / n;
  set_whitener(out, own ? shared / inverse_bias(realizations) : shared);
  return out;
}

Covariance sample(const FitData& data) {
  const int n = data.values(), r = data.realizations();
  const Eigen::MatrixXd d = deviations(data);
  Covariance out;
  out.kind = "sample";
  out.effective_values = n;
  out.freedom = r - n;
  out.of_mean = d * d.transpose() / (static_cast<double>(r - 1) * r);
  set_whitener(out, static_cast<double>(r - n - 2) / (r - 1));
  return out;
}

// Values taken as independent with the errors they came with.
Covariance given(const FitData& data) {
  Covariance out;
  out.kind = "diagonal";
  out.note =
      "single realizations unknown (a parametric covariance needs 3): the field's standard errors, "
      "values taken as independent";
  out.effective_values = data.values();
  out.of_mean = data.error.cwiseAbs2().asDiagonal();
  set_whitener(out, 1);
  return out;
}

// Copies of one packing, or of a perfect lattice: they differ by rounding only.
bool all_equal(const FitData& data) {
  return deviations(data).cwiseAbs().maxCoeff() <= kRounding * data.samples.cwiseAbs().maxCoeff();
}

Covariance unknown(const FitData& data) {
  const int n = data.values();
  Covariance out;
  out.kind = "unknown";
  out.note = data.realizations() == 1
                 ? "one realization, and a diagonal covariance needs 2, a parametric one 3"
                 : fmt::format("all {} realizations are equal", data.realizations());
  out.note += ": no errors, all values count alike";
  out.effective_values = n;
  out.of_mean = Eigen::MatrixXd::Identity(n, n);
  out.whitener = out.of_mean;
  return out;
}

}  // namespace

double inverse_bias(int realizations) {
  if (realizations < 2) {
    throw std::invalid_argument(
        fmt::format("variance: found {} realization, needed: 2 or more", realizations));
  }
  // x: sample variance over sigma^2, f x of chi-squared distribution with f degrees of freedom;
  // y = sqrt x takes the pole of its density at 0 away.
  const double half = 0.5 * (realizations - 1);
  const auto integrand = [half](double y) {
    if (!(y > 0)) return half == 0.5 ? 4 * std::sqrt(half) / std::tgamma(half) : 0.0;
    const double x = y * y;
    const double density =
        std::exp(half * std::log(half) + (half - 1) * std::log(x) - half * x - std::lgamma(half));
    return 2 * y * density * 2 / (1 + x);
  };
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
      integrand, 0.0, std::numeric_limits<double>::infinity(), 12, 1e-10);
}

int least_realizations(const std::string& kind, int values) {
  if (kind == "sample") return values + 3;
  if (kind == "parametric") return 3;
  if (kind == "diagonal") return 2;
  throw std::invalid_argument(
      fmt::format("covariance: found \"{}\", allowed: auto, sample, parametric, diagonal", kind));
}

Covariance covariance_of(const FitData& data, const std::string& kind) {
  check(data);
  const std::string asked = kind == "auto" ? "parametric" : kind;
  const int needed = least_realizations(asked, data.values()), found = data.realizations();
  if (found > 1 && all_equal(data)) return unknown(data);
  if (found >= needed) {
    if (asked == "sample") return sample(data);
    return pooled(data, asked == "parametric");
  }
  if (found == 1) return data.error.size() > 0 ? given(data) : unknown(data);
  const std::string next = asked == "sample" && found >= 3 ? "parametric" : "diagonal";
  Covariance out = pooled(data, next == "parametric");
  out.note = fmt::format("{} covariance of {} values needs {} realizations, found {}: {} instead",
                         asked, data.values(), needed, found, next);
  return out;
}

}  // namespace grainfield::coupling
