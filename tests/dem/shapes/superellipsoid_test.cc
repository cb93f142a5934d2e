// Superellipsoids: surface points, normals and curvatures against their parametrization and their
// equation in 100 digits, volume and moments against Boost's Beta functions and quadrature.
#include "dem/shapes/superellipsoid.h"

#include <gmock/gmock.h>

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <numbers>

#include "dem/random/random.h"
#include "tests/dem/superellipsoid_scene.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;
using Number = boost::multiprecision::cpp_bin_float_100;
using Three = std::array<Number, 3>;
using testing::HasSubstr;

/// Squared cosine and sine of an angle in 100 digits.
struct Angle {
  Number cosine2, sine2;
};

/// A point of the surface by Barr's angles: x1 = r1 c1^e1 c2^e2, x2 = r2 s1^e1 c2^e2, x3 = r3
/// s2^e2; the normal has 2 - e for e and 1/r for r.
struct Reference {
  Three point, normal;
  Number height;
};
Reference reference_of(const Superellipsoid& body, const Angle& level, const Angle& upright) {
  const auto point = [&](Number e1, Number e2, bool inverse) {
    const Number around = pow(upright.cosine2, e2 / 2);
    Three out{around * pow(level.cosine2, e1 / 2), around * pow(level.sine2, e1 / 2),
              pow(upright.sine2, e2 / 2)};
    for (int k = 0; k < 3; ++k) {
      if (inverse) out[k] /= Number(body.axes[k]);
      if (!inverse) out[k] *= Number(body.axes[k]);
    }
    return out;
  };
  const Number e1(body.exponents[0]), e2(body.exponents[1]);
  Reference out{point(e1, e2, false), point(2 - e1, 2 - e2, true), 0};
  Number square = 0;
  for (const Number& n : out.normal) square += n * n;
  const Number length = sqrt(square);
  for (int k = 0; k < 3; ++k) {
    out.normal[k] /= length;
    out.height += out.normal[k] * out.point[k];
  }
  return out;
}

/// Mean and product of the curvatures of the surface F = 1 at a point of the first octant, from F's
/// derivatives (Goldman 2005), and the quadratic form along a direction.
struct Curvatures {
  Number twice_mean, product;
  Number along = 0;
};
Curvatures curvatures_of(const Superellipsoid& body, const Three& x, const Vector3d& way) {
  const Number p = 2 / Number(body.exponents[0]), q = 2 / Number(body.exponents[1]);
  const Three r{Number(body.axes[0]), Number(body.axes[1]), Number(body.axes[2])};
  const Number a = pow(Number(x[0] / r[0]), p), b = pow(Number(x[1] / r[1]), p);
  const Number sum = a + b, power = pow(sum, q / p), z = pow(Number(x[2] / r[2]), q);
  // With l = log sum: dF = power q/p dl, and l's derivatives in relative terms.
  const Number f1 = q * power * a / sum / x[0], f2 = q * power * b / sum / x[1], f3 = q * z / x[2];
  const Number f11 = q * power / (x[0] * x[0]) * (a / sum) * ((p - 1) + (q - p) * a / sum);
  const Number f22 = q * power / (x[1] * x[1]) * (b / sum) * ((p - 1) + (q - p) * b / sum);
  const Number f12 = q * power / (x[0] * x[1]) * (q - p) * (a / sum) * (b / sum);
  const Number f33 = q * (q - 1) * z / (x[2] * x[2]);
  const Number g2 = f1 * f1 + f2 * f2 + f3 * f3, g = sqrt(g2);
  const Number form = f1 * f1 * f11 + 2 * f1 * f2 * f12 + f2 * f2 * f22 + f3 * f3 * f33;
  const Number minor = f11 * f22 - f12 * f12;
  const Number adjugate =
      f3 * f3 * minor + f33 * (f1 * f1 * f22 - 2 * f1 * f2 * f12 + f2 * f2 * f11);
  Curvatures out{((f11 + f22 + f33) * g2 - form) / (g2 * g), adjugate / (g2 * g2)};
  const Number u(way[0]), v(way[1]), w(way[2]);
  out.along = (u * u * f11 + 2 * u * v * f12 + v * v * f22 + w * w * f33) / g;
  return out;
}

double off(const Number& found, const Number& exact) {
  return static_cast<double>(abs(found / exact - 1));
}

struct Errors {
  double height = 0, point = 0, radii = 0, direction = 0;
};
/// Adds what support_of and radii_of are off where the surface has these angles, relative.
void look(const Superellipsoid& body, const Angle& level, const Angle& upright, Errors& worst) {
  const Reference exact = reference_of(body, level, upright);
  Vector3d n;
  for (int k = 0; k < 3; ++k) n[k] = static_cast<double>(exact.normal[k]);
  const Support found = support_of(body, n);
  worst.height = std::max(worst.height, off(Number(found.height), exact.height));
  EXPECT_NEAR(height_of(body, n), found.height, 1e-14 * found.height);
  for (int k = 0; k < 3; ++k) {
    worst.point = std::max(worst.point, off(Number(found.point[k]), exact.point[k]));
  }
  const Principal radii = radii_of(n, found);
  const Curvatures c = curvatures_of(body, exact.point, radii.along);
  const Number greater(radii.greater), lesser(radii.lesser);
  worst.radii = std::max(worst.radii, off(1 / greater / lesser, c.product));
  worst.radii = std::max(worst.radii, off(1 / greater + 1 / lesser, c.twice_mean));
  // The curvature along the direction of the greater radius, against the other one: a direction
  // that is off by an angle takes its square of the other curvature in.
  const double other = static_cast<double>(abs(c.along - 1 / greater) * lesser);
  worst.direction = std::max(worst.direction, other);
}

