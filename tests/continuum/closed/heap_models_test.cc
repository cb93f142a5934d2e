// What every closed-form heap owes: equilibrium, continuity, free slopes, its weight on the base.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "continuum/model.h"
#include "tests/continuum/heap_scene.h"

using namespace grainfield::continuum;
using namespace grainfield::continuum::testing;
using grainfield::dem::Random;
using ::testing::HasSubstr;

namespace {

// Rounding of a handful of operations on numbers of size rho g.
constexpr double kRounding = 1e-12;

std::string where(const Heap& heap, int k) {
  return heap.name + " " + std::to_string(k) +
         " phi = " + std::to_string(heap.field->phi() / kDegree);
}

// Largest coefficient: what rounding errors are relative to.
double size_of(const HeapField& field) {
  double size = field.rho_g();
  for (std::size_t k = 0; k < field.regions().size(); ++k) {
    const double theta = (field.regions()[k].from + field.regions()[k].to) / 2;
    size =
        std::max(size, field.gradient(k, std::sin(theta), -std::cos(theta)).cwiseAbs().maxCoeff());
  }
  return size;
}

// Composite Simpson over the base of unit depth, exact for linear fields.
double base_force(const HeapField& field, int intervals) {
  double sum = 0;
  for (std::size_t k = 0; k < field.regions().size(); ++k) {
    const double a = std::tan(field.regions()[k].from), b = std::tan(field.regions()[k].to);
    const double h = (b - a) / intervals;
    const auto pressure = [&](double x) {
      return -(field.gradient(k, x, -1) * Eigen::Vector2d(x, -1))[1];
    };
    for (int i = 0; i < intervals; ++i)
      sum += h / 6 *
             (pressure(a + i * h) + 4 * pressure(a + (i + 0.5) * h) + pressure(a + (i + 1) * h));
  }
  return sum;
}

double weight_above(const HeapField& field) {
  const double left = std::tan(field.rays().front()), right = std::tan(field.rays().back());
  return field.rho_g() * (right - left) / 2;
}

// From the principal stresses; infinite where their sum is no compression.
double principal_ratio(const Eigen::Vector3d& s, double phi) {
  Eigen::Matrix2d full;
  full << s[0], s[2], s[2], s[1];
  const Eigen::Vector2d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(full).eigenvalues();
  const double sum = principal[0] + principal[1];
  if (!(sum < 0)) return std::numeric_limits<double>::infinity();
  return (principal[0] - principal[1]) / sum / std::sin(phi);
}

// The largest of many directions, up to kNear of a region's width from the rays that bound it.
constexpr double kNear = 1e-6;
double sampled_ratio(const HeapField& field, int directions) {
  double largest = 0;
  for (const HeapRegion& region : field.regions()) {
    for (int i = 0; i <= directions; ++i) {
      const double share = std::clamp(static_cast<double>(i) / directions, kNear, 1 - kNear);
      const double theta = region.from + (region.to - region.from) * share;
      largest = std::max(
          largest, principal_ratio(field.stress(std::sin(theta), -std::cos(theta)), field.phi()));
    }
  }
  return largest;
}

void expect_largest(const HeapField& field, const std::string& what) {
  const double sampled = sampled_ratio(field, 500), found = field.largest_mobilised();
  if (std::isinf(sampled)) {
    EXPECT_TRUE(std::isinf(found)) << what << " " << found;
    return;
  }
  // Between the outermost samples and the rays the ratio changes by its square at most.
  EXPECT_NEAR(found / sampled, 1, 1e-4 * std::max(1., sampled)) << what;
}

}  // namespace

TEST(Heaps, LargestMobilisedFrictionIsThatOfManyDirections) {
  Random random(10);
  int beyond = 0, tension = 0;
  for (int k = 0; k < 2000; ++k) {
    const Heap heap = random_heap(random);
    expect_largest(*heap.field, where(heap, k));
    const double largest = heap.field->largest_mobilised();
    beyond += largest > 1 + 1e-9;
    tension += std::isinf(largest);
  }
  std::printf("of 2000 heaps %d beyond the limit of friction, %d in tension somewhere\n", beyond,
              tension);
  EXPECT_GT(beyond, 100);
  EXPECT_GT(tension, 20);
  for (const double degrees : {15., 28., 40.})
    expect_largest(IfeField(degrees * kDegree, 2), "ife");
}

