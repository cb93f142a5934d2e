// Return mapping of the Mohr-Coulomb law against independent answers: non-negative least squares
// over the cone's rays, all sets of active planes tried out, the flow rule integrated in small
// steps; the tangent against differences; the limit of no cohesion.
#include "continuum/plasticity/mohr_coulomb.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "continuum/model.h"

using namespace grainfield::continuum;
using namespace grainfield::continuum::plasticity;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::HasSubstr;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
  }
  bool one_in(std::uint64_t n) { return bits_() % n == 0; }

 private:
  std::mt19937_64 bits_;
};

MohrCoulomb random_material(Draw& draw, bool associated) {
  MohrCoulomb m;
  m.E = std::exp(draw.uniform(0, 3));
  m.nu = draw.uniform(0, 0.45);
  m.friction_deg = draw.uniform(5, 45);
  m.dilation_deg =
      associated ? m.friction_deg : (draw.one_in(4) ? 0 : draw.uniform(0, m.friction_deg));
  m.cohesion = draw.one_in(3) ? 0 : draw.uniform(0, 0.3);
  return m;
}

Matrix3d principal_stiffness(const MohrCoulomb& m) {
  Matrix3d d = Matrix3d::Constant(m.E * m.nu / ((1 + m.nu) * (1 - 2 * m.nu))) +
               Matrix3d(Vector3d::Constant(m.E / (1 + m.nu)).asDiagonal());
  return d;
}

/// Principal trial stresses: anywhere, near the hydrostatic axis, two equal, or all three.
Vector3d random_trial(Draw& draw) {
  Vector3d t(draw.uniform(-3, 1), draw.uniform(-3, 1), draw.uniform(-3, 1));
  if (draw.one_in(5)) t = Vector3d::Constant(t[0]) + 0.05 * t;
  if (draw.one_in(8)) t[1] = t[0];
  if (draw.one_in(8)) t[2] = t[1];
  return t;
}

/// The first two along axes turned by angle, the third out of the plane.
Vector4 turned(const Vector3d& s, double angle) {
  const double c = std::cos(angle), n = std::sin(angle);
  return {c * c * s[0] + n * n * s[1], n * n * s[0] + c * c * s[1], s[2], c * n * (s[0] - s[1])};
}

Vector3d gradient(int i, int j, double sine) {
  Vector3d out = Vector3d::Zero();
  out[i] = 1 + sine;
  out[j] = -(1 - sine);
  return out;
}

std::array<std::pair<int, int>, 6> planes() {
  return {{{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}}};
}

/// Largest f over all ordered pairs, without sorting.
double yield_of(const MohrCoulomb& m, const Vector3d& s) {
  const double sine = std::sin(m.friction_deg * kDegree);
  double most = -1e300;
  for (const auto& [i, j] : planes())
    most = std::max(
        most, gradient(i, j, sine).dot(s) - 2 * m.cohesion * std::cos(m.friction_deg * kDegree));
  return most;
}

/// The admissible stress nearest to t in the norm of the elastic energy: apex minus a non-negative
/// sum of the cone's six rays, by cyclic coordinate descent.
Vector3d nearest(const MohrCoulomb& m, const Vector3d& t) {
  const double sine = std::sin(m.friction_deg * kDegree);
  const double active = (1 - sine) / (1 + sine);
  const double apex = m.cohesion * std::cos(m.friction_deg * kDegree) / sine;
  std::vector<Vector3d> rays;
  for (int k = 0; k < 3; ++k) {
    Vector3d one = Vector3d::Constant(-active), two = Vector3d::Constant(-1);
    one[k] = -1;
    two[k] = -active;
    rays.push_back(one);
    rays.push_back(two);
  }
  const Matrix3d compliance = principal_stiffness(m).inverse();
  Vector3d s = Vector3d::Constant(apex);
  std::array<double, 6> amount{};
  for (int sweep = 0; sweep < 40000; ++sweep) {
    double moved = 0;
    for (int k = 0; k < 6; ++k) {
      const Vector3d weighted = compliance * rays[k];
      const double step = std::max(-amount[k], weighted.dot(t - s) / weighted.dot(rays[k]));
      amount[k] += step;
      s += step * rays[k];
      moved = std::max(moved, std::abs(step));
    }
    if (moved < 1e-15) break;
  }
  return s;
}

