// Spheres settled in LAMMPS go on here from the same state, through the user's way: dumps, import,
// snapshot file, engine. Optional: skipped where there is no LAMMPS (`lmp`, Debian package lammps).
//
// What LAMMPS' gran/hooke/history shares with our linear law: k_n depth, dashpots gamma m_eff v,
// a tangential spring k_t (sum of slip) capped with its dashpot at mu times the normal force. What
// it does otherwise: its arms are whole radii, ours end at the contact point (apart by half the
// depth), it does not turn the spring about the normal and lets it shrink where the normal tilts.
// The first thing that comes of it are other torques, so other spins within the step. Hence a step
// so short that spins stay: there depths, springs and dashpots are compared to 1e-10. In a step of
// the usual length the springs' advance is seen, to about the depth over the radius.
//
// LAMMPS shows springs nowhere. But a pair at rest with any friction allowed has nothing else in
// its tangential force (p1 p2 p3 of compute pair/local): speeds are put aside, shown with the dump,
// and given back. The limits of what walls show stay; in this packing no wall slides.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "coupling/import/import.h"
#include "dem/engine/engine.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;
using testing::Folder;

constexpr const char* kScript = R"(units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes
region box block 0 0.04 0 0.04 -0.001 0.2 units box
create_box 1 box
lattice sc 0.011
region fill block 0.003 0.037 0.003 0.037 0.004 0.18 units box
create_atoms 1 region fill
variable d atom 0.008+0.002*((id*7919%101)/100)
set group all diameter v_d
set group all density 2500
displace_atoms all random 0.0005 0.0005 0 4711
variable law string "hooke/history 1e5 3e4 2000 1000 0.5 1"
pair_style gran/${law}
pair_coeff * *
neighbor 0.001 bin
neigh_modify delay 0 every 1 check yes
timestep 1e-5
fix move all nve/sphere
fix weight all gravity 9.81 vector 0 0 -1
fix floor all wall/gran ${law} zplane 0 NULL contacts
fix left all wall/gran ${law} xplane 0 NULL contacts
fix right all wall/gran ${law} xplane NULL 0.04 contacts
fix front all wall/gran ${law} yplane 0 NULL contacts
fix back all wall/gran ${law} yplane NULL 0.04 contacts
fix damp all viscous 0.01
thermo 100000
run 40000
# Spheres that spin on the spot or roll would go on for long.
variable k loop 20
label quiet
velocity all set 0 0 0
set group all omega 0 0 0
run 5000
next k
jump SELF quiet
unfix damp
variable s1 atom 2e-5*sin(id)
variable s2 atom 2e-5*sin(2*id)
variable s3 atom 2e-5*sin(3*id)
variable t1 atom 1e-6*cos(id)
variable t2 atom 1e-6*cos(2*id)
variable t3 atom 1e-6*cos(3*id)
velocity all set v_s1 v_s2 v_s3
set group all omega v_t1 v_t2 v_t3
fix keep all store/state 0 vx vy vz omegax omegay omegaz
compute ids all property/local patom1 patom2 cutoff radius
compute p all pair/local fx fy fz p1 p2 p3 cutoff radius
velocity all set 0 0 0
set group all omega 0 0 0
pair_style gran/hooke/history 1e5 3e4 2000 1000 10000 0
dump grains all custom 1 grains.dump id x y z radius mass f_keep[*] f_floor[*] f_left[*] f_right[*] f_front[*] f_back[*]
dump contacts all local 1 contacts.dump index c_ids[1] c_ids[2] c_p[*]
dump_modify grains format float %.17g
dump_modify contacts format float %.17g
run 0
undump grains
undump contacts
variable vx atom f_keep[1]
variable vy atom f_keep[2]
variable vz atom f_keep[3]
variable wx atom f_keep[4]
variable wy atom f_keep[5]
variable wz atom f_keep[6]
velocity all set v_vx v_vy v_vz
set group all omega v_wx v_wy v_wz
pair_style gran/${law}
dump after all custom 1 after.dump id fx fy fz
dump_modify after format float %.17g
timestep ${dt}
run 1
)";

// Forces on the grains by id, of the last step of a dump of id fx fy fz.
std::map<long long, Vec3> last_forces(const std::string& file) {
  std::istringstream in(testing::read_text(file));
  std::map<long long, Vec3> forces;
  bool rows = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("ITEM:")) {
      rows = line.starts_with("ITEM: ATOMS");
      if (rows) forces.clear();
      continue;
    }
    if (!rows) continue;
    std::istringstream fields(line);
    long long id = 0;
    Vec3 f;
    fields >> id >> f.x() >> f.y() >> f.z();
    forces[id] = f;
  }
  return forces;
}

// Ids 0, 1, 2, ... as the engine wants them; LAMMPS' id of each.
std::vector<long long> renumber(dem::Snapshot& s) {
  std::vector<long long> ids;
  for (dem::Grain& g : s.grains) {
    ids.push_back(g.id);
    g.id = static_cast<std::int64_t>(ids.size()) - 1;
  }
  return ids;
}