// A core beyond the limit on a ray that bounds regions only: on the axis, on its border.
TEST(Heaps, TheLimitIsExceededOnTheRaysThatBoundRegions) {
  const double phi = 28 * kDegree;
  const auto ratio = [&](double beta_hat_deg) {
    return cantelaube_field(phi, beta_hat_deg * kDegree, 1).largest_mobilised();
  };
  for (const double beta_hat : {22.4, 22., 48.7}) {
    const SectorField field = cantelaube_field(phi, beta_hat * kDegree, 1);
    EXPECT_NEAR(ratio(beta_hat), principal_ratio(field.stress(0, -1), phi), 1e-12) << beta_hat;
  }
  EXPECT_NEAR(ratio(22.4), 1.0193, 5e-5);
  EXPECT_NEAR(ratio(22.0), 1.103, 5e-4);
  EXPECT_NEAR(ratio(48.7), 1.0037, 5e-5);
  // Between the branches minus and plus the core is inside the limit, beyond them it is not.
  EXPECT_NEAR(ratio(22.5), 1, 1e-12);
  EXPECT_NEAR(ratio(48.6), 1, 1e-12);
}

TEST(Heaps, AreInEquilibrium) {
  Random random(1);
  for (int k = 0; k < 5000; ++k) {
    const Heap heap = random_heap(random);
    for (std::size_t r = 0; r < heap.field->regions().size(); ++r) {
      const auto p = random_point(random, *heap.field, r);
      const auto residual = heap.field->equilibrium_residual(r, p.x(), p.y());
      EXPECT_LT(residual.cwiseAbs().maxCoeff(), kRounding * size_of(*heap.field)) << where(heap, k);
    }
  }
}

TEST(Heaps, AreContinuousAcrossEveryRay) {
  Random random(2);
  for (int k = 0; k < 5000; ++k) {
    const Heap heap = random_heap(random);
    // A narrow core is the difference of steep fields: its rays are as exact as their ratio allows.
    const double size = size_of(*heap.field),
                 slack = size * std::max(1., size / heap.field->rho_g());
    for (std::size_t ray = 1; ray < heap.field->regions().size(); ++ray)
      EXPECT_LT(heap.field->jump(ray), kRounding * slack) << where(heap, k);
  }
}

TEST(Heaps, CarryNothingOnTheirSlopes) {
  Random random(3);
  for (int k = 0; k < 5000; ++k) {
    const Heap heap = random_heap(random);
    for (const double theta : {heap.field->rays().front(), heap.field->rays().back()}) {
      const Eigen::Vector3d s = heap.field->stress(std::sin(theta), -std::cos(theta));
      EXPECT_LT(s.cwiseAbs().maxCoeff(), kRounding * size_of(*heap.field)) << where(heap, k);
    }
  }
}

TEST(Heaps, PressTheirWeightOnTheBase) {
  Random random(4);
  for (int k = 0; k < 5000; ++k) {
    const Heap heap = random_heap(random);
    const double weight = weight_above(*heap.field);
    EXPECT_NEAR(base_force(*heap.field, 1) / weight, 1,
                kRounding * size_of(*heap.field) / heap.field->rho_g())
        << where(heap, k);
  }
}

TEST(Heaps, RegionsAreInOrderAndTileTheHeap) {
  Random random(5);
  for (int k = 0; k < 5000; ++k) {
    const Heap heap = random_heap(random);
    const auto& regions = heap.field->regions();
    for (std::size_t r = 0; r < regions.size(); ++r) {
      EXPECT_LT(regions[r].from, regions[r].to) << where(heap, k);
      if (r > 0) {
        EXPECT_EQ(regions[r].from, regions[r - 1].to);
      }
      const double middle = (regions[r].from + regions[r].to) / 2;
      EXPECT_EQ(heap.field->region_of(std::sin(middle), -std::cos(middle)), static_cast<int>(r));
    }
  }
}

