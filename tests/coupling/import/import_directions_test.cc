// Forces that files give as sizes: directions, their lengths, and which body is the first.
#include <gmock/gmock.h>

#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;
using ::testing::HasSubstr;
using testing::Outcome;

class ImportDirections : public testing::ImportOfFiles {
 protected:
  // A grain on the floor and one above it.
  Outcome contact(const std::string& format, const std::string& rows) {
    const std::string separated = format == "csv" ? "id,x,y,z,radius,mass\n1,0,0,0.0049,0.005,1\n"
                                                    "2,0,0,0.0148,0.005,1\n"
                                                  : "# id x y z r mass\n1 0 0 0.0049 0.005 1\n"
                                                    "2 0 0 0.0148 0.005 1\n";
    return import(format, {write("g", separated), write("c", rows)}, [](ImportOptions& o) {
      o.dim = 3;
      o.walls.push_back(parse_wall("floor:z=0:ids=9"));
    });
  }
  static Vec3 force(const Outcome& outcome) {
    const auto& s = only(outcome).snapshot;
    EXPECT_EQ(s.contacts.size(), 1u);
    return s.contacts.empty() ? Vec3::Zero() : s.contacts[0].force;
  }
  const std::string names_ = "i,j,fn,ft,nx,ny,nz,tx,ty,tz\n";
};

TEST_F(ImportDirections, AWallMayStandFirst) {
  const Vec3 grain_first = force(contact("csv", names_ + "1,9,3,0.5,0,0,-1,1,0,0\n")),
             wall_first = force(contact("csv", names_ + "9,1,3,0.5,0,0,1,-1,0,0\n"));
  EXPECT_EQ(grain_first, Vec3(0.5, 0, 3));
  EXPECT_EQ(wall_first, grain_first);
}

TEST_F(ImportDirections, NormalsOfAnyLengthAreDirections) {
  const Vec3 right = force(contact("csv", names_ + "1,2,3,0.5,0,0,1,1,0,0\n"));
  EXPECT_EQ(right, Vec3(0.5, 0, -3));
  EXPECT_EQ(force(contact("csv", names_ + "1,2,3,0.5,0,0,2,1,0,0\n")), right);
  const Outcome long_one = contact("csv", "i,j,fx,fy,fz,nx,ny,nz\n1,2,0,0,-3,0,0,2\n");
  EXPECT_NEAR(only(long_one).snapshot.contacts[0].point.z(), 0.00985, 1e-15);
}

TEST_F(ImportDirections, TangentsThatAreNoneAreRefused) {
  for (const char* tangent : {"3,0,0", "0,0,1", "0.001,0,0"})
    EXPECT_THAT(contact("csv", names_ + "1,2,3,0.5,0,0,1," + tangent + "\n").refused,
                HasSubstr("allowed: 1 at 90 degrees"))
        << tangent;
  // Without a size it needs none.
  EXPECT_EQ(force(contact("csv", names_ + "1,2,3,0,0,0,1,0,0,0\n")), Vec3(0, 0, -3));
}

// YADE's shear force acts on the second body, and fn pushes as anywhere.
TEST_F(ImportDirections, YadesTangentsActOnTheSecond) {
  const std::string names = "# id1 id2 fn ft nx ny nz tx ty tz\n";
  EXPECT_EQ(force(contact("yade", names + "1 2 3 0.5 0 0 1 1 0 0\n")), Vec3(-0.5, 0, -3));
  const std::string parts = "# id1 id2 fnx fny fnz ftx fty ftz\n";
  EXPECT_EQ(force(contact("yade", parts + "1 2 0 0 3 0.5 0 0\n")), Vec3(-0.5, 0, -3));
  EXPECT_EQ(force(contact("yade", names + "9 1 3 0.5 0 0 1 1 0 0\n")), Vec3(0.5, 0, 3));
}

TEST_F(ImportDirections, ShearForcesHaveTheirNames) {
  EXPECT_EQ(force(contact("csv", "i,j,fnx,fny,fnz,fsx,fsy,fsz\n1,2,0,0,-3,0.5,0,0\n")),
            Vec3(0.5, 0, -3));
  EXPECT_THAT(contact("csv", "i,j,fn,nx,ny,nz\n1,2,3,0,0,1\n").refused,
              HasSubstr("without friction: --column ft=0"));
}

}  // namespace
}  // namespace grainfield::coupling
