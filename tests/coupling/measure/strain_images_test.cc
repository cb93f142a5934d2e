// Displacements and strains between two states of periodic packings: those of the grains, whatever
// the files say of images, or the shortest ways with a line and a warning.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "coupling/import/import.h"
#include "coupling/strain/motion.h"
#include "dem/snapshot/cell_places.h"
#include "dem/snapshot/displacements.h"
#include "tests/coupling/periodic_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Exchange = Eigen::Matrix3i;  // columns: new edges in old ones

constexpr double kSide = 0.08;  // of periodic_packing() in the plane; m
constexpr double kTolerance = 1e-13;

// A state of a packing that has moved as a whole: places in space, before they are carried back.
struct State {
  dem::Snapshot s;           // all images counted
  Eigen::Matrix3d gradient;  // of the motion since the packing
  Exchange exchange;
  std::vector<Vec3> place;
};

// x' = gradient x + drift, in a cell whose edges are exchanged as an engine does it.
State state_of(const dem::Snapshot& packing, const Eigen::Matrix3d& gradient, const Vec3& drift,
               const Exchange& exchange = Exchange::Identity()) {
  State out{packing, gradient, exchange, {}};
  dem::Snapshot& s = out.s;
  const Eigen::Matrix3d edges = gradient * packing.cell.edges;
  for (int a = 0; a < 3; ++a) {
    s.cell.edges.col(a).setZero();
    for (int b = 0; b < 3; ++b) s.cell.edges.col(a) += exchange(b, a) * edges.col(b);
  }
  for (dem::Grain& g : s.grains) {
    out.place.push_back(gradient * g.position + drift);
    g.image = dem::edges_away(s.cell, out.place.back());
    g.position = dem::wrapped(s.cell, out.place.back());
  }
  const Eigen::Matrix3d back = exchange.cast<double>().inverse();
  for (dem::Contact& c : s.contacts) {
    const dem::Grain &i = s.grains[static_cast<std::size_t>(c.i)],
                     &j = s.grains[static_cast<std::size_t>(c.j)];
    const Vec3 n = back * Vec3(c.image[0], c.image[1], c.image[2]);
    for (std::size_t a = 0; a < 3; ++a)
      c.image[a] =
          j.image[a] - i.image[a] + static_cast<int>(std::lround(n[static_cast<Eigen::Index>(a)]));
  }
  return out;
}

// What a file leaves of the images: those of these axes.
dem::Snapshot told(dem::Snapshot s, const std::string& text, std::array<bool, 3> axes) {
  s.attributes["images"] = text;
  for (dem::Grain& g : s.grains)
    for (std::size_t a = 0; a < 3; ++a)
      if (!axes[a]) g.image[a] = 0;
  return s;
}
dem::Snapshot counted(const State& state) { return told(state.s, "counted", {true, true, true}); }
dem::Snapshot untold(const State& state) { return told(state.s, "untold", {}); }

// The displacement of the copy that was in the cell before.
Vec3 displacement_of(const State& a, const State& b, std::size_t g) {
  const Eigen::Matrix3d between = b.gradient * a.gradient.inverse();
  const auto& n = a.s.grains[g].image;
  const Vec3 edges = a.s.cell.edges * Vec3(n[0], n[1], n[2]);
  return b.place[g] - between * edges - a.s.grains[g].position;
}

double largest_error(const State& a, const State& b, const dem::Displacements& found) {
  double most = 0;
  for (std::size_t g = 0; g < a.place.size(); ++g)
    most = std::max(most, (found.of(g) - displacement_of(a, b, g)).norm());
  return most;
}

// Contacts across the sides, too.
double largest_strain_error(const State& a, const State& b, const dem::Snapshot& before,
                            const dem::Snapshot& after) {
  const int dim = before.dim;
  const Eigen::Matrix3d between = b.gradient * a.gradient.inverse();
  const Eigen::MatrixXd change =
      (between - Eigen::Matrix3d::Identity()).topLeftCorner(dim, dim).transpose();
  const GrainMotion motion = grain_motion(before, after);
  return (motion.relative - motion.branch * change).rowwise().norm().maxCoeff();
}

Vec3 drift_of(dem::Random& random, double least, double most, int dim) {
  const auto one = [&] {
    return kSide * random.uniform(least, most) * (random.uniform() < 0.5 ? -1 : 1);
  };
  const double x = one(), y = one(), z = one();
  return {x, y, dim == 3 ? z : 0};
}

Eigen::Matrix3d shear(int row, int column, double by) {
  Eigen::Matrix3d out = Eigen::Matrix3d::Identity();
  out(row, column) = by;
  return out;
}

