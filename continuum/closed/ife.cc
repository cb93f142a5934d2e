#include "continuum/closed/ife.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "continuum/closed/models.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

using std::numbers::pi;
// Degree of the polynomials: the balance of forces is met to 4e-8 rho g. With higher degrees
// Newton's method fails, so near is the next solution at the singular slope.
constexpr int kDegree = 26;
// Newton's method ends when its step is below this share of the solution.
constexpr double kConverged = 1e-11;
constexpr int kMostSteps = 100;
// Friction angles for which the polynomials suffice, degrees.
constexpr double kLeastAngle = 15, kLargestAngle = 60;
// Accepted residual between the collocation points, rho g.
constexpr double kBalanced = 1e-6;
// Friction angle at which the straight guess converges, steps away from it and the least of them,
// rad.
constexpr double kStart = 0.5, kStep = 0.05, kLeastStep = 1e-3;

// k(u) and its derivative; T may be complex.
template <class T>
std::pair<T, T> active(const T& u, double phi) {
  using std::sqrt;
  const double s = std::sin(phi), c = std::cos(phi);
  const T root = sqrt(s * s - u * u * (c * c));
  return {(1 + s * s - 2. * root) / (c * c), 2. * u / root};
}

// s_xx' + s_xy - xi s_xy' from A, A', W, W'.
template <class T>
T balance(const T& a, const T& da, const T& w, const T& dw, double xi, double phi) {
  const double delta = 1 / std::tan(phi) - xi;
  const auto [k, slope] = active<T>(w / a, phi);
  const T vertical = -a + delta * da, shear = -w + delta * dw;
  return (k - w / a * slope) * vertical + slope * shear + delta * w - xi * shear;
}

// Chebyshev's points cos(pi j / n) and the matrix that differentiates there (Trefethen 2000, ch.
// 6).
Eigen::VectorXd points_of(int n) {
  Eigen::VectorXd x(n + 1);
  for (int j = 0; j <= n; ++j) x[j] = std::cos(pi * j / n);
  return x;
}

Eigen::MatrixXd differentiation(const Eigen::VectorXd& x) {
  const auto n = x.size() - 1;
  Eigen::MatrixXd d(n + 1, n + 1);
  for (Eigen::Index i = 0; i <= n; ++i) {
    double sum = 0;
    for (Eigen::Index j = 0; j <= n; ++j) {
      if (i == j) continue;
      const double ci = i == 0 || i == n ? 2 : 1, cj = j == 0 || j == n ? 2 : 1;
      d(i, j) = ci / cj * ((i + j) % 2 == 0 ? 1 : -1) / (x[i] - x[j]);
      sum += d(i, j);
    }
    d(i, i) = -sum;
  }
  return d;
}

// From values at Chebyshev's points.
Eigen::VectorXd coefficients(const Eigen::VectorXd& values) {
  const auto n = values.size() - 1;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(n + 1);
  for (Eigen::Index k = 0; k <= n; ++k) {
    for (Eigen::Index j = 0; j <= n; ++j) {
      const double half = j == 0 || j == n ? 0.5 : 1;
      out[k] +=
          half * values[j] *
          std::cos(pi * static_cast<double>(j) * static_cast<double>(k) / static_cast<double>(n));
    }
    out[k] *= (k == 0 || k == n ? 1. : 2.) / static_cast<double>(n);
  }
  return out;
}

// Value and derivative of a Chebyshev series at x in [-1, 1].
std::pair<double, double> series(const Eigen::VectorXd& c, double x) {
  double t0 = 1, t1 = x, u0 = 1, u1 = 2 * x;  // T_k, T_k+1, U_k, U_k+1
  double value = c[0], slope = 0;
  for (Eigen::Index k = 1; k < c.size(); ++k) {
    value += c[k] * t1;
    slope += c[k] * static_cast<double>(k) * u0;
    const double t2 = 2 * x * t1 - t0, u2 = 2 * x * u1 - u0;
    t0 = t1;
    t1 = t2;
    u0 = u1;
    u1 = u2;
  }
  return {value, slope};
}

