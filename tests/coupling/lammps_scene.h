// Spheres settled in LAMMPS under a law of its, shown with all that their contacts remember, and
// brought to us: dumps, import, snapshot file. The way of lammps_spheres_test.cc, for any law and
// number, by a restart file, so that LAMMPS too can go on from the same state more than once.
//
// A pair at rest with any friction allowed has nothing but its springs in its tangential force and
// its rolling pseudo-force: speeds are put aside, shown with the dump, and given back.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "coupling/import/import.h"
#include "dem/engine/engine.h"
#include "program.h"

namespace grainfield::coupling::lammps {

using dem::Vec3;

/// A law in LAMMPS' words and in ours.
struct Law {
  std::string pair;   ///< commands
  std::string shown;  ///< the same without dashpots and caps
  std::string wall;   ///< style and coefficients of fix wall/gran
  bool rolls = false;
  dem::AnyLaw law;  ///< of all contacts
  double friction = 0.5;
  dem::RollingLaw
      rolling{};  ///< between spheres; walls show none of its springs, so they have none
  double wall_friction = 0.5;
};

inline bool is_there() { return std::system("command -v lmp > /dev/null") == 0; }

inline std::string run_lammps(const std::string& folder, const std::string& script,
                              const std::string& variables = "") {
  const std::string command =
      fmt::format("cd {} && OMP_NUM_THREADS=1 lmp -log none -screen screen {} -in {}", folder,
                  variables, script);
  if (std::system(command.c_str()) != 0) {
    ADD_FAILURE() << testing::read_text(folder + "/screen");
  }
  return testing::read_text(folder + "/screen");
}

constexpr const char* kWalls = R"(fix floor all wall/gran ${wall} zplane 0 NULL contacts
fix left all wall/gran ${wall} xplane 0 NULL contacts
fix right all wall/gran ${wall} xplane NULL ${width} contacts
fix front all wall/gran ${wall} yplane 0 NULL contacts
fix back all wall/gran ${wall} yplane NULL ${width} contacts
neighbor 0.001 bin
neigh_modify delay 0 every 1 check yes
timestep 1e-5
fix move all nve/sphere
fix weight all gravity 9.81 vector 0 0 -1
)";

constexpr const char* kSettle = R"(units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes
variable high equal 0.011*(${layers}+4)
variable fill equal 0.003+0.011*(${layers}-0.5)
variable most equal ${width}-0.003
region box block 0 ${width} 0 ${width} -0.001 ${high} units box
create_box 1 box
lattice sc 0.011
region fill block 0.003 ${most} 0.003 ${most} 0.004 ${fill} units box
create_atoms 1 region fill
variable d atom 0.008+0.002*((id*7919%101)/100)
set group all diameter v_d
set group all density 2500
displace_atoms all random 0.0005 0.0005 0 4711
include pair.in
include walls.in
fix damp all viscous 0.01
thermo 10000
run 40000
# Spheres that spin on the spot or roll would go on for long.
variable k loop 20
label quiet
velocity all set 0 0 0
set group all omega 0 0 0
run 5000
next k
jump SELF quiet
write_restart settled
)";

constexpr const char* kGoOn = R"in(read_restart settled
comm_modify vel yes
include pair.in
include walls.in
variable shaken_x atom x+${shake}*sin(37*id+${seed})
variable shaken_y atom y+${shake}*sin(61*id+${seed})
variable shaken_z atom z+${shake}*sin(97*id+${seed})
if "${shake} > 0" then "set group all x v_shaken_x y v_shaken_y z v_shaken_z"
variable s1 atom 2e-5*sin(id)
variable s2 atom 2e-5*sin(2*id)
variable s3 atom 2e-5*sin(3*id)
variable t1 atom 1e-7*cos(id)
variable t2 atom 1e-7*cos(2*id)
variable t3 atom 1e-7*cos(3*id)
velocity all set v_s1 v_s2 v_s3
set group all omega v_t1 v_t2 v_t3
fix keep all store/state 0 vx vy vz omegax omegay omegaz
compute ids all property/local patom1 patom2 cutoff radius
compute p all pair/local ${shows} cutoff radius
velocity all set 0 0 0
set group all omega 0 0 0
include shown.in
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
include pair.in
dump after all custom ${steps} after.dump id fx fy fz tqx tqy tqz
dump_modify after format float %.17g
compute stress all pressure NULL pair
thermo_style custom step ke c_stress[1] c_stress[2] c_stress[3]
timestep ${dt}
run ${steps}
print "STRESS $(vol*c_stress[1]:%.17g) $(vol*c_stress[2]:%.17g) $(vol*c_stress[3]:%.17g)"
)in";