TEST(StrainImages, OfCountedImagesAnyTranslationIsTheGrains) {
  dem::Random random(11);
  for (int draw = 0; draw < 40; ++draw) {
    const int dim = 2 + draw % 2;
    const dem::Snapshot packing =
        test::periodic_packing(dim, 100U + static_cast<unsigned>(draw), draw % 3 != 0);
    const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
    const bool all = draw % 3 != 0;
    const auto in_period = [&](Vec3 v) {
      if (!all) v[dim - 1] = 0.1 * kSide;
      return v;
    };
    const State a = state_of(packing, none, in_period(drift_of(random, 0, 3, dim))),
                b = state_of(packing, none, in_period(drift_of(random, 0, 3, dim)));
    const dem::Snapshot before = counted(a), after = counted(b);
    const dem::Displacements found(before, after);
    EXPECT_LT(largest_error(a, b, found), kTolerance) << draw;
    EXPECT_LT(largest_strain_error(a, b, before, after), kTolerance) << draw;
    EXPECT_THAT(found.images(), IsEmpty()) << draw;
    EXPECT_THAT(found.doubt(), IsEmpty()) << draw;
  }
}

// Both without, the first without, the second without: what the shortest way can say it does.
TEST(StrainImages, OfUntoldImagesATranslationIsTheShortestWay) {
  dem::Random random(12);
  for (int draw = 0; draw < 60; ++draw) {
    const int dim = 2 + draw % 2;
    const dem::Snapshot packing = test::periodic_packing(dim, 200U + static_cast<unsigned>(draw));
    const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
    const double spacing = dim == 2 ? 1 : 5.0 / 8;  // a cell in space is smaller
    const Vec3 drift = drift_of(random, 0, 3, dim), way = spacing * drift_of(random, 0, 0.15, dim);
    const State a = state_of(packing, none, drift), b = state_of(packing, none, drift + way);
    const dem::Snapshot before = draw % 3 == 1 ? counted(a) : untold(a),
                        after = draw % 3 == 2 ? counted(b) : untold(b);
    const dem::Displacements found(before, after);
    for (std::size_t g = 0; g < before.grains.size(); ++g)
      ASSERT_LT((found.of(g) - way).norm(), kTolerance) << draw;
    EXPECT_LT(largest_strain_error(a, b, before, after), kTolerance) << draw;
    EXPECT_THAT(found.images(), HasSubstr(draw % 3 == 0 ? "each of the two states has no images"
                                                        : "one of the two states has no images"));
    EXPECT_THAT(found.doubt(), IsEmpty()) << draw;
  }
}

TEST(StrainImages, OfUntoldImagesALongWayIsDoubted) {
  const dem::Snapshot packing = test::periodic_packing(2, 3);
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
  const State a = state_of(packing, none, {0, 0, 0}),
              b = state_of(packing, none, {0.4 * kSide, 0, 0});
  for (const bool first : {false, true}) {
    const GrainMotion motion =
        grain_motion(first ? counted(a) : untold(a), first ? untold(b) : counted(b));
    EXPECT_THAT(motion.doubt, HasSubstr("64 of 64 grains have moved by more than a third"));
    EXPECT_THAT(motion.doubt, HasSubstr("import both with unwrapped places"));
  }
}

// Flags along x, none along y: any way along x, the shortest along y.
TEST(StrainImages, FlagsOfOneAxisAreUsed) {
  dem::Random random(13);
  for (int draw = 0; draw < 40; ++draw) {
    const int dim = 2 + draw % 2;
    const dem::Snapshot packing = test::periodic_packing(dim, 300U + static_cast<unsigned>(draw));
    const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
    const Vec3 drift = drift_of(random, 0, 3, dim);
    Vec3 way = 0.5 * drift_of(random, 0, 0.15, dim);
    way.x() = random.uniform(-3, 3) * kSide;
    const State a = state_of(packing, none, drift), b = state_of(packing, none, drift + way);
    const std::array<bool, 3> x{true, false, false};
    const dem::Snapshot before = told(a.s, "counted along x", x),
                        after = draw % 4 == 0 ? counted(b) : told(b.s, "counted along x", x);
    const dem::Displacements found(before, after);
    for (std::size_t g = 0; g < before.grains.size(); ++g)
      ASSERT_LT((found.of(g) - way).norm(), kTolerance) << draw;
    EXPECT_LT(largest_strain_error(a, b, before, after), kTolerance) << draw;
    EXPECT_THAT(found.images(), HasSubstr(dim == 2 ? "no images along y:" : "along y, z:"));
    EXPECT_THAT(found.doubt(), IsEmpty()) << draw;
  }
}

