// Elastic layer of depth h on a rigid base under a line load, plane strain.
//
// With d the depth, k the wave number, s = k d, u = k h, Airy's function is
//   phi = (F/pi) Int g(s) cos(k x) / k^2 dk,  so that
//   sigma_xx = (F/pi) Int g'' cos(k x) dk,  sigma_yy = -(F/pi) Int g cos(k x) dk,
//   sigma_xd = (F/pi) Int g' sin(k x) dk,   primes: d/ds.
// Top: g(0) = 1 (the load), g'(0) = 0 (no shear). Base, s = u: no vertical displacement,
//   (1-nu) g''' - (2-nu) g' = 0, and either no shear, g' = 0 (smooth), or no horizontal
//   displacement, (1-nu) g'' + nu g = 0 (rough).
// g = (1+s) exp(-s) is Flamant's half plane, added in closed form. The rest vanishes with its first
// derivative at s = 0:
//   g_r = a (sinh s - s cosh s) + b s sinh s,
// with a, b of order u exp(-2u): the integrand decays like exp(-k (2h - d)), also under the load.
//
// Point load in space: the same plane waves from all directions of the plane, with the stress
// nu (g'' - g) along their crests. Averaged over the directions, J0 and J1 at k r,
//   sigma_zz = -(F/2 pi) Int k g J0 dk,   sigma_rd = (F/2 pi) Int k g' J1 dk,
//   sigma_rr = (F/2 pi) Int k [g'' (J0 - J1/kr) + nu (g'' - g) J1/kr] dk,
//   sigma_tt = (F/2 pi) Int k [g'' J1/kr + nu (g'' - g) (J0 - J1/kr)] dk.
// There (1+s) exp(-s) is Boussinesq's half space.
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "continuum/closed/about_axis.h"
#include "continuum/closed/half_space.h"
#include "continuum/closed/models.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

using Gauss = boost::math::quadrature::gauss<double, 30>;

/// Values that differ from the base's height by less than this part of h are on the base.
constexpr double kOnBase = 1e-9;
/// The integrand's tail beyond exp(-48) u^2 is below 1e-17 of the peak.
constexpr double kDecay = 48;
/// Panels: 30 Gauss points carry 6 rad of cos(k x) and 2 units of u (the integrand's poles
/// are at least 0.9 away from the real axis) to round-off.
constexpr double kPanelPhase = 6, kPanelWidth = 2;

/// The functions p = sinh s - s cosh s and q = s sinh s and their derivatives, times exp(-s).
struct Basis {
  double p0, p1, p2, p3, q0, q1, q2, q3;
  explicit Basis(double s) {
    const double sh = -0.5 * std::expm1(-2 * s), ch = 1 - sh;
    // The series replaces a difference of nearly equal terms.
    p0 = s < 1e-2 ? -std::exp(-s) * s * s * s * (1. / 3 + s * s / 30 + s * s * s * s / 840)
                  : sh - s * ch;
    p1 = -s * sh;
    p2 = -sh - s * ch;
    p3 = -2 * ch - s * sh;
    q0 = s * sh;
    q1 = sh + s * ch;
    q2 = 2 * ch + s * sh;
    q3 = 3 * sh + s * ch;
  }
};

class Layer : public Model {
 public:
  Layer(double load, double depth, double poisson, bool rough, int dim)
      : load_(load), h_(depth), nu_(poisson), rough_(rough), dim_(dim) {}

