// The elasto-plastic wedge: meshes that fit the layers, unlike slopes, units, and the core's
// border.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <utility>

#include "continuum/constants.h"
#include "continuum/fe/wedge.h"
#include "continuum/model.h"
#include "tests/continuum/wedge_scene.h"

using namespace grainfield::continuum;
using testing::HasSubstr;

namespace {

// Mesh lines must lie between the layers.
TEST(FePlastic, RefusesMeshesThatDoNotFitTheLayers) {
  EXPECT_THAT(refusal({{"history", "rise"}, {"cells", "10"}, {"layers", "3"}}),
              HasSubstr("cells = 10 is out of range; allowed: multiples of 3 (nearest: 9), so that "
                        "mesh lines lie between layers = 3"));
  EXPECT_EQ(refusal({{"history", "rise"}, {"cells", "9"}, {"layers", "3"}}), "accepted");
  EXPECT_THAT(refusal({{"history", "grow"}, {"cells", "11"}, {"layers", "4"}}),
              HasSubstr("cells = 11 is out of range; allowed: multiples of 8 (nearest: 8)"));
  EXPECT_THAT(refusal({{"history", "grow"}, {"cells", "12"}, {"layers", "4"}}),
              HasSubstr("multiples of 8 (nearest: 16)"));
  EXPECT_EQ(refusal({{"history", "grow"}, {"cells", "16"}, {"layers", "4"}}), "accepted");
  // Unlike slopes have mesh lines of their own on either side.
  EXPECT_EQ(refusal({{"history", "grow"}, {"cells", "12"}, {"layers", "4"}, {"right_deg", "21"}}),
            "accepted");
  EXPECT_THAT(refusal({{"history", "grow"}, {"cells", "2"}, {"layers", "40"}}),
              HasSubstr("multiples of 80 (nearest: 80)"));
}

// Heaps with two slopes that grow along them: they find rest, carry their weight, and the mirrored
// heap has the mirrored stress.
TEST(FePlastic, UnlikeSlopesGrow) {
  for (const double dilation : {10., 28.}) {
    WedgeProblem p = heap(12, 28);
    p.right_deg = 21;
    p.dilation_deg = dilation;
    p.history = WedgeHistory::grow;
    p.layers = 6;
    const WedgeResult one = solve_wedge(p);
    std::swap(p.left_deg, p.right_deg);
    const WedgeResult other = solve_wedge(p);
    EXPECT_NEAR(one.base_force[1] / one.weight, 1, 1e-5) << dilation;
    for (const double x : {-1.1, -0.3, 0.4, 1.9}) {
      const plasticity::Vector4 a = one.stress_at({x, -0.97}), b = other.stress_at({-x, -0.97});
      EXPECT_LT((a - plasticity::Vector4(b[0], b[1], b[2], -b[3])).norm(), 2e-2 * a.norm())
          << dilation << " " << x;
    }
    // Every corner is found in a triangle that has it, on the axis too.
    for (std::size_t v = 0; v < one.mesh.vertices.size(); ++v) {
      const int t = one.triangle_at(one.mesh.vertices[v]);
      ASSERT_GE(t, 0) << one.mesh.vertices[v].transpose();
      EXPECT_LT((one.stress_at(one.mesh.vertices[v]) -
                 one.stress.row(static_cast<Eigen::Index>(v)).transpose())
                    .norm(),
                1e-9);
    }
    EXPECT_EQ(one.triangle_at({0.1, 0.1}), -1);
  }
}

// The units decide nothing.
TEST(FePlastic, TinyAndHugeHeapsAreTheSame) {
  WedgeProblem p = heap(8, 24);
  p.cohesion = 1e-2;
  const plasticity::Vector4 here = solve_wedge(p).stress_at({0.3, -0.7});
  for (const auto& [height, weight, young] : {std::tuple{1e-30, 1., 1e3},
                                              {1e30, 1., 1e3},
                                              {1., 1e40, 1e3},
                                              {1., 1e-40, 1e3},
                                              {1., 1., 1e14}}) {
    WedgeProblem other = p;
    other.height = height;
    other.rho_g = weight;
    other.young = young;
    const plasticity::Vector4 there =
        solve_wedge(other).stress_at({0.3 * height, -0.7 * height}) / (height * weight);
    EXPECT_LT((there - here).norm(), 1e-6) << height << " " << weight << " " << young;
  }
}

/// A heap whose stress is that of a closed form.
WedgeResult closed_heap(const std::string& branch, int cells) {
  WedgeResult out;
  out.problem = heap(cells, 28);
  out.problem.cohesion = 0;
  const double foot = 1 / std::tan(28 * grainfield::kDegree);
  out.mesh = fe::triangle_lattice({-foot, -1}, {foot, -1}, {0, 0}, cells);
  Points at(static_cast<Eigen::Index>(out.mesh.vertices.size()), 2);
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    // A hair inside: corners on the outline may be counted out.
    at.row(i) = Eigen::RowVector2d(0, -0.5) +
                (1 - 1e-9) * (out.mesh.vertices[static_cast<std::size_t>(i)].transpose() -
                              Eigen::RowVector2d(0, -0.5));
  }
  const Stresses s = make_model("cantelaube", {{"branch", branch}, {"phi_deg", "28"}})->stress(at);
  out.stress.resize(at.rows(), 4);
  out.stress << s.col(0), s.col(1), (s.col(0) + s.col(1)) / 2, s.col(2);
  for (std::size_t t = 0; t < out.mesh.triangles.size(); ++t)
    out.pieces.push_back({static_cast<int>(t)});
  return out;
}

// The line that the core's border is measured to be, on fields that have one.
TEST(FePlastic, CoreOfAClosedFormHasItsBorder) {
  for (const auto& [branch, beta] : {std::pair{"minus", 22.5}, {"zero", 38.56}, {"plus", 48.6}}) {
    for (const int cells : {48, 192}) {
      const WedgeCore core = wedge_core(closed_heap(branch, cells));
      std::printf("cantelaube %s, %d cells: beta_hat %.2f (%.2f) deg, misfit %.4f\n", branch, cells,
                  core.right_deg, beta, core.right_misfit);
      EXPECT_NEAR(core.left_deg, core.right_deg, 0.2) << branch;
      EXPECT_NEAR(core.share, 1, 1e-12);
      const double error = std::abs(core.right_deg - beta);
      EXPECT_LT(error, cells == 48 ? 2 : 0.5) << branch;
    }
  }
}

// Where nothing yields there is no flank, and no core with a border.
TEST(FePlastic, AnElasticHeapHasNoCore) {
  WedgeProblem p = heap(8, 28);
  p.dilation_deg = 28;
  for (const double cohesion : {0.1, 10.}) {
    p.cohesion = cohesion;
    const WedgeResult result = solve_wedge(p);
    for (const auto& point : result.points) EXPECT_EQ(point.regime, plasticity::Regime::elastic);
    const WedgeCore core = wedge_core(result);
    EXPECT_TRUE(std::isnan(core.left_deg) && std::isnan(core.right_deg)) << core.left_deg;
    EXPECT_EQ(core.share, 0);
    EXPECT_LT(core.axis_mobilized, 1);
    for (const auto& v : result.mesh.vertices) EXPECT_LT(result.mobilized_at(v), 1);
  }
}

}  // namespace
