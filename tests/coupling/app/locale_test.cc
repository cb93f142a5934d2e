// Numbers are read and written alike in a locale with a comma as decimal point, in the program and
// in a process that has set it, as Python's may.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <locale>
#include <regex>

#include "coupling/case/case.h"
#include "coupling/result/field_file.h"
#include "coupling/tasks/measured_field.h"
#include "dem/shared/number.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::contents;
using testing::Folder;
using ::testing::IsEmpty;
using testing::Output;
using testing::program;

constexpr const char* kLocale = "de_DE.UTF-8";

// A folder with a locale of its own, so that none has to be installed (package locales).
class Locale : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    const std::string made = *folder_ / kLocale;
    const std::string command = "localedef -i de_DE -f UTF-8 " + made + " > /dev/null 2>&1";
    good_ = std::system(command.c_str()) == 0 && std::filesystem::exists(made);
  }
  static void TearDownTestSuite() {
    std::setlocale(LC_ALL, "C");
    std::locale::global(std::locale::classic());
    delete folder_;
  }
  void SetUp() override {
    ASSERT_TRUE(good_) << "localedef -i de_DE -f UTF-8 FOLDER failed: install the package locales";
  }
  static std::string environment() { return "LOCPATH=" + folder_->path() + " LC_ALL=" + kLocale; }

  static Folder* folder_;
  static bool good_;
};
Folder* Locale::folder_ = nullptr;
bool Locale::good_ = false;

const std::string kMeasured =
    "x (mm),component,value (kPa),error (kPa)\n-60.5,pressure,0.55,0.05\n-30.5,pressure,0.8,0.05\n"
    "0.5,pressure,1.05,0.05\n30.5,pressure,0.8,0.05\n60.5,pressure,0.55,0.05\n";

TEST_F(Locale, TheProgramsFilesAreTheSame) {
  const Folder folder;
  const std::string file = folder.write("tiny.toml", testing::tiny_case());
  const std::string measured = folder.write("m.csv", kMeasured);
  const auto work = [&](const std::string& name, const std::string& prefix) {
    const std::string out = folder / name;
    for (const std::string& command :
         {"run " + file +
              " --set material.friction=0.25 --set ensemble.realizations=2 --set "
              "output.report=false -o " +
              out + "/run",
          "average " + out + "/run/snapshots.h5:loaded --frame packing --width 0.0125 -o " + out +
              "/field.csv",
          "import-field " + measured + " --height '80.5 mm' --slope 30.5 --rho-g 15000.5 -o " +
              out + "/measured.h5",
          "compare " + out + "/measured.h5 --model osl:eta=0.75,mu=-0.25 bcc -o " + out +
              "/compare",
          std::string("cases")}) {
      const Output said = program(command, prefix);
      EXPECT_EQ(said.code, 0) << command << said.err;
    }
    auto files = contents(out);
    std::erase_if(files, [](const auto& one) {  // pages name their folder
      return one.first.ends_with(".html") || one.first.ends_with("summary.json");
    });
    return files;
  };
  const auto plain = work("plain", "LC_ALL=C"), comma = work("comma", environment());
  EXPECT_GT(plain.size(), 8U);
  for (const auto& [name, text] : plain) {
    if (name.ends_with(".h5")) continue;
    EXPECT_EQ(comma.at(name), text) << name;
  }
}

// A process that has set the locale for C and for C++ streams.
TEST_F(Locale, AProcessMaySetIt) {
  setenv("LOCPATH", folder_->path().c_str(), 1);
  ASSERT_NE(std::setlocale(LC_ALL, kLocale), nullptr);
  std::locale::global(std::locale(kLocale));
  ASSERT_EQ(std::localeconv()->decimal_point, std::string(","));
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number("1.5e-310"), 1.5e-310);  // by another way: subnormal
  EXPECT_EQ(parse_number("1,5"), std::nullopt);
  const Folder folder;
  const Case value = read_case(folder.write("x.toml", testing::tiny_case()), false,
                               {"material.friction=0.25", "packing.radius=\"3.5 mm\""});
  const std::string text = write_case(value);
  EXPECT_NE(text.find("friction = 0.25"), std::string::npos);
  MeasuredRequest request;
  request.file = folder.write("m.csv", kMeasured);
  request.height = 0.0805;
  request.left_deg = request.right_deg = 30.5;
  request.rho_g = 15000.5;
  const Field field = measured_field(request);
  const auto doubts = measured_doubts(field);
  const std::string csv = field_csv(field);
  std::setlocale(LC_ALL, "C");
  std::locale::global(std::locale::classic());
  EXPECT_EQ(measured_doubts(measured_field(request)), doubts);
  EXPECT_EQ(field_csv(measured_field(request)), csv);
}

// What the C library reads and writes goes by the locale: none of it outside of tests.
TEST(LocaleSources, NoneGoByTheLocale) {
  const std::regex banned(
      R"((\bstd::sto(d|f|ld)\b|\bstrto(d|f|ld)\s*\(|\batof\s*\(|\bsscanf\s*\(|\bs?n?printf\s*\(|setprecision))");
  std::vector<std::string> found;
  for (const char* module : {"dem", "continuum", "coupling"}) {
    const std::filesystem::path root = std::filesystem::path(GRAINFIELD_SOURCES) / module;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
      const std::string ending = entry.path().extension();
      if (ending != ".cc" && ending != ".h") continue;
      std::ifstream in(entry.path());
      int number = 0;
      for (std::string line; std::getline(in, line);) {
        ++number;
        if (std::regex_search(line, banned))
          found.push_back(entry.path().filename().string() + ":" + std::to_string(number) + line);
      }
    }
  }
  EXPECT_THAT(found, IsEmpty());
}

}  // namespace
}  // namespace grainfield::coupling