// Simple shears up to two cells' widths between the states, with cells that engines keep near
// upright by exchanging edges, or that are sheared on.
TEST(StrainImages, ACellMaySlideByManyEdges) {
  dem::Random random(14);
  for (int draw = 0; draw < 60; ++draw) {
    const int dim = 2 + draw % 2;
    const dem::Snapshot packing = test::periodic_packing(dim, 400U + static_cast<unsigned>(draw));
    const auto flow = [&](double by) { return draw % 4 == 3 ? shear(1, 2, by) : shear(0, 1, by); };
    const auto upright = [&](const Eigen::Matrix3d& f) {
      Exchange out = Exchange::Identity();
      if (draw % 5 == 0) return out;
      const Eigen::Matrix3d edges = f * packing.cell.edges;
      const int row = draw % 4 == 3 ? 1 : 0;
      out(row, row + 1) = -static_cast<int>(std::lround(edges(row, row + 1) / edges(row, row)));
      return out;
    };
    const Eigen::Matrix3d first = flow(random.uniform(-1, 1)),
                          second = flow(random.uniform(-2, 2)) * first;
    const State a = state_of(packing, first, drift_of(random, 0, 2, dim), upright(first)),
                b = state_of(packing, second, drift_of(random, 0, 2, dim), upright(second));
    const dem::Snapshot before = counted(a), after = counted(b);
    const dem::Displacements found(before, after);
    EXPECT_LT(largest_error(a, b, found), kTolerance) << draw;
    EXPECT_LT(largest_strain_error(a, b, before, after), kTolerance) << draw;
    EXPECT_THAT(found.doubt(), IsEmpty()) << draw;
  }
}

// A place far out of the cell says that it was never carried back; of the other state only the
// contacts say whether it was.
TEST(StrainImages, NeighboursDecideWhereOneStateIsOutOfTheCell) {
  dem::Random random(15);
  for (int draw = 0; draw < 40; ++draw) {
    const int dim = 2 + draw % 2;
    const dem::Snapshot packing = test::periodic_packing(dim, 500U + static_cast<unsigned>(draw));
    const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
    Vec3 start = Vec3::Constant(0.3 * 0.05);
    if (dim == 2) start.z() = 0;
    const Vec3 way = 0.6 * drift_of(random, 0.05, 0.3, dim);
    const State a = state_of(packing, none, start), b = state_of(packing, none, start + way);
    const dem::Snapshot after = told(b.s, "not carried back", {true, true, true});
    // As it was, and carried back.
    const dem::Snapshot as_it_was = told(a.s, "untold", {true, true, true}),
                        carried_back = untold(a);
    for (const dem::Snapshot* before : {&as_it_was, &carried_back}) {
      const dem::Displacements found(*before, after);
      for (std::size_t g = 0; g < after.grains.size(); ++g)
        ASSERT_LT((found.of(g) - way).norm(), kTolerance) << draw;
      EXPECT_LT(largest_strain_error(a, b, *before, after), kTolerance) << draw;
      EXPECT_THAT(found.images(), HasSubstr("images")) << draw;
    }
  }
}

// 2.7 periods, from a first state within the cell.
TEST(StrainImages, PlacesThatAreNeverCarriedBackMayGoFar) {
  const dem::Snapshot packing = test::periodic_packing(2, 4);
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
  const Vec3 way(2.7 * kSide, 0, 0);
  const State a = state_of(packing, none, {0, 0, 0}), b = state_of(packing, none, way);
  const dem::Snapshot before = untold(a), after = told(b.s, "not carried back", {true, true, true});
  const dem::Displacements found(before, after);
  for (std::size_t g = 0; g < after.grains.size(); ++g)
    ASSERT_LT((found.of(g) - way).norm(), kTolerance);
  EXPECT_THAT(found.images(), HasSubstr("counted from the places of both states"));
}

// The files of people: a lattice of 10 x 10 disks that touch, and drifts.
class ImportedDrift : public ::testing::Test {
 protected:
  static constexpr double kLength = 0.1, kRadius = 0.005;
  enum class Told { places, carried_back, unwrapped, flags, flags_of_x };

  static double wrapped(double x) { return x - kLength * std::floor(x / kLength); }

