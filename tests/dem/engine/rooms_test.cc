// The rooms of dem.
#include "tests/rooms.h"

#include <gmock/gmock.h>

namespace grainfield::testing {
namespace {

// From the bottom up: a room knows only rooms above its line. Files beside the rooms (what is
// thrown) know none.
const std::vector<Room>& rooms() {
  static const std::vector<Room> kRooms{
      {"shared", {}},
      {"space", {"shared"}},
      {"checkpoint", {}},
      {"words", {}},
      {"random", {}},
      {"newton", {}},
      {"hdf5", {"shared"}},
      {"snapshot", {"space", "hdf5", "shared"}},
      {"shapes", {"space", "checkpoint", "words"}},
      {"laws", {"space", "words"}},
      {"neighbours", {"space"}},
      {"motion", {"space", "words"}},
      {"walls", {"shared", "space", "words", "snapshot"}},
      {"collisions", {"shared", "space", "random"}},
      {"contacts", {"space", "neighbours"}},
      {"sleep", {"space", "contacts"}},
      {"engine",
       {"shared", "space", "checkpoint", "shapes", "laws", "neighbours", "contacts", "sleep",
        "motion", "walls", "snapshot"}},
      {"quasistatic",
       {"shared", "space", "shapes", "laws", "neighbours", "motion", "newton", "snapshot"}},
      {"implicit", {"shared", "space", "checkpoint", "neighbours", "newton", "quasistatic"}},
      {"switching", {"space", "checkpoint", "neighbours", "collisions", "implicit"}},
      {"grains", {"shared", "space", "engine", "laws", "shapes", "random", "snapshot"}},
      {"pouring", {"engine", "grains"}},
      {"run",
       {"engine", "grains", "checkpoint", "hdf5", "implicit", "laws", "motion", "quasistatic",
        "random", "shapes", "shared", "snapshot", "space"}},
  };
  return kRooms;
}

TEST(Rooms, KnowOnlyWhatIsBelowThem) {
  const std::vector<Include> includes = includes_of("dem");
  EXPECT_GT(includes.size(), 100U);
  expect_known_only_below(rooms(), includes);
}

TEST(Rooms, HaveNoCycle) {
  Graph graph = graph_of(includes_of("dem"));
  EXPECT_THAT(cycle_in(graph), ::testing::IsEmpty());
  // What such a cycle looks like, through a third room.
  graph["space"].insert("run");
  EXPECT_THAT(cycle_in(graph), ::testing::SizeIs(::testing::Ge(3)));
  EXPECT_THAT(cycle_in({{"a", {"b"}}, {"b", {"c"}}, {"c", {"d", "b"}}}),
              ::testing::ElementsAre("b", "c", "b"));
}

}  // namespace
}  // namespace grainfield::testing
