// The rooms of coupling. What runs cases, what reads them and what draws pages know no study.
#include "tests/rooms.h"

#include <gmock/gmock.h>

#include "coupling/case/study.h"

namespace grainfield::testing {
namespace {

// From the bottom up: a room knows only rooms above its line.
const std::vector<Room> kBelowStudies{
    {"base", {}},
    {"statistics", {"base"}},
    {"averaging", {"base", "statistics"}},
    {"strain", {"averaging", "base", "statistics"}},
    {"structure", {"averaging", "base", "statistics"}},
    {"import", {"averaging", "base"}},
    {"judge", {"statistics"}},
    {"compare", {"averaging", "judge", "statistics"}},
    {"specimen", {"averaging", "base", "statistics"}},
    {"store", {"base"}},
    {"result", {"base", "compare", "judge", "store"}},
    {"elastic_constants", {"averaging", "base", "result", "statistics"}},
    {"report", {"averaging", "base", "judge", "result", "store"}},
    {"models", {"averaging", "base", "compare", "result"}},
    {"case", {"base", "models", "result"}},
    {"export", {"base", "report", "result", "store", "structure"}},
    {"run",
     {"averaging", "base", "case", "compare", "export", "judge", "report", "result", "statistics",
      "store", "structure"}},
    {"observe",
     {"averaging", "base", "case", "compare", "specimen", "import", "models", "report", "result",
      "run", "store"}},
    {"fit",
     {"averaging", "case", "compare", "judge", "models", "observe", "report", "result", "run",
      "statistics", "structure"}},
};

// What studies take from others of their kind, besides all rooms above.
const std::map<std::string, std::set<std::string>> kTakenFromOthers{
    {"studies/sample", {"studies/sample/simulation"}},
    {"studies/cone", {"studies/pile", "studies/sample/simulation"}},
    {"studies/pile_fields", {"studies/pile"}},
    {"studies/implicit_settling", {"studies/lattice_pile"}},
    {"studies/boussinesq_limit", {"studies/point_load"}},
    {"studies/solvers", {"studies/point_load"}},
    {"studies/wedge", {"studies/point_load"}}};

const std::vector<Room> kAboveStudies{
    {"studies", {"case"}},
    {"tasks",
     {"averaging", "base", "case", "compare", "fit", "specimen", "import", "judge", "models",
      "observe", "result", "run", "store", "strain", "studies/pile", "studies/point_load"}},
    {"app",
     {"averaging", "base", "case", "export", "import", "judge", "models", "result", "run", "store",
      "structure", "tasks"}},
    {"python",
     {"app", "base", "case", "compare", "fit", "import", "judge", "models", "result", "run",
      "store", "structure", "tasks"}},
};

std::vector<Room> rooms() {
  namespace fs = std::filesystem;
  std::vector<Room> out = kBelowStudies;
  std::set<std::string> below;
  for (const Room& room : out) below.insert(room.name);
  std::vector<Room> takers{{"studies/sample/simulation", {}}};
  const fs::path coupling = fs::path(GRAINFIELD_SOURCES) / "coupling";
  for (const auto& entry : fs::directory_iterator(coupling / "studies")) {
    if (!entry.is_directory()) continue;
    const std::string name = fs::relative(entry.path(), coupling).generic_string();
    const auto others = kTakenFromOthers.find(name);
    const bool takes = others != kTakenFromOthers.end();
    Room& room = (takes ? takers : out).emplace_back(Room{name, below});
    if (takes) room.knows.insert(others->second.begin(), others->second.end());
  }
  out.insert(out.end(), takers.begin(), takers.end());
  out.insert(out.end(), kAboveStudies.begin(), kAboveStudies.end());
  return out;
}

TEST(Rooms, KnowOnlyWhatIsBelowThem) {
  const std::vector<Include> includes = includes_of("coupling");
  EXPECT_GT(includes.size(), 500U);
  expect_known_only_below(rooms(), includes);
}

TEST(Rooms, HaveNoCycle) {
  Graph graph = graph_of(includes_of("coupling"));
  EXPECT_THAT(cycle_in(graph), ::testing::IsEmpty());
  graph["case"].insert("studies/pile");
  EXPECT_THAT(cycle_in(graph), ::testing::SizeIs(::testing::Ge(3)));
}

// The words of the case key `study`, which only their own folders and the commands may say.
TEST(Rooms, OfRunsCasesAndPagesKnowNoStudyByName) {
  namespace fs = std::filesystem;
  const fs::path root = GRAINFIELD_SOURCES;
  int files = 0;
  for (const char* room :
       {"case", "run", "report", "models", "result", "store", "averaging", "specimen"}) {
    for (const auto& entry : fs::directory_iterator(root / "coupling" / room)) {
      std::ifstream in(entry.path());
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      ++files;
      for (const coupling::Study& study : coupling::studies()) {
        EXPECT_EQ(text.find('"' + study.name + '"'), std::string::npos)
            << entry.path() << " names the study " << study.name;
      }
    }
  }
  EXPECT_GT(files, 80);
}

}  // namespace
}  // namespace grainfield::testing
