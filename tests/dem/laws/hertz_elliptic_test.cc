// The contact ellipse against Johnson's formulas with Boost's elliptic integrals, Mindlin's
// compliances, the bounds of the radii, and the source's penalty law.
#include "dem/laws/hertz_elliptic.h"

#include <gmock/gmock.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <numbers>

#include "dem/laws/penalty.h"
#include "dem/random/random.h"
#include "dem/space/kinematics3.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;
using Number = boost::multiprecision::cpp_bin_float_50;
constexpr double kPi = std::numbers::pi;

struct Johnson {
  Number k, e, b, d, kappa;
};
/// Johnson 1985, 4.28 to 4.31 and the appendix: with the integrals as they stand.
Johnson johnson_at(const Number& kappa) {
  const Number square = 1 - 1 / (kappa * kappa), modulus = sqrt(square);
  Johnson out;
  out.kappa = kappa;
  out.k = boost::math::ellint_1(modulus);
  out.e = boost::math::ellint_2(modulus);
  out.b = (out.e - (1 - square) * out.k) / square;
  out.d = (out.k - out.e) / square;
  return out;
}
Number ratio_at(const Number& kappa) {
  const Johnson j = johnson_at(kappa);
  return (kappa * kappa * j.e - j.k) / (j.k - j.e);
}
Johnson johnson_of(const Number& ratio) {
  boost::uintmax_t steps = 200;
  const auto root = boost::math::tools::toms748_solve(
      [&](const Number& x) { return Number(log(ratio_at(exp(x))) - log(ratio)); }, Number(1e-12),
      Number(30), boost::math::tools::eps_tolerance<Number>(100), steps);
  return johnson_at(exp(root.first));
}
double off(double found, const Number& exact) {
  return std::fabs(static_cast<double>(Number(found) / exact - 1));
}

TEST(HertzElliptic, EllipseIsJohnsons) {
  double kappa = 0, integrals = 0, gamma = 0, axis = 0;
  for (int k = 1; k <= 60; ++k) {
    const double ratio = std::pow(10, 0.1 * k), a = 2.5, b = ratio * a;
    const Johnson exact = johnson_of(ratio);
    const EllipticContact found = elliptic_contact(a, b);
    kappa = std::max(kappa, off(found.shape.kappa, exact.kappa));
    const auto& e = found.shape.integrals;
    for (const double error : {off(e.k, exact.k), off(e.b, exact.b), off(e.d, exact.d)}) {
      integrals = std::max(integrals, error);
    }
    // d = p0 b/E* K(e), F = 2/3 p0 pi a b and a from A; so gamma and axis without Wellmann.
    const Number semi = sqrt(exact.d / (exact.k * Number(a)));  // at d = 1
    axis = std::max(axis, off(found.axis, semi));
    const Number p0 = 1 / (semi / exact.kappa * exact.k);
    const Number force =
        Number(2) / 3 * p0 * boost::math::constants::pi<Number>() * semi * semi / exact.kappa;
    gamma = std::max(gamma, off(found.gamma, force));
  }
  EXPECT_LT(kappa, 1e-12);
  EXPECT_LT(integrals, 1e-12);
  EXPECT_LT(axis, 1e-12);
  EXPECT_LT(gamma, 1e-12);
}

TEST(HertzElliptic, RatioHoldsFarBeyondAndNextToRound) {
  for (const double kappa : {1 + 1e-9, 1 + 1e-5, 1.02, 1.04, 3.0, 1e4, 1e7}) {
    const double ratio = static_cast<double>(ratio_at(Number(kappa)));
    EXPECT_NEAR(ellipse_ratio(ratio).kappa / kappa, 1, 1e-12) << kappa;
  }
  EXPECT_EQ(ellipse_ratio(1).kappa, 1);
}