Angle angle(double share) { return {Number(1) - Number(share), Number(share)}; }

TEST(Superellipsoid, SurfaceIsThatOfHundredDigits) {
  Random random(11);
  Errors worst;
  for (int k = 0; k < 10000; ++k) {
    const Superellipsoid body = random_superellipsoid(random, kLeastExponent, kMostExponent);
    look(body, angle(random.uniform()), angle(random.uniform()), worst);
  }
  EXPECT_LT(worst.height, 1e-13);
  EXPECT_LT(worst.point, 1e-11);
  EXPECT_LT(worst.radii, 1e-10);
  EXPECT_LT(worst.direction, 1e-10);
}

// Near the axes' planes, down to angles whose squares are 1e-30, and at both ends of the exponents:
// radii of 1e50 and of 1e-50 beside one of the usual size.
TEST(Superellipsoid, SurfaceNearItsEdgesAndFacesIsThatOfHundredDigits) {
  Random random(12);
  Errors worst;
  for (int k = 0; k < 2000; ++k) {
    const auto end = [&] { return random.uniform() < 0.5 ? kLeastExponent : kMostExponent; };
    const Superellipsoid body = superellipsoid(
        {random.uniform(0.5, 1.5), random.uniform(0.5, 1.5), random.uniform(0.5, 1.5)},
        {end(), end()});
    const auto near = [&] {
      const double small = std::pow(10, random.uniform(-30, -1));
      const Angle at = angle(small);
      return random.uniform() < 0.5 ? at : Angle{at.sine2, at.cosine2};
    };
    look(body, near(), near(), worst);
  }
  EXPECT_LT(worst.height, 1e-13);
  EXPECT_LT(worst.point, 1e-10);
  EXPECT_LT(worst.radii, 1e-10);
  EXPECT_LT(worst.direction, 1e-10);
}

TEST(Superellipsoid, OnItsAxesAreItsSemiAxes) {
  Random random(13);
  for (int k = 0; k < 200; ++k) {
    const Superellipsoid body = random_superellipsoid(random, kLeastExponent, kMostExponent);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        const Support s = support_of(body, sign * Vector3d::Unit(axis));
        EXPECT_NEAR(s.height, body.axes[axis], 1e-14);
        EXPECT_NEAR((s.point - sign * body.axes[axis] * Vector3d::Unit(axis)).norm(), 0, 1e-14);
        const Principal radii = radii_of(sign * Vector3d::Unit(axis), s);
        EXPECT_TRUE(std::isfinite(radii.greater) && radii.lesser >= 0);
        EXPECT_NEAR(radii.along[axis], 0, 1e-12);
        EXPECT_NEAR(radii.along.norm(), 1, 1e-12);
      }
    }
  }
}

// The closed forms of an ellipsoid: at the end of an axis r_j^2/r_k.
TEST(Superellipsoid, EllipsoidsAndSpheresHaveTheirRadii) {
  const Superellipsoid body = superellipsoid({1, 2, 3}, {1, 1});
  for (int axis = 0; axis < 3; ++axis) {
    const Principal radii = radii_of(Vector3d::Unit(axis), support_of(body, Vector3d::Unit(axis)));
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double one = body.axes[a] * body.axes[a] / body.axes[axis];
    const double two = body.axes[b] * body.axes[b] / body.axes[axis];
    EXPECT_NEAR(radii.greater, std::max(one, two), 1e-13);
    EXPECT_NEAR(radii.lesser, std::min(one, two), 1e-13);
    EXPECT_NEAR(std::fabs(radii.along[one > two ? a : b]), 1, 1e-13);
  }
  const Superellipsoid ball = superellipsoid({0.7, 0.7, 0.7}, {1, 1});
  Random random(14);
  for (int k = 0; k < 100; ++k) {
    const Vector3d n = random_direction(random);
    const Support s = support_of(ball, n);
    EXPECT_NEAR((s.point - 0.7 * n).norm(), 0, 1e-15);
    const Principal radii = radii_of(n, s);
    EXPECT_NEAR(radii.greater, 0.7, 1e-14);
    EXPECT_NEAR(radii.lesser, 0.7, 1e-14);
  }
}