  std::string dump(Told told, double drift) const {
    std::string columns = "id x y", rows;
    if (told == Told::unwrapped) columns = "id xu yu";
    if (told == Told::flags) columns += " ix iy";
    if (told == Told::flags_of_x) columns += " ix";
    const bool back = told != Told::places && told != Told::unwrapped;
    for (int k = 0; k < 100; ++k) {
      const double x = kRadius * (2 * (k / 10) + 1) + drift, y = kRadius * (2 * (k % 10) + 1);
      rows += fmt::format("{} {:.17g} {:.17g}", k + 1, back ? wrapped(x) : x, y);
      if (told == Told::flags || told == Told::flags_of_x)
        rows += fmt::format(" {}", static_cast<int>(std::floor(x / kLength)));
      if (told == Told::flags) rows += " 0";
      rows += fmt::format(" {} 1\n", kRadius);
    }
    return fmt::format(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n100\nITEM: BOX BOUNDS pp pp pp\n0 0.1\n0 0.1\n"
        "-0.01 0.01\nITEM: ATOMS {} radius mass\n{}",
        columns, rows);
  }
  static std::string contacts() {
    std::string rows;
    int count = 0;
    for (int k = 0; k < 100; ++k) {
      const int right = (k + 10) % 100, above = k / 10 * 10 + (k + 1) % 10;
      rows += fmt::format("{} {} -1 0 0 0 0 0\n{} {} 0 -1 0 0 0 0\n", k + 1, right + 1, k + 1,
                          above + 1);
      count += 2;
    }
    return fmt::format(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n{}\nITEM: BOX BOUNDS pp pp pp\n0 0.1\n0 0.1\n"
        "-0.01 0.01\nITEM: ENTRIES patom1 patom2 fx fy fz p1 p2 p3\n{}",
        count, rows);
  }
  ImportedSnapshot state(Told told, double drift) const {
    const testing::Folder folder;
    ImportOptions options;
    options.format = "lammps";
    options.gravity = Vec3(0, 0, 0);
    options.files = {folder.write("g", dump(told, drift)), folder.write("c", contacts())};
    ImportedSnapshot out;
    import_snapshots(options, [&](ImportedSnapshot&& imported) { out = std::move(imported); });
    return out;
  }
  // All grains and contacts move by `way`; returns what is said.
  GrainMotion expect_way(Told a, double drift_a, Told b, double drift_b, double way) const {
    const ImportedSnapshot before = state(a, drift_a), after = state(b, drift_b);
    GrainMotion motion = grain_motion(before.snapshot, after.snapshot);
    EXPECT_LT((motion.displacement.col(0).array() - way).abs().maxCoeff(), kTolerance);
    EXPECT_LT(motion.displacement.col(1).cwiseAbs().maxCoeff(), kTolerance);
    EXPECT_LT(motion.relative.cwiseAbs().maxCoeff(), kTolerance);
    return motion;
  }
};

// YADE's: at first a few grains are slightly out of the cell, later some are far out of it.
TEST_F(ImportedDrift, PlacesThatWereNeverCarriedBack) {
  EXPECT_THAT(expect_way(Told::places, 0.007, Told::places, 0.022, 0.015).images,
              HasSubstr("counted from the places of both states"));
  expect_way(Told::places, 0, Told::places, 0.27, 0.27);
  EXPECT_THAT(expect_way(Told::places, 0.13, Told::places, 0.27, 0.14).images, IsEmpty());
  EXPECT_THAT(expect_way(Told::places, 0.007, Told::places, 0.009, 0.002).images,
              HasSubstr("each of the two states has no images"));
}

// LAMMPS' places may be out of the box by a part of the skin until they are carried back.
TEST_F(ImportedDrift, PlacesThatAreCarriedBackLate) {
  expect_way(Told::places, 0.007, Told::carried_back, 0.009, 0.002);
  expect_way(Told::carried_back, 0.02, Told::carried_back, 0.04, 0.02);
}

// Columns of the dump that were changed between two runs.
TEST_F(ImportedDrift, OneStateWithoutImages) {
  for (const Told other : {Told::unwrapped, Told::flags, Told::places}) {
    expect_way(Told::carried_back, 0.007, other, 0.022, 0.015);
    expect_way(other, 0.022, Told::carried_back, 0.007, -0.015);
  }
  EXPECT_THAT(expect_way(Told::carried_back, 0.007, Told::unwrapped, 0.047, 0.04).doubt,
              HasSubstr("100 of 100 grains have moved by more than a third"));
  expect_way(Told::flags, 0.022, Told::unwrapped, 0.28, 0.258);
}

TEST_F(ImportedDrift, FlagsOfOneAxis) {
  EXPECT_THAT(expect_way(Told::flags_of_x, 0, Told::flags_of_x, 0.072, 0.072).images,
              HasSubstr("each of the two states has no images along y"));
  EXPECT_THAT(state(Told::flags_of_x, 0.072).notes,
              ::testing::Contains(HasSubstr("images are counted along x only")));
  EXPECT_THAT(state(Told::flags, 0.072).notes,
              ::testing::Not(::testing::Contains(HasSubstr("images are counted"))));
}

}  // namespace
}  // namespace grainfield::coupling
