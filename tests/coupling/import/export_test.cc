// Packings of spheres for LAMMPS: what is written, what is refused, and, where LAMMPS is there, the
// way there and back.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "coupling/export/lammps_deck.h"
#include "dem/engine/engine.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/coupling/lammps_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;
using ::testing::Contains;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::program;

dem::Snapshot two_spheres() {
  dem::EngineSettings e;
  e.shape = dem::ShapeKind::sphere;
  e.law = dem::HertzLaw{1e7, 0.3, 0.2};
  e.gravity_y = 0;
  e.gravity_z = -9.81;
  e.cell.periodic = {true, true, false};
  e.cell.edges = dem::Vec3(0.1, 0.2, 1).asDiagonal();
  const auto engine = dem::make_engine(e);
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.7});
  for (int k = 0; k < 2; ++k) {
    dem::NewGrain g;
    g.x = g.y = 0.05;
    g.z = 0.005 + 0.01 * k;
    g.radius = 0.005;
    g.density = 2500;
    g.fixed = k == 0;
    engine->add(g);
  }
  dem::Snapshot s = engine->snapshot();
  s.gravity = dem::Vec3(0, 0, -9.81);
  return s;
}

LammpsSetup setup_of(const char* law) {
  LammpsSetup setup;
  setup.material.law = law;
  setup.material.young = 1e7;
  setup.material.damping = 0.2;
  setup.material.friction = 0.4;
  return setup;
}

TEST(Export, SaysLawWallsCellAndLoadInLammpsWords) {
  LammpsSetup setup = setup_of("hertz");
  setup.loaded = {1};
  setup.force = dem::Vec3(0, 0, -0.5);
  setup.background_damping = 3;
  const LammpsDeck deck = lammps_deck(two_spheres(), setup);
  EXPECT_THAT(deck.notes, Not(Contains(HasSubstr("local_damping"))));
  EXPECT_THAT(deck.data, HasSubstr("2 atoms\n2 atom types"));
  EXPECT_THAT(deck.data, HasSubstr("0 0.10000000000000001 xlo xhi"));
  EXPECT_THAT(deck.data, HasSubstr("\n1 2 0.01"));
  EXPECT_THAT(deck.input, HasSubstr("boundary p p f"));
  EXPECT_THAT(deck.input, HasSubstr("pair_coeff * * hertz/material 10000000 "));
  EXPECT_THAT(deck.input, HasSubstr(" 0.29999999999999999 damping tsuji tangential "
                                    "mindlin_rescale/force NULL "));
  EXPECT_THAT(deck.input, HasSubstr(" zplane 0 NULL contacts"));
  EXPECT_THAT(deck.input, HasSubstr("fix hold fixed freeze"));
  EXPECT_THAT(deck.input, HasSubstr("group loaded id 2\nfix load loaded addforce 0 0 -0.5"));
  setup = setup_of("linear");
  setup.material.rolling_friction = 0.1;
  setup.material.rolling_stiffness = 500;
  setup.local_damping = 0.2;
  EXPECT_THAT(lammps_deck(two_spheres(), setup).notes, Contains(HasSubstr("motion.local_damping")));
  EXPECT_THAT(lammps_deck(two_spheres(), setup).input,
              HasSubstr("hooke 10000000 500 damping mass_velocity tangential linear_history "));
  EXPECT_THAT(lammps_deck(two_spheres(), setup).input, HasSubstr(" rolling sds 500 0 0.1"));
}