/// All states that at most two active planes can explain: multipliers >= 0, no plane violated.
std::vector<Vector3d> explained_by_planes(const MohrCoulomb& m, const Vector3d& t) {
  const double phi = std::sin(m.friction_deg * kDegree), psi = std::sin(m.dilation_deg * kDegree);
  const double strength = 2 * m.cohesion * std::cos(m.friction_deg * kDegree);
  const Matrix3d stiffness = principal_stiffness(m);
  const double slack = 1e-12 * (t.norm() + strength);
  std::vector<Vector3d> out;
  if (yield_of(m, t) <= 0) return {t};
  const auto all = planes();
  for (std::size_t p = 0; p < all.size(); ++p) {
    for (std::size_t q = p; q < all.size(); ++q) {
      const int n = p == q ? 1 : 2;
      Eigen::MatrixXd a(3, n), flow(3, n);
      a.col(0) = gradient(all[p].first, all[p].second, phi);
      flow.col(0) = stiffness * gradient(all[p].first, all[p].second, psi);
      if (n == 2) {
        a.col(1) = gradient(all[q].first, all[q].second, phi);
        flow.col(1) = stiffness * gradient(all[q].first, all[q].second, psi);
      }
      const Eigen::FullPivLU<Eigen::MatrixXd> lu(a.transpose() * flow);
      if (!lu.isInvertible()) continue;
      const Eigen::VectorXd l =
          lu.solve(a.transpose() * t - Eigen::VectorXd::Constant(n, strength));
      const Vector3d s = t - flow * l;
      if (l.minCoeff() >= -slack && yield_of(m, s) <= 10 * slack) out.push_back(s);
    }
  }
  return out;
}

}  // namespace

TEST(MohrCoulomb, AssociatedReturnIsTheClosestPointInEnergy) {
  Draw draw(11);
  std::map<Regime, int> seen;
  for (int n = 0; n < 4000; ++n) {
    const MohrCoulomb m = random_material(draw, true);
    const MohrCoulombLaw law(m);
    const Vector3d t = random_trial(draw);
    const double angle = draw.uniform(0, std::numbers::pi);
    const Returned r = law(law.elastic_strain(turned(t, angle)));
    ++seen[r.regime];
    const Vector3d want = nearest(m, t);
    // The descent stops when a sweep moves it by 1e-15; slow sweeps leave some 1e-9.
    ASSERT_LT((r.stress - turned(want, angle)).norm(), 1e-7) << n << ": " << t.transpose();
    ASSERT_LE(law.yield(r.stress), 1e-13);
  }
  for (const Regime regime :
       {Regime::elastic, Regime::plane, Regime::edge_12, Regime::edge_23, Regime::apex})
    EXPECT_GT(seen[regime], 100) << static_cast<int>(regime);
}

// The closest point among all admissible stresses, turned ones included: the variational inequality
// of the projection, (t - s) : C : (other - s) <= 0.
TEST(MohrCoulomb, NoAdmissibleTensorIsCloser) {
  Draw draw(12);
  for (int n = 0; n < 3000; ++n) {
    const MohrCoulombLaw law(random_material(draw, true));
    const Vector4 t = turned(random_trial(draw), draw.uniform(0, std::numbers::pi));
    const Returned r = law(law.elastic_strain(t));
    const Vector4 plastic = law.elastic_strain(t) - r.elastic_strain;
    for (int k = 0; k < 10; ++k) {
      Vector4 other = r.stress;
      for (int i = 0; i < 4; ++i) other[i] += draw.uniform(-1, 1);
      if (law.yield(other) > 0) continue;
      ASSERT_LE(plastic.dot(other - r.stress), 1e-13);
    }
  }
}

