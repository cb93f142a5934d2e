// The line model of Liffman's piles: his printed formulas, equilibrium, limits, tents, the lattice.
#include "continuum/closed/liffman.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "continuum/model.h"

using namespace grainfield::continuum;
using testing::HasSubstr;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRoot3 = std::numbers::sqrt3;

// Every test draws its own numbers; the generator's bits are the same everywhere.
double uniform(std::mt19937_64& bits, double from, double to) {
  return from + (to - from) * static_cast<double>(bits() >> 11) * 0x1p-53;
}

HeapProfile triangle(double alpha, double width) { return {alpha, alpha, width, 0}; }

HeapProfile random_heap(std::mt19937_64& bits) {
  const double a = uniform(bits, 0.02, kPi / 3), b = uniform(bits, 0.02, kPi / 3);
  const double width = std::exp(uniform(bits, -3, 3));
  return {a, bits() % 2 == 0 ? a : b, width, width * uniform(bits, 0, 0.5)};
}

bool inside(const HeapProfile& heap, double x, double y) {
  return y > -heap.height() && y < heap.surface(x);
}

// Liffman 54-59 as printed, x from the left corner.
BaseForce printed(double a, double chi_g, double width, double x) {
  const double xc = width / 2 * std::tan(a) * (1 / std::tan(a) - 1 / kRoot3);
  const double plus = std::sin(2 * kPi / 3 - a), minus = std::sin(kPi / 3 - a);
  if (x > xc && x < width - xc) {
    return {chi_g * width * std::sin(a) / (2 * plus),
            chi_g * (x - width / 2) * std::sin(a) / (kRoot3 * plus)};
  }
  const double near = std::min(x, width - x), side = x < width / 2 ? -1 : 1;
  return {kRoot3 * near * chi_g * std::sin(a) * std::cos(a) / (2 * plus * minus),
          side * near * chi_g * std::sin(a) * std::sin(a) / (2 * kRoot3 * plus * minus)};
}

Stresses at(const Settings& settings, const Points& points) {
  return make_model("liffman", settings)->stress(points);
}

Settings settings_of(const HeapProfile& heap, double chi_g, double spacing) {
  char buffer[64];
  const auto exact = [&buffer](double v) {
    std::snprintf(buffer, sizeof buffer, "%.17g", v);
    return std::string(buffer);
  };
  return {{"alpha_deg", exact(std::min(60.0, heap.alpha * 180 / kPi))},
          {"top_alpha_deg", exact(std::min(60.0, heap.top_alpha * 180 / kPi))},
          {"bend", exact(heap.bend / heap.width)},
          {"width", exact(heap.width)},
          {"chi_g", exact(chi_g)},
          {"spacing", exact(spacing)}};
}

}  // namespace

TEST(Liffman, BaseForcesArePrintedFormulas) {
  std::mt19937_64 bits(1);
  for (int k = 0; k < 20000; ++k) {
    const double a = uniform(bits, 0.01, kPi / 3 - 0.001), width = std::exp(uniform(bits, -3, 3));
    const double chi_g = std::exp(uniform(bits, -3, 3)), x = uniform(bits, 0, width);
    const HeapProfile heap = triangle(a, width);
    const BaseForce found = line_force(line_lengths(heap, x - width / 2, -heap.height()), chi_g);
    const BaseForce expected = printed(a, chi_g, width, x);
    const double scale = 1e-11 * chi_g * width / (kPi / 3 - a);
    EXPECT_NEAR(found.normal, expected.normal, scale) << a << " " << width << " " << x;
    EXPECT_NEAR(found.horizontal, expected.horizontal, scale) << a << " " << width << " " << x;
  }
}

// The base carries the whole heap, with as much push to the left as to the right. N and H are
// linear between the kinks at x_c and width - x_c, so the trapezoidal rule with them is exact.
TEST(Liffman, BaseCarriesTheWeight) {
  std::mt19937_64 bits(2);
  for (int k = 0; k < 2000; ++k) {
    const double a = uniform(bits, 0.01, kPi / 3), width = std::exp(uniform(bits, -3, 3));
    const double chi_g = std::exp(uniform(bits, -3, 3)), spacing = std::exp(uniform(bits, -3, 0));
    const HeapProfile heap = triangle(a, width);
    const double h = heap.height(), kink = width / 2 - h / kRoot3;
    Points p(4, 2);
    p << -width / 2, -h, -width / 2 + kink, -h, width / 2 - kink, -h, width / 2, -h;
    const Stresses s = at(settings_of(heap, chi_g, spacing), p);
    double normal = 0, horizontal = 0;
    for (int i = 0; i < 3; ++i) {
      const double dx = p(i + 1, 0) - p(i, 0);
      normal -= 0.5 * dx * (s(i, 1) + s(i + 1, 1));
      horizontal += 0.5 * dx * (s(i, 2) + s(i + 1, 2));
    }
    const double weight = 2 * chi_g / (kRoot3 * spacing) * width * h / 2;
    EXPECT_NEAR(normal / weight, 1, 2e-6) << a;  // corners are met to the outline's tolerance
    EXPECT_NEAR(horizontal / weight, 0, 2e-6) << a;
  }
}

