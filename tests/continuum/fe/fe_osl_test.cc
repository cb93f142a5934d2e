// The discontinuous Galerkin solver of oriented stress linearity against manufactured and exact
// solutions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "continuum/fe/osl_solver.h"
#include "continuum/model.h"
#include "tests/continuum/osl_exact.h"

using namespace grainfield::continuum;
using fe::OslSolver;
using osl::State;

namespace {

/// Of the observed order: leading-order convergence is reached, but not exactly.
constexpr double kOrder = 0.2;

osl::Problem constant(const osl::exact::Constants& k, std::function<double(double)> weight) {
  osl::Problem p;
  p.name = "fe_osl_wedge";
  p.weight = [weight](double, double y) { return weight(y); };
  p.eta = [k](double, double) { return k.eta; };
  p.mu = [k](double, double) { return k.mu; };
  return p;
}

double total_error(OslSolver& solver, const osl::StateField& exact) {
  solver.solve();
  EXPECT_LT(solver.figures().at("force_balance"), 1e-12);
  return solver.errors(exact).norm();
}

/// syy = 2 + sin(x + 2 y), sxy = cos(2 x - y) with eta = 0.8 + 0.2 sin(x + y), mu = 0.3 cos(x) + y
/// / 4: the forces that belong to it, by hand.
osl::Problem manufactured(bool mirrored) {
  osl::Problem p;
  p.name = "manufactured";
  p.mirrored = mirrored;
  p.eta = [](double x, double y) { return 0.8 + 0.2 * std::sin(x + y); };
  p.mu = [](double x, double y) { return 0.3 * std::cos(x) + y / 4; };
  p.weight = [](double x, double y) { return 2 * std::cos(x + 2 * y) - 2 * std::sin(2 * x - y); };
  p.side_force = [](double x, double y) {
    const double syy = 2 + std::sin(x + 2 * y), sxy = std::cos(2 * x - y);
    return std::sin(2 * x - y) + 0.2 * std::cos(x + y) * syy +
           (0.8 + 0.2 * std::sin(x + y)) * std::cos(x + 2 * y) - 0.3 * std::sin(x) * sxy -
           (0.3 * std::cos(x) + y / 4) * 2 * std::sin(2 * x - y);
  };
  p.surface = p.beyond = [](double x, double y) {
    return State(2 + std::sin(x + 2 * y), std::cos(2 * x - y));
  };
  return p;
}

}  // namespace

TEST(FeOsl, OrderOfAManufacturedSolutionInALayer) {
  const osl::Problem p = manufactured(false);
  for (int order = 0; order <= 3; ++order) {
    double coarse = 0;
    for (int n = order == 0 ? 16 : 4; n <= (order == 0 ? 64 : 16); n *= 2) {
      OslSolver solver(p, osl::box_mesh(0.7, 1, n, 2 * n), order);
      const double fine = total_error(solver, p.surface);
      std::printf("layer p %d n %d error %.3g order %.3f\n", order, n, fine,
                  std::log2(coarse / fine));
      if (coarse > 0) {
        EXPECT_NEAR(std::log2(coarse / fine), order + 1, kOrder) << "order " << order << " n " << n;
      }
      coarse = fine;
    }
  }
}

TEST(FeOsl, OrderOfAManufacturedSolutionInAHeap) {
  const osl::Problem p = manufactured(false);
  for (int order = 0; order <= 3; ++order) {
    double coarse = 0;
    for (int n = order == 0 ? 16 : 4; n <= (order == 0 ? 64 : 16); n *= 2) {
      OslSolver solver(p, osl::heap_mesh(2, 0.7, n, 2 * n, 0), order);
      const double fine = total_error(solver, p.surface);
      std::printf("heap p %d n %d error %.3g order %.3f\n", order, n, fine,
                  std::log2(coarse / fine));
      if (coarse > 0) {
        EXPECT_NEAR(std::log2(coarse / fine), order + 1, kOrder) << "order " << order << " n " << n;
      }
      coarse = fine;
    }
  }
}

TEST(FeOsl, ClosedFormOfTheHeapIsMetToRoundOffOnAnAlignedMesh) {
  for (const double phi_deg : {15., 28., 40.}) {
    const double tangent = std::tan(phi_deg * std::numbers::pi / 180), c = 1 / tangent;
    for (const double mu : {0., -0.31, -2 * tangent, 0.2}) {
      const osl::exact::Constants k{(1 - mu * tangent) / (1 + 2 * tangent * tangent), mu};
      for (int order = 1; order <= 3; ++order) {
        OslSolver solver(constant(k, [](double) { return 1; }), osl::heap_mesh(c, 1, 4, 5, k.c1()),
                         order);
        const double error = total_error(
            solver, [&](double x, double y) { return osl::exact::closed_form(k, c, x, y); });
        EXPECT_LT(error, 1e-12) << "phi " << phi_deg << " mu " << mu << " order " << order;
        EXPECT_NEAR(solver.figures().at("base_force"), c, 1e-13 * c);
      }
    }
  }
}