TEST(MohrCoulomb, EveryReturnIsTheOneThatSomeActivePlanesExplain) {
  Draw draw(13);
  std::map<Regime, int> seen;
  for (int n = 0; n < 20000; ++n) {
    const MohrCoulomb m = random_material(draw, draw.one_in(4));
    const MohrCoulombLaw law(m);
    const Vector3d t = random_trial(draw);
    const double angle = draw.uniform(0, std::numbers::pi);
    const Returned r = law(law.elastic_strain(turned(t, angle)));
    ++seen[r.regime];
    const double scale = 1 + t.norm();
    const auto found = explained_by_planes(m, t);
    if (r.regime == Regime::apex) {
      const double apex = m.cohesion / std::tan(m.friction_deg * kDegree);
      for (const Vector3d& s : found)  // only on the apex itself, its border
        ASSERT_LT((s - Vector3d::Constant(apex)).norm(), 1e-9 * scale) << t.transpose();
      ASSERT_LT((r.stress - Vector4(apex, apex, apex, 0)).norm(), 1e-14 * scale);
      continue;
    }
    ASSERT_FALSE(found.empty()) << n << ": " << t.transpose();
    for (const Vector3d& s : found)
      ASSERT_LT((r.stress - turned(s, angle)).norm(), 1e-9 * scale) << n << ": " << t.transpose();
  }
  for (const Regime regime :
       {Regime::elastic, Regime::plane, Regime::edge_12, Regime::edge_23, Regime::apex})
    EXPECT_GT(seen[regime], 500) << static_cast<int>(regime);
}

// The stress relaxes from the trial state along the flow of the most violated plane, in the full
// tensor, with principal directions found anew in every step, until it is admissible.
TEST(MohrCoulomb, FlowRuleIntegratedInSmallSteps) {
  Draw draw(14);
  int edges = 0, faces = 0;
  for (int n = 0; n < 400; ++n) {
    const MohrCoulomb m = random_material(draw, draw.one_in(4));
    const MohrCoulombLaw law(m);
    const double angle = draw.uniform(0, std::numbers::pi);
    const Vector4 t = turned(random_trial(draw), angle);
    const Returned r = law(law.elastic_strain(t));
    if (r.regime == Regime::elastic || r.regime == Regime::apex) continue;
    (r.regime == Regime::plane ? faces : edges) += 1;
    const double psi = std::sin(m.dilation_deg * kDegree);
    const double step = 3e-4 * (t - r.stress).norm() / principal_stiffness(m).norm();
    Matrix3d s;
    s << t[0], t[3], 0, t[3], t[1], 0, 0, 0, t[2];
    int k = 0;
    for (; k < 200000; ++k) {
      const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(s);  // ascending
      const Vector3d value = eigen.eigenvalues();
      if (yield_of(m, value) <= 0) break;
      const Vector3d largest = eigen.eigenvectors().col(2), least = eigen.eigenvectors().col(0);
      const Matrix3d flow =
          (1 + psi) * largest * largest.transpose() - (1 - psi) * least * least.transpose();
      const double lambda = m.E * m.nu / ((1 + m.nu) * (1 - 2 * m.nu));
      s -= step * (lambda * flow.trace() * Matrix3d::Identity() + m.E / (1 + m.nu) * flow);
    }
    ASSERT_LT(k, 200000);
    const Vector4 end(s(0, 0), s(1, 1), s(2, 2), s(0, 1));
    // A step of overshoot, and its zigzag along an edge.
    EXPECT_LT((end - r.stress).norm(), 6e-3 * (t - r.stress).norm())
        << n << " regime " << static_cast<int>(r.regime) << " trial " << t.transpose();
  }
  EXPECT_GT(faces, 40);
  EXPECT_GT(edges, 40);
}

