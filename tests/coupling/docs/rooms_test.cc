// The rooms of coupling. What runs cases, what reads them and what draws pages know no study.
#include "tests/rooms.h"

#include <gmock/gmock.h>

#include "coupling/case/study.h"

namespace grainfield::testing {
namespace {

// From the bottom up: a room knows only rooms above its line. Files beside the rooms (fields,
// the version, names that do not exist) know none.
const std::vector<Room>& rooms() {
  static const std::vector<Room> kRooms{
      {"system", {}},
      {"statistics", {}},
      {"averaging", {"statistics"}},
      {"strain", {"averaging", "statistics"}},
      {"structure", {"averaging", "statistics"}},
      {"import", {"averaging", "system"}},
      {"judge", {"statistics"}},
      {"compare", {"averaging", "judge", "statistics"}},
      {"heap", {"averaging", "statistics"}},
      {"output", {"compare", "judge", "system"}},
      {"elastic_constants", {"averaging", "output", "statistics", "system"}},
      {"report", {"averaging", "judge", "output", "system"}},
      {"models", {"averaging", "compare", "output"}},
      {"case", {"models", "output", "system"}},
      {"export", {"output", "report", "structure"}},
      {"run",
       {"averaging", "case", "compare", "export", "judge", "output", "report", "statistics",
        "structure", "system"}},
      {"observe",
       {"averaging", "case", "compare", "heap", "import", "models", "output", "report", "run"}},
      {"fit",
       {"averaging", "case", "compare", "heap", "judge", "models", "observe", "output", "report",
        "run", "statistics", "structure"}},
      // Each study by itself, and what it takes from others of its kind.
      {"studies/sample/simulation", {}},
      {"studies/point_load",
       {"averaging", "case", "compare", "elastic_constants", "fit", "judge", "models", "observe",
        "output", "report", "run"}},
      {"studies/pile",
       {"averaging", "case", "compare", "fit", "heap", "models", "observe", "output", "report",
        "run", "statistics"}},
      {"studies/pile_fields",
       {"averaging", "case", "elastic_constants", "heap", "judge", "output", "report", "run",
        "statistics", "strain", "structure", "studies/pile"}},
      {"studies/cone",
       {"averaging", "case", "compare", "heap", "judge", "models", "observe", "output", "report",
        "run", "studies/pile", "studies/sample/simulation"}},
      {"studies/lattice_pile", {"case", "compare", "models", "output", "report", "run"}},
      {"studies/sample",
       {"averaging", "case", "compare", "elastic_constants", "judge", "output", "report", "run",
        "statistics", "strain", "structure", "studies/sample/simulation"}},
      {"studies/pair", {"case", "output", "report", "run"}},
      {"studies/hard_disks", {"case", "judge", "output", "report", "run"}},
      {"studies/implicit_settling", {"case", "output", "report", "run", "studies/lattice_pile"}},
      {"studies/hard_to_soft", {"case", "output", "report", "run"}},
      {"studies/solvers", {"averaging", "case", "models", "run", "studies/point_load"}},
      {"studies/wedge",
       {"averaging", "case", "heap", "judge", "models", "output", "report", "run",
        "studies/point_load"}},
      {"studies", {"case"}},
      {"files",
       {"averaging", "case", "compare", "fit", "heap", "import", "judge", "models", "observe",
        "output", "run", "strain", "studies/pile", "studies/point_load"}},
      {"app",
       {"averaging", "case", "export", "files", "import", "judge", "models", "output", "run",
        "structure", "system"}},
      {"python",
       {"app", "averaging", "case", "compare", "files", "fit", "import", "judge", "models",
        "output", "run", "structure", "system"}},
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
  for (const char* room : {"case", "run", "report", "models", "output", "averaging", "heap"}) {
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
