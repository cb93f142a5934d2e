// Where an installation is looked for.
#include "continuum/installed.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace grainfield::continuum {
namespace {

TEST(InstalledPrefixes, AreAboveTheProgramUnlessTheEnvironmentSays) {
  unsetenv("GRAINFIELD_PREFIX");
  const auto own = installed_prefixes();
  ASSERT_EQ(own.size(), 1U);
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  EXPECT_EQ(own[0], program.parent_path().parent_path());
  setenv("GRAINFIELD_PREFIX", "/opt/grainfield", 1);
  const auto given = installed_prefixes();
  unsetenv("GRAINFIELD_PREFIX");
  ASSERT_EQ(given.size(), 1U);
  EXPECT_EQ(given[0], "/opt/grainfield");
}

}  // namespace
}  // namespace grainfield::continuum