TEST(MohrCoulomb, TangentIsTheDerivative) {
  Draw draw(15);
  std::map<Regime, int> compared;
  for (int n = 0; n < 5000; ++n) {
    const MohrCoulomb m = random_material(draw, draw.one_in(3));
    const MohrCoulombLaw law(m);
    const Vector4 e =
        law.elastic_strain(turned(random_trial(draw), draw.uniform(0, std::numbers::pi)));
    const Returned r = law(e);
    // Central differences: error of second order in h, round-off eps / h.
    const double h = 1e-5 * e.norm();
    Matrix4 difference;
    bool one_regime = true;
    for (int k = 0; k < 4; ++k) {
      const Returned up = law(e + h * Vector4::Unit(k)), down = law(e - h * Vector4::Unit(k));
      one_regime = one_regime && up.regime == r.regime && down.regime == r.regime;
      difference.col(k) = (up.stress - down.stress) / (2 * h);
    }
    if (!one_regime) continue;
    // Close to equal stresses in the plane their order changes within h: a kink.
    const Vector4 trial = law.elasticity() * e;
    const double radius = std::hypot((trial[0] - trial[1]) / 2, trial[3]);
    if (radius < 1e-2 * trial.norm()) continue;
    ++compared[r.regime];
    ASSERT_LT((difference - r.tangent).norm(), 1e-5 * law.elasticity().norm())
        << n << " regime " << static_cast<int>(r.regime);
  }
  for (const Regime regime :
       {Regime::elastic, Regime::plane, Regime::edge_12, Regime::edge_23, Regime::apex})
    EXPECT_GT(compared[regime], 100) << static_cast<int>(regime);
}

// Equal in-plane stresses: directions are arbitrary, stress and tangent are not.
TEST(MohrCoulomb, IsotropicInThePlaneHasAnIsotropicTangent) {
  Draw draw(16);
  int plastic = 0;
  for (int n = 0; n < 500; ++n) {
    const MohrCoulombLaw law(random_material(draw, draw.one_in(3)));
    const double s = draw.uniform(-3, 1), z = draw.uniform(-3, 1);
    const Returned r = law(law.elastic_strain({s, s, z, 0}));
    plastic += r.regime != Regime::elastic;
    const double size = law.elasticity().norm();
    EXPECT_NEAR(r.tangent(0, 0), r.tangent(1, 1), 1e-12 * size);
    EXPECT_NEAR(r.tangent(0, 2), r.tangent(1, 2), 1e-12 * size);
    EXPECT_NEAR(r.tangent(3, 3), (r.tangent(0, 0) - r.tangent(0, 1)) / 2, 1e-12 * size);
  }
  EXPECT_GT(plastic, 100);
}

TEST(MohrCoulomb, TurningTheAxesTurnsStressAndTangent) {
  Draw draw(17);
  for (int n = 0; n < 1000; ++n) {
    const MohrCoulombLaw law(random_material(draw, false));
    const Vector3d t = random_trial(draw);
    const double a = draw.uniform(0, 3), b = draw.uniform(0, 3);
    const Returned one = law(law.elastic_strain(turned(t, a)));
    const Returned two = law(law.elastic_strain(turned(t, b)));
    // Rotation of stress vectors by b - a.
    const double c = std::cos(b - a), s = std::sin(b - a);
    Matrix4 q;
    q << c * c, s * s, 0, -2 * c * s, s * s, c * c, 0, 2 * c * s, 0, 0, 1, 0, c * s, -c * s, 0,
        c * c - s * s;
    ASSERT_LT((q * one.stress - two.stress).norm(), 1e-13 * (1 + t.norm()));
    // Where two or three stresses are equal the derivative jumps; elsewhere it turns along.
    if (std::abs(t[0] - t[1]) < 1e-3 || std::abs(t[1] - t[2]) < 1e-3) continue;
    ASSERT_LT((q * one.tangent * q.transpose() - two.tangent).norm(),
              1e-10 * law.elasticity().norm());
  }
}

TEST(MohrCoulomb, PlasticStrainDilatesByTheAngleAndDissipates) {
  Draw draw(18);
  int faces = 0;
  for (int n = 0; n < 3000; ++n) {
    const MohrCoulomb m = random_material(draw, false);
    const MohrCoulombLaw law(m);
    const Vector4 t = turned(random_trial(draw), draw.uniform(0, std::numbers::pi));
    const Returned r = law(law.elastic_strain(t));
    const Vector4 plastic = law.elastic_strain(t) - r.elastic_strain;
    ASSERT_GE(plastic.dot(r.stress), -1e-13);
    if (r.regime != Regime::plane) continue;
    ++faces;
    Vector4 tensor = plastic;
    tensor[3] /= 2;
    const Vector3d e = principal(tensor);
    EXPECT_NEAR(e.sum(), (e[0] - e[2]) * std::sin(m.dilation_deg * kDegree), 1e-12);
    EXPECT_NEAR(e[1], 0, 1e-12);
  }
  EXPECT_GT(faces, 300);
}