// A response to a small load needs a rest as deep as that of the engine: the limit of the spheres'
// energy goes with the contacts' energy, and with the copies.
TEST(Export, RestIsMeasuredByTheEnergyOfTheContacts) {
  dem::Snapshot s = two_spheres();
  const double depth = 1e-5;
  s.grains[1].position =
      s.grains[0].position + dem::Vec3(0, 0, s.grains[0].radius + s.grains[1].radius - depth);
  dem::Contact c;
  c.i = 0;
  c.j = 1;
  c.normal_force = 0.25;
  s.contacts = {c};
  LammpsSetup setup = setup_of("hertz");
  setup.kinetic_to_elastic_energy = 1e-12;
  const auto limit = [&] {
    const std::string input = lammps_deck(s, setup).input, before = "c_motion+c_spin > ";
    return std::stod(input.substr(input.find(before) + before.size()));
  };
  EXPECT_NEAR(limit() / (1e-12 * 0.4 * 0.25 * depth), 1, 1e-9);
  EXPECT_THAT(lammps_deck(s, setup).input, Not(HasSubstr("replicate")));
  setup.copies = {3, 2};
  EXPECT_NEAR(limit() / (6e-12 * 0.4 * 0.25 * depth), 1, 1e-9);
  EXPECT_THAT(lammps_deck(s, setup).input, HasSubstr("packing.data\nreplicate 3 2 1\n"));
  setup = setup_of("linear");
  setup.kinetic_to_elastic_energy = 1e-12;
  EXPECT_NEAR(limit() / (1e-12 * 0.5 * 0.25 * depth), 1, 1e-9);
  s.contacts.clear();
  EXPECT_GT(limit(), 0);
}

TEST(Export, RestitutionOfTsujisPolynomial) {
  EXPECT_EQ(tsuji_restitution(2), 0);
  for (const double e : {0.1, 0.5, 0.9}) {
    const double alpha = 1.2728 - 4.2783 * e + 11.087 * e * e - 22.348 * std::pow(e, 3) +
                         27.467 * std::pow(e, 4) - 18.022 * std::pow(e, 5) +
                         4.8218 * std::pow(e, 6);
    EXPECT_NEAR(tsuji_restitution(alpha), e, 1e-9);
  }
}