struct Solution {
  Eigen::VectorXd a, w;  // values at Chebyshev's points, the slope first, the axis last
};

// What A cot(phi) and W / A are from the slope to the axis hardly depends on phi.
Solution straight_guess(double phi) {
  const double s = std::sin(phi), cot = 1 / std::tan(phi);
  const double u0 = s * std::cos(phi) / (1 + s * s), a0 = 1 / (cot - u0);
  const double centre = (1 - 0.43 * s) / cot;
  const Eigen::VectorXd share = (points_of(kDegree).array() + 1) / 2;
  return {centre + (a0 - centre) * share.array(), u0 * a0 * share};
}

// The solution at one angle as a guess for another.
Solution scaled(const Solution& other, double from, double to) {
  const double factor = std::tan(to) / std::tan(from);
  return {factor * other.a, factor * factor * other.w};
}

std::optional<Solution> newton(double phi, Solution out) {
  const int n = kDegree;
  const double cot = 1 / std::tan(phi);
  const Eigen::VectorXd x = points_of(n), xi = cot / 2 * (x.array() + 1);
  const Eigen::MatrixXd d = 2 / cot * differentiation(x);
  const double s = std::sin(phi), slope_a = 1 / (cot - s * std::cos(phi) / (1 + s * s)),
               slope_w = cot * slope_a - 1;
  Eigen::MatrixXd jacobian(2 * n + 2, 2 * n + 2);
  Eigen::VectorXd residual(2 * n + 2);
  for (int step = 0; step < kMostSteps; ++step) {
    jacobian.setZero();
    const Eigen::VectorXd da = d * out.a, dw = d * out.w;
    // On the slope the smooth solution's values, which the equations alone would leave to chance.
    residual[0] = out.a[0] - slope_a;
    jacobian(0, 0) = 1;
    residual[n + 1] = out.w[0] - slope_w;
    jacobian(n + 1, n + 1) = 1;
    for (int i = 1; i <= n; ++i) {
      const double delta = cot - xi[i];
      // The vertical balance.
      residual[i] =
          -out.w[i] + delta * dw[i] + delta * out.a[i] - xi[i] * (-out.a[i] + delta * da[i]) - 1;
      jacobian.row(i).head(n + 1) = -xi[i] * delta * d.row(i);
      jacobian(i, i) += delta + xi[i];
      jacobian.row(i).tail(n + 1) = delta * d.row(i);
      jacobian(i, n + 1 + i) -= 1;
      // The horizontal one; on the axis no shear.
      const int row = n + 1 + i;
      if (i == n) {
        residual[row] = out.w[n];
        jacobian(row, row) = 1;
        continue;
      }
      using C = std::complex<double>;
      const double h = 1e-30;
      const auto part = [&](int which) {
        return balance<C>({out.a[i], which == 0 ? h : 0}, {da[i], which == 1 ? h : 0},
                          {out.w[i], which == 2 ? h : 0}, {dw[i], which == 3 ? h : 0}, xi[i], phi)
                   .imag() /
               h;
      };
      residual[row] = balance<double>(out.a[i], da[i], out.w[i], dw[i], xi[i], phi);
      jacobian.row(row).head(n + 1) = part(1) * d.row(i);
      jacobian(row, i) += part(0);
      jacobian.row(row).tail(n + 1) = part(3) * d.row(i);
      jacobian(row, n + 1 + i) += part(2);
    }
    const Eigen::VectorXd change = jacobian.partialPivLu().solve(residual);
    if (!change.allFinite()) break;
    // No step so long that the root of k(u) turns complex.
    double share = 1;
    const auto allowed = [&](double f) {
      const Eigen::VectorXd a = out.a - f * change.head(n + 1), w = out.w - f * change.tail(n + 1);
      return (a.array() > 0).all() && (w.array().abs() < 0.999 * std::tan(phi) * a.array()).all();
    };
    while (share > 1e-6 && !allowed(share)) share /= 2;
    out.a -= share * change.head(n + 1);
    out.w -= share * change.tail(n + 1);
    if (share == 1 && change.cwiseAbs().maxCoeff() < kConverged * out.a.cwiseAbs().maxCoeff())
      return out;
  }
  return std::nullopt;
}