// div sigma = (0, rho g) everywhere inside, tents included: central differences of a field that is
// linear between kinks are exact where no kink is near.
TEST(Liffman, StressIsInEquilibriumInside) {
  std::mt19937_64 bits(3);
  int checked = 0;
  for (int k = 0; k < 4000; ++k) {
    const HeapProfile heap = random_heap(bits);
    const double h = heap.height(), step = 1e-4 * h;
    const double y = -h * uniform(bits, 0.01, 0.99);
    const double x = heap.width * uniform(bits, -0.5, 0.5);
    Points p(5, 2);
    p << x, y, x - step, y, x + step, y, x, y - step, x, y + step;
    bool all = true;
    for (int i = 0; i < 5; ++i) all = all && inside(heap, p(i, 0), p(i, 1));
    if (!all) continue;
    const double spacing = 0.1, chi_g = 3;
    const Stresses s = at(settings_of(heap, chi_g, spacing), p);
    // A kink between the points shows as curvature.
    const double curvature =
        (s.row(1) + s.row(2) - 2 * s.row(0)).norm() + (s.row(3) + s.row(4) - 2 * s.row(0)).norm();
    const double unit = 2 * chi_g / (kRoot3 * spacing);
    if (curvature > 1e-9 * unit * step) continue;
    ++checked;
    const double fx = (s(2, 0) - s(1, 0) + s(4, 2) - s(3, 2)) / (2 * step);
    const double fy = (s(2, 2) - s(1, 2) + s(4, 1) - s(3, 1)) / (2 * step);
    EXPECT_NEAR(fx / unit, 0, 1e-7) << k;
    EXPECT_NEAR(fy / unit, 1, 1e-7) << k;
  }
  EXPECT_GT(checked, 1000);
}

TEST(Liffman, MirrorSymmetricAndNoTension) {
  std::mt19937_64 bits(4);
  for (int k = 0; k < 5000; ++k) {
    const HeapProfile heap = random_heap(bits);
    Points p(2, 2);
    p(0, 0) = heap.width * uniform(bits, 0, 0.5);
    p(0, 1) = p(1, 1) = -heap.height() * uniform(bits, 0, 1);
    p(1, 0) = -p(0, 0);
    const Stresses s = at(settings_of(heap, 1, 1), p);
    EXPECT_EQ(std::isnan(s(0, 0)), std::isnan(s(1, 0)));
    if (std::isnan(s(0, 0))) continue;
    EXPECT_EQ(s(0, 0), s(1, 0));
    EXPECT_EQ(s(0, 1), s(1, 1));
    EXPECT_EQ(s(0, 2), -s(1, 2));
    EXPECT_LE(s(0, 1), 0);
    EXPECT_GE(s(0, 0) * s(0, 1) - s(0, 2) * s(0, 2), -1e-12 * s(0, 1) * s(0, 1));
  }
}

TEST(Liffman, NotANumberOutside) {
  Points p(6, 2);
  const double h = 0.5 * std::tan(kPi / 6);
  p << 0, 0.01, 0, -1.01 * h, 0.51, -h, -0.3, -0.1, 0.49, -h, 0, -0.5 * h;
  const Stresses s = at({{"alpha_deg", "30"}, {"width", "1"}}, p);
  for (int i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isnan(s(i, c))) << i;
  }
  for (int i = 4; i < 6; ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_FALSE(std::isnan(s(i, c))) << i;
  }
  // The base typed with six digits, below the exact one.
  Points base(1, 2);
  base << 0.1, -0.288676;
  EXPECT_FALSE(std::isnan(at({{"alpha_deg", "30"}, {"width", "1"}}, base)(0, 1)));
}

// 60 degrees: N is the same everywhere, H runs straight from one corner to the other; slopes just
// below come arbitrarily near away from the corners.
TEST(Liffman, EquilateralIsTheLimit) {
  const double h = 0.5 * kRoot3;
  Points p(5, 2);
  p << -0.5, -h, -0.2, -h, 0, -h, 0.3, -h, 0.5, -h;
  const Stresses s = at({{"alpha_deg", "60"}, {"chi_g", "2"}, {"width", "1"}}, p);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(s(i, 1), -1, 2e-6);
    EXPECT_NEAR(s(i, 2), 2 * p(i, 0) / kRoot3, 2e-6);
  }
  double previous = 1;
  for (const char* alpha : {"59", "59.9", "59.99"}) {
    const double t = 0.5 * std::tan(std::atof(alpha) * kPi / 180);
    p.col(1).setConstant(-t);
    const Stresses near = at({{"alpha_deg", alpha}, {"chi_g", "2"}, {"width", "1"}}, p);
    const double away = (near.middleRows(1, 3) - s.middleRows(1, 3)).cwiseAbs().maxCoeff();
    EXPECT_LT(away, previous / 5);
    previous = away;
  }
}

