// Numbers of realizations foreseen from 8, against what is needed (docs/verdict.md):
//   build/release/tests/coupling_judge power_long_test | grep '^|'
// The field of a real ensemble that GRAINFIELD_ENSEMBLE names, with the models of
// GRAINFIELD_MODELS, parted by blanks:
//   xz -dkc docs/reproduction/states/pile-rest-300-awake.h5.xz > piles.h5
//   grainfield average piles.h5 --frame heap --grid 41x21 --quantities sigma -o field.h5
// Columns: models; what is needed, median over the draws; draws; foreseen within a factor of 1.5,
// needed inside the range, foreseen too few, too many, in 100 draws.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string>

#include "tests/coupling/foresight.h"

namespace grainfield::coupling {
namespace {

// The size of a normal difference that so many realizations find in 80 of 100 ensembles.
double size_of(double needed) {
  double low = 0.02, high = 6;
  while (high - low > 1e-4) {
    const double middle = std::sqrt(low * high);
    (realizations_for_power(middle, 1) > needed - 0.5 ? low : high) = middle;
  }
  return low;
}

void report(const std::string& what, double needed, const test::Foresight& f) {
  const auto share = [&](int count) { return 100.0 * count / f.draws; };
  fmt::print("| {} | {} | {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} |\n", what, needed, f.draws,
             share(f.near), share(f.inside), share(f.too_few), share(f.too_many));
  std::fflush(stdout);
}

// What 8 realizations can foresee at best: of a difference that is normal.
TEST(Power, ForeseenFromEightOfANormalDifference) {
  dem::Random random(20001);
  for (const double needed : {4, 5, 6, 8, 12, 20, 40}) {
    test::Foresight seen;
    const double size = size_of(needed);
    for (int k = 0; k < 1000; ++k) {
      seen.add(test::normal_difference(size, 8, random).models.back().power, needed);
    }
    report("normal", needed, seen);
    // Ends are whole numbers and belong to the range.
    EXPECT_GE(seen.inside, 0.76 * seen.draws);
  }
}

TEST(Power, ForeseenFromEightOfARealEnsemble) {
  const char *file = std::getenv("GRAINFIELD_ENSEMBLE"), *named = std::getenv("GRAINFIELD_MODELS");
  if (file == nullptr || named == nullptr) GTEST_SKIP() << "the environment names no ensemble";
  std::istringstream words(named);
  const test::ManyRealizations all(
      file, {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()});
  ASSERT_GE(all.realizations(), 16);
  dem::Random random(20001);
  constexpr int kDraws = 100, kTries = 40;
  for (std::size_t one = 0; one < all.models().size(); ++one) {
    for (std::size_t other = one + 1; other < all.models().size(); ++other) {
      test::Foresight seen;
      for (int k = 0; k < kDraws; ++k) all.strike({one, other}, kTries, random, seen);
      report(all.models()[one].key + ", " + all.models()[other].key, test::median(seen.needed),
             seen);
    }
  }
}

}  // namespace
}  // namespace grainfield::coupling