// The table against what it was made from, of any ratio, at the parts' ends and beyond it.
TEST(HertzElliptic, TableIsWhatIsSolvedFor) {
  Random random(5);
  double worst = 0;
  const auto compare = [&](double ratio) {
    const EllipticContact solved = elliptic_contact(0.7, 0.7 * ratio);
    const EllipticContact found = EllipseTable::get().contact(0.7, 0.7 * ratio);
    const auto &a = solved.shape, &b = found.shape;
    for (const auto& [x, y] : {std::pair(solved.gamma, found.gamma),
                               {solved.axis, found.axis},
                               {a.kappa, b.kappa},
                               {a.integrals.k, b.integrals.k},
                               {a.integrals.b, b.integrals.b},
                               {a.integrals.d, b.integrals.d}}) {
      worst = std::max(worst, std::fabs(y / x - 1));
    }
  };
  for (int k = 0; k < 20000; ++k) compare(std::pow(10, random.uniform(0, 7)));
  for (int k = 8; k < 8 * 21; ++k) {
    const double end = std::ldexp(1 + k % 8 / 8.0, k / 8 - 1);
    for (const double ratio : {end, std::nextafter(end, 1e9), std::nextafter(end, 1.0)}) {
      compare(std::max(ratio, 1.0));
    }
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(HertzElliptic, OfSpheresIsHertz) {
  const double radius = 0.3;
  const EllipticContact c = elliptic_contact(0.5 / radius, 0.5 / radius);
  EXPECT_NEAR(c.gamma, 4.0 / 3 * std::sqrt(radius), 1e-15);
  EXPECT_NEAR(c.axis, std::sqrt(radius), 1e-15);
  const HertzEllipticLaw law{2e7, 0.22, 1};
  const double a = 1e-3;
  const auto [major, minor] = law.compliances(c.shape.integrals, a);
  // Mindlin: 1/C = 2 a E/((2 - nu)(1 + nu)) = 8 G* a.
  EXPECT_NEAR(1 / major, 2 * a * 2e7 / (1.78 * 1.22), 1e-8);
  EXPECT_NEAR(minor, major, 1e-14 * major);
  const HertzLaw round{2e7, 0.22, 1};
  EXPECT_NEAR(1 / major, 8 * round.effective_shear() * a, 1e-8);
}

TEST(HertzElliptic, IsMoreCompliantAlongTheMajorAxis) {
  for (const double ratio : {1.0, 1.1, 3.0, 100.0, 1e6}) {
    const EllipseRatio e = ellipse_ratio(ratio);
    for (const double nu : {0.0, 0.22, 0.5}) {
      const auto [major, minor] = HertzEllipticLaw{1e7, nu, 1}.compliances(e.integrals, 1e-3);
      if (nu == 0 || ratio == 1) {
        EXPECT_NEAR(major, minor, 1e-14 * major) << ratio << " " << nu;
      } else {
        EXPECT_GT(major, minor * (1 + 1e-6)) << ratio << " " << nu;
      }
      // With nu = 0 as compliant as across the contact at its load (Wellmann after eq. 24).
      if (nu != 0) continue;
      const EllipticContact c = elliptic_contact(1, ratio);
      const double depth = 1e-4, a = c.axis * std::sqrt(depth);
      const HertzEllipticLaw law{1e7, nu, 1};
      const double across = 1 / (1.5 * c.gamma * law.effective_young() * std::sqrt(depth));
      EXPECT_NEAR(law.compliances(c.shape.integrals, a).major / across, 1, 1e-12) << ratio;
    }
  }
}

/// kappa of B/A in doubles, by bracketing Johnson's ratio of integrals.
double kappa_of(double ratio) {
  boost::uintmax_t steps = 200;
  const auto root = boost::math::tools::toms748_solve(
      [&](double x) {
        const double kappa = std::exp(x), e = std::sqrt(1 - 1 / (kappa * kappa));
        const double k = boost::math::ellint_1(e), second = boost::math::ellint_2(e);
        return std::log((kappa * kappa * second - k) / (k - second) / ratio);
      },
      1e-3, 9.0, boost::math::tools::eps_tolerance<double>(50), steps);
  return std::exp(0.5 * (root.first + root.second));
}
/// Displacement of the middle of an ellipse with semi-axes a along x and b, over the force along x,
/// of both bodies: Cerruti's (Johnson 1985, 3.75) of the traction that sticks, Q/(2 pi a b)
/// (1 - r^2/R^2)^(-1/2) with R(phi) the ellipse's edge. Its integral along r is pi R/2.
double compliance_by_quadrature(double a, double b, double young, double nu) {
  const auto along = [&](double phi) {
    const double c = std::cos(phi), s = std::sin(phi);
    return a * b / std::hypot(b * c, a * s) * (1 - nu + nu * c * c);
  };
  const double quarter =
      boost::math::quadrature::gauss_kronrod<double, 31>::integrate(along, 0, kPi / 2, 20, 1e-11);
  const double shear = young / (2 * (1 + nu));
  return quarter / (kPi * shear * a * b);
}

TEST(HertzElliptic, CompliancesAreCerrutisIntegralsOverTheContact) {
  Random random(17);
  double worst = 0, most_kappa = 1, unlike = 0;
  for (int n = 0; n < 1000; ++n) {
    const double ratio = std::pow(10, random.uniform(0.01, 5)), nu = random.uniform(0, 0.5);
    const double a = 1e-3, kappa = kappa_of(ratio), b = a / kappa;
    const auto found =
        HertzEllipticLaw{1e7, nu, 1}.compliances(elliptic_contact(1, ratio).shape.integrals, a);
    worst = std::max(worst, std::fabs(found.major / compliance_by_quadrature(a, b, 1e7, nu) - 1));
    worst = std::max(worst, std::fabs(found.minor / compliance_by_quadrature(b, a, 1e7, nu) - 1));
    most_kappa = std::max(most_kappa, kappa);
    unlike = std::max(unlike, found.major / found.minor);
  }
  EXPECT_LT(worst, 1e-8);
  EXPECT_GT(most_kappa, 100);
  EXPECT_GT(unlike, 1.3);
}

Overlap3 overlap_of(double lesser, double greater, double depth) {
  Overlap3 o;
  o.normal = Vector3d(1, 2, 2) / 3;
  o.major = Vector3d(2, 1, -2) / 3;
  o.depth = depth;
  o.radius = 0.5;
  o.lesser_curvature = lesser;
  o.greater_curvature = greater;
  return o;
}
ContactMotion<3> motion(double approach, const Vector3d& slip) {
  ContactMotion<3> m;
  m.approach = approach;
  m.slip = slip;
  m.inverse_mass = 4;
  return m;
}

TEST(HertzElliptic, ForcesAreThoseOfTheSource) {
  const HertzEllipticLaw law{1e6, 0.3, 1};
  const Overlap3 o = overlap_of(0.6, 4, 1e-3);
  const EllipticContact c = law.ellipse(o);
  HertzMemory<3> memory;
  const Vector3d minor = o.normal.cross(o.major), slip = 0.02 * o.major - 0.03 * minor;
  const double dt = 1e-4;
  const LawForce<3> f = law(o, motion(0.1, slip), 10, dt, memory);
  const double elastic = c.gamma * law.effective_young() * std::pow(1e-3, 1.5);
  const double stiffness = 1.5 * c.gamma * law.effective_young() * std::sqrt(1e-3);
  EXPECT_NEAR(f.normal, elastic + 2 * std::sqrt(stiffness * 0.25) * 0.1, 1e-12 * elastic);
  EXPECT_NEAR(law.repulsion(o), elastic, 1e-12 * elastic);
  const auto [cx, cy] = law.compliances(c.shape.integrals, c.axis * std::sqrt(1e-3));
  EXPECT_NEAR(f.tangential.dot(o.major), -dt * 0.02 / cx, 1e-12 / cx);
  EXPECT_NEAR(f.tangential.dot(minor), dt * 0.03 / cy, 1e-12 / cy);
  // Not along the slip.
  EXPECT_GT(f.tangential.cross(slip).norm(), 1e-3 * f.tangential.norm() * slip.norm());
  EXPECT_NEAR(law.energy(o, memory).tangential,
              0.5 * (cx * std::pow(0.02 * dt / cx, 2) + cy * std::pow(0.03 * dt / cy, 2)), 1e-14);
  // Coulomb, along the trial force; and -dF/dd = k: the energy's derivative is the force.
  HertzMemory<3> slides;
  const LawForce<3> capped = law(o, motion(0, 1e4 * slip), 0.5, dt, slides);
  EXPECT_NEAR(capped.tangential.norm(), 0.5 * capped.normal, 1e-12 * capped.normal);
  EXPECT_NEAR(capped.tangential.cross(f.tangential).norm(), 0,
              1e-12 * capped.normal * f.tangential.norm());
  const double h = 1e-7;
  const double up = law.energy(overlap_of(0.6, 4, 1e-3 + h), HertzMemory<3>{}).normal;
  const double down = law.energy(overlap_of(0.6, 4, 1e-3 - h), HertzMemory<3>{}).normal;
  EXPECT_NEAR((up - down) / (2 * h), elastic, 1e-6 * elastic);
  // Unloading shrinks the spring with the axis; loading does not stretch it.
  HertzMemory<3> shrinks = memory;
  law(overlap_of(0.6, 4, 2.5e-4), motion(0, {0, 0, 0}), 10, dt, shrinks);
  EXPECT_NEAR((shrinks.spring - 0.5 * memory.spring).norm(), 0, 1e-12 * memory.spring.norm());
  HertzMemory<3> stays = memory;
  law(overlap_of(0.6, 4, 4e-3), motion(0, {0, 0, 0}), 10, dt, stays);
  EXPECT_NEAR((stays.spring - memory.spring).norm(), 0, 1e-15);
}

// A flat face and an edge: the force at the bounds, and how it goes by them. The force of a surface
// without curvature one way grows by 2.2 to 2.5 where the bound is ten times as far (at last by the
// root of ten: a line's length), that of an edge falls by a fifth.
TEST(HertzElliptic, RadiiAreBounded) {
  const Overlap3 face = overlap_of(1e-30, 0.5, 1e-3), edge = overlap_of(1, 1e50, 1e-3);
  const auto force = [](const Overlap3& o, double least, double most) {
    return HertzEllipticLaw{1e6, 0.3, 1, false, least, most}.repulsion(o);
  };
  for (const auto& [o, radius] : {std::pair(face, 10.0), {edge, 0.1}}) {
    const double bound = 0.5 / (radius * o.radius);
    Overlap3 there = o;
    (radius > 1 ? there.lesser_curvature : there.greater_curvature) = bound;
    EXPECT_EQ(force(o, 0.1, 10), force(there, 0.1, 10));
    EXPECT_EQ(force(o, 0.1, 10), force(there, 1e-9, 1e9));
  }
  double before = force(face, 0.1, 10);
  for (const double most : {100.0, 1000.0}) {
    const double now = force(face, 0.1, most);
    EXPECT_GT(now, before);
    EXPECT_LT(now, std::sqrt(10) * before);
    before = now;
  }
  before = force(edge, 0.1, 10);
  for (const double least : {0.01, 0.001}) {
    const double now = force(edge, least, 10);
    EXPECT_LT(now, before);
    EXPECT_GT(now, 0.6 * before);
    before = now;
  }
  EXPECT_TRUE(
      std::isfinite(force(overlap_of(0, std::numeric_limits<double>::infinity(), 1), 0.1, 10)));
}

TEST(HertzElliptic, NumbersOutOfRangeAreRefused) {
  const auto refusal = [](double poisson, double least, double most) {
    MaterialSetup m;
    m.poisson = poisson;
    m.least_radius = least;
    m.most_radius = most;
    try {
      HertzEllipticLaw::of(m);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(0.5, 0.1, 10), "accepted");
  EXPECT_EQ(refusal(-1, 0.1, 10), "material.poisson: found -1, allowed: above -1, up to 0.5");
  EXPECT_EQ(refusal(0.51, 0.1, 10), "material.poisson: found 0.51, allowed: above -1, up to 0.5");
  EXPECT_EQ(refusal(0.3, 0, 10),
            "material.least_radius, most_radius: found 0, 10, allowed: above 0 up to 1, and 1 or "
            "more");
}

TEST(Penalty, ForcesAreThoseOfTheSource) {
  const PenaltyLaw law{1e5, 4e4, 1};
  const Overlap3 o = overlap_of(1, 1, 1e-3);
  SpringMemory<3> memory;
  const Vector3d slip = 0.01 * o.major;
  const LawForce<3> f = law(o, motion(0.2, slip), 10, 1e-3, memory);
  EXPECT_NEAR(f.normal, 100 + 2 * std::sqrt(1e5 * 0.25) * 0.2, 1e-10);
  EXPECT_NEAR((f.tangential + 0.4 * o.major).norm(), 0, 1e-13);
  const LawForce<3> capped = law(o, motion(0, 1e6 * slip), 0.25, 1e-3, memory);
  EXPECT_NEAR((capped.tangential + 25 * o.major).norm(), 0, 1e-10);
  EXPECT_EQ(law(o, motion(-1, slip), 0.25, 1e-3, memory).normal, 0);  // never attractive
}

// Head on, critically damped: the rebound of a mass on spring and dashpot that lets go when the
// force would pull, u/v = exp(-2) (the spring and dashpot's force is 0 at t = 2/omega).
TEST(Penalty, CriticalDampingLetsAPairCreepApart) {
  const PenaltyLaw law{1e4, 0, 1};
  const double mass = 0.25, omega = std::sqrt(1e4 / mass), dt = 1e-4 / omega;
  double depth = 0, speed = 1;
  SpringMemory<3> memory;
  for (int k = 0; k < 100000 && (k < 10 || depth > 0); ++k) {
    const double f =
        law(overlap_of(1, 1, depth), motion(speed, Vector3d::Zero()), 0, dt, memory).normal;
    if (k > 10 && f == 0) break;
    speed -= dt * f / mass;
    depth += dt * speed;
  }
  EXPECT_NEAR(-speed, std::exp(-2.0), 1e-3);
}

}  // namespace
}  // namespace grainfield::dem