// A steeper top (Liffman fig. 19: 30 below, 45 degrees above, bend at 0.38 B) lowers N in the
// middle; a flatter top does not.
TEST(Liffman, TentsWithASteeperTopDip) {
  const HeapProfile steep{kPi / 6, kPi / 4, 1, 0.38}, flat{kPi / 4, kPi / 6, 1, 0.38};
  const auto normal = [](const HeapProfile& heap, double x) {
    return line_force(line_lengths(heap, x, -heap.height()), 1).normal;
  };
  double largest = 0, largest_flat = 0;
  for (int i = -100; i <= 100; ++i) {
    largest = std::max(largest, normal(steep, 0.005 * i));
    largest_flat = std::max(largest_flat, normal(flat, 0.005 * i));
  }
  EXPECT_LT(normal(steep, 0), 0.98 * largest);
  EXPECT_NEAR(normal(flat, 0), largest_flat, 1e-12);
}

TEST(Liffman, TentsWithEqualSlopesAreTriangles) {
  std::mt19937_64 bits(5);
  for (int k = 0; k < 2000; ++k) {
    HeapProfile heap = random_heap(bits);
    heap.top_alpha = heap.alpha;
    const double x = heap.width * uniform(bits, -0.5, 0.5);
    HeapProfile plain = triangle(heap.alpha, heap.width);
    EXPECT_NEAR(heap.height(), plain.height(), 1e-12 * plain.height());
    const double y = -plain.height();
    EXPECT_NEAR(line_lengths(heap, x, y).left, line_lengths(plain, x, y).left, 1e-9 * heap.width);
  }
}

TEST(Liffman, ClosePackedPileInClosedForm) {
  for (const int layers : {1, 2, 5, 45}) {
    const double weight = 3;
    std::vector<int> rows;
    for (int j = 0; j < layers; ++j) rows.push_back(layers - j);
    const auto forces = lattice_base_forces(rows, weight, 1 / kRoot3);
    double normal = 0, horizontal = 0;
    for (int i = 1; i <= layers; ++i) {
      const BaseForce f = equilateral_base_force(layers, i, weight);
      EXPECT_DOUBLE_EQ(f.normal, (layers + 1) * weight / 2);
      EXPECT_NEAR(f.horizontal, weight * (2 * i - layers - 1) / (2 * kRoot3), 1e-12);
      EXPECT_NEAR(forces[i - 1].normal, f.normal, 1e-12);
      EXPECT_NEAR(forces[i - 1].horizontal, f.horizontal, 1e-12);
      normal += f.normal;
      horizontal += f.horizontal;
    }
    EXPECT_NEAR(normal, weight * layers * (layers + 1) / 2, 1e-9);
    EXPECT_NEAR(horizontal, 0, 1e-9);
  }
}

// Lattice piles of any slope carry their weight, and with more grains go over into the lines.
TEST(Liffman, LatticeGoesOverIntoTheLines) {
  double previous = 1;
  for (const int base : {45, 180, 720}) {
    std::vector<int> rows;  // 30 degrees: three grains fewer in every row
    int grains = 0;
    for (int n = base; n >= 1; n -= 3) {
      rows.push_back(n);
      grains += n;
    }
    const auto forces = lattice_base_forces(rows, 1, 1 / kRoot3);
    const HeapProfile heap = triangle(kPi / 6, base);
    double total = 0, largest = 0, away = 0;
    for (int i = 0; i < base; ++i) {
      const BaseForce line =
          line_force(line_lengths(heap, i + 0.5 - 0.5 * base, -heap.height()), 1);
      total += forces[i].normal;
      largest = std::max(largest, line.normal);
      away = std::max({away, std::fabs(forces[i].normal - line.normal),
                       std::fabs(forces[i].horizontal - line.horizontal)});
    }
    EXPECT_NEAR(total, grains, 1e-9);
    EXPECT_LT(away / largest, previous / 2);
    previous = away / largest;
  }
  EXPECT_LT(previous, 0.01);
}

TEST(Liffman, RefusesWhatCannotBe) {
  EXPECT_THROW(equilateral_base_force(3, 4, 1), std::invalid_argument);
  EXPECT_THROW(lattice_base_forces({3, 3}, 1, 0.5), std::invalid_argument);
  EXPECT_THROW(lattice_base_forces({4, 2}, 1, 0.5), std::invalid_argument);
  EXPECT_THROW(lattice_base_forces({2, 0}, 1, 0.5), std::invalid_argument);
  try {
    make_model("liffman", {{"alpha_deg", "61"}});
    ADD_FAILURE();
  } catch (const BadParameter& e) {
    EXPECT_THAT(e.what(), HasSubstr("alpha_deg = 61 is out of range; allowed: "));
  }
  EXPECT_THROW(make_model("liffman", {{"width", "0"}}), BadParameter);
  EXPECT_THROW(make_model("liffman", {{"alpha_deg", "0"}}), BadParameter);
}