TEST(Superellipsoid, VolumeAndMomentsAreThoseOfHundredDigits) {
  Random random(15);
  for (int k = 0; k < 300; ++k) {
    const Superellipsoid body = random_superellipsoid(random, kLeastExponent, kMostExponent);
    const Number e1(body.exponents[0]), e2(body.exponents[1]);
    const Number a(body.axes[0]), b(body.axes[1]), c(body.axes[2]);
    using boost::math::beta;
    // Jaklic, Leonardis and Solina 2000, eqs 2.60 and after, with their exponents exchanged.
    const Number volume = 2 * a * b * c * e1 * e2 * beta(Number(e2 / 2 + 1), e2) *
                          beta(Number(e1 / 2), Number(e1 / 2));
    const auto level = [&](const Number& r) {
      return r * r * beta(Number(3 * e1 / 2), Number(e1 / 2)) *
             beta(Number(e2 / 2), Number(2 * e2 + 1));
    };
    const Number upright = 4 * c * c * beta(Number(e1 / 2), Number(e1 / 2 + 1)) *
                           beta(Number(3 * e2 / 2), Number(e2 + 1));
    const Number half = a * b * c * e1 * e2 / 2;
    const Solid<3> solid = solid_of(body);
    EXPECT_LT(off(Number(solid.volume), volume), 1e-13);
    EXPECT_LT(off(Number(solid.moments[0]), half * (level(b) + upright)), 1e-13);
    EXPECT_LT(off(Number(solid.moments[1]), half * (level(a) + upright)), 1e-13);
    EXPECT_LT(off(Number(solid.moments[2]), half * (level(a) + level(b))), 1e-13);
  }
  const double sphere = 4.0 / 3 * std::numbers::pi;
  const Solid<3> solid = solid_of(superellipsoid({1, 2, 3}, {1, 1}));
  EXPECT_NEAR(solid.volume, 6 * sphere, 1e-13 * sphere);
  EXPECT_NEAR(solid.moments[0], 0.2 * 6 * sphere * 13, 1e-12 * sphere);
}

// The divergence theorem in the plane of the sphere's angles: 3 V = integral of h over the surface.
TEST(Superellipsoid, VolumeIsThatOfItsSurface) {
  const Superellipsoid body = superellipsoid({0.6, 1.1, 1.4}, {0.8, 1.2});
  boost::math::quadrature::tanh_sinh<double> rule;
  // dA = R1 R2 dn: over an octant of directions, by cos(polar) and azimuth.
  const double integral = rule.integrate(
      [&](double z) {
        return rule.integrate(
            [&](double phi) {
              const double r = std::sqrt(1 - z * z);
              const Vector3d n(r * std::cos(phi), r * std::sin(phi), z);
              const Support s = support_of(body, n);
              const Principal radii = radii_of(n, s);
              return s.height * radii.greater * radii.lesser;
            },
            0.0, 0.5 * std::numbers::pi, 1e-9);
      },
      0.0, 1.0, 1e-9);
  EXPECT_NEAR(8 * integral / 3, solid_of(body).volume, 1e-6);
}

TEST(Superellipsoid, NearestAndFarthestPointBoundTheSurface) {
  Random random(16);
  for (int k = 0; k < 300; ++k) {
    const Superellipsoid body = random_superellipsoid(random, kLeastExponent, kMostExponent);
    const double farthest = farthest_of(body), nearest = nearest_of(body);
    double most = 0, least = 1e9;
    // By the parametrization, densely where surfaces bend: uniform in the angles' squares.
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; j <= 60; ++j) {
        const auto [e1, e2] = body.exponents;
        const double u = 0.5 * (1 - std::cos(std::numbers::pi * i / 60));
        const double v = 0.5 * (1 - std::cos(std::numbers::pi * j / 60));
        const Vector3d x(body.axes[0] * std::pow(u, 0.5 * e1) * std::pow(v, 0.5 * e2),
                         body.axes[1] * std::pow(1 - u, 0.5 * e1) * std::pow(v, 0.5 * e2),
                         body.axes[2] * std::pow(1 - v, 0.5 * e2));
        most = std::max(most, x.norm());
        least = std::min(least, x.norm());
      }
    }
    EXPECT_LE(most, farthest * (1 + 1e-13));
    EXPECT_GE(least, nearest * (1 - 1e-13));
    EXPECT_NEAR(most, farthest, 0.01 * farthest);
    EXPECT_NEAR(least, nearest, 0.05 * nearest);
  }
}

TEST(Superellipsoid, WhatIsNoneIsRefused) {
  const auto refusal = [](const std::array<double, 3>& axes, const std::array<double, 2>& e) {
    try {
      superellipsoid(axes, e);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal({1, 1, 1}, {0.1, 1.9}), "accepted");
  EXPECT_EQ(refusal({1, 1, 1}, {0.09, 1}),
            "a superellipsoid's exponents: found 0.09, 1, allowed: 0.1 to 1.9");
  EXPECT_THAT(refusal({1, 1, 1}, {1, 2}), HasSubstr("found 1, 2, allowed: 0.1 to 1.9"));
  EXPECT_EQ(refusal({1, 0, 1}, {1, 1}),
            "a superellipsoid's semi-axes: found 1, 0, 1 m, allowed: above 0");
  EXPECT_THAT(refusal({1, 1, std::nan("")}, {1, 1}), HasSubstr("found 1, 1, nan m"));
}

}  // namespace
}  // namespace grainfield::dem
