// A checkpoint is told from that of every other setup: any member that changes, changes the text.
#include "dem/run/fingerprint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "coupling/studies/cone/simulation.h"
#include "coupling/studies/lattice_pile/simulation.h"
#include "coupling/studies/pile/simulation.h"
#include "coupling/studies/point_load/simulation.h"

namespace grainfield::dem {
namespace {

void change(double& value) { value = std::nextafter(value, 1e300); }
void change(int& value) { ++value; }
void change(bool& value) { value = !value; }
void change(std::string& value) { value += "x"; }
void change(std::vector<double>& value) { value.push_back(1); }

/// Calls look() once for every member, with that one changed.
template <class T, class Look>
void change_each(const T& value, Look look) {
  auto& here =
      const_cast<T&>(value);  // members() gives what the caller's own, changeable setup has
  if constexpr (Listed<T>) {
    std::apply([&](const auto&... member) { (change_each(member, look), ...); }, here.members());
  } else {
    const T before = here;
    change(here);
    look();
    here = before;
  }
}

template <class Setup>
std::size_t texts_of_changes() {
  Setup setup;
  const std::string before = fingerprint_of(setup);
  std::set<std::string> texts{before};
  std::size_t changes = 0;
  change_each(setup, [&] {
    ++changes;
    texts.insert(fingerprint_of(setup));
  });
  EXPECT_EQ(texts.size(), changes + 1);
  EXPECT_EQ(fingerprint_of(setup), before);
  return changes;
}

TEST(Fingerprint, EveryMemberCounts) {
  EXPECT_EQ(texts_of_changes<PileSetup>(), 9U + 11 + 2 + 27 + 4 + 5 + 12 + 4);
  EXPECT_EQ(texts_of_changes<PointLoadSetup>(), 25U + 27 + 4 + 5 + 12);
  EXPECT_EQ(texts_of_changes<ConeSetup>(), 16U + 27 + 4 + 5 + 11);
  EXPECT_EQ(texts_of_changes<LatticePileSetup>(), 6U + 27 + 4 + 5);
}

struct Forgetful {
  int told = 1, forgotten = 2;
  auto members() const { return std::tie(told); }
};
// What fingerprint_of asserts.
static_assert(detail::count_members<Forgetful>() == 2);
static_assert(detail::count_members<PackingSetup>() == 25);

}  // namespace
}  // namespace grainfield::dem
