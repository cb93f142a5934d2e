// The rooms of a module: which one may include which. A cycle, also one through other rooms, would
// mean that none of them can be read or tested without the others.
#pragma once
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/paths.h"

namespace grainfield::testing {

using Graph = std::map<std::string, std::set<std::string>>;

/// A folder of a module, and the folders whose files its own may include.
struct Room {
  std::string name;
  std::set<std::string> knows;
};

struct Include {
  std::string file, from, to;  ///< from, to: rooms; "": beside the rooms
};

/// A way through the graph that ends where it began; empty: there is none.
inline std::vector<std::string> cycle_in(const Graph& graph) {
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

/// "dem/engine/engine.h" -> "engine"; a folder inside is a room of its own: "studies/pile".
inline std::string room_of(const std::string& path) {
  const std::size_t first = path.find('/') + 1, last = path.rfind('/');
  return last < first ? "" : path.substr(first, last - first);
}

/// Those of the module's own files among each other. `module`: "dem".
inline std::vector<Include> includes_of(const std::string& module) {
  namespace fs = std::filesystem;
  std::vector<Include> found;
  const fs::path root = GRAINFIELD_SOURCES;
  const std::string begin = "#include \"" + module + "/";
  for (const auto& entry : fs::recursive_directory_iterator(root / module)) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cc") continue;
    const std::string file = fs::relative(entry.path(), root).generic_string();
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with(begin)) continue;
      const std::string path = line.substr(10, line.find('"', 10) - 10);
      found.push_back({file, room_of(file), room_of(path)});
    }
  }
  return found;
}

inline Graph graph_of(const std::vector<Include>& includes) {
  Graph graph;
  for (const Include& i : includes) {
    if (i.from != i.to && !i.to.empty()) graph[i.from].insert(i.to);
  }
  return graph;
}

/// Expects that every room knows only rooms above its line, and that files beside the rooms know
/// none.
inline void expect_known_only_below(const std::vector<Room>& rooms,
                                    const std::vector<Include>& includes) {
  std::map<std::string, std::set<std::string>> allowed;
  std::set<std::string> below;
  for (const Room& room : rooms) {
    for (const std::string& other : room.knows) {
      EXPECT_TRUE(below.contains(other)) << room.name << " knows " << other << ", not below it";
    }
    below.insert(room.name);
    allowed[room.name] = room.knows;
  }
  for (const Include& i : includes) {
    if (i.to.empty() || i.from == i.to) continue;
    ASSERT_TRUE(allowed.contains(i.from)) << i.file << ": no room of the list";
    EXPECT_TRUE(allowed[i.from].contains(i.to)) << i.file << " includes " << i.to;
  }
}

}  // namespace grainfield::testing
