// Superellipsoids: size, moments, and all that contacts ask of their surface, from the support
// function (physics section 5; Wellmann et al. eq. 1).
//
//   F = ((|x1/r1|^(2/e1) + |x2/r2|^(2/e1))^(e1/e2) + |x3/r3|^(2/e2)),  inside F < 1
//
// For 0 < e < 2 that is a mixed norm, and the support function the dual one: with P = 2/(2 - e1),
// Q = 2/(2 - e2), a_k = |r_k n_k|,
//
//   s = (a1^P + a2^P)^(1/P),  h(n) = (s^Q + a3^Q)^(1/Q).
//
// Its gradient is the point of the surface with the outward normal n, its Hessian across n has the
// principal radii of curvature for eigenvalues. The Hessian is a sum of two squares,
//
//   H = c1 u1 u1' + c2 u2 u2',  n.(u1 x u2) = +-r1 r2 r3/h,
//
// one from each norm, which are kept apart: of long and short radii neither is lost in the other.
// e < 1: flat where an a_k is 0, radius infinite; e > 1: sharp there, radius 0.
#pragma once
#include <array>
#include <string>

#include "dem/shapes/solid.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

/// Exponents that are held to be safe: below the faces, above the edges are too sharp for double
/// precision.
inline constexpr double kLeastExponent = 0.1, kMostExponent = 1.9;

/// Plain numbers, in the body frame.
struct Superellipsoid {
  Eigen::Vector3d axes = Eigen::Vector3d::Ones();  ///< r1, r2, r3: semi-axes, m
  std::array<double, 2> exponents{1, 1};           ///< e1 of the first two, e2 with the third
  double level = 2;                                ///< P, of the first two axes
  double upright = 2;                              ///< Q, with the third
};

/// Throws std::invalid_argument: semi-axes that are not positive and finite, exponents out of
/// range.
Superellipsoid superellipsoid(const std::array<double, 3>& axes,
                              const std::array<double, 2>& exponents);

/// m3, by Beta functions (Jaklic et al. 2000).
double volume_of(const Superellipsoid& body);
/// Bounding radius, volume and moments at density 1 (about the axes).
Solid<3> solid_of(const Superellipsoid& body);
/// From the centre to the farthest and to the nearest point of the surface, m.
double farthest_of(const Superellipsoid& body);
double nearest_of(const Superellipsoid& body);

/// What of a grain bounds the time step: the mass that a force along a normal feels at least, kg,
/// because it also turns the grain, 1/m + (x cross n)' I^-1 (x cross n) looked at on a grid of the
/// surface; and the radius of the sphere of equal volume, m.
struct FeltMass {
  double mass = 0, radius = 0;
};
FeltMass felt_mass(const Superellipsoid& body, double density);

/// A square c u u' of a tensor across a normal.
struct Square {
  double weight = 0;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
};

/// What a surface is like where its outward normal is n.
struct Support {
  double height = 0;                                ///< h, m
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< from the centre, m
  std::array<Square, 2> bend;                       ///< H = sum weight along along', m
  double area = 0;                                  ///< |n.(u1 x u2)|, m2
};

/// `n`: unit, in the body frame.
Support support_of(const Superellipsoid& body, const Eigen::Vector3d& n);
/// The height alone, m.
double height_of(const Superellipsoid& body, const Eigen::Vector3d& n);

/// Eigenvalues of a sum of squares across the unit vector n, and the direction of the greater one.
struct Principal {
  double greater = 0, lesser = 0;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< unit, across n
};
Principal principal_of(const Eigen::Vector3d& n, const Square* squares, int count);

/// Unit vectors x and y = n cross x.
struct Tangents {
  Eigen::Vector3d x = Eigen::Vector3d::Zero(), y = Eigen::Vector3d::Zero();
};
Tangents tangents_of(const Eigen::Vector3d& n);

/// The Hessian of one body in the plane of two tangents.
struct Bend {
  struct Square {
    double weight = 0, x = 0, y = 0;
  };
  std::array<Square, 2> squares;
  double area = 0;  ///< |u1 x u2|: known without a difference
};
/// `x`, `y`: the tangents in the body frame.
Bend bend_of(const Support& support, const Tangents& in_body);

/// A symmetric tensor in the plane.
struct PlaneTensor {
  double xx = 0, xy = 0, yy = 0;
  double determinant = 0;  ///< a sum of positive terms (Cauchy and Binet), not by a difference
};
/// The sum of both Hessians.
PlaneTensor sum_of(const Bend& i, const Bend& j);

/// Eigenvalues of a symmetric tensor in the plane, and the direction of the greater one.
struct PlanePrincipal {
  double greater = 0, lesser = 0;
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
};
PlanePrincipal principal_of(const PlaneTensor& tensor);
/// The relative curvatures A <= B, 1/m, and the direction of B: of half the sum of both curvature
/// tensors, which is what Wellmann's eqs. 9 and 10 say without angles; of the first one alone where
/// the other body is flat.
PlanePrincipal relative_curvatures(const Bend& i, const Bend& j);
PlanePrincipal relative_curvatures(const Bend& i);
/// The direction of the lesser one in space: unit.
inline Eigen::Vector3d across_of(const PlanePrincipal& p, const Tangents& t) {
  return p.along.x() * t.y - p.along.y() * t.x;
}

/// Principal radii of curvature, m, and the direction of the greater one.
inline Principal radii_of(const Eigen::Vector3d& n, const Support& support) {
  return principal_of(n, support.bend.data(), 2);
}

}  // namespace grainfield::dem