TEST(Heaps, MirrorSymmetricOnesAre) {
  Random random(6);
  for (int k = 0; k < 5000; ++k) {
    const Heap heap = random_heap(random);
    if (!heap.symmetric) continue;
    const auto p = random_point(random, *heap.field, heap.field->regions().size() - 1);
    const Eigen::Vector3d right = heap.field->stress(p.x(), p.y()),
                          left = heap.field->stress(-p.x(), p.y());
    const double slack = kRounding * size_of(*heap.field) * p.norm();
    EXPECT_NEAR(left[0], right[0], slack);
    EXPECT_NEAR(left[1], right[1], slack);
    EXPECT_NEAR(left[2], -right[2], slack);
  }
}

// The gradients are those of the stresses: Richardson's differences along both axes.
TEST(Heaps, GradientsAreThoseOfTheStress) {
  Random random(7);
  std::vector<Heap> heaps;
  for (int k = 0; k < 300; ++k) heaps.push_back(random_heap(random));
  for (const double degrees : {15., 28., 40.})
    heaps.push_back(heap("ife", IfeField(degrees * kDegree, 2)));
  for (const Heap& heap : heaps) {
    for (std::size_t r = 0; r < heap.field->regions().size(); ++r) {
      const HeapRegion& region = heap.field->regions()[r];
      const double theta = region.from + (region.to - region.from) * random.uniform(0.1, 0.9);
      const double x = std::sin(theta), y = -std::cos(theta);
      const double h = 1e-2 * std::min(0.5, region.to - region.from);
      const LinearStress exact = heap.field->gradient(r, x, y);
      for (int axis = 0; axis < 2; ++axis) {
        const auto difference = [&](double step) -> Eigen::Vector3d {
          const double dx = axis == 0 ? step : 0, dy = axis == 1 ? step : 0;
          return (heap.field->stress(x + dx, y + dy) - heap.field->stress(x - dx, y - dy)) /
                 (2 * step);
        };
        const Eigen::Vector3d found = (4 * difference(h / 2) - difference(h)) / 3;
        EXPECT_LT((found - exact.col(axis)).cwiseAbs().maxCoeff(), 2e-7 * size_of(*heap.field))
            << heap.name;
      }
    }
  }
}

TEST(Heaps, NotANumberOutside) {
  Random random(8);
  for (int k = 0; k < 2000; ++k) {
    const Heap heap = random_heap(random);
    const double left = heap.field->rays().front(), right = heap.field->rays().back();
    for (const double theta : {left - 1e-6, right + 1e-6, 3.0, -2.0}) {
      EXPECT_TRUE(heap.field->stress(std::sin(theta), -std::cos(theta)).array().isNaN().all());
      EXPECT_EQ(heap.field->region_of(std::sin(theta), -std::cos(theta)), -1);
    }
    EXPECT_TRUE(heap.field->stress(std::nan(""), -1).hasNaN());
    EXPECT_EQ(heap.field->stress(0, 0).norm(), 0);
  }
}

// Smooth fields from polynomials: the balance holds to the collocation's accuracy.
TEST(Ife, BalancesYieldsEverywhereAndCarriesItsWeight) {
  Random random(9);
  for (double degrees = 15; degrees <= 60; degrees += 2.5) {
    const IfeField field(degrees * kDegree, 3);
    EXPECT_NEAR(base_force(field, 400) / weight_above(field), 1, 1e-7) << degrees;
    for (int k = 0; k < 200; ++k) {
      const std::size_t r = k % 2;
      const auto p = random_point(random, field, r);
      EXPECT_LT(field.equilibrium_residual(r, p.x(), p.y()).norm(), 3e-7) << degrees;
      const Eigen::Vector3d s = field.stress(p.x(), p.y());
      EXPECT_NEAR(mobilised_sine(s) / std::sin(field.phi()), 1, 1e-9) << degrees;
      EXPECT_GE(std::fabs(s[1]), std::fabs(s[0]));  // the active state
    }
    EXPECT_NEAR(field.stress(0, -1)[2], 0, 1e-13);
    EXPECT_LT(field.jump(1), 1e-12);
    // A peak on the axis.
    EXPECT_LT(field.stress(0, -1)[1], field.stress(0.1, -1)[1]);
  }
}

