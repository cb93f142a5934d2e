#include "coupling/base/version.h"

#include "coupling/commit.h"  // generated: write_commit.cmake

namespace grainfield::coupling {

std::string version() { return GRAINFIELD_VERSION; }

std::string version_and_commit() {
  const std::string commit = GRAINFIELD_COMMIT;
  return commit.empty() ? version() : version() + " (" + commit + ")";
}

}  // namespace grainfield::coupling
