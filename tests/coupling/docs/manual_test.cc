// Pages of the manual and completion of bash: what --help lists is in both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "tests/coupling/guide_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::program;
using testing::read_text;

std::vector<std::string> all_matches(const std::string& text, const char* expression) {
  std::vector<std::string> out;
  const std::regex re(expression);
  for (auto at = std::sregex_iterator(text.begin(), text.end(), re); at != std::sregex_iterator();
       ++at) {
    out.push_back((*at)[1]);
  }
  return out;
}

// Commands as --help lists them: two spaces, a name, its meaning.
std::vector<std::string> commands() {
  const std::string help = program("--help").out;
  return all_matches(help.substr(help.find("Subcommands:")), "\n  ([a-z-]+) ");
}

// Options as the command's --help lists them, at the start of a line.
std::set<std::string> options(const std::string& command) {
  std::set<std::string> out;
  std::istringstream lines(program(command + " --help").out);
  std::string line;
  while (std::getline(lines, line)) {
    if (line.compare(0, 3, "  -") != 0) continue;
    const std::string names = line.substr(0, line.find("  ", 3));
    for (const std::string& name : all_matches(names, "(--?[a-zA-Z][a-zA-Z-]*)")) out.insert(name);
  }
  return out;
}

// As man's markup has it.
std::string with_dashes(const std::string& text) {
  return std::regex_replace(text, std::regex("-"), "\\-");
}

TEST(Manual, HasAPageForEveryCommandWithEveryOption) {
  const Folder folder;
  ASSERT_EQ(program("manual -o " + (folder / "m")).code, 0);
  const std::vector<std::string> names = commands();
  EXPECT_GT(names.size(), 14U);
  EXPECT_THAT(names, Not(::testing::Contains("manual")));  // for who builds packages
  const std::string whole = read_text(folder / "m/man1/grainfield.1");
  const std::string completion = read_text(folder / "m/completions/grainfield");
  std::size_t found = 0;
  for (const std::string& name : names) {
    EXPECT_THAT(whole, HasSubstr("grainfield " + with_dashes(name)));
    const std::string page = read_text(folder / "m/man1/grainfield-" + name + ".1");
    EXPECT_THAT(page, HasSubstr(".SH EXIT STATUS")) << name;
    const std::size_t row = completion.find("    " + name + ") options=\"");
    ASSERT_NE(row, std::string::npos) << name;
    const std::string offered =
        " " +
        completion.substr(row + name.size() + 15,
                          completion.find("\";", row) - row - name.size() - 15) +
        " ";
    const std::set<std::string> all = options(name);
    EXPECT_TRUE(all.count("--help")) << name;
    found += all.size();
    for (const std::string& option : all) {
      EXPECT_THAT(page, HasSubstr("\\fB" + with_dashes(option) + "\\fR")) << name;
      EXPECT_THAT(offered, HasSubstr(" " + option + " ")) << name;
    }
  }
  EXPECT_GT(found, 100U);
}

TEST(Manual, PagesOfCommandsAndColumnsAreCurrent) {
  const Folder folder;
  ASSERT_EQ(program("manual -o " + (folder / "m")).code, 0);
  for (const std::string page : {"commands.md", "columns.md"}) {
    EXPECT_EQ(read_text(test::kDocs + page), read_text(folder / "m/pages/" + page))
        << "regenerate: grainfield manual -o DIR, then DIR/pages/" << page << " to docs/";
  }
  const std::string page = read_text(folder / "m/pages/commands.md");
  for (const std::string& name : commands()) {
    EXPECT_THAT(page, HasSubstr("\n## " + name + "\n"));
    for (const std::string& option : options(name)) {
      EXPECT_THAT(page.substr(page.find("\n## " + name + "\n")), HasSubstr("`" + option + "`"));
    }
  }
}

