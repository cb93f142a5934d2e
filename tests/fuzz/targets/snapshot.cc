// HDF5 files as `info` looks at them, and what every command asks of a snapshot first.
#include "dem/snapshot/snapshot.h"

#include "coupling/app/terminal.h"
#include "coupling/import/import.h"
#include "coupling/import/packing_warnings.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_snapshot(std::string_view bytes) {
  const InputFile file(bytes);
  std::vector<std::string> groups;
  attempt([&] { groups = dem::list_snapshots(file.path()); });
  for (const std::string& group : groups) {
    attempt([&] {
      const dem::Snapshot s = dem::read_snapshot(file.path(), group);
      coupling::cell_text(s.cell);
      coupling::warnings_of(coupling::check_packing(s));
      coupling::strange_units(s);
    });
  }
}

const Registration snapshot_is_there("snapshot", fuzz_snapshot);

}  // namespace
}  // namespace grainfield::fuzz
