// Moduli of the slabs of a layer: lattices whose moduli are known in closed form, in the plane and
// in space; layers of two materials; the table that finite elements read.
#include "coupling/elastic_constants/slab_moduli.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "continuum/moduli_by_depth.h"
#include "coupling/studies/point_load/layer_probe.h"
#include "coupling/studies/point_load/probed_slabs.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/quasistatic/sphere_law.h"
#include "tests/dem/sphere_relaxation_scene.h"

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;
using C = SlabConstants;
using dem::kRadius;
using dem::Snapshot;
using dem::Vec3;

constexpr double kSpring = 1e6, kShearSpring = 5e5;
constexpr double kOverlap = 1e-4;  // of a diameter
constexpr double kTolerance = 2e-3;

struct Layer {
  dem::EngineSettings settings;
  Snapshot rest;
  double height = 0;
};

bool always(int, int) { return true; }

// Rows of a triangular lattice, pressed evenly, whose slabs of `rows_of_slab` rows end halfway
// between two of them. `is_there`: of row and column.
template <class There>
Layer triangular(int slabs, int rows_of_slab, const There& is_there) {
  Layer out;
  out.settings.law = dem::LinearLaw{kSpring, kShearSpring, 0, 0};
  out.settings.friction = 5;
  out.settings.gravity_y = 0;
  out.settings.time_step = 1e-7;
  const double diameter = 2 * kRadius, a = diameter * (1 - kOverlap), rise = a * std::sqrt(3) / 2;
  const int rows = slabs * rows_of_slab + 4, columns = 42;
  out.height = 3 * diameter + slabs * rows_of_slab * rise;
  const auto engine = dem::make_engine(out.settings);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (!is_there(row, column)) continue;
      dem::NewGrain g;
      g.x = a * (column + 0.5 * (row % 2));
      g.y = 1.5 * diameter + (row - 1.5) * rise;
      g.radius = kRadius;
      g.density = 1000;
      engine->add(g);
    }
  }
  out.rest = engine->snapshot();
  out.rest.gravity.setZero();
  return out;
}

const double kBulk = std::sqrt(3) / 2 * kSpring;
const double kShear = std::sqrt(3) / 4 * (kSpring + kShearSpring);

TEST(SlabModuli, TheTriangularLatticeHasThemInClosedForm) {
  const Layer l = triangular(3, 6, always);
  const auto probed = probe_slabs(l.rest, l.settings, l.height, {1e-6, 3, 4});
  ASSERT_TRUE(probed);
  ASSERT_EQ(probed->slabs.size(), 3U);
  const double young = 3 * kShear - kShear * kShear / kBulk;
  const double e_h = 4 * kBulk * kShear / (kBulk + kShear);
  for (const SlabModuli& slab : probed->slabs) {
    EXPECT_NEAR(slab.mean[C::young], young, kTolerance * young) << slab.depth;
    EXPECT_NEAR(slab.mean[C::poisson], 0.5 * (1 - kShear / kBulk), kTolerance);
    EXPECT_NEAR(slab.mean[C::g_v], kShear, kTolerance * kShear);
    EXPECT_NEAR(slab.mean[C::e_h], e_h, kTolerance * e_h);
    // In the plane the five constants are the two.
    const continuum::PlaneModuli plane =
        continuum::TransverseModuli{slab.mean[C::e_h], slab.mean[C::e_v], slab.mean[C::nu_h],
                                    slab.mean[C::nu_v], slab.mean[C::g_v]}
            .plane_strain();
    const continuum::PlaneModuli same =
        continuum::TransverseModuli{young, young, slab.mean[C::poisson], slab.mean[C::poisson],
                                    kShear}
            .plane_strain();
    EXPECT_NEAR(plane.E_x, same.E_x, kTolerance * same.E_x);
    EXPECT_NEAR(plane.E_y, same.E_y, kTolerance * same.E_y);
    EXPECT_LT(slab.residual_isotropic, kTolerance);
    EXPECT_LT(slab.error[C::young], kTolerance * young);
  }
  EXPECT_LT(probed->contacts_changed, 1e-9);
  EXPECT_NEAR(probed->whole.mean[C::young], young, kTolerance * young);
  EXPECT_LT(probed->slabs[0].depth, probed->slabs[1].depth);
  EXPECT_NEAR(probed->slabs[0].depth - probed->slabs[0].thickness / 2, 3 * kRadius, 1e-9);
}

// Every ninth grain of the lower half is missing: its slab has the moduli of a lattice in which
// they are missing everywhere, the upper one those of the full lattice.
TEST(SlabModuli, OfTwoMaterialsAreEachItsOwn) {
  const auto holes = [](int row, int column) { return row % 3 != 1 || column % 3 != 1; };
  const auto below = [&](int row, int column) { return row > 7 || holes(row, column); };
  const auto young = [](const Layer& l) {
    const auto probed = probe_slabs(l.rest, l.settings, l.height, {1e-6, 2, 4});
    return std::pair(probed->slabs.front().mean[C::young], probed->slabs.back().mean[C::young]);
  };
  const auto [full, full_below] = young(triangular(2, 6, always));
  const auto [weak, weak_below] = young(triangular(2, 6, holes));
  const auto [upper, lower] = young(triangular(2, 6, below));
  EXPECT_NEAR(full_below, full, 1e-3 * full);
  EXPECT_NEAR(weak_below, weak, 0.02 * weak);
  ASSERT_LT(weak, 0.85 * full);
  EXPECT_NEAR(upper, full, 0.03 * full);
  EXPECT_NEAR(lower, weak_below, 0.03 * weak);
}