// Polynomials that meet the balances at Chebyshev's points only are no solution: the largest
// residual half way between them.
double between(double phi, const Solution& found) {
  const double cot = 1 / std::tan(phi);
  const Eigen::VectorXd a = coefficients(found.a), w = coefficients(found.w);
  double largest = 0;
  for (int j = 0; j < kDegree; ++j) {
    const double x = std::cos(pi * (j + 0.5) / kDegree), xi = cot / 2 * (x + 1), delta = cot - xi;
    const auto [va, da] = series(a, x);
    const auto [vw, dw] = series(w, x);
    const double down = -vw + delta * dw * 2 / cot + delta * va - xi * (-va + delta * da * 2 / cot);
    const double along = balance<double>(va, da * 2 / cot, vw, dw * 2 / cot, xi, phi);
    largest = std::max({largest, std::fabs(down - 1), std::fabs(along)});
  }
  return largest;
}

// In steps from an angle where the straight guess leads to the solution.
Solution solve(double phi) {
  const auto accepted = [](double angle, const Solution& guess) {
    auto found = newton(angle, guess);
    if (found && !(between(angle, *found) < kBalanced)) found.reset();
    return found;
  };
  double at = kStart, step = std::copysign(kStep, phi - at);
  auto last = accepted(at, straight_guess(at));
  while (last && at != phi && std::fabs(step) > kLeastStep) {
    const double next = std::fabs(step) < std::fabs(phi - at) ? at + step : phi;
    if (auto found = accepted(next, scaled(*last, at, next))) {
      at = next;
      last = found;
    } else {
      step /= 2;
    }
  }
  if (last && at == phi) return *last;
  throw ComputationFailed(
      fmt::format("model ife: no solution found at phi_deg = {:g}; try an angle nearer to {:g}",
                  phi * 180 / pi, at * 180 / pi));
}

}  // namespace

IfeField::IfeField(double phi, double rho_g)
    : HeapField({{"left half", phi - pi / 2, 0}, {"right half", 0, pi / 2 - phi}}, rho_g, phi),
      cot_(1 / std::tan(phi)) {
  const Solution found = solve(phi);
  a_ = coefficients(found.a);
  w_ = coefficients(found.w);
}

LinearStress IfeField::gradient(std::size_t region, double x, double y) const {
  const double down = -y;
  // On the slope's line xi may be above c by rounding.
  const double xi = down > 0 ? std::min(std::fabs(x) / down, cot_) : cot_, delta = cot_ - xi;
  const auto [a, da] = series(a_, 2 * xi / cot_ - 1);
  const auto [w, dw] = series(w_, 2 * xi / cot_ - 1);
  const auto [k, slope] = active(w / a, phi());
  const double vertical = -a + delta * da * 2 / cot_, shear = -w + delta * dw * 2 / cot_;
  const double horizontal = (k - w / a * slope) * vertical + slope * shear;
  // stress = -y s(x / -y): d/dx = s', d/dy = -s + xi s'.
  LinearStress out;
  out << -horizontal, delta * a * k - xi * horizontal,  //
      -vertical, delta * a - xi * vertical,             //
      shear, -delta * w + xi * shear;
  out *= rho_g();
  return region == 1 ? out : mirrored(out);
}

ModelInfo ife_info() {
  return {"ife",
          "heap at the limit of friction everywhere (incipient failure everywhere)",
          2,
          {number("phi_deg", "deg", "friction angle, and slope of a heap at its angle of repose",
                  "Roul 4.2", 28, kLeastAngle, kLargestAngle),
           weight()},
          [](const Settings& s) -> std::unique_ptr<Model> {
            auto field = std::make_unique<IfeField>(number_of(s, "phi_deg") * pi / 180,
                                                    number_of(s, "rho_g"));
            return std::make_unique<HeapModel>(std::move(field), [](const HeapField& f) {
              return std::map<std::string, double>{{"yield_residual", f.off_yield({0, 1}, {})}};
            });
          },
          heap_figures({yield_figure("everywhere")})};
}

}  // namespace grainfield::continuum
