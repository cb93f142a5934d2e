// Lists mean the same in all commands, and files what their endings say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/app/list_words.h"
#include "coupling/models/parse_choices.h"
#include "coupling/result/tables.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::ElementsAre;
using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;
using ::testing::StartsWith;

struct Lists {
  std::vector<std::string> files, models, sets;
  std::vector<double> heights;
  double width = 0;
};

Lists parsed(const std::vector<std::string>& words) {
  CLI::App app;
  Lists out;
  app.add_option("inputs", out.files)->required();
  app.add_option("--model", out.models)->allow_extra_args(false);
  app.add_option("--set", out.sets)->allow_extra_args(false);
  app.add_option("--heights", out.heights)->delimiter(',');
  app.add_option("--width", out.width);
  std::vector<std::string> spread = spread_lists(app, words);
  std::reverse(spread.begin(), spread.end());
  app.parse(spread);
  return out;
}

TEST(AppLists, OneMeaningForEveryForm) {
  using Words = std::vector<std::string>;
  for (const Words& words :
       {Words{"x.h5", "--model", "osl", "--model", "bcc"}, Words{"x.h5", "--model", "osl", "bcc"},
        Words{"--model", "osl", "bcc", "x.h5"}, Words{"--model=osl", "bcc", "--width", "2", "x.h5"},
        Words{"--width", "2", "--model", "osl", "--model", "bcc", "--", "x.h5"}}) {
    const Lists lists = parsed(words);
    EXPECT_THAT(lists.models, ElementsAre("osl", "bcc"));
    EXPECT_THAT(lists.files, ElementsAre("x.h5"));
  }
  EXPECT_THAT(parsed({"x.h5", "--set", "a=1", "b=[2, 3]"}).sets, ElementsAre("a=1", "b=[2, 3]"));
  EXPECT_THAT(parsed({"x.h5", "--set", "a=1,b=2"}).sets, ElementsAre("a=1", "b=2"));
  EXPECT_THAT(parsed({"--set", "a=1", "case"}).files, ElementsAre("case"));
  EXPECT_THAT(parsed({"x.h5", "--heights", "0.1", "0.5"}).heights, ElementsAre(0.1, 0.5));
  EXPECT_THAT(parsed({"--heights", "0.1,0.5", "x.h5", "y.h5:g"}).files,
              ElementsAre("x.h5", "y.h5:g"));
  // The last word of a command without inputs is its input.
  EXPECT_THAT(parsed({"--model", "osl", "heap"}).files, ElementsAre("heap"));
}

TEST(AppLists, CommasPartSettingsAndModels) {
  EXPECT_THAT(split_settings("a=1,b=\"x,c=2\",d=[1,2],e=,f"),
              ElementsAre("a=1", "b=\"x,c=2\"", "d=[1,2]", "e=,f"));
  EXPECT_THAT(split_choices("osl,bcc"), ElementsAre("osl", "bcc"));
  EXPECT_THAT(split_choices("osl:eta=0.7,mu=-0.3,bcc,b=bcc"),
              ElementsAre("osl:eta=0.7,mu=-0.3", "bcc", "b=bcc"));
}

TEST(AppLists, ThePrograms) {
  const Folder folder;
  const std::string points = folder.write("p.csv", "x,y\n0.1,-0.5\n");
  const std::string same = "model flamant --points " + points + " ";
  const Output one = program(same + "--set F=2"),
               two = program("model layer --points " + points + " --set F=2 h=1");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(two.code, 0) << two.err;
  EXPECT_EQ(two.out, program("model layer --points " + points + " --set F=2,h=1").out);
  EXPECT_EQ(two.out, program("model layer --points " + points + " --set F=2 --set h=1").out);
  const std::string check = program("check " + folder.write("t.toml", testing::tiny_case()) +
                                    " --set packing.rows=4 packing.columns=9")
                                .out;
  EXPECT_THAT(check, HasSubstr("of 34 grains"));
}

TEST(AppLists, EndingsSayWhatIsWritten) {
  const Folder folder;
  const std::string measured = folder.write(
      "m.csv", "x (mm),component,value (N/m),error (N/m)\n0,pressure,1,0.1\n10,pressure,0.9,0.1\n");
  const std::string command =
      "import-field " + measured + " --height 0.08 --slope 30 --rho-g 15 --dim 2 -o ";
  EXPECT_EQ(program(command + (folder / "f.csv")).code, 0);
  EXPECT_THAT(
      testing::read_text(folder / "f.csv"),
      ::testing::ContainsRegex("^# frame heap: apex at .*; 1 realization; stresses tension "
                               "positive\nx .m.,y .m.,sigma_yy .N/m.,sigma_yy_error .N/m."));
  const Output refused = program(command + (folder / "f.txt"));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("f.txt, whose ending is \".txt\"; allowed: .h5, .hdf5, .csv"));
  EXPECT_FALSE(testing::fs::exists(folder / "f.txt"));
  EXPECT_EQ(
      program("model flamant --set F=1 --points " + (folder / "f.csv") + " -o " + (folder / "q.h5"))
          .code,
      2);
  // Points are read with their units: what we write, too.
  EXPECT_EQ(program("model flamant --set F=1 --points " + (folder / "f.csv")).code, 0);
  const std::string mm = folder.write("mm.csv", "x (mm),y (mm)\n100,-500\n"),
                    m = folder.write("p.csv", "x,y\n0.1,-0.5\n");
  EXPECT_EQ(program("model flamant --set F=1 --points " + mm).out,
            program("model flamant --set F=1 --points " + m).out);
}

}  // namespace
}  // namespace grainfield::coupling