// Simple cubic, repeated sideways; slabs end halfway between two levels.
Layer cubic(const dem::AnyLaw& law, double gravity, int levels) {
  Layer out;
  out.settings = dem::settings_of(law, 5);
  constexpr int kSide = 5;
  const double a = 2 * kRadius * (1 - 10 * kOverlap);
  out.settings.cell.periodic = {true, true, false};
  out.settings.cell.edges = Vec3(kSide * a, kSide * a, 1).asDiagonal();
  const auto engine = dem::make_engine(out.settings);
  for (int k = 0; k < kSide * kSide * levels; ++k)
    engine->add(dem::sphere(a * Vec3(k % kSide + 0.5, k / kSide % kSide + 0.5, k / kSide / kSide)));
  out.rest = engine->snapshot();
  out.rest.gravity = Vec3(0, 0, -gravity);
  out.height = (levels - 1) * a;
  return out;
}

// With the same spring along and across each contact it is isotropic, without sideways strain.
TEST(SlabModuli, TheCubicLatticeHasThemInClosedForm) {
  const Layer l = cubic(dem::LinearLaw{kSpring, kSpring, 0, 0}, 0, 16);
  const auto probed = probe_slabs(l.rest, l.settings, l.height, {1e-6, 3, 5});
  ASSERT_TRUE(probed);
  const double young = kSpring / (2 * kRadius);
  for (const SlabModuli& slab : probed->slabs) {
    EXPECT_NEAR(slab.mean[C::e_v], young, 0.005 * young);
    EXPECT_NEAR(slab.mean[C::e_h], young, 0.005 * young);
    EXPECT_NEAR(slab.mean[C::g_v], 0.5 * young, 0.005 * young);
    EXPECT_NEAR(slab.mean[C::nu_h], 0, 0.005);
    EXPECT_NEAR(slab.mean[C::nu_v], 0, 0.005);
    EXPECT_LT(slab.error[C::e_v], 0.005 * young);
  }
}

// Hertzian columns under their weight: stiffer below, by the force of each contact.
TEST(SlabModuli, GrowWithTheForceOfHertzianContacts) {
  const dem::HertzLaw law{5e6, 0.3, 0};
  const Layer l = cubic(law, dem::kG / 25, 16);
  const auto probed = probe_slabs(l.rest, l.settings, l.height, {1e-6, 3, 1});
  ASSERT_TRUE(probed);
  // The forces of the columns at rest between their held ends, from a prober of the same layer.
  const std::vector<dem::Slab> slabs = dem::slabs_of(l.rest, l.height, 3);
  dem::LayerProber prober(l.rest, l.settings, l.height, 1e-6, slabs);
  ASSERT_TRUE(prober.settle(nullptr));
  const dem::SphereLaw sphere_law{dem::AnyLaw(law)};
  const double a = 2 * kRadius * (1 - 10 * kOverlap);
  for (std::size_t k = 0; k < 3; ++k) {
    const double force = -prober.stress_before(k)(2, 2) * a * a;
    double low = 0, high = 0.1 * kRadius;
    for (int n = 0; n < 60; ++n) {
      const double depth = 0.5 * (low + high);
      (sphere_law.repulsion(depth, kRadius / 2).value < force ? low : high) = depth;
    }
    const double young = sphere_law.repulsion(low, kRadius / 2).slope / a;
    const SlabModuli& slab = probed->slabs[2 - k];
    EXPECT_NEAR(slab.mean[C::e_v], young, 0.015 * young) << slab.depth;
    EXPECT_TRUE(std::isnan(slab.error[C::e_v]));
  }
  EXPECT_GT(probed->slabs[2].mean[C::e_v], 1.15 * probed->slabs[0].mean[C::e_v]);
}

Layer settled_layer() {
  Layer out;
  out.settings = dem::settings_of(dem::HertzLaw{5e6, 0.3, 0.3}, 0.5);
  const auto engine = dem::settled(out.settings, true, 5, 6);
  out.settings.cell = engine->snapshot().cell;
  out.rest = dem::relax(engine->snapshot(), out.settings, {0, 0, -dem::kG}, {}, {}).state;
  for (const dem::Grain& g : out.rest.grains)
    out.height = std::max(out.height, g.position.z() + g.radius);
  return out;
}

