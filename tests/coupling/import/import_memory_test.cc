// Import goes through fixed buffers: the most bytes in use do not grow with the number of steps.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "coupling/import/import.h"
#include "tests/coupling/import_scene.h"
#include "tests/coupling/program.h"

namespace {
std::atomic<long> in_use{0}, most{0};
}  // namespace

void* operator new(std::size_t size) {
  void* const p = std::malloc(size > 0 ? size : 1);
  if (!p) throw std::bad_alloc();
  const long now = in_use += static_cast<long>(malloc_usable_size(p));
  if (now > most) most = now;
  return p;
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* p) noexcept {
  if (p) in_use -= static_cast<long>(malloc_usable_size(p));
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept { operator delete(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { operator delete(p); }

namespace grainfield::coupling {
namespace {

struct Use {
  long bytes;  ///< at most, beyond those before
  long files;  ///< size of the files
};

Use import_steps(int steps, bool all) {
  const testing::Folder folder;
  ImportOptions options;
  options.format = "lammps";
  options.columns = {"i,j=c_ids[1..2]", "fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]"};
  options.all_steps = all;
  long size = 0;
  {
    const dem::Snapshot ours = test::overlapping_layer(7, 12, 6);
    std::string grains, contacts;
    for (long step = 0; step < steps; ++step) {
      grains += test::dump_grains(ours, step, false);
      contacts += test::lammps_contacts(ours, step);
    }
    size = static_cast<long>(grains.size() + contacts.size());
    options.files = {folder.write("g", grains), folder.write("c", contacts)};
  }
  const long before = in_use;
  most = before;
  int met = 0;
  import_snapshots(options, [&](ImportedSnapshot&& imported) {
    EXPECT_EQ(imported.snapshot.grains.size(), 72u);
    ++met;
  });
  EXPECT_EQ(met, all ? steps : 1);
  return {most - before, size};
}

TEST(ImportMemory, DoesNotGrowWithTheFiles) {
  for (const bool all : {true, false}) {
    const Use few = import_steps(2, all), many = import_steps(102, all);
    ASSERT_GT(many.files - few.files, 1500000);
    // What grows is the list of the steps: a few hundred bytes each.
    EXPECT_LT(many.bytes - few.bytes, (many.files - few.files) / 15) << all;
    // A buffer of 1 MiB for each file, and one step.
    EXPECT_LT(many.bytes, 3'000'000) << all;
  }
}

}  // namespace
}  // namespace grainfield::coupling