  Stresses stress(const Points& points) override {
    Stresses out = Stresses::Constant(points.rows(), dim_ == 2 ? 3 : 6,
                                      std::numeric_limits<double>::quiet_NaN());
    std::vector<Eigen::Index> inside;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const double up = points(i, dim_ - 1);
      if (up < 0 && up >= -h_ * (1 + kOnBase) && points.row(i).allFinite()) inside.push_back(i);
    }
    if (dim_ == 3) {
      in_space(points, inside, out);
      return out;
    }
    for (const Eigen::Index i : inside)
      out.row(i) = at(points(i, 0), std::max(points(i, 1), -h_)).transpose();
    return out;
  }

 private:
  /// exp(2u) a and exp(2u) b.
  Eigen::Vector2d coefficients(double u) const {
    const Basis f(u);
    // Flamant's g' = -s, g'' = s - 1, g''' = 2 - s, g = 1 + s, all times exp(-s).
    Eigen::Matrix2d m;
    Eigen::Vector2d rhs;
    m.row(0) << (1 - nu_) * f.p3 - (2 - nu_) * f.p1, (1 - nu_) * f.q3 - (2 - nu_) * f.q1;
    rhs(0) = -((1 - nu_) * (2 - u) + (2 - nu_) * u);
    if (rough_) {
      m.row(1) << (1 - nu_) * f.p2 + nu_ * f.p0, (1 - nu_) * f.q2 + nu_ * f.q0;
      rhs(1) = -((1 - nu_) * (u - 1) + nu_ * (1 + u));
    } else {
      m.row(1) << f.p1, f.q1;
      rhs(1) = u;
    }
    return m.inverse() * rhs;
  }

  // Calls wave(u, weight, g'', g, g') of g_r at the nodes of a quadrature over u: at the depth t
  // (of h), where phases up to u * `phase` are resolved.
  template <class Wave>
  void over_waves(double t, double phase, Wave&& wave) const {
    const double end = kDecay / (2 - t);
    const double width = std::min(kPanelWidth, kPanelPhase / std::max(std::abs(phase), 1e-3));
    const int panels = static_cast<int>(std::ceil(end / width));
    const double half = 0.5 * end / panels;
    const auto add = [&](double u, double weight) {
      const Eigen::Vector2d ab = coefficients(u);
      const Basis f(u * t);
      wave(u, weight * std::exp(-u * (2 - t)), ab(0) * f.p2 + ab(1) * f.q2,
           ab(0) * f.p0 + ab(1) * f.q0, ab(0) * f.p1 + ab(1) * f.q1);
    };
    for (int panel = 0; panel < panels; ++panel) {
      const double middle = (2 * panel + 1) * half;
      for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
        add(middle + half * Gauss::abscissa()[i], half * Gauss::weights()[i]);
        add(middle - half * Gauss::abscissa()[i], half * Gauss::weights()[i]);
      }
    }
  }

  void in_space(const Points& points, const std::vector<Eigen::Index>& inside,
                Stresses& out) const {
    const auto n = static_cast<Eigen::Index>(inside.size());
    Eigen::ArrayXd radius(n), depth(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto p = points.row(inside[static_cast<std::size_t>(k)]);
      radius[k] = std::hypot(p[0], p[1]) / h_;
      depth[k] = std::min(-p[2] / h_, 1.0);
    }
    const auto field = [this](const Eigen::ArrayXd& r, const Eigen::ArrayXd& d) {
      return of_base(r, d);
    };
    // As far as the load's mirror image is from the base.
    const Eigen::ArrayX4d base = about_axis(field, 1, radius, depth);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto i = inside[static_cast<std::size_t>(k)];
      const double x = points(i, 0), y = points(i, 1), r = radius[k] * h_;
      const double c = r > 0 ? x / r : 1, s = r > 0 ? y / r : 0;
      const double rr = base(k, 0), tt = base(k, 1), zz = base(k, 2), rz = base(k, 3);
      const double added[6] = {rr * c * c + tt * s * s, rr * s * s + tt * c * c, zz, rz * s, rz * c,
                               (rr - tt) * c * s};
      const auto half_space = boussinesq_stress(load_, nu_, x, y, -depth[k] * h_);
      for (int a = 0; a < 6; ++a) out(i, a) = half_space[static_cast<std::size_t>(a)] + added[a];
    }
  }

  /// What the base adds at these radii and depths over h: rr, tt, zz, rz (z up), Pa.
  Eigen::ArrayX4d of_base(const Eigen::ArrayXd& radius, const Eigen::ArrayXd& depth) const {
    Eigen::ArrayX4d out = Eigen::ArrayX4d::Zero(radius.size(), 4);
    for (Eigen::Index k = 0; k < radius.size(); ++k) {
      double rr = 0, tt = 0, zz = 0, rz = 0;
      over_waves(depth[k], radius[k],
                 [&](double u, double weight, double g2, double g0, double g1) {
                   const double at = u * radius[k], j0 = ::j0(at), j1 = ::j1(at);
                   const double beside = at > 1e-4 ? j1 / at : 0.5 - at * at / 16;
                   const double ahead = j0 - beside;
                   const double crest = nu_ * (g2 - g0), wave = weight * u;
                   rr += wave * (g2 * ahead + crest * beside);
                   tt += wave * (g2 * beside + crest * ahead);
                   zz -= wave * g0 * j0;
                   rz -= wave * g1 * j1;  // changes sign with the axis that points up
                 });
      out.row(k) << rr, tt, zz, rz;
    }
    return out * (load_ / (2 * M_PI * h_ * h_));
  }

  Eigen::Vector3d at(double x, double y) const {
    const double phase = x / h_;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // g'' cos, g cos, g' sin
    over_waves(-y / h_, phase, [&](double u, double weight, double g2, double g0, double g1) {
      const double c = weight * std::cos(u * phase), s = weight * std::sin(u * phase);
      sum += Eigen::Vector3d(c * g2, c * g0, s * g1);
    });
    sum *= load_ / (M_PI * h_);
    const auto half_plane = flamant_stress(load_, x, y);
    // sigma_xd changes sign with the axis that points up.
    return {half_plane[0] + sum(0), half_plane[1] - sum(1), half_plane[2] - sum(2)};
  }

  double load_, h_, nu_;
  bool rough_;
  int dim_;
};

}  // namespace

ModelInfo layer_info() {
  return {
      "layer",
      "elastic layer on a rigid base under a line load, in space a point load",
      0,
      {number("F", "N", "load at the origin, down", "Roul 5.6", 1, 0, kUnbounded),
       number("h", "m", "depth of the layer", "Roul 5.6", 1, kAboveZero, kUnbounded),
       may_be_free(
           number("nu", "-", "Poisson's ratio; sigma_yy over a smooth base does not depend on it",
                  "elasticity, plane strain", 0.3, 0, 0.5),
           0, 0.499),
       choice("base", "smooth: no shear; rough: no displacement", "Roul 5.6", {"smooth", "rough"}),
       choice("dim", "2: plane strain; 3: space", "elasticity", {"2", "3"})},
      [](const Settings& s) -> std::unique_ptr<Model> {
        return std::make_unique<Layer>(number_of(s, "F"), number_of(s, "h"), number_of(s, "nu"),
                                       s.at("base") == "rough", s.at("dim") == "3" ? 3 : 2);
      }};
}

}  // namespace grainfield::continuum
