// Spheres settled by YADE in a box of facets, which have the lowest numbers and are the first body
// of their contacts: stress, forces and weight of the import beside those that YADE computes
// itself.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <sstream>

#include "coupling/import/import.h"
#include "dem/snapshot/snapshot.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;
using ::testing::HasSubstr;

// Share of the largest: sums of some dozens of numbers of 17 digits, in another order.
constexpr double kDigits = 1e-13;
// Share of the largest: each number has six digits.
constexpr double kSixDigits = 1e-4;

class YadeBox : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (std::system("command -v yade > /dev/null") != 0) return;
    folder_ = std::make_unique<testing::Folder>();
    const std::string command = fmt::format(
        "cd {0} && cp {1}/yade_export.py {1}/yade_box.py . && yade -n -x yade_box.py > out 2>&1",
        folder_->path(), GRAINFIELD_SOURCES "/tests/oracles");
    EXPECT_EQ(std::system(command.c_str()), 0) << testing::read_text(*folder_ / "out");
    std::istringstream out(testing::read_text(*folder_ / "out"));
    for (std::string line, word; std::getline(out, line);) {
      std::istringstream fields(line);
      fields >> word;
      std::string name;
      if (word == "wall") {
        fields >> name;
        walls_ += " --wall " + name;
      } else if (word == "force") {
        Vec3& force = sides_[(fields >> name, name)];
        fields >> force.x() >> force.y() >> force.z();
      } else if (word == "body") {
        std::int64_t id = 0;
        fields >> id;
        Vec3& force = forces_[id];
        fields >> force.x() >> force.y() >> force.z();
      } else if (word == "weight") {
        fields >> weight_;
      } else if (word == "stress") {
        for (int k = 0; k < 9; ++k) fields >> stress_(k / 3, k % 3);
      }
    }
  }
  static void TearDownTestSuite() { folder_.reset(); }

  void SetUp() override {
    if (!folder_) GTEST_SKIP() << "yade not found: the Debian package yade has it";
    ASSERT_EQ(forces_.size(), 71u);
    ASSERT_EQ(sides_.size(), 6u);
  }

  static dem::Snapshot import(const std::string& files) {
    const std::string at = folder_->path() + "/";
    const testing::Output done = testing::program(
        "import --from yade " + files + walls_ + " -o " + at + "packing.h5", "cd " + at + " &&");
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("71 grains (0 fixed)"));
    return dem::read_snapshot(at + "packing.h5", "/packing");
  }

  /// Compares all that YADE says, to `share` of the largest.
  static void expect_as_in_yade(const dem::Snapshot& s, double share) {
    std::vector<Vec3> resultants(s.grains.size(), Vec3::Zero());
    std::map<std::string, Vec3> sides;
    for (const dem::Wall& wall : s.walls) sides[wall.name] = Vec3::Zero();
    double largest = 0;
    for (const dem::Contact& c : s.contacts) {
      resultants[static_cast<std::size_t>(c.i)] += c.force;
      if (c.j >= 0) resultants[static_cast<std::size_t>(c.j)] -= c.force;
      if (c.j < 0) sides.at(s.walls[static_cast<std::size_t>(-1 - c.j)].name) += c.force;
      largest = std::max(largest, c.force.norm());
    }
    for (std::size_t g = 0; g < s.grains.size(); ++g)
      EXPECT_LE((resultants[g] - forces_.at(s.grains[g].id)).norm(), share * largest)
          << s.grains[g].id;
    for (const auto& [name, force] : sides_)
      EXPECT_LE((sides.at(name) - force).norm(), share * weight_) << name;
    const PackingCheck check = check_packing(s);
    EXPECT_NEAR(check.support_ratio * weight_,
                (sides_.at("floor") + sides_.at("left") + sides_.at("right") + sides_.at("front") +
                 sides_.at("back"))
                    .z(),
                share * weight_);
    EXPECT_LE((check.pairs + check.walls - stress_).cwiseAbs().maxCoeff(),
              share * stress_.cwiseAbs().maxCoeff());
  }

  static inline std::unique_ptr<testing::Folder> folder_;
  static inline std::string walls_;
  static inline std::map<std::string, Vec3> sides_;    // forces of the walls on the spheres, N
  static inline std::map<std::int64_t, Vec3> forces_;  // of contacts, by the sphere's number, N
  static inline Eigen::Matrix3d stress_ = Eigen::Matrix3d::Zero();  // times volume, N m
  static inline double weight_ = 0;                                 // N
};

TEST_F(YadeBox, StressForcesAndWeightToTheDigits) {
  const dem::Snapshot s = import("bodies.txt interactions.txt");
  expect_as_in_yade(s, kDigits);
  // The sphere above the edge of two facets has a contact with each.
  int at_floor = 0;
  for (const dem::Contact& c : s.contacts) at_floor += c.i == 0 && c.j < 0;
  EXPECT_EQ(at_floor, 2);
}

TEST_F(YadeBox, SixDigitsOfTextExt) {
  expect_as_in_yade(import("spheres.txt interactions.txt --density 2600"), kSixDigits);
}

}  // namespace
}  // namespace grainfield::coupling