// After one step: sum of the contacts' forces and of the weight on every grain.
std::vector<Vec3> first_forces(const dem::Snapshot& start, double time_step) {
  dem::EngineSettings settings;
  settings.shape = dem::ShapeKind::sphere;
  settings.integrator = dem::IntegratorKind::verlet;
  settings.law = dem::LinearLaw{1e5, 3e4, 2000, 1000};
  settings.friction = 0.5;
  settings.time_step = time_step;
  const auto engine = dem::make_engine(settings, start);
  engine->step(1);
  const dem::Snapshot s = engine->snapshot();
  std::vector<Vec3> forces;
  for (const dem::Grain& g : s.grains) forces.emplace_back(g.mass * s.gravity);
  for (const dem::Contact& c : s.contacts) {
    forces[static_cast<std::size_t>(c.i)] += c.force;
    if (c.j >= 0) forces[static_cast<std::size_t>(c.j)] -= c.force;
  }
  return forces;
}

class LammpsSpheres : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v lmp > /dev/null") != 0)
      GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  }

  /// Lets LAMMPS settle and make a step, and imports where the step begins.
  void settle(double time_step) {
    time_step_ = time_step;
    folder_.write("in.spheres", kScript);
    const std::string run = fmt::format(
        "cd {} && OMP_NUM_THREADS=1 lmp -log none -screen screen -var dt {} "
        "-in in.spheres",
        folder_.path(), time_step);
    ASSERT_EQ(std::system(run.c_str()), 0) << testing::read_text(folder_ / "screen");
    std::string walls;
    for (const std::string wall :
         {"floor:z=0", "left:x=0", "right:x=0.04", "front:y=0", "back:y=0.04"})
      walls += fmt::format(" --wall {}:fix=f_{}", wall, wall.substr(0, wall.find(':')));
    const testing::Output imported = testing::program(
        fmt::format("import --from lammps {0}/grains.dump {0}/contacts.dump -o {0}/packing.h5 "
                    "--friction 0.5 --column 'i,j=c_ids[1..2]' "
                    "--column 'fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]' --column 'sx,sy,sz=c_p[4..6]' "
                    "--column 'vx,vy,vz,spin_x,spin_y,spin=f_keep[1..6]'{1}",
                    folder_.path(), walls));
    ASSERT_EQ(imported.code, 0) << imported.err;
    EXPECT_EQ(imported.err, "");
    const std::string file = folder_ / "packing.h5";
    start_ = dem::read_snapshot(file, dem::list_snapshots(file).at(0));
    ids_ = renumber(start_);
    theirs_ = last_forces(folder_ / "after.dump");
    ASSERT_EQ(theirs_.size(), ids_.size());
    for (const dem::Contact& c : start_.contacts) {
      largest_ = std::max(largest_, c.force.norm());
      (c.j < 0 ? at_walls_ : pairs_) += 1;
      // Else the walls would not have shown their springs.
      if (c.j < 0) {
        EXPECT_LT(c.tangential_force, 0.999 * 0.5 * c.normal_force);
      }
    }
  }

  /// Of the forces on grains in the first step, over the largest contact force.
  double difference(const dem::Snapshot& from) const {
    const std::vector<Vec3> ours = first_forces(from, time_step_);
    double worst = 0;
    for (std::size_t g = 0; g < ids_.size(); ++g)
      worst = std::max(worst, (ours[g] - theirs_.at(ids_[g])).norm());
    return worst / largest_;
  }

  /// The same without something.
  template <class Spoil>
  double without(Spoil spoil) const {
    dem::Snapshot other = start_;
    for (dem::Grain& g : other.grains) spoil(g);
    return difference(other);
  }

  double time_step_ = 0;
  Folder folder_;
  dem::Snapshot start_;
  std::vector<long long> ids_;  // theirs
  std::map<long long, Vec3> theirs_;
  double largest_ = 0;
  int pairs_ = 0, at_walls_ = 0;
};

TEST_F(LammpsSpheres, GoOnWithTheSameForces) {
  settle(1e-10);
  if (IsSkipped() || HasFatalFailure()) return;
  EXPECT_GT(ids_.size(), 100U);
  EXPECT_GT(pairs_, 200);
  EXPECT_GT(at_walls_, 50);
  const double found = difference(start_);
  std::printf("%zu spheres, %d pairs, %d at walls: largest difference %.2g of the largest force\n",
              ids_.size(), pairs_, at_walls_, found);
  EXPECT_LT(found, 1e-10);
  // It is told whether dashpots of speeds and of spins, and springs, are the same ones.
  EXPECT_GT(without([](dem::Grain& g) { g.velocity *= 1 + 1e-4; }), 1e-9);
  EXPECT_GT(without([](dem::Grain& g) { g.angular_velocity *= -1; }), 1e-9);
  dem::Snapshot other = start_;
  for (dem::Contact& c : other.contacts) c.spring_vector *= 1 + 1e-8;
  EXPECT_GT(difference(other), 1e-9);
}

TEST_F(LammpsSpheres, SpringsAdvanceAlike) {
  settle(1e-5);
  if (IsSkipped() || HasFatalFailure()) return;
  const double found = difference(start_);
  std::printf("a step of 1e-5 s: largest difference %.2g of the largest force\n", found);
  EXPECT_LT(found, 1e-5);
  // All that moves and so advances springs.
  EXPECT_GT(without([](dem::Grain& g) { g.velocity.setZero(); }), 1e-4);
}

}  // namespace
}  // namespace grainfield::coupling
