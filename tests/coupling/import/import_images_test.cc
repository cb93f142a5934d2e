// Displacements between two states whose files tell images in different ways: always those of the
// grains, or the shortest way with a warning.
#include <gmock/gmock.h>

#include "dem/snapshot/displacements.h"
#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Outcome;

constexpr double kLength = 0.1, kRadius = 0.005;
constexpr int kColumns = 10;

class ImportImages : public testing::ImportOfFiles {
 protected:
  enum class Told { carried_back, as_they_are, unwrapped, flags, flags_of_x };

  // A row of disks that has drifted.
  std::string dump(Told told, double drift) {
    std::string rows, columns = "id x y radius mass";
    if (told == Told::unwrapped) columns = "id xu yu radius mass";
    if (told == Told::flags) columns = "id x y ix iy radius mass";
    if (told == Told::flags_of_x) columns = "id x y ix radius mass";
    for (int k = 0; k < kColumns; ++k) {
      const double x = kRadius * (2 * k + 1) + drift;
      const int image = static_cast<int>(std::floor(x / kLength));
      const bool wrapped = told != Told::as_they_are && told != Told::unwrapped;
      rows += fmt::format("{} {:.17g} 0.05", k + 1, wrapped ? x - image * kLength : x);
      if (told == Told::flags) rows += fmt::format(" {} 0", image);
      if (told == Told::flags_of_x) rows += fmt::format(" {}", image);
      rows += fmt::format(" {} 1\n", kRadius);
    }
    return atoms(0, "", rows, columns, "pp pp ff\n0 0.1\n0 0.1\n0 1");
  }
  Outcome state(Told told, double drift) {
    return import("lammps", {write("g", dump(told, drift))}, [](ImportOptions& o) {
      o.dim = 2;
      o.without_contacts = true;
    });
  }
  // The largest and the least way along x, of all grains.
  std::pair<double, double> ways(Told a, double drift_a, Told b, double drift_b) {
    const Outcome one = state(a, drift_a), two = state(b, drift_b);
    const dem::Snapshot &before = only(one).snapshot, &after = only(two).snapshot;
    const dem::Displacements displacements(before, after);
    double least = 1, most = -1;
    for (std::size_t g = 0; g < before.grains.size(); ++g) {
      const double way = displacements.of(g).x();
      least = std::min(least, way);
      most = std::max(most, way);
    }
    doubt_ = displacements.doubt();
    return {least, most};
  }
  void expect_all(const std::pair<double, double>& ways, double way) {
    EXPECT_NEAR(ways.first, way, 1e-15);
    EXPECT_NEAR(ways.second, way, 1e-15);
  }

  std::string doubt_;
};

// YADE's: at first a few grains stand slightly out of the cell, later some are far out of it.
TEST_F(ImportImages, PlacesThatWereNeverCarriedBack) {
  expect_all(ways(Told::as_they_are, 0.007, Told::as_they_are, 0.022), 0.015);
  expect_all(ways(Told::as_they_are, 0, Told::as_they_are, 0.27), 0.27);
  expect_all(ways(Told::as_they_are, 0.007, Told::as_they_are, 0.009), 0.002);
}

// A dump's places may stand out of its box by a part of the skin, and are carried back later.
TEST_F(ImportImages, PlacesThatAreCarriedBackLate) {
  expect_all(ways(Told::as_they_are, 0.007, Told::carried_back, 0.009), 0.002);
  expect_all(ways(Told::carried_back, 0.02, Told::carried_back, 0.04), 0.02);
}

// Whoever changes the columns of the dump between two runs.
TEST_F(ImportImages, OneStateWithoutImages) {
  expect_all(ways(Told::carried_back, 0.022, Told::unwrapped, 0.037), 0.015);
  EXPECT_EQ(doubt_, "");
  expect_all(ways(Told::flags, 0.022, Told::carried_back, 0.037), 0.015);
  ways(Told::carried_back, 0.022, Told::unwrapped, 0.08);
  EXPECT_THAT(doubt_, HasSubstr("more than a third of the periodic cell"));
  expect_all(ways(Told::flags, 0.022, Told::unwrapped, 0.28), 0.258);
}

TEST_F(ImportImages, FlagsOfOneAxisAreSaid) {
  const Outcome half = state(Told::flags_of_x, 0.072);
  EXPECT_THAT(only(half).notes, Contains(HasSubstr("images are counted along x only")));
  EXPECT_THAT(only(state(Told::flags, 0.072)).warnings, ::testing::IsEmpty());
}

}  // namespace
}  // namespace grainfield::coupling
