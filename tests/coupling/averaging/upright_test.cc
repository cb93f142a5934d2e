// Which way is up follows gravity, the load, or what the user says, in the plane and in space.
#include "coupling/averaging/upright.h"

#include <gmock/gmock.h>

#include "coupling/averaging/layer.h"
#include "coupling/tasks/average_task.h"
#include "tests/coupling/lattice_layer_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::ElementsAre;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Output;
using testing::program;

// The packing with its axes turned: the old axis a becomes sign[a] times the axis to[a].
dem::Snapshot turned(const dem::Snapshot& given, const std::array<int, 3>& to,
                     const std::array<int, 3>& sign) {
  dem::Snapshot s = given;
  const auto turn = [&](dem::Vec3& v) {
    const dem::Vec3 old = v;
    for (std::size_t a = 0; a < 3; ++a) v[to[a]] = sign[a] * old[static_cast<int>(a)];
  };
  turn(s.gravity);
  turn(s.applied_force);
  for (dem::Grain& g : s.grains) turn(g.position);
  for (dem::Contact& c : s.contacts) {
    turn(c.point);
    turn(c.normal);
    turn(c.force);
  }
  for (dem::Wall& w : s.walls) {
    turn(w.point);
    turn(w.normal);
  }
  return s;
}

// Without a cell, whose grains at the sides then lack partners: any packing will do.
dem::Snapshot bounded(int dim) {
  dem::Snapshot s = test::lattice_layer(dim, dim == 2 ? 10 : 5, dim == 2 ? 8 : 5);
  s.cell = {};
  std::erase_if(s.contacts, [](const dem::Contact& c) {
    return c.image != std::array<int, 3>{0, 0, 0};
  });
  s.loaded_grain = s.grains[s.grains.size() / 2].id;
  s.applied_force = -3 * dem::Vec3::Unit(dim - 1);
  return s;
}

AverageRequest request_of(const dem::Snapshot& s, const std::string& frame = "layer") {
  AverageRequest out;
  out.snapshots = {{"x", "loaded", std::make_shared<const dem::Snapshot>(s)}};
  out.frame = frame;
  out.options.width = 0.01;
  out.nx = out.ny = 5;
  out.nz = s.dim == 3 ? 5 : 0;
  return out;
}

void expect_same(const dem::Snapshot& one, const dem::Snapshot& other, const std::string& up = "") {
  AverageRequest asked = request_of(other);
  asked.up = up;
  const Field a = run_average(request_of(one)).front().second;
  const Field b = run_average(asked).front().second;
  EXPECT_TRUE(a.points.isApprox(b.points, 1e-12));
  for (const Column& column : a.columns) {
    if (column.name.find("sigma") == std::string::npos && column.name != "volume_fraction")
      continue;
    const Eigen::VectorXd& there = b.find(column.name)->value;
    for (Eigen::Index k = 0; k < there.size(); ++k) {
      if (std::isnan(column.value[k])) continue;
      EXPECT_NEAR(there[k], column.value[k], 1e-8) << column.name;
    }
  }
}

TEST(Upright, ALayerIsTheSameWhicheverAxisIsUp) {
  const dem::Snapshot plane = bounded(2), space = bounded(3);
  expect_same(plane, turned(plane, {1, 0, 2}, {-1, 1, 1}));   // x up
  expect_same(plane, turned(plane, {0, 1, 2}, {-1, -1, 1}));  // -y up
  expect_same(space, turned(space, {0, 2, 1}, {1, -1, 1}));   // y up, as LAMMPS' users have it
  expect_same(space, turned(space, {1, 2, 0}, {1, 1, 1}));    // x up
  dem::Snapshot weightless = turned(space, {0, 2, 1}, {1, -1, 1});
  weightless.gravity.setZero();
  weightless.applied_force.setZero();
  expect_same(space, weightless, "y");
}

TEST(Upright, LoadsCountAlongGravity) {
  const dem::Snapshot loaded = bounded(3);
  dem::Snapshot unloaded = loaded;
  unloaded.loaded_grain = -1;
  unloaded.applied_force.setZero();
  for (dem::Contact& c : unloaded.contacts) c.force *= 0.5;
  const auto response = [](const dem::Snapshot& before, const dem::Snapshot& after,
                           const std::string& frame, std::vector<std::string>& warnings) {
    AverageRequest request = request_of(after, frame);
    request.response = true;
    request.snapshots.push_back({"x", "unloaded", std::make_shared<const dem::Snapshot>(before)});
    return run_average(request, nullptr, &warnings).front().second;
  };
  const std::array<int, 3> to{0, 2, 1}, sign{1, -1, 1};
  for (const char* frame : {"layer", "packing"}) {
    std::vector<std::string> warnings;
    const Field field =
        response(turned(unloaded, to, sign), turned(loaded, to, sign), frame, warnings);
    EXPECT_EQ(field.number("F"), 3) << frame;
    EXPECT_THAT(warnings, IsEmpty()) << frame;
  }
}

TEST(Upright, WhatNobodySaysIsAskedFor) {
  dem::Snapshot s = bounded(3);
  s.gravity = {0, -5, -8};
  const auto refusal = [](const AverageRequest& request) -> std::string {
    try {
      run_average(request);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(
      refusal(request_of(s)),
      HasSubstr("--up: the packing's gravity is (0, -5, -8), along no axis; say which way is "
                "up: x, -x, y, -y, z or -z"));
  AverageRequest asked = request_of(s);
  asked.up = "z";
  EXPECT_EQ(refusal(asked), "");
  asked.up = "w";
  EXPECT_THAT(refusal(asked), HasSubstr("--up: found \"w\", allowed: x, -x, y, -y, z or -z"));
  s.gravity = s.applied_force = {0, 0, 0};
  std::vector<std::string> warnings;
  run_average(request_of(s), nullptr, &warnings);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("neither gravity nor a load says which way is up; z "
                                              "is taken (--up changes it)")));
  EXPECT_THAT(refusal(request_of(s, "heap")), HasSubstr("has no gravity, and a heap needs it"));
}

TEST(Upright, PeriodicSidesTurnWithThePacking) {
  const dem::Snapshot layer = test::lattice_layer(3, 5, 6);
  dem::Snapshot other = turned(layer, {0, 2, 1}, {1, -1, 1});
  other.cell.periodic = {true, false, true};
  other.cell.low = {layer.cell.low.x(), 0, -layer.cell.low.y() - layer.cell.edges(1, 1)};
  other.cell.edges.setZero();
  other.cell.edges(0, 0) = layer.cell.edges(0, 0);
  other.cell.edges(2, 2) = layer.cell.edges(1, 1);
  for (dem::Contact& c : other.contacts) c.image = {c.image[0], 0, -c.image[1]};
  expect_same(layer, other);
  const auto back = upright(std::make_shared<const dem::Snapshot>(other), up_of(other, ""));
  EXPECT_TRUE(back->cell.low.isApprox(layer.cell.low, 1e-12));
  EXPECT_EQ(back->contacts.front().image, layer.contacts.front().image);
  dem::Snapshot tilted = other;
  tilted.cell.edges(0, 2) = 0.01;
  EXPECT_THROW(upright(std::make_shared<const dem::Snapshot>(tilted), up_of(tilted, "")),
               std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::coupling