// An independent way to it: Runge and Kutta's method from the axis, with the pressure found there,
// follows the field; with more pressure it meets a characteristic before the slope, with less the
// yield condition loses its root.
TEST(Ife, AgreesWithShootingFromTheAxis) {
  const double phi = 28 * kDegree, s = std::sin(phi), c = std::cos(phi), cot = c / s;
  enum class Fate { none, characteristic, root };
  const auto shoot = [&](double start, double until, double& v, double& w) {
    Fate fate = Fate::none;
    const auto slope = [&](double xi, double at_v, double at_w) -> Eigen::Vector2d {
      const double u = at_w / at_v, square = s * s - u * u * c * c;
      if (!(square > 0)) {
        if (fate == Fate::none) fate = Fate::root;
        return {0, 0};
      }
      const double root = std::sqrt(square), k = (1 + s * s - 2 * root) / (c * c), m = 2 * u / root;
      const double divisor = k - u * m + (m - xi) * xi;
      if (divisor <= 0 && fate == Fate::none) fate = Fate::characteristic;
      const double dv = (-at_w - (m - xi) * (1 - at_v)) / divisor;
      return {dv, 1 - at_v + xi * dv};
    };
    v = start;
    w = 0;
    const int steps = 4000;
    const double h = until / steps;
    for (int i = 0; i < steps && fate == Fate::none; ++i) {
      const double xi = i * h;
      const auto a = slope(xi, v, w), b = slope(xi + h / 2, v + h / 2 * a[0], w + h / 2 * a[1]),
                 d = slope(xi + h / 2, v + h / 2 * b[0], w + h / 2 * b[1]),
                 e = slope(xi + h, v + h * d[0], w + h * d[1]);
      v += h / 6 * (a[0] + 2 * b[0] + 2 * d[0] + e[0]);
      w += h / 6 * (a[1] + 2 * b[1] + 2 * d[1] + e[1]);
    }
    return fate;
  };
  const IfeField field(phi, 1);
  const double centre = -field.stress(0, -1)[1];
  double v = 0, w = 0;
  for (const double share : {0.3, 0.6, 0.8, 0.9}) {
    EXPECT_EQ(shoot(centre, share * cot, v, w), Fate::none);
    EXPECT_NEAR(-field.stress(share * cot, -1)[1], v, 1e-6);
    EXPECT_NEAR(field.stress(share * cot, -1)[2], w, 1e-6);
  }
  // A little more pressure on the axis or a little less, and there is no way to the slope.
  EXPECT_EQ(shoot(1.001 * centre, 0.99 * cot, v, w), Fate::characteristic);
  EXPECT_EQ(shoot(0.995 * centre, 0.99 * cot, v, w), Fate::root);
}

// Figures that say how well a field keeps what it promises: equilibrium, its closure, yield.
TEST(Heaps, FiguresOfTheResiduals) {
  for (const char* phi : {"16", "28", "40"}) {
    for (const char* name : {"cantelaube", "cantelaube_asymmetric", "osl", "fpa", "bcc", "ife"}) {
      const auto f = make_model(name, {{"phi_deg", phi}, {"rho_g", "7"}})->figures();
      const bool wedge = std::string(name).rfind("cantelaube", 0) == 0, ife = name[0] == 'i';
      EXPECT_LT(f.at("equilibrium_residual"), ife ? 1e-6 : 1e-13) << name;
      EXPECT_EQ(f.count("yield_residual"), wedge || ife) << name;
      EXPECT_EQ(f.count("closure_residual"), !wedge && !ife) << name;
      if (wedge || ife) {
        EXPECT_LT(f.at("yield_residual"), 1e-9) << name;
      } else {
        EXPECT_LT(f.at("closure_residual"), 1e-13) << name;
      }
    }
  }
  for (const char* branch : {"minus", "plus"})
    EXPECT_LT(make_model("cantelaube_asymmetric",
                         {{"branch", branch}, {"left_deg", "25"}, {"yield_ray_deg", "2"}})
                  ->figures()
                  .at("yield_residual"),
              1e-11);
}

