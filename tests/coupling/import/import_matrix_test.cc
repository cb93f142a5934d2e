// Every dialect with every habit: what is read equals the packing that was written, and what cannot
// be read is refused by naming what the files lack.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <optional>

#include "dem/snapshot/displacements.h"
#include "tests/coupling/import_matrix_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using test::Dialect;
using test::Habit;

struct Seen {
  std::optional<dem::Snapshot> before, after;
  std::string refused;
};

std::optional<dem::Snapshot> read(const test::Written& written, std::string& refused) {
  const testing::Folder folder;
  ImportOptions options = written.options;
  for (const auto& [name, text] : written.files) options.files.push_back(folder.write(name, text));
  std::optional<dem::Snapshot> out;
  try {
    import_snapshots(options, [&](ImportedSnapshot&& one) { out = std::move(one.snapshot); });
  } catch (const std::invalid_argument& e) {
    refused = e.what();
  }
  return out;
}

Seen see(Dialect dialect, Habit habit, const test::Motion& motion) {
  Seen out;
  out.before = read(test::write_as(dialect, habit, motion, false), out.refused);
  if (!out.refused.empty()) return out;
  out.after = read(test::write_as(dialect, habit, motion, true), out.refused);
  return out;
}

Eigen::Matrix3d fabric(const dem::Snapshot& s) {
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  for (const dem::Contact& c : s.contacts) out += c.normal * c.normal.transpose();
  return out / static_cast<double>(s.contacts.size());
}

// Relative to the largest component.
double difference(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const double scale = std::max(b.cwiseAbs().maxCoeff(), 1e-300);
  return (a - b).cwiseAbs().maxCoeff() / scale;
}

// Empty: equal.
std::string difference(const dem::Snapshot& found, const dem::Snapshot& ours, double tolerance) {
  if (found.dim != ours.dim) return "dimension";
  if (found.grains.size() != ours.grains.size())
    return fmt::format("{} grains of {}", found.grains.size(), ours.grains.size());
  if (found.contacts.size() != ours.contacts.size())  // the coordination number
    return fmt::format("{} contacts of {}", found.contacts.size(), ours.contacts.size());
  const PackingCheck a = check_packing(found), b = check_packing(ours);
  const double pairs = difference(a.pairs, b.pairs);
  if (!(pairs <= tolerance)) return fmt::format("stress of the pairs off by {:g}", pairs);
  const double walls = ours.walls.empty() ? 0 : difference(a.walls, b.walls);
  if (!(walls <= tolerance)) return fmt::format("stress of the walls off by {:g}", walls);
  const double directions = difference(fabric(found), fabric(ours));
  if (!(directions <= tolerance)) return fmt::format("fabric off by {:g}", directions);
  return "";
}

// The way between two states, of every grain.
std::string displaced(const Seen& seen, const test::Motion& motion, double tolerance) {
  const dem::Snapshot &before = *seen.before, &after = *seen.after;
  const dem::Displacements displacements(before, after);
  for (std::size_t g = 0; g < before.grains.size(); ++g) {
    const dem::Vec3 ours = motion.after.grains[g].position - motion.before.grains[g].position;
    const double off = (displacements.of(g) - ours).norm();
    if (!(off <= tolerance)) return fmt::format("displacement of grain {} off by {:g} m", g, off);
  }
  return "";
}

// Whether the files of the combination tell images.
bool tells_images(Dialect, Habit habit, const test::Motion& motion) {
  return !motion.before.cell.is_periodic() || habit == Habit::unwrapped ||
         habit == Habit::image_flags;
}

TEST(ImportMatrix, EveryDialectWithEveryHabit) {
  int tried = 0, good = 0, refused = 0;
  std::vector<std::string> wrong;
  for (const test::Motion& motion : test::motions())
    for (const Dialect dialect : test::dialects())
      for (const Habit habit : test::habits()) {
        if (!test::exists(dialect, habit, motion)) continue;
        ++tried;
        const std::string name =
            fmt::format("{}, {}, {}", motion.name, test::name_of(dialect), test::name_of(habit));
        const Seen seen = see(dialect, habit, motion);
        if (!seen.refused.empty()) {
          ++refused;
          // Nothing that these files hold should be refused.
          wrong.push_back(name + ": refused: " + seen.refused);
          continue;
        }
        // Six digits: half a unit of the sixth of each of a force, a place and a radius.
        const bool rounded = habit == Habit::six_digits;
        const double tolerance = rounded ? 1e-4 : 1e-12;
        std::string text = difference(*seen.before, motion.before, tolerance);
        if (text.empty()) text = difference(*seen.after, motion.after, tolerance);
        const double length = 0.1;  // m, of the packings
        if (text.empty() && tells_images(dialect, habit, motion))
          text = displaced(seen, motion, (rounded ? 1e-5 : 1e-14) * length);
        if (text.empty())
          ++good;
        else
          wrong.push_back(name + ": " + text);
      }
  std::cout << fmt::format("{} combinations, {} equal, {} refused\n", tried, good, refused);
  for (const std::string& text : wrong) ADD_FAILURE() << text;
  EXPECT_GE(tried, 300);
  EXPECT_GE(good, 270);
}

// Ids that were printed alike are never guessed.
TEST(ImportMatrix, AmbiguousIdsAreRefused) {
  const test::Motion motion = test::motions().front();
  test::Written written = test::write_as(Dialect::lammps, Habit::ids_beyond_million, motion, false);
  std::string& contacts = written.files[1].second;
  // "3000012" as LAMMPS' %g prints it.
  std::size_t at = 0;
  while ((at = contacts.find(" \n3", at)) != std::string::npos) {
    contacts.replace(at + 2, 7, "3.00001e+06");
    ++at;
  }
  std::string refused;
  EXPECT_FALSE(read(written, refused));
  EXPECT_THAT(refused, ::testing::HasSubstr("printed without its last digits"));
  EXPECT_THAT(refused, ::testing::HasSubstr("format"));
}

}  // namespace
}  // namespace grainfield::coupling
