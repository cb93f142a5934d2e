#include "dem/shapes/superellipsoid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dem/shapes/dual_norm.h"
#include "dem/space/elementary.h"

namespace grainfield::dem {
namespace {

/// (a^P + b^P)^(1/P) of a, b > 0, and its derivatives.
struct Norm {
  double size = 0;
  double a = 0, b = 0;            // over the size
  double pull_a = 0, pull_b = 0;  // d size/da, d size/db
  double bend = 0;                // Hessian: bend/size (b, -a)(b, -a)'
};

double norm_size(double a, double b, double power) {
  const double most = std::max(a, b), ratio = std::min(a, b) / most;
  if (power == 2) return most * std::sqrt(1 + ratio * ratio);
  const double share = exponential(power * natural_log(ratio));
  return most * exponential(natural_log(1 + share) / power);
}

Norm norm_of(double a, double b, double power) {
  const bool swapped = b > a;
  const double most = swapped ? b : a, least = swapped ? a : b, ratio = least / most;
  double share = ratio * ratio, root = 1;
  if (power == 2) {
    root = std::sqrt(1 + share);
  } else {
    const Powers::OfNorm at = powers_at(ratio, power);
    share = at.share;
    root = at.root;
  }
  // The greater component over the size.
  const double part = 1 / root, whole = 1 + share, rest = ratio * part;
  const double pull_most = 1 / (whole * part), pull_least = share / (whole * rest);
  Norm out;
  out.size = most * root;
  out.bend = (power - 1) * pull_most * pull_least / (part * rest);
  out.a = swapped ? rest : part;
  out.b = swapped ? part : rest;
  out.pull_a = swapped ? pull_least : pull_most;
  out.pull_b = swapped ? pull_most : pull_least;
  return out;
}

Eigen::Vector3d scaled(const Superellipsoid& body, const Eigen::Vector3d& n) {
  const Eigen::Vector3d a = body.axes.cwiseProduct(n).cwiseAbs();
  return a.cwiseMax(kLeastShare * a.maxCoeff());
}

/// Half the inverse: that of c1 u1 u1' + c2 u2 u2' has 1/(c2 v^2) for n x u1 and 1/(c1 v^2) for
/// n x u2, v = |u1 x u2|.
Bend half_inverse(const Bend& bend) {
  const double half = 0.5 / (bend.area * bend.area);
  const auto& [one, two] = bend.squares;
  Bend out;
  out.squares[0] = {half / std::max(two.weight, kLeastWeight), -one.y, one.x};
  out.squares[1] = {half / std::max(one.weight, kLeastWeight), -two.y, two.x};
  out.area = bend.area;
  return out;
}

void add(const Bend& bend, PlaneTensor& sum) {
  const auto& [one, two] = bend.squares;
  for (const auto& s : {one, two}) {
    sum.xx += s.weight * s.x * s.x;
    sum.xy += s.weight * s.x * s.y;
    sum.yy += s.weight * s.y * s.y;
  }
  sum.determinant += one.weight * two.weight * bend.area * bend.area;
}

/// Squared distance of the farthest and of the nearest point of a superellipse, of squared
/// semi-axes: by Hoelder's inequality their norm of the power p/(p - 2) = 1/(1 - e) where e is
/// below (above) 1.
double farthest_pair(double a, double b, double exponent) {
  return exponent < 1 ? norm_size(a, b, 1 / (1 - exponent)) : std::max(a, b);
}
double nearest_pair(double a, double b, double exponent) {
  return exponent > 1 ? 1 / norm_size(1 / a, 1 / b, 1 / (exponent - 1)) : std::min(a, b);
}

}  // namespace

Powers::OfNorm powers_at(double ratio, double power) {
  const double share = exponential(power * natural_log(ratio));
  return {1 / ratio, share, exponential(natural_log(1 + share) / power)};
}

Superellipsoid superellipsoid(const std::array<double, 3>& axes,
                              const std::array<double, 2>& exponents) {
  for (const double r : axes) {
    if (!(r > 0 && std::isfinite(r))) {
      throw std::invalid_argument(
          fmt::format("a superellipsoid's semi-axes: found {:g}, {:g}, {:g} m, allowed: above 0",
                      axes[0], axes[1], axes[2]));
    }
  }
  for (const double e : exponents) {
    if (!(e >= kLeastExponent && e <= kMostExponent)) {
      throw std::invalid_argument(
          fmt::format("a superellipsoid's exponents: found {:g}, {:g}, allowed: {:g} to {:g}",
                      exponents[0], exponents[1], kLeastExponent, kMostExponent));
    }
  }
  return {{axes[0], axes[1], axes[2]}, exponents, 2 / (2 - exponents[0]), 2 / (2 - exponents[1])};
}

// With z = |x3/r3| a slice is a superellipse of the size (1 - z^q)^(1/q), q = 2/e2, and area and
// second moments of superellipses are Beta functions, too.
Solid<3> solid_of(const Superellipsoid& body) {
  const auto [e1, e2] = body.exponents;
  const double area = 2 * e1 * beta(0.5 * e1, 0.5 * e1 + 1);    // of the slice, r1 = r2 = 1
  const double moment = 2 * e1 * beta(1.5 * e1, 0.5 * e1 + 1);  // of x1^2
  const double slices = e2 * beta(0.5 * e2, e2 + 1);            // integral of size^2
  const double level = e2 * beta(0.5 * e2, 2 * e2 + 1);         // of size^4
  const double upright = e2 * beta(1.5 * e2, e2 + 1);           // of z^2 size^2
  const Eigen::Vector3d squares = body.axes.cwiseProduct(body.axes);
  const double block = body.axes.prod();
  const double x = block * squares[0] * moment * level;
  const double y = block * squares[1] * moment * level;
  const double z = block * squares[2] * area * upright;
  return {farthest_of(body), block * area * slices, {y + z, z + x, x + y}};
}

double volume_of(const Superellipsoid& body) { return solid_of(body).volume; }

double farthest_of(const Superellipsoid& body) {
  const auto [e1, e2] = body.exponents;
  const Eigen::Vector3d q = body.axes.cwiseProduct(body.axes);
  return std::sqrt(farthest_pair(farthest_pair(q[0], q[1], e1), q[2], e2));
}
double nearest_of(const Superellipsoid& body) {
  const auto [e1, e2] = body.exponents;
  const Eigen::Vector3d q = body.axes.cwiseProduct(body.axes);
  return std::sqrt(nearest_pair(nearest_pair(q[0], q[1], e1), q[2], e2));
}

FeltMass felt_mass(const Superellipsoid& body, double density) {
  const Solid<3> solid = solid_of(body);
  const auto [e1, e2] = body.exponents;
  // Barr's angles, by their squared cosines: points go by e, normals by 2 - e.
  const auto power = [](double square, double e) {
    return exponential(0.5 * e * natural_log(square));
  };
  double most = 0;
  constexpr int kPoints = 12;
  for (int k = 0; k < kPoints; ++k) {
    for (int l = 0; l < kPoints; ++l) {
      const double u = (k + 0.5) / kPoints, v = (l + 0.5) / kPoints;
      const Eigen::Vector3d x = body.axes.cwiseProduct(Eigen::Vector3d(
          power(u, e1) * power(v, e2), power(1 - u, e1) * power(v, e2), power(1 - v, e2)));
      const double f1 = 2 - e1, f2 = 2 - e2;
      const Eigen::Vector3d n = Eigen::Vector3d(power(u, f1) * power(v, f2),
                                                power(1 - u, f1) * power(v, f2), power(1 - v, f2))
                                    .cwiseQuotient(body.axes)
                                    .normalized();
      const Eigen::Vector3d lever = x.cross(n);
      most = std::max(most, lever.cwiseProduct(lever).cwiseQuotient(solid.moments).sum());
    }
  }
  return {density / (1 / solid.volume + most),
          cube_root(solid.volume / (4.0 / 3 * std::numbers::pi))};
}

double height_of(const Superellipsoid& body, const Eigen::Vector3d& n) {
  const Eigen::Vector3d a = scaled(body, n);
  return norm_size(norm_size(a[0], a[1], body.level), a[2], body.upright);
}

Support support_of(const Superellipsoid& body, const Eigen::Vector3d& n) {
  const Eigen::Vector3d a = scaled(body, n);
  const Norm level = norm_of(a[0], a[1], body.level);
  const Norm whole = norm_of(level.size, a[2], body.upright);
  Eigen::Vector3d r;  // semi-axes with the normal's signs
  for (int k = 0; k < 3; ++k) r[k] = std::copysign(body.axes[k], n[k]);
  Support out;
  out.height = whole.size;
  const Eigen::Vector3d slope(r[0] * level.pull_a, r[1] * level.pull_b, 0);  // of s
  out.point = whole.pull_a * slope;
  out.point[2] = r[2] * whole.pull_b;
  for (int k = 0; k < 3; ++k) {
    if (n[k] == 0) out.point[k] = 0;
  }
  out.bend[0] = {whole.pull_a * level.bend / level.size, {r[0] * level.b, -r[1] * level.a, 0}};
  out.bend[1] = {whole.bend / whole.size,
                 {whole.b * slope[0], whole.b * slope[1], -whole.a * r[2]}};
  out.area = body.axes[0] * body.axes[1] * body.axes[2] / whole.size;
  return out;
}

Principal principal_of(const Eigen::Vector3d& n, const Square* squares, int count) {
  // In the frame of the strongest square; the determinant without a difference (Cauchy and Binet).
  double trace = 0, determinant = 0, strongest = -1;
  int first = 0;
  for (int k = 0; k < count; ++k) {
    const double size = squares[k].weight * squares[k].along.squaredNorm();
    trace += size;
    if (size > strongest) {
      strongest = size;
      first = k;
    }
    for (int l = 0; l < k; ++l) {
      const double across = n.dot(squares[k].along.cross(squares[l].along));
      determinant += squares[k].weight * squares[l].weight * across * across;
    }
  }
  Principal out;
  const double length = squares[first].along.norm();
  if (!(length > 0)) return out;
  const Eigen::Vector3d x = squares[first].along / length, y = n.cross(x);
  double xy = 0, yy = 0;
  for (int k = 0; k < count; ++k) {
    const double along = squares[k].along.dot(x), beside = squares[k].along.dot(y);
    xy += squares[k].weight * along * beside;
    yy += squares[k].weight * beside * beside;
  }
  const double xx = trace - yy;
  out.greater = 0.5 * (trace + std::sqrt((xx - yy) * (xx - yy) + 4 * xy * xy));
  out.along = x;
  if (!(out.greater > 0)) return out;
  out.lesser = determinant / out.greater;
  const double most = out.greater, slant = xy / most;
  const double straight = xx >= yy ? (most - yy) / most : (most - xx) / most;
  const Eigen::Vector3d way = xx >= yy ? Eigen::Vector3d(straight * x + slant * y)
                                       : Eigen::Vector3d(slant * x + straight * y);
  if (way.squaredNorm() > 0) out.along = way.normalized();
  return out;
}

// Duff et al. 2017.
Tangents tangents_of(const Eigen::Vector3d& n) {
  const double sign = std::copysign(1.0, n.z()), a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
  return {{1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()},
          {b, sign + n.y() * n.y() * a, -n.y()}};
}

Bend bend_of(const Support& support, const Tangents& in_body) {
  Bend out;
  for (int k = 0; k < 2; ++k) {
    const auto& [weight, along] = support.bend[k];
    out.squares[k] = {weight, along.dot(in_body.x), along.dot(in_body.y)};
  }
  out.area = support.area;
  return out;
}

PlaneTensor sum_of(const Bend& i, const Bend& j) {
  PlaneTensor sum;
  add(i, sum);
  add(j, sum);
  for (const auto& s : i.squares) {
    for (const auto& t : j.squares) {
      const double area = s.x * t.y - s.y * t.x;
      sum.determinant += s.weight * t.weight * area * area;
    }
  }
  return sum;
}

PlanePrincipal principal_of(const PlaneTensor& t) {
  const double apart = t.xx - t.yy, root = std::sqrt(apart * apart + 4 * t.xy * t.xy);
  PlanePrincipal out;
  out.greater = 0.5 * ((t.xx + t.yy) + root);
  if (!(out.greater > 0)) return out;
  out.lesser = t.determinant / out.greater;
  // Both forms of an eigenvector hold; the longer one is without a difference.
  const double straight = 0.5 * (std::fabs(apart) + root);
  const double size = std::sqrt(straight * straight + t.xy * t.xy);
  if (!(size > 0)) return out;
  const double c = straight / size, d = t.xy / size;
  out.along = apart >= 0 ? Eigen::Vector2d(c, d) : Eigen::Vector2d(d, c);
  return out;
}

PlanePrincipal relative_curvatures(const Bend& i, const Bend& j) {
  return principal_of(sum_of(half_inverse(i), half_inverse(j)));
}
PlanePrincipal relative_curvatures(const Bend& i) {
  PlaneTensor only;
  add(half_inverse(i), only);
  return principal_of(only);
}

}  // namespace grainfield::dem
