#include "continuum/osl/flux.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "continuum/model.h"

namespace grainfield::continuum::osl {
namespace {

/// Speeds below this part of |nx| (|lambda| + 1) + |ny| are of a line along a characteristic.
constexpr double kAlong = 1e-12;

}  // namespace

Matrix Characteristics::matrix() const { return (Matrix() << 0, 1, eta, mu).finished(); }

Characteristics characteristics(const Problem& problem, double x, double depth, int sign) {
  Characteristics c;
  c.eta = problem.eta(x, depth);
  const double mu = problem.mu(x, depth);
  c.mu = problem.mirrored ? sign * mu : mu;
  const double discriminant = mu * mu + 4 * c.eta;
  if (!(discriminant > 0))
    throw BadParameter(fmt::format(
        "model {}: eta = {:.6g} with mu = {:.6g} at x = {:.6g}, depth {:.6g} is outside the "
        "hyperbolic range; allowed: mu^2 + 4 eta above 0, here eta above {:.6g}",
        problem.name, c.eta, mu, x, depth, problem.mirrored ? 0. : 0 - mu * mu / 4));
  if (problem.mirrored && !(c.eta > 0))
    throw BadParameter(
        fmt::format("model {}: eta = {:.6g} with mu = {:.6g} at x = {:.6g}, depth {:.6g} has both "
                    "characteristics on one side of the vertical; allowed: eta above 0",
                    problem.name, c.eta, mu, x, depth));
  // The root without cancellation, the other from the product -eta.
  const double large = (c.mu + std::copysign(std::sqrt(discriminant), c.mu)) / 2;
  const double small = -c.eta / large;
  c.downwind = std::max(large, small);
  c.upwind = std::min(large, small);
  return c;
}

Flux upwind_flux(const Characteristics& c, double nx, double ny) {
  Flux out;
  const Matrix a = c.matrix();
  const double gap = c.downwind - c.upwind;
  for (const bool first : {true, false}) {
    const double here = first ? c.downwind : c.upwind, there = first ? c.upwind : c.downwind;
    const double speed = here * nx + ny;
    if (std::abs(speed) <= kAlong * (std::abs(nx) * (std::abs(here) + 1) + std::abs(ny))) continue;
    const Matrix part = (speed / (first ? gap : -gap)) * (a - there * Matrix::Identity());
    (speed > 0 ? out.own : out.other) += part;
  }
  return out;
}

// Waves leave the axis to both sides: a w1 with w1 = (1, left.upwind), b w2 with w2 = (1,
// right.downwind). Continuity of F = A u: A_L u_L + a w1 = A_R u_R + b w2.
Flux axis_flux(const Characteristics& left, const Characteristics& right) {
  const Eigen::Vector2d w1(1, left.upwind), w2(1, right.downwind);
  Matrix waves;
  waves << w1, -w2;
  const Matrix pick = w1 * waves.inverse().row(0);
  return {(Matrix::Identity() - pick) * left.matrix(), pick * right.matrix()};
}

Flux wall_flux(const Characteristics& c, double friction, int sign) {
  const Eigen::Vector2d back(1, sign > 0 ? c.upwind : c.downwind);
  const Eigen::RowVector2d condition =
      Eigen::RowVector2d(0, 1) - sign * friction * Eigen::RowVector2d(c.eta, c.mu);
  const Matrix projector = Matrix::Identity() - back * condition / condition.dot(back);
  return {sign * c.matrix() * projector, Matrix::Zero()};
}

void require_entering(const Problem& problem, const Characteristics& c, const Flux& flux,
                      double spread, double x, double depth) {
  if (flux.own.isZero(0)) return;
  throw BadParameter(fmt::format(
      "model {}: eta = {:.6g}, mu = {:.6g} at x = {:.6g}, depth {:.6g} have a characteristic "
      "outside the heap, dx/dy = {:.6g}; allowed: below cot(phi) = {:.6g}, the slope",
      problem.name, c.eta, problem.mu(x, depth), x, depth, x < 0 ? -c.upwind : c.downwind, spread));
}

}  // namespace grainfield::continuum::osl
