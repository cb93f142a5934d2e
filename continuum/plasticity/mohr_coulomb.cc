#include "continuum/plasticity/mohr_coulomb.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "continuum/constants.h"
#include "continuum/model.h"

namespace grainfield::continuum::plasticity {
namespace {

/// Below this friction angle the apex lies too far off to be computed: a prism (Tresca).
constexpr double kLeastSine = 1e-9;
/// Trial stresses in the plane that differ by less than this part of the stress: their directions
/// are round-off, and the tangent is taken at its limit.
constexpr double kSamePrincipal = 1e-12;

void refuse(bool wrong, const char* name, double found, const std::string& allowed) {
  if (wrong)
    throw BadParameter(
        fmt::format("Mohr-Coulomb material: {} = {:g}; allowed: {}", name, found, allowed));
}

struct InPlane {
  double mean, radius, cosine, sine;  ///< of twice the angle from x to the larger stress
};

InPlane in_plane(const Vector4& s) {
  const double half = (s[0] - s[1]) / 2, radius = std::hypot(half, s[3]);
  if (radius == 0) return {(s[0] + s[1]) / 2, 0, 1, 0};
  return {(s[0] + s[1]) / 2, radius, half / radius, s[3] / radius};
}

}  // namespace

Eigen::Vector3d principal(const Vector4& stress) {
  const InPlane p = in_plane(stress);
  Eigen::Vector3d s(p.mean + p.radius, p.mean - p.radius, stress[2]);
  std::sort(s.data(), s.data() + 3, std::greater<>());
  return s;
}

MohrCoulombLaw::MohrCoulombLaw(const MohrCoulomb& constants) : constants_(constants) {
  const MohrCoulomb& m = constants;
  refuse(!(m.E > 0 && std::isfinite(m.E)), "E", m.E, "above 0");
  refuse(!(m.nu >= 0 && m.nu < 0.5), "nu", m.nu, "0 to below 0.5");
  refuse(!(m.friction_deg >= 0 && m.friction_deg < 90), "friction angle", m.friction_deg,
         "0 to below 90 deg");
  refuse(!(m.dilation_deg >= 0 && m.dilation_deg <= m.friction_deg), "dilation angle",
         m.dilation_deg, fmt::format("0 to the friction angle, {:g} deg", m.friction_deg));
  refuse(!(m.cohesion >= 0 && std::isfinite(m.cohesion)), "cohesion", m.cohesion, "at least 0");
  sin_friction_ = std::sin(m.friction_deg * kDegree);
  sin_dilation_ = std::sin(m.dilation_deg * kDegree);
  strength_ = 2 * m.cohesion * std::cos(m.friction_deg * kDegree);
  refuse(sin_friction_ < kLeastSine && m.cohesion == 0, "cohesion", m.cohesion,
         "above 0 where the friction angle is 0");
  shear_ = m.E / (2 * (1 + m.nu));
  const double lambda = m.E * m.nu / ((1 + m.nu) * (1 - 2 * m.nu));
  stiffness_.setConstant(lambda);
  stiffness_.diagonal().array() += 2 * shear_;
  elastic_.setZero();
  elastic_.topLeftCorner<3, 3>() = stiffness_;
  elastic_(3, 3) = shear_;
}

double MohrCoulombLaw::yield(const Vector4& stress) const {
  const Eigen::Vector3d s = principal(stress);
  return (s[0] - s[2]) + (s[0] + s[2]) * sin_friction_ - strength_;
}

Vector4 MohrCoulombLaw::elastic_strain(const Vector4& stress) const {
  const double trace = stress.head<3>().sum(), nu = constants_.nu;
  Vector4 strain = ((1 + nu) * stress - nu * trace * Vector4(1, 1, 1, 0)) / constants_.E;
  strain[3] = stress[3] / shear_;
  return strain;
}

Eigen::Vector3d MohrCoulombLaw::gradient(int i, int j, double sine) const {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  out[i] = 1 + sine;
  out[j] = -(1 - sine);
  return out;
}

MohrCoulombLaw::Principal MohrCoulombLaw::to_plane(const Eigen::Vector3d& t) const {
  const Eigen::Vector3d a = gradient(0, 2, sin_friction_);
  const Eigen::Vector3d flow = stiffness_ * gradient(0, 2, sin_dilation_);
  const double slope = a.dot(flow);
  return {t - flow * ((a.dot(t) - strength_) / slope),
          stiffness_ - flow * (stiffness_ * a).transpose() / slope, Regime::plane};
}

bool MohrCoulombLaw::to_edge(const Eigen::Vector3d& t, Regime edge, Principal& found) const {
  const bool upper = edge == Regime::edge_12;  // s1 = s2: planes (1,3), (2,3)
  const int i = upper ? 1 : 0, j = upper ? 2 : 1;
  Eigen::Matrix<double, 3, 2> a, flow;
  a << gradient(0, 2, sin_friction_), gradient(i, j, sin_friction_);
  flow << gradient(0, 2, sin_dilation_), gradient(i, j, sin_dilation_);
  flow = stiffness_ * flow;
  const Eigen::Matrix2d inverse = (a.transpose() * flow).inverse();
  const Eigen::Vector2d multipliers =
      inverse * (a.transpose() * t - Eigen::Vector2d::Constant(strength_));
  Eigen::Vector3d s = t - flow * multipliers;
  // The two equal stresses exactly so: the tangent asks whether they are.
  if (upper)
    s[0] = s[1] = (s[0] + s[1]) / 2;
  else
    s[1] = s[2] = (s[1] + s[2]) / 2;
  found = {s, stiffness_ - flow * inverse * (a.transpose() * stiffness_), edge};
  return multipliers.minCoeff() >= 0 && s[0] >= s[2];
}

MohrCoulombLaw::Principal MohrCoulombLaw::principal_return(const Eigen::Vector3d& t) const {
  if ((t[0] - t[2]) + (t[0] + t[2]) * sin_friction_ - strength_ <= 0)
    return {t, stiffness_, Regime::elastic};
  const Principal plane = to_plane(t);
  const bool upper = plane.stress[0] < plane.stress[1], lower = plane.stress[1] < plane.stress[2];
  if (!upper && !lower) return plane;
  Principal edge;
  if (upper && to_edge(t, Regime::edge_12, edge)) return edge;
  if (lower && to_edge(t, Regime::edge_23, edge)) return edge;
  if (sin_friction_ < kLeastSine) {
    to_edge(t, upper ? Regime::edge_12 : Regime::edge_23, edge);
    return edge;
  }
  const double tension = strength_ / (2 * sin_friction_);
  return {Eigen::Vector3d::Constant(tension), Eigen::Matrix3d::Zero(), Regime::apex};
}

Returned MohrCoulombLaw::operator()(const Vector4& trial_strain) const {
  const Vector4 trial = elastic_ * trial_strain;
  const InPlane p = in_plane(trial);
  // Principal trial stresses: the two in the plane, then the one out of it.
  const Eigen::Vector3d t(p.mean + p.radius, p.mean - p.radius, trial[2]);
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&t](int a, int b) { return t[a] > t[b]; });
  const Principal found = principal_return({t[order[0]], t[order[1]], t[order[2]]});

  Returned out;
  out.regime = found.regime;
  if (found.regime == Regime::elastic) {
    out.stress = trial;
    out.elastic_strain = trial_strain;
    out.tangent = elastic_;
    return out;
  }
  Eigen::Vector3d s;
  Eigen::Matrix3d a;
  for (int i = 0; i < 3; ++i) {
    s[order[i]] = found.stress[i];
    for (int j = 0; j < 3; ++j) a(order[i], order[j]) = found.tangent(i, j);
  }

  // Back to x, y: sigma = sum s_k m_k and d eps_k = m_k . d eps with the same vectors m, because
  // the shear strain is the engineering one; a turn of the directions adds the shear m_s.
  const double c2 = (1 + p.cosine) / 2, s2 = (1 - p.cosine) / 2, cs = p.sine / 2;
  Eigen::Matrix<double, 4, 3> m;
  m.col(0) << c2, s2, 0, cs;
  m.col(1) << s2, c2, 0, -cs;
  m.col(2) << 0, 0, 1, 0;
  const Vector4 turn(-p.sine, p.sine, 0, p.cosine);
  const double scale = std::abs(p.mean) + p.radius + std::abs(trial[2]);
  const double turned = p.radius > kSamePrincipal * scale
                            ? shear_ * (s[0] - s[1]) / (2 * p.radius)
                            : (a(0, 0) + a(1, 1) - a(0, 1) - a(1, 0)) / 4;
  out.stress = m * s;
  out.elastic_strain = elastic_strain(out.stress);
  out.tangent = m * a * m.transpose() + turned * turn * turn.transpose();
  return out;
}

}  // namespace grainfield::continuum::plasticity