TEST(FeOsl, OrderOnTheHeapWithAndWithoutAlignment) {
  // A weight that varies with the depth: the exact solution is no longer linear between the kinks.
  const osl::exact::Constants k;
  const double c = 1.88;
  const auto p = constant(k, [](double y) { return 1 + std::cos(3 * y); });
  const osl::StateField exact = [&](double x, double y) {
    return osl::exact::heap(
        k, c, [](double d) { return d + std::sin(3 * d) / 3; }, x, y);
  };
  for (const bool aligned : {true, false}) {
    for (int order = 0; order <= 3; ++order) {
      const int first = order == 0 ? 16 : 8;
      double coarse = 0, coarsest = 0;
      for (int n = first; n <= 4 * first; n *= 2) {
        OslSolver solver(p, osl::heap_mesh(c, 1, n, 2 * n, aligned ? k.c1() : 0), order);
        const double fine = total_error(solver, exact);
        std::printf("%s p %d n %d error %.3g order %.3f\n", aligned ? "aligned" : "rays", order, n,
                    fine, std::log2(coarse / fine));
        if (coarse > 0 && aligned) {
          EXPECT_NEAR(std::log2(coarse / fine), order + 1, kOrder)
              << "order " << order << " n " << n;
        }
        coarse = fine;
        if (n == first) coarsest = fine;
      }
      if (aligned) continue;
      // The kink on the characteristic from the apex: h^(3/2) at best, whatever the degree, and no
      // less than h^(1/2) over two halvings, though one alone may bring nothing.
      const double both = std::log2(coarsest / coarse) / 2;
      std::printf("rays p %d both halvings: order %.3f\n", order, both);
      if (order == 0) {
        EXPECT_NEAR(both, 1, kOrder);
      } else {
        EXPECT_GT(both, 0.5) << "order " << order;
        EXPECT_LT(both, 1.6) << "order " << order;
      }
    }
  }
}

TEST(FeOsl, SlopesThatAreNotBordersOfTheMeshCostAnOrder) {
  // Rectangles, weightless beyond the slopes: the weight jumps inside of cells.
  const osl::exact::Constants k;
  const double c = 1.88;
  auto p = constant(k, [](double) { return 1; });
  p.weight = [c](double x, double y) { return std::abs(x) < c * y ? 1 : 0; };
  const osl::StateField exact = [&](double x, double y) -> State {
    return std::abs(x) < c * y ? osl::exact::closed_form(k, c, x, y) : State(0, 0);
  };
  for (int order = 0; order <= 2; ++order) {
    double coarse = 0, coarsest = 0;
    for (int n = 8; n <= 32; n *= 2) {
      OslSolver solver(p, osl::box_mesh(c, 1, n, 2 * n), order);
      const double fine = total_error(solver, exact);
      std::printf("box p %d n %d error %.3g order %.3f\n", order, n, fine,
                  std::log2(coarse / fine));
      coarse = fine;
      if (n == 8) coarsest = fine;
    }
    EXPECT_NEAR(std::log2(coarsest / coarse) / 2, order == 0 ? 1 : 1.3, 0.4) << "order " << order;
  }
}

TEST(FeOsl, RefusesOrdersAndMeshes) {
  const auto p = constant({}, [](double) { return 1; });
  const auto refusal = [&](const osl::StripMesh& mesh, int order) -> std::string {
    try {
      OslSolver(p, mesh, order).solve();
    } catch (const BadParameter& e) {
      return e.what();
    }
    return "accepted";
  };
  using testing::HasSubstr;
  const auto heap = osl::heap_mesh(1.88, 1, 4, 4, 0);
  EXPECT_THAT(refusal(heap, -1), HasSubstr("order = -1 is out of range; allowed: 0 to 8"));
  EXPECT_THAT(refusal(heap, 9), HasSubstr("order = 9 is out of range; allowed: 0 to 8"));
  EXPECT_THAT(
      refusal(osl::heap_mesh(0.7, 1, 4, 4, 0), 1),
      HasSubstr(
          "a characteristic outside the heap, dx/dy = 0.72137; allowed: below cot(phi) = 0.7"));
  EXPECT_THAT(refusal(osl::StripMesh{{-1, 0, 0.5}, {0, 1}, 2, {}}, 1),
              HasSubstr("does not fit the heap, its rays end at -1 and 0.5 of the slopes"));
}