/// Numbers of the rows after the last "ITEM: ATOMS" or "ITEM: ENTRIES" of a dump.
inline std::vector<std::vector<double>> last_rows(const std::string& file) {
  std::istringstream in(testing::read_text(file));
  std::vector<std::vector<double>> rows;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("ITEM:")) {
      inside = line.starts_with("ITEM: ATOMS") || line.starts_with("ITEM: ENTRIES");
      if (inside) rows.clear();
      continue;
    }
    if (!inside) continue;
    std::istringstream fields(line);
    auto& row = rows.emplace_back();
    for (double value = 0; fields >> value;) row.push_back(value);
  }
  return rows;
}

/// What LAMMPS tells of the end of a run.
struct End {
  std::map<long long, std::pair<Vec3, Vec3>> loads;  ///< forces and torques by id, N, N m
  Vec3 stress{0, 0, 0};  ///< sum over pairs of force times branch, along x, y, z, N m
};

class Scene {
 public:
  Scene(const Law& law, double width, int layers) : law_(law), width_(width) {
    folder_.write("pair.in", law.pair + "\n");
    folder_.write("shown.in", law.shown + "\n");
    folder_.write("walls.in", fmt::format("variable wall string \"{}\"\n", law.wall) + kWalls);
    folder_.write("settle.in", kSettle);
    folder_.write("go.in", kGoOn);
    run_lammps(folder_.path(), "settle.in",
               fmt::format("-var width {} -var layers {}", width, layers));
  }

  /// So many steps from the settled state, whose places have been shaken by up to `shake`, m.
  End go_on(double time_step, int steps, double shake = 0, int seed = 1) const {
    const std::string screen = run_lammps(
        folder_.path(), "go.in",
        fmt::format("-var width {} -var dt {} -var steps {} -var shake {} -var seed {} "
                    "-var shows \"fx fy fz p1 p2 p3{}\"",
                    width_, time_step, steps, shake, seed, law_.rolls ? " p5 p6 p7" : ""));
    End end;
    for (const auto& row : last_rows(folder_ / "after.dump")) {
      end.loads[static_cast<long long>(row[0])] = {{row[1], row[2], row[3]},
                                                   {row[4], row[5], row[6]}};
    }
    std::istringstream in(screen.substr(screen.rfind("\nSTRESS ") + 8));
    in >> end.stress.x() >> end.stress.y() >> end.stress.z();
    return end;
  }

  /// The state in which go_on last began. `ids`: LAMMPS' of each grain.
  dem::Snapshot start(std::vector<long long>& ids) const {
    std::string walls;
    for (const std::string wall : {"floor:z=0", "left:x=0", "front:y=0"})
      walls += fmt::format(" --wall {}:fix=f_{}", wall, wall.substr(0, wall.find(':')));
    for (const std::string wall : {"right:x=", "back:y="})
      walls += fmt::format(" --wall {}{}:fix=f_{}", wall, width_, wall.substr(0, wall.find(':')));
    const testing::Output imported = testing::program(
        fmt::format("import --from lammps {0}/grains.dump {0}/contacts.dump -o {0}/packing.h5 "
                    "--friction 0.5 --column 'i,j=c_ids[1..2]' "
                    "--column 'fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]' --column 'sx,sy,sz=c_p[4..6]' "
                    "--column 'vx,vy,vz,spin_x,spin_y,spin=f_keep[1..6]'{1}",
                    folder_.path(), walls));
    EXPECT_EQ(imported.code, 0) << imported.err;
    const std::string file = folder_ / "packing.h5";
    dem::Snapshot s = dem::read_snapshot(file, dem::list_snapshots(file).at(0));
    std::remove(file.c_str());
    std::map<long long, std::int64_t> ours;
    ids.clear();
    for (dem::Grain& g : s.grains) {
      ours[g.id] = static_cast<std::int64_t>(ids.size());
      ids.push_back(g.id);
      g.id = ours[g.id];
      g.material = "grain";
    }
    for (dem::Wall& w : s.walls) w.material = "wall";
    if (!law_.rolls) return s;
    std::map<std::pair<std::int64_t, std::int64_t>, Vec3> rolling;
    for (const auto& row : last_rows(folder_ / "contacts.dump")) {
      const std::int64_t a = ours.at(static_cast<long long>(row[1])),
                         b = ours.at(static_cast<long long>(row[2]));
      rolling[{std::min(a, b), std::max(a, b)}] = -Vec3(row[9], row[10], row[11]);
    }
    for (dem::Contact& c : s.contacts)
      if (c.j >= 0) c.rolling_spring = rolling.at({c.i, c.j});
    return s;
  }