// Regularization by a cohesion: its effect vanishes linearly with it, and at none all is finite.
TEST(MohrCoulomb, CohesionTakenToZeroConvergesToTheCohesionlessReturn) {
  Draw draw(19);
  for (int n = 0; n < 2000; ++n) {
    MohrCoulomb m = random_material(draw, draw.one_in(2));
    m.cohesion = 0;
    const MohrCoulombLaw none(m);
    const Vector4 e = none.elastic_strain(turned(random_trial(draw), draw.uniform(0, 3)));
    const Returned limit = none(e);
    ASSERT_TRUE(limit.stress.allFinite() && limit.tangent.allFinite());
    for (const double c : {1e-2, 1e-4, 1e-6}) {
      m.cohesion = c;
      const Returned r = MohrCoulombLaw(m)(e);
      // The apex moves by c cot(phi), 11.4 c at 5 degrees; oblique flow lengthens that.
      ASSERT_LT((r.stress - limit.stress).norm(), 100 * c);
    }
  }
  // At rest and in pure tension.
  MohrCoulomb m;
  m.friction_deg = 28;
  const MohrCoulombLaw law(m);
  EXPECT_EQ(law(Vector4::Zero()).stress.norm(), 0);
  EXPECT_EQ(law(Vector4(1, 1, 1, 0)).regime, Regime::apex);
  EXPECT_EQ(law(Vector4(1, 1, 1, 0)).stress.norm(), 0);
  EXPECT_EQ(law(Vector4(1, 1, 1, 0)).elastic_strain.norm(), 0);
}

// Without friction: Tresca, which leaves the mean stress alone and has no apex.
TEST(MohrCoulomb, WithoutFrictionItIsTresca) {
  Draw draw(20);
  MohrCoulomb m;
  m.E = 10;
  m.cohesion = 0.2;
  const MohrCoulombLaw law(m);
  std::map<Regime, int> seen;
  for (int n = 0; n < 2000; ++n) {
    const Vector4 t = turned(random_trial(draw), draw.uniform(0, 3));
    const Returned r = law(law.elastic_strain(t));
    ++seen[r.regime];
    ASSERT_NEAR(r.stress.head<3>().sum(), t.head<3>().sum(), 1e-13);
    const Vector3d s = principal(r.stress);
    if (r.regime != Regime::elastic) {
      ASSERT_NEAR(s[0] - s[2], 2 * m.cohesion, 1e-13);
    }
  }
  EXPECT_EQ(seen[Regime::apex], 0);
  EXPECT_GT(seen[Regime::edge_12], 100);
  EXPECT_GT(seen[Regime::edge_23], 100);
}

TEST(MohrCoulomb, RefusesConstantsOutOfRange) {
  const auto refusal = [](auto change) -> std::string {
    MohrCoulomb m;
    m.friction_deg = 28;
    change(m);
    try {
      const MohrCoulombLaw law(m);
    } catch (const BadParameter& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal([](MohrCoulomb&) {}), "accepted");
  EXPECT_THAT(refusal([](MohrCoulomb& m) { m.dilation_deg = 30; }),
              HasSubstr("dilation angle = 30; allowed: 0 to the friction angle, 28 deg"));
  EXPECT_THAT(refusal([](MohrCoulomb& m) { m.dilation_deg = -1; }), HasSubstr("dilation angle"));
  EXPECT_THAT(refusal([](MohrCoulomb& m) { m.friction_deg = 90; }), HasSubstr("friction angle"));
  EXPECT_THAT(refusal([](MohrCoulomb& m) { m.E = 0; }), HasSubstr("E = 0; allowed: above 0"));
  EXPECT_THAT(refusal([](MohrCoulomb& m) { m.nu = 0.5; }), HasSubstr("nu = 0.5"));
  EXPECT_THAT(refusal([](MohrCoulomb& m) { m.cohesion = -1; }), HasSubstr("cohesion = -1"));
  EXPECT_THAT(refusal([](MohrCoulomb& m) { m.friction_deg = 0; }),
              HasSubstr("cohesion = 0; allowed: above 0 where the friction angle is 0"));
}