TEST(Export, RefusesWhatLammpsHasNot) {
  const auto complaint = [](const dem::Snapshot& s, const LammpsSetup& setup) {
    try {
      lammps_deck(s, setup);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const dem::Snapshot good = two_spheres();
  EXPECT_EQ(complaint(good, setup_of("hertz")), "none");
  EXPECT_THAT(complaint(good, setup_of("penalty")), HasSubstr("material.law: found penalty"));
  dem::Snapshot bad = good;
  bad.dim = 2;
  EXPECT_THAT(complaint(bad, setup_of("hertz")), HasSubstr("in the plane"));
  bad = good;
  bad.cell.periodic[1] = false;
  LammpsSetup twice = setup_of("hertz");
  twice.copies = {1, 2};
  EXPECT_THAT(complaint(bad, twice), HasSubstr("--copies: found 2 along y, allowed: 1"));
  bad = good;
  bad.cell.edges(0, 2) = 0.1;
  EXPECT_THAT(complaint(bad, setup_of("hertz")), HasSubstr("sheared cell"));
  bad = good;
  bad.walls[0].normal = dem::Vec3(0, 0.6, 0.8);
  EXPECT_THAT(complaint(bad, setup_of("hertz")), HasSubstr("wall floor"));
  bad = good;
  bad.grains[1].axes = dem::Vec3(1, 1, 2);
  EXPECT_THAT(complaint(bad, setup_of("hertz")), HasSubstr("grain 1"));
}

// A small loaded layer goes to LAMMPS, rests there and is loaded, and comes back: the same weight
// and load on the floor, and a response that grainfield takes in.
TEST(Export, GoesToLammpsAndComesBack) {
  if (!lammps::is_there()) GTEST_SKIP() << "no lmp";
  const Folder folder;
  folder.write("layer.toml", R"(study = "point-load"
[packing]
dim = 3
kind = "random"
sizes = "uniform"
radius_min = 0.0045
radius_max = 0.0055
width = 0.06
depth = 0.03
[material]
law = "hertz"
density = 2500
young = 1e7
damping = 0.3
[rest]
background_damping = 40
[load]
weights = 1
[ensemble]
realizations = 1
[compare]
models = ["boussinesq"]
)");
  const std::string at = folder.path() + "/";
  ASSERT_EQ(program("run " + at + "layer.toml -o " + at + "out").code, 0);
  const testing::Output exported = program("export " + at + "layer.toml " + at +
                                           "out/snapshots.h5 --to lammps -o " + at + "deck");
  ASSERT_EQ(exported.code, 0) << exported.err;
  const std::string screen = lammps::run_lammps(at + "deck", "in.lammps");
  // The deck's first lines are the commands that bring it back.
  std::istringstream deck(testing::read_text(at + "deck/in.lammps"));
  std::string line;
  int commands = 0;
  while (std::getline(deck, line)) {
    const std::string word = "# grainfield ";
    if (line.rfind(word, 0) != 0) continue;
    const testing::Output back = program(line.substr(word.size()), "cd " + at + "deck &&");
    ASSERT_EQ(back.code, 0) << line << "\n" << back.err;
    ++commands;
  }
  ASSERT_EQ(commands, 2);
  const dem::Snapshot unloaded = dem::read_snapshot(at + "deck/lammps.h5", "/unloaded");
  const dem::Snapshot loaded = dem::read_snapshot(at + "deck/lammps.h5", "/loaded");
  double weight = 0;
  for (const dem::Grain& g : unloaded.grains) weight += g.fixed ? 0 : 9.81 * g.mass;
  EXPECT_NEAR(dem::base_force(unloaded).z() / weight, 1, 1e-3);
  EXPECT_NEAR((dem::base_force(loaded) - dem::base_force(unloaded)).z() / -loaded.applied_force.z(),
              1, 0.02);
}

// An imported packing has no case: LAMMPS runs its deck with the law of the command line, and the
// commands of its first lines bring it back.
TEST(Export, APackingWithoutACaseRuns) {
  if (!lammps::is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  const Folder folder;
  const std::string at = folder.path() + "/";
  std::string plane = "id,x,y,radius,density\n", space = "id,x,y,z,radius,density\n";
  for (int k = 0; k < 12; ++k) {
    const double x = 0.006 + 0.011 * (k % 4), y = 0.006 + 0.011 * (k / 4 % 3);
    plane += fmt::format("{},{},{},0.005,2500\n", k + 1, x, y);
    space += fmt::format("{},{},{},{},0.005,2500\n", k + 1, x, 0.006 + 0.011 * (k / 4), 0.006);
  }
  folder.write("2.csv", plane);
  folder.write("3.csv", space);
  for (const std::string dim : {"2", "3"}) {
    const std::string walls = dim == "2" ? " --wall floor:y=0 --wall left:x=0 --wall right:x=0.045"
                                         : " --wall floor:z=0 --periodic x=0:0.044";
    const testing::Output imported =
        program("import --from csv --without-contacts --friction 0.5 --dim " + dim + " " + at +
                dim + ".csv" + walls + " -o " + at + dim + ".h5");
    ASSERT_EQ(imported.code, 0) << imported.err;
    const std::string deck = at + "deck" + dim;
    const testing::Output exported = program("export " + at + dim + ".h5 --to lammps -o " + deck);
    ASSERT_EQ(exported.code, 0) << exported.err;
    // Numbers in the words of the deck's first line.
    lammps::run_lammps(
        deck, "in.lammps",
        "-var law \"hooke 1e4 20 damping mass_velocity tangential linear_history 2857 "
        "1 0.5\" -var step 1e-5");
    const std::string command = "# grainfield ", text = testing::read_text(deck + "/in.lammps");
    const std::size_t line = text.find(command);
    ASSERT_NE(line, std::string::npos);
    const std::size_t begin = line + command.size();
    const testing::Output back =
        program(text.substr(begin, text.find('\n', begin) - begin), "cd " + deck + " &&");
    ASSERT_EQ(back.code, 0) << back.err;
    const dem::Snapshot s = dem::read_snapshot(deck + "/lammps.h5", "/unloaded");
    ASSERT_EQ(s.grains.size(), 12u);
    EXPECT_EQ(std::to_string(s.dim), dim);
    // The floor carries the weight.
    Vec3 floor = Vec3::Zero();
    double weight = 0;
    for (const dem::Contact& c : s.contacts)
      if (c.j == -1) floor += c.force;
    for (const dem::Grain& g : s.grains) weight += 9.81 * g.mass;
    EXPECT_NEAR(floor[s.dim - 1] / weight, 1, 1e-2) << dim;
  }
}

}  // namespace
}  // namespace grainfield::coupling