// They are not 0 by construction.
TEST(Heaps, ResidualsOfFieldsThatAreWrong) {
  const double phi = 28 * kDegree;
  SectorField right = cantelaube_field(phi, core_angle(phi, CoreBranch::zero), 2);
  std::vector<LinearStress> fields;
  for (std::size_t k = 0; k < right.regions().size(); ++k) fields.push_back(right.linear(k));
  fields[2](2, 0) += 0.2;  // d sigma_xy / dx
  fields[3] *= 0.9;
  const SectorField wrong(right.regions(), fields, 2, phi);
  EXPECT_NEAR(right.largest_imbalance(), 0, 1e-14);
  EXPECT_NEAR(wrong.largest_imbalance(), 0.1, 1e-12);
  EXPECT_NEAR(right.off_yield({0, 3}, {}), 0, 1e-12);
  EXPECT_NEAR(wrong.off_yield({0, 3}, {}), 0, 1e-12);
  fields[3](1, 0) *= 1.1;
  EXPECT_GT(SectorField(right.regions(), fields, 2, phi).off_yield({0, 3}, {}), 0.01);
  // The axis of a plateau does not yield, that of a dip does.
  EXPECT_GT(right.off_yield({0, 3}, {2}), 0.05);
  EXPECT_LT(cantelaube_field(phi, core_angle(phi, CoreBranch::minus), 2).off_yield({}, {2}), 1e-12);
}

// Against differences of the stress: pressure alone does not hold a slope.
TEST(Heaps, HydrostaticPressureIsNoEquilibriumUnderASlope) {
  for (const auto& [left, right] : {std::pair{0., 0.}, {20., 30.}, {35., 10.}}) {
    const auto model = make_model(
        "hydrostatic",
        {{"rho_g", "5"}, {"left_deg", std::to_string(left)}, {"right_deg", std::to_string(right)}});
    double largest = 0;
    const double d = 1e-3;
    for (const double x : {-0.5, 0.5}) {
      const Stresses s = model->stress((Points(4, 2) << x - d, -2, x + d, -2,  //
                                        x, -2 - d, x, -2 + d)
                                           .finished());
      const double along = (s(1, 0) - s(0, 0) + s(3, 2) - s(2, 2)) / (2 * d),
                   up = (s(1, 2) - s(0, 2) + s(3, 1) - s(2, 1)) / (2 * d) - 5;
      largest = std::max(largest, std::hypot(along, up) / 5);
    }
    EXPECT_NEAR(model->figures().at("equilibrium_residual"), largest, 1e-9) << left << right;
    EXPECT_NEAR(largest, std::tan(std::max(left, right) * kDegree), 1e-9);
  }
}

TEST(Heaps, TheRegistryFillsAndReports) {
  for (const char* name : {"cantelaube", "cantelaube_asymmetric", "osl", "fpa", "bcc", "ife"}) {
    const auto model = make_model(name, {{"phi_deg", "30"}, {"rho_g", "2"}});
    const auto* heap = dynamic_cast<const HeapModel*>(model.get());
    ASSERT_NE(heap, nullptr) << name;
    EXPECT_EQ(heap->field().rho_g(), 2);
    EXPECT_EQ(heap->field().phi(), 30 * kDegree);
    const auto figures = model->figures();
    EXPECT_EQ(figures.count("mobilised_sine_ratio"), 1U);
    for (std::size_t k = 1; k < heap->field().regions().size(); ++k)
      EXPECT_EQ(figures.count("ray_" + std::to_string(k) + "_deg"), 1U) << name;
    // None of them violates the limit of friction.
    EXPECT_LE(figures.at("mobilised_sine_ratio"), 1 + 1e-9) << name;
    Points points(3, 2);
    points << 0, -1, 1.7, -1, 1.8, -1;
    const Stresses s = model->stress(points);
    EXPECT_FALSE(s.topRows(2).hasNaN());
    EXPECT_TRUE(s.row(2).array().isNaN().all()) << name;
  }
}