// Strips make up their slab, slabs the layer, and the middle half is what a prober takes itself.
TEST(SlabModuli, PartsAddUp) {
  const Layer l = settled_layer();
  const double h = l.height;
  const std::vector<dem::Slab> slabs{
      {0.25 * h, 0.75 * h}, {0.25 * h, 0.5 * h}, {0.5 * h, 0.75 * h}};
  dem::LayerProber alone(l.rest, l.settings, h, 1e-6);
  dem::LayerProber parts(l.rest, l.settings, h, 1e-6, slabs, 3);
  ASSERT_TRUE(alone.settle(nullptr) && parts.settle(nullptr));
  ASSERT_EQ(parts.parts(), 12U);
  const auto one = alone.probe(4, nullptr);
  const auto all = parts.probe_parts(4, nullptr);
  ASSERT_TRUE(one && all);
  EXPECT_EQ(one->stress, all->front().stress);
  EXPECT_EQ(one->gradient, all->front().gradient);
  for (std::size_t s = 0; s < 3; ++s) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t k = 1; k <= 3; ++k) sum += parts.stress_before(4 * s + k) / 3;
    const Eigen::Matrix3d& whole = parts.stress_before(4 * s);
    EXPECT_LT((sum - whole).norm(), 1e-10 * whole.norm()) << s;
  }
  const Eigen::Matrix3d& whole = parts.stress_before(0);
  EXPECT_LT((0.5 * (parts.stress_before(4) + parts.stress_before(8)) - whole).norm(),
            1e-10 * whole.norm());
}

TEST(SlabModuli, ThinSlabsAreRefused) {
  const Layer l = settled_layer();
  EXPECT_THAT(
      [&] {
        probe_slabs(l.rest, l.settings, l.height, {1e-6, 40, 1});
      },
      ::testing::ThrowsMessage<ComputationFailed>(HasSubstr("allowed: a diameter")));
}

TEST(SlabModuli, HaveErrorsOverRealizationsAndStrips) {
  const auto with = [](double young) {
    SlabConstants out;
    out.values.fill(1);
    out.values[C::young] = young;
    return out;
  };
  const SlabModuli of = slab_of_realizations({with(1), with(2), with(6)});
  EXPECT_DOUBLE_EQ(of.mean[C::young], 3);
  EXPECT_NEAR(of.error[C::young], std::sqrt(14.0 / 6), 1e-12);
  EXPECT_DOUBLE_EQ(of.error[C::g_v], 0);
  const SlabModuli strips = slab_of_strips(with(10), {with(1), with(2), with(6)});
  EXPECT_DOUBLE_EQ(strips.mean[C::young], 10);
  EXPECT_NEAR(strips.error[C::young], std::sqrt(14.0 / 6), 1e-12);
  EXPECT_TRUE(std::isnan(slab_of_realizations({with(1)}).error[C::young]));
  SlabModuli first = of, second = of;
  first.depth = 1;
  second.depth = 3;
  second.mean[C::young] = 5;
  const std::vector<SlabModuli> over = over_realizations({{first}, {second}});
  EXPECT_DOUBLE_EQ(over[0].depth, 2);
  EXPECT_DOUBLE_EQ(over[0].mean[C::young], 4);
  EXPECT_DOUBLE_EQ(over[0].error[C::young], 1);
}

TEST(SlabModuli, AreReadByFiniteElements) {
  SlabModuli upper, lower;
  upper.depth = 0.1;
  upper.mean = {1e5, 2e5, 0.2, 0.25, 6e4, 1.5e5, 0.22};
  lower.depth = 0.3;
  lower.mean = {2e5, 4e5, 0.2, 0.25, 12e4, 3e5, 0.24};
  const std::string file = (std::filesystem::temp_directory_path() / "slab_moduli.csv").string();
  const auto read = [&](bool isotropic) {
    std::ofstream(file) << moduli_table({upper, lower}, 0.5, isotropic);
    return continuum::read_moduli_by_depth(file);
  };
  const continuum::ModuliByDepth five = read(false);
  EXPECT_NO_THROW(five.require_cover(0.5));
  for (const auto& [depth, e_v] :
       {std::pair(0.0, 2e5), {0.1, 2e5}, {0.2, 3e5}, {0.3, 4e5}, {0.5, 4e5}}) {
    EXPECT_NEAR(five.at(depth).E_v, e_v, 1) << depth;
    EXPECT_NEAR(five.at(depth).E_h, e_v / 2, 1) << depth;
  }
  EXPECT_NEAR(five.at(0.1).G_v, 6e4, 1);
  EXPECT_NEAR(five.at(0.1).nu_h, 0.2, 1e-9);
  EXPECT_NEAR(five.at(0.1).nu_v, 0.25, 1e-9);
  const continuum::ModuliByDepth two = read(true);
  EXPECT_NEAR(two.at(0.2).E_v, 2.25e5, 1);
  EXPECT_NEAR(two.at(0.2).nu_v, 0.23, 1e-9);
  std::filesystem::remove(file);
  EXPECT_THAT(
      [&] {
        moduli_table({lower, upper}, 0.5, true);
      },
      ::testing::ThrowsMessage<std::invalid_argument>(HasSubstr("from the surface downwards")));
  EXPECT_THROW(moduli_table({}, 0.5, true), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::coupling
