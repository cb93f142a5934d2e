// The rooms of dem: which one may include which. A cycle, also one through other rooms, would mean
// that none of them can be read or tested without the others.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/paths.h"

namespace {

namespace fs = std::filesystem;
using Graph = std::map<std::string, std::set<std::string>>;

struct Room {
  std::string name;
  std::set<std::string> knows;
};

// From the bottom up: a room knows only rooms above its line. Files beside the rooms (what is
// thrown) know none.
const std::vector<Room>& rooms() {
  static const std::vector<Room> kRooms{
      {"space", {}},
      {"image", {}},
      {"words", {}},
      {"random", {}},
      {"newton", {}},
      {"snapshot", {"space"}},
      {"shapes", {"space", "image", "words"}},
      {"laws", {"space", "words"}},
      {"neighbours", {"space"}},
      {"motion", {"space", "words"}},
      {"walls", {"space", "words", "snapshot"}},
      {"contacts", {"space", "neighbours"}},
      {"sleep", {"space", "contacts"}},
      {"engine",
       {"space", "image", "shapes", "laws", "neighbours", "contacts", "sleep", "motion", "walls",
        "snapshot"}},
      {"quasistatic", {"space", "shapes", "laws", "neighbours", "motion", "newton", "snapshot"}},
      {"heap", {"space", "engine", "shapes", "random", "snapshot"}},
      {"packing", {"engine", "heap", "laws", "random", "space"}},
      {"study",
       {"engine", "image", "laws", "motion", "heap", "packing", "quasistatic", "random", "snapshot",
        "space", "walls"}},
  };
  return kRooms;
}

/// A way through the graph that ends where it began; empty: there is none.
std::vector<std::string> cycle_in(const Graph& graph) {
  std::set<std::string> done;
  std::vector<std::string> way;
  const auto visit = [&](const auto& self, const std::string& room) -> bool {
    if (done.contains(room)) return false;
    const auto at = std::find(way.begin(), way.end(), room);
    if (at != way.end()) {
      way.erase(way.begin(), at);
      way.push_back(room);
      return true;
    }
    way.push_back(room);
    if (const auto next = graph.find(room); next != graph.end()) {
      for (const std::string& other : next->second) {
        if (self(self, other)) return true;
      }
    }
    way.pop_back();
    done.insert(room);
    return false;
  };
  for (const auto& [room, known] : graph) {
    if (visit(visit, room)) return way;
  }
  return {};
}

struct Include {
  std::string file, from, to;  // from, to: rooms; "": beside the rooms
};

std::string room_of(const std::string& path) {  // "dem/engine/engine.h" -> "engine"
  const std::size_t first = path.find('/') + 1, second = path.find('/', first);
  return second == std::string::npos ? "" : path.substr(first, second - first);
}

std::vector<Include> includes_of_dem() {
  std::vector<Include> found;
  const fs::path root = GRAINFIELD_SOURCES;
  for (const auto& entry : fs::recursive_directory_iterator(root / "dem")) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cc") continue;
    const std::string file = fs::relative(entry.path(), root).generic_string();
    std::ifstream in(entry.path());
    const std::string begin = "#include \"dem/";
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with(begin)) continue;
      const std::string path = line.substr(10, line.find('"', 10) - 10);
      found.push_back({file, room_of(file), room_of(path)});
    }
  }
  return found;
}

TEST(Rooms, KnowOnlyWhatIsBelowThem) {
  std::map<std::string, std::set<std::string>> allowed;
  std::set<std::string> below;
  for (const Room& room : rooms()) {
    for (const std::string& other : room.knows) {
      EXPECT_TRUE(below.contains(other)) << room.name << " knows " << other << ", not below it";
    }
    below.insert(room.name);
    allowed[room.name] = room.knows;
  }
  const std::vector<Include> includes = includes_of_dem();
  EXPECT_GT(includes.size(), 100U);
  for (const Include& i : includes) {
    if (i.to.empty() || i.from == i.to) continue;
    ASSERT_TRUE(allowed.contains(i.from)) << i.file << ": no room of the list";
    EXPECT_TRUE(allowed[i.from].contains(i.to)) << i.file << " includes " << i.to;
  }
}

TEST(Rooms, HaveNoCycle) {
  Graph graph;
  for (const Include& i : includes_of_dem()) {
    if (i.from != i.to && !i.to.empty()) graph[i.from].insert(i.to);
  }
  EXPECT_THAT(cycle_in(graph), testing::IsEmpty());
  // What such a cycle looks like, through a third room.
  graph["space"].insert("study");
  EXPECT_THAT(cycle_in(graph), testing::SizeIs(testing::Ge(3)));
  EXPECT_THAT(cycle_in({{"a", {"b"}}, {"b", {"c"}}, {"c", {"d", "b"}}}),
              testing::ElementsAre("b", "c", "b"));
}

}  // namespace
