// The rooms of coupling. What runs cases, what reads them and what draws pages know no study.
#include "tests/rooms.h"

#include <gmock/gmock.h>

#include "coupling/case/study.h"

namespace grainfield::testing {
namespace {

// From the bottom up: a room knows only rooms above its line.
const std::vector<Room>& rooms() {
  static const std::vector<Room> kRooms{
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
      // Each study by itself, and what it takes from others of its kind.
      {"studies/sample/simulation", {}},
      {"studies/point_load",
       {"averaging", "base", "case", "compare", "elastic_constants", "fit", "judge", "models",
        "observe", "report", "result", "run"}},
      {"studies/pile",
       {"averaging", "base", "case", "compare", "fit", "specimen", "models", "observe", "report",
        "result", "run", "statistics"}},
      {"studies/pile_fields",
       {"averaging", "base", "case", "elastic_constants", "specimen", "judge", "report", "result",
        "run", "statistics", "store", "strain", "structure", "studies/pile"}},
      {"studies/cone",
       {"averaging", "base", "case", "specimen", "judge", "models", "observe", "report", "result",
        "run", "studies/pile", "studies/sample/simulation"}},
      {"studies/lattice_pile", {"case", "compare", "models", "report", "result", "run"}},
      {"studies/sample",
       {"averaging", "case", "elastic_constants", "judge", "report", "result", "run", "statistics",
        "store", "strain", "structure", "studies/sample/simulation"}},
      {"studies/pair", {"case", "report", "result", "run"}},
      {"studies/hard_disks", {"case", "judge", "report", "result", "run"}},
      {"studies/implicit_settling", {"case", "observe", "result", "run", "studies/lattice_pile"}},
      {"studies/hard_to_soft", {"case", "observe", "run"}},
      {"studies/solvers", {"averaging", "case", "models", "run", "studies/point_load"}},
      {"studies/wedge",
       {"averaging", "case", "specimen", "judge", "models", "report", "result", "run", "store",
        "studies/point_load"}},
      {"studies", {"case"}},
      {"tasks",
       {"averaging", "base", "case", "compare", "fit", "specimen", "import", "judge", "models",
        "observe", "result", "run", "store", "strain", "studies/pile", "studies/point_load"}},
      {"app",
       {"averaging", "base", "case", "export", "import", "judge", "models", "result", "run",
        "store", "structure", "tasks"}},
      {"python",
       {"app", "base", "case", "compare", "fit", "import", "judge", "models", "result", "run",
        "store", "structure", "tasks"}},
  };
  return kRooms;
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