  std::unique_ptr<dem::Engine> engine(const dem::Snapshot& start, double time_step) const {
    dem::EngineSettings settings;
    settings.shape = dem::ShapeKind::sphere;
    settings.materials = {"grain", "wall"};
    settings.material_pairs = {{"grain", "grain", law_.law, law_.friction, law_.rolling},
                               {"grain", "wall", law_.law, law_.wall_friction}};
    settings.time_step = time_step;
    return dem::make_engine(settings, start);
  }

 private:
  Law law_;
  double width_;
  testing::Folder folder_;
};

/// Sum of the contacts' forces and of the weight on every grain, N.
inline std::vector<Vec3> forces_of(const dem::Snapshot& s) {
  std::vector<Vec3> forces;
  for (const dem::Grain& g : s.grains) forces.emplace_back(g.mass * s.gravity);
  for (const dem::Contact& c : s.contacts) {
    forces[static_cast<std::size_t>(c.i)] += c.force;
    if (c.j >= 0) forces[static_cast<std::size_t>(c.j)] -= c.force;
  }
  return forces;
}

/// As End::stress.
inline Vec3 stress_of(const dem::Snapshot& s) {
  Vec3 sum(0, 0, 0);
  for (const dem::Contact& c : s.contacts) {
    if (c.j < 0) continue;
    const Vec3 branch = s.grains[static_cast<std::size_t>(c.i)].position -
                        s.grains[static_cast<std::size_t>(c.j)].position;
    sum += c.force.cwiseProduct(branch);
  }
  return sum;
}

constexpr double kYoung = 1e8, kPoisson = 0.3, kNormal = 2e7, kTangential = 1e7;

/// `displacement`, `viscoelastic` with gran/hertz/history's K_n = 4/3 E*, K_t = 8 G*.
inline Law hertz_history() {
  const dem::HertzLaw ours{kYoung, kPoisson, 0, true, true, kNormal, kTangential};
  const auto style = [&](double mu, bool damps) {
    return fmt::format("hertz/history {:.17g} {:.17g} {} {} {} 1", 4.0 / 3 * ours.effective_young(),
                       8 * ours.effective_shear(), damps ? kNormal : 0, damps ? kTangential : 0,
                       mu);
  };
  const auto pair = [](const std::string& words) {
    return fmt::format("pair_style gran/{}\npair_coeff * *", words);
  };
  return {pair(style(0.5, true)), pair(style(10000, false)), style(0.5, true), false, ours};
}

/// granular with rolling sds; `memory`: mindlin (displacement) or mindlin_rescale/force (force).
inline Law granular(const std::string& memory, double wall_friction = 0.5) {
  const dem::RollingLaw rolling{2e3, 0.5, 0.1};
  const auto contact = [&](bool damps, double mu) {
    return fmt::format("hertz/material {} {} {} tangential {} NULL 0.5 {}", kYoung,
                       damps ? kNormal : 0, kPoisson, memory, mu);
  };
  const auto pair = [&](bool damps, double mu, double mu_r) {
    return fmt::format("pair_coeff * * {} rolling sds {} {} {} damping viscoelastic",
                       contact(damps, mu), rolling.stiffness, damps ? rolling.damping : 0, mu_r);
  };
  const dem::HertzLaw ours{kYoung, kPoisson, 0, memory == "mindlin", true, kNormal, kTangential};
  // With hertz/material a wall would have E/(2 (1 - nu)) for E*, apart from pairs.
  const std::string wall = fmt::format(
      "granular hertz {:.17g} {} tangential {} {:.17g} 0.5 {} damping viscoelastic",
      4.0 / 3 * ours.effective_young(), kNormal, memory, 8 * ours.effective_shear(), wall_friction);
  return {"pair_style granular\n" + pair(true, 0.5, rolling.friction),
          pair(false, 10000, 10000),
          wall,
          true,
          ours,
          0.5,
          rolling,
          wall_friction};
}

}  // namespace grainfield::coupling::lammps
