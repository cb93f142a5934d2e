// Files that Python's VTK 9.1 has written (vtk/write_files.py): four spheres, three contacts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/import/import.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

dem::Snapshot read(const std::vector<std::string>& names) {
  ImportOptions options;
  options.format = "vtk";
  options.density = 2500;
  options.dim = 3;
  for (const std::string& name : names)
    options.files.push_back(GRAINFIELD_SOURCES "/tests/coupling/import/vtk/" + name);
  dem::Snapshot out;
  import_snapshots(options, [&](ImportedSnapshot&& one) { out = std::move(one.snapshot); });
  return out;
}

void expect_column(const dem::Snapshot& s, const std::string& form) {
  ASSERT_EQ(s.grains.size(), 4u) << form;
  EXPECT_EQ(s.grains[3].id, 15) << form;
  EXPECT_EQ(s.grains[3].position, dem::Vec3(0, 0, 0.034965)) << form;
  ASSERT_EQ(s.contacts.size(), 3u) << form;
  EXPECT_EQ(s.contacts[0].force, dem::Vec3(0, 0, -3)) << form;
  EXPECT_EQ(s.contacts[2].j, 3) << form;
}

TEST(ImportVtk, EveryFormThatVtkWrites) {
  for (const char* form : {"ascii.vtp", "bin.vtp", "binz.vtp", "raw.vtp", "rawz.vtp", "base.vtp",
                           "basez.vtp", "a42.vtk", "a51.vtk", "b42.vtk", "b51.vtk"}) {
    expect_column(read({std::string("g_") + form, std::string("c_") + form}), form);
    // One file: lines between the grains.
    expect_column(read({std::string("b_") + form}), form);
  }
}

// Never more, never less: a file that is cut off anywhere, or has a byte of another value.
TEST(ImportVtk, DamagedFilesAreRefusedOrRead) {
  const testing::Folder folder;
  for (const char* form : {"raw.vtp", "basez.vtp", "b42.vtk", "a51.vtk"}) {
    const std::string bytes =
        testing::read_text(GRAINFIELD_SOURCES "/tests/coupling/import/vtk/b_" + std::string(form));
    for (std::size_t cut = 1; cut < bytes.size(); cut += 37) {
      std::string changed = bytes;
      changed[cut] = static_cast<char>(changed[cut] ^ 0x11);
      for (const std::string& text : {bytes.substr(0, cut), changed}) {
        ImportOptions options;
        options.format = "vtk";
        options.density = 2500;
        options.dim = 3;
        options.files = {folder.write(form, text)};
        try {
          import_snapshots(options, [](ImportedSnapshot&&) {});
        } catch (const std::invalid_argument& e) {
          EXPECT_THAT(e.what(), ::testing::HasSubstr(form));
        }
      }
    }
  }
}

}  // namespace
}  // namespace grainfield::coupling
