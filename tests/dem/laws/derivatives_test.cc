// The text of overlap, motion, law and friction over numbers with derivatives (space/number.h).
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "dem/laws/hertz.h"
#include "dem/laws/linear.h"
#include "dem/laws/penalty.h"
#include "dem/space/kinematics3.h"
#include "dem/space/round_overlap.h"

namespace grainfield::dem {
namespace {

constexpr double kStep = 1e-3;

/// Two bodies that touch, the second away from its place by `shift`, m.
template <int D, class N>
void place(const VectorOf<D, N>& shift, Body<D, N>& a, Body<D, N>& b) {
  for (int d = 0; d < D; ++d) {
    a.position[d] = N(0);
    b.position[d] = N(d == 0 ? 1.2 : 0.5 + 0.1 * d) + shift[d];
    a.velocity[d] = N(0.3 - 0.2 * d);
    b.velocity[d] = N(-0.1 + 0.1 * d);
  }
  a.radius = N(1);
  b.radius = N(0.8);
  a.inverse_mass = N(0.5);
  b.inverse_mass = N(0.7);
}
template <class N>
Overlap2Of<N> overlap_of(const Body<2, N>& a, const Body<2, N>& b) {
  Overlap2Of<N> o;
  EXPECT_FALSE(disks_meet(N(b.position.x() - a.position.x()), N(b.position.y() - a.position.y()),
                          a.radius, b.radius, o)
                   .apart);
  return o;
}
template <class N>
Overlap3Of<N> overlap_of(const Body<3, N>& a, const Body<3, N>& b) {
  Overlap3Of<N> o;
  const auto meet = spheres_meet(VectorOf<3, N>(b.position - a.position), a.radius, b.radius, o);
  EXPECT_FALSE(meet.apart);
  set_arms(meet.lever_i, meet.lever_j, o);
  return o;
}
/// On the first of the two, N, with a spring that is there already.
template <int D, class N, class Law>
VectorOf<D, N> force_of(const Law& law, double friction, const VectorOf<D, N>& shift) {
  Body<D, N> a, b;
  place<D, N>(shift, a, b);
  const OverlapIn<D, N> o = overlap_of(a, b);
  typename Law::template Memory<D, N> memory;
  if constexpr (D == 2) {
    memory.spring = N(-3);
  } else {
    memory.spring = o.normal.cross(VectorOf<3, N>(N(4), N(1), N(-2)));
    turn_with_contact(memory.spring, o.normal, N(0.01), o);
  }
  if constexpr (requires { memory.contact_radius; }) memory.contact_radius = N(0.6);
  const LawForce<D, N> f = law(o, motion_at<true>(a, b, o), N(friction), kStep, memory);
  return forces_at<true>(o, f.normal, f.tangential).force;
}

template <int D, class Law>
void expect_derivatives(const Law& law, double friction) {
  using Vector = Eigen::Matrix<double, D, 1>;
  using Derived = Eigen::AutoDiffScalar<Vector>;
  VectorOf<D, Derived> shift;
  for (int d = 0; d < D; ++d) shift[d] = Derived(0, D, d);
  const VectorOf<D, Derived> force = force_of<D, Derived>(law, friction, shift);
  constexpr double kAside = 1e-5;  // differences of second order: 1e-10 and rounding 1e-11
  for (int d = 0; d < D; ++d) {
    const VectorOf<D> aside = kAside * Vector::Unit(d);
    const VectorOf<D> slope = (force_of<D, double>(law, friction, aside) -
                               force_of<D, double>(law, friction, VectorOf<D>(-aside))) /
                              (2 * kAside);
    const VectorOf<D> here = force_of<D, double>(law, friction, VectorOf<D>::Zero());
    for (int k = 0; k < D; ++k) {
      EXPECT_EQ(force[k].value(), here[k]);
      EXPECT_NEAR(force[k].derivatives()[d], slope[k], 1e-7 * slope.norm()) << d << " " << k;
    }
  }
}

TEST(Derivatives, OfForcesAreThoseOfDifferences) {
  for (const double friction : {0.01, 10.0}) {  // it slides, and sticks
    expect_derivatives<2>(LinearLaw{300, 100, 2, 1}, friction);
    expect_derivatives<2>(PenaltyLaw{300, 200, 0.2}, friction);
    expect_derivatives<3>(LinearLaw{300, 100, 2, 1}, friction);
    HertzLaw hertz{2e3, 0.3, 0.2};
    expect_derivatives<3>(hertz, friction);
    hertz.viscoelastic = hertz.displacement = true;
    hertz.normal_damping = 2;
    hertz.tangential_damping = 1;
    expect_derivatives<3>(hertz, friction);
  }
}

}  // namespace
}  // namespace grainfield::dem
