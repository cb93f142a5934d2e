// The main function of every room's program of suites: `dem_engine disk_test` runs the suites of
// disk_test.cc alone, `dem_engine` those of all its files. GoogleTest's own flags go with both.
#include <gmock/gmock.h>

#include <cstdio>
#include <set>
#include <string>

namespace {

std::string file_of(const testing::TestInfo& test) {
  std::string path = test.file();
  path.erase(0, path.find_last_of('/') + 1);
  return path.substr(0, path.rfind('.'));
}

/// Excludes the tests of other files, whatever the filter lets through. Returns whether some are
/// left; not where another file has a test of the same name, which the filter cannot distinguish.
bool keep_file(const std::string& name) {
  std::set<std::string> kept, excluded;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestInfo& test = *suite.GetTestInfo(t);
      auto& names = file_of(test) == name ? kept : excluded;
      names.insert(std::string(suite.name()) + "." + test.name());
    }
  }
  std::string filter = GTEST_FLAG_GET(filter);
  char before = filter.find('-') == std::string::npos ? '-' : ':';
  for (const std::string& test : excluded) {
    if (kept.count(test) > 0) {
      std::fprintf(stderr, "%s: another file of the room has this test, too\n", test.c_str());
      return false;
    }
    filter += before + test;
    before = ':';
  }
  GTEST_FLAG_SET(filter, filter);
  return !kept.empty();
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  if (argc > 2 || (argc == 2 && !keep_file(argv[1]))) {
    std::fprintf(stderr, "%s: no file of suites: %s; allowed: one NAME_test without its ending\n",
                 argv[0], argv[argc - 1]);
    return 2;
  }
  return RUN_ALL_TESTS();
}