TEST(Manual, ManReadsItWithoutAWarning) {
  if (std::system("command -v man > /dev/null 2>&1") != 0) GTEST_SKIP() << "no man here";
  const Folder folder;
  ASSERT_EQ(program("manual -o " + (folder / "m")).code, 0);
  for (const std::string& name : commands()) {
    const std::string page = folder / "m/man1/grainfield-" + name + ".1";
    const std::string command = "MANWIDTH=100 LC_ALL=C.UTF-8 man -l --warnings " + page + " > " +
                                (folder / "text") + " 2> " + (folder / "log");
    EXPECT_EQ(std::system(command.c_str()), 0) << name;
    EXPECT_EQ(read_text(folder / "log"), "") << name;
    EXPECT_THAT(read_text(folder / "text"), HasSubstr("grainfield")) << name;
  }
}

// What bash offers after these words, sorted.
std::string offered(const Folder& folder, const std::string& words) {
  const int count = static_cast<int>(std::count(words.begin(), words.end(), ' '));
  const std::string script = "source " + (folder / "m/completions/grainfield") + "\ncd " +
                             folder.path() + "\nCOMP_WORDS=(" + GRAINFIELD_PROGRAM + " " + words +
                             ")\nCOMP_CWORD=" + std::to_string(count + 1) +
                             "\n_grainfield\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
  folder.write("ask.sh", script);
  std::system(("bash " + (folder / "ask.sh") + " > " + (folder / "answer") + " 2>&1").c_str());
  return read_text(folder / "answer");
}

TEST(Completion, OffersCommandsOptionsCasesModelsAndFiles) {
  const Folder folder;
  ASSERT_EQ(program("manual -o " + (folder / "m")).code, 0);
  EXPECT_EQ(offered(folder, "str"), "strain\nstructure\n");
  EXPECT_EQ(offered(folder, "fit --hei"), "--heights\n");
  EXPECT_EQ(offered(folder, "run osl-w"), "osl-wedge\n");
  EXPECT_EQ(offered(folder, "model flam"), "flamant\n");
  EXPECT_EQ(offered(folder, "compare x.h5 --model boussi"), "boussinesq\n");
  EXPECT_EQ(offered(folder, "keys pile"), "pile\npile-fields\n");
  EXPECT_EQ(offered(folder, "export x.h5 --to v"), "vtu\n");
  EXPECT_EQ(offered(folder, "export x.h5 --to "), "lammps\nvtu\ncsv\nhtml\nsvg\npng\n");
  EXPECT_EQ(offered(folder, "import --from "), "lammps\nliggghts\nyade\ncsv\nmercury\nvtk\n");
  EXPECT_EQ(offered(folder, "import --units "), "m\ncm\nmm\num\ncgs\nmicro\nnano\n");
  EXPECT_EQ(offered(folder, "average --frame "), "layer\nheap\npacking\n");
  EXPECT_EQ(offered(folder, "average --kernel "), "lucy\ngaussian\nheaviside\ncircle\nsquare\n");
  EXPECT_EQ(offered(folder, "import-field --geometry l"), "layer\n");
  EXPECT_EQ(offered(folder, "import-field --dim "), "2\n3\n");
  folder.write("mine.h5", "");
  EXPECT_EQ(offered(folder, "export --group mi"), "mine.h5\n");
  EXPECT_EQ(offered(folder, "info min"), "mine.h5\n");
}

TEST(Samples, AreListedAndCopied) {
  const Folder folder;
  const testing::Output list = program("samples");
  ASSERT_EQ(list.code, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("heaps.h5       2D, 4 states"));
  EXPECT_THAT(list.out, HasSubstr("layer.h5       2D, 8 states"));
  EXPECT_THAT(list.out, HasSubstr("box.h5         3D"));
  ASSERT_EQ(program("samples -o " + (folder / "s")).code, 0);
  for (const char* name : {"heaps.h5", "layer.h5", "box.h5", "measured.csv"}) {
    EXPECT_EQ(read_text(folder / "s/" + name),
              read_text(std::string(GRAINFIELD_CASES) + "/samples/" + name));
  }
  // What the user has there under that name stays.
  testing::fs::create_directories(folder / "own");
  folder.write("own/box.h5", "mine");
  const testing::Output refused = program("samples -o " + (folder / "own"));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("box.h5"));
  EXPECT_EQ(read_text(folder / "own/box.h5"), "mine");
}

}  // namespace
}  // namespace grainfield::coupling
