#include "coupling/export/lammps_deck.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/export/lammps_ids.h"
#include "dem/snapshot/added_forces_mark.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;

constexpr const char* kAxes = "xyz";
// Beyond the outermost sphere, in its radii: where space does not repeat the box may end there.
constexpr double kMargin = 4;

// Our normal dashpots over LAMMPS' for `tsuji`: 2 zeta sqrt(2 E* a m) = alpha sqrt(4/3 E* a m).
const double kTsujiShare = 2 * std::sqrt(1.5);

double tsuji_alpha(double e) {
  return 1.2728 +
         e * (-4.2783 + e * (11.087 + e * (-22.348 + e * (27.467 + e * (-18.022 + e * 4.8218)))));
}

void require(bool good, const std::string& what) {
  if (!good) throw std::invalid_argument("export to LAMMPS: " + what);
}

void check_law(const dem::MaterialSetup& m) {
  require(m.law == "linear" || m.law == "hertz",
          fmt::format("material.law: found {}, allowed: linear, hertz", m.law));
  require(m.law != "linear" || m.normal_damping > 0 || m.tangential_damping == 0,
          fmt::format("material.normal_damping: found 0 beside tangential_damping = {:g}, allowed: "
                      "above 0 (LAMMPS takes the tangential one as a multiple of it)",
                      m.tangential_damping));
}

bool is_flat(const dem::Wall& w) {
  return w.shape == "plane" && w.normal.cwiseAbs().maxCoeff() == 1 && w.material.empty();
}

void check(const dem::Snapshot& s, const LammpsSetup& setup) {
  require(s.dim == 3 || !setup.known, "found a packing in the plane, allowed: spheres in space");
  require(!s.grains.empty(), "found no grain");
  for (const dem::Grain& g : s.grains) {
    require(g.axes.isZero(0) && g.outline.empty(),
            fmt::format("grain {}: found a shape that is no sphere, allowed: spheres", g.id));
    require(
        g.material.empty(),
        fmt::format("grain {}: found the material {}, allowed: one material", g.id, g.material));
  }
  for (int a = 0; a < 2; ++a) {
    require(setup.copies[a] == 1 || s.cell.periodic[a],
            fmt::format("--copies: found {} along {}, allowed: 1, for the packing does not repeat "
                        "there",
                        setup.copies[a], kAxes[a]));
  }
  if (setup.known) check_law(setup.material);
  if (s.cell.is_periodic()) {
    Eigen::Matrix3d off = s.cell.edges;
    off.diagonal().setZero();
    require(off.isZero(0), "found a sheared cell, allowed: one with edges along the axes");
    require(s.cell.velocity_gradient.isZero(0), "found a cell that flows, allowed: one at rest");
  }
  if (!setup.known) return;
  require(s.gravity.norm() > 0, "found no gravity, allowed: packings that rest under their weight");
  for (const dem::Wall& w : s.walls) {
    require(w.velocity.isZero(0) && w.angular_velocity.isZero(0),
            fmt::format("wall {}: found one that moves, allowed: walls at rest", w.name));
    require(is_flat(w), fmt::format("wall {}: found a {}, allowed: planes across an axis without a "
                                    "material of their own",
                                    w.name, w.shape));
  }
}

struct Box {
  Vec3 low, high;
};

Box box_of(const dem::Snapshot& s) {
  Box box{Vec3::Constant(HUGE_VAL), Vec3::Constant(-HUGE_VAL)};
  for (const dem::Grain& g : s.grains) {
    box.low = box.low.cwiseMin((g.position.array() - kMargin * g.radius).matrix());
    box.high = box.high.cwiseMax((g.position.array() + kMargin * g.radius).matrix());
  }
  for (int a = 0; a < 3; ++a) {
    if (!s.cell.periodic[a]) continue;
    box.low[a] = s.cell.low[a];
    box.high[a] = s.cell.low[a] + s.cell.edges(a, a);
  }
  return box;
}

// In the plane LAMMPS' grains are spheres, too: they get our masses.
double volume_of(const dem::Snapshot& s, const dem::Grain& g) {
  return s.dim == 3 ? g.volume : 4.0 / 3 * std::numbers::pi * g.radius * g.radius * g.radius;
}

std::string data_of(const dem::Snapshot& s, const LammpsIds& ids) {
  const Box box = box_of(s);
  const std::string mark = dem::added_forces_note(s.attributes);
  std::string out = fmt::format("Packing of {}, SI units{}{}\n\n{} atoms\n2 atom types\n\n",
                                s.dim == 2 ? "disks" : "spheres", mark.empty() ? "" : "; ", mark,
                                s.grains.size());
  for (int a = 0; a < 3; ++a) {
    out += fmt::format("{:.17g} {:.17g} {}lo {}hi\n", box.low[a], box.high[a], kAxes[a], kAxes[a]);
  }
  out += "\nAtoms # sphere\n\n";
  for (const dem::Grain& g : s.grains) {
    out += fmt::format("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", ids.of(g.id),
                       g.fixed ? 2 : 1, 2 * g.radius, g.mass / volume_of(s, g), g.position.x(),
                       g.position.y(), g.position.z());
  }
  return out;
}

/// Energy of the normal forces between spheres, J: measure of rest. 0 before they touch.
double elastic_energy(const dem::Snapshot& s, const std::string& law) {
  const double share = law == "hertz" ? 0.4 : 0.5;  // of force times depth
  double out = 0;
  for (const dem::Contact& c : s.contacts) {
    if (c.j < 0) continue;
    const dem::Grain& a = s.grains[static_cast<std::size_t>(c.i)];
    const dem::Grain& b = s.grains[static_cast<std::size_t>(c.j)];
    const Vec3 way = dem::second_place(s, c) - a.position;
    out += share * c.normal_force * std::max(0., a.radius + b.radius - way.norm());
  }
  return out;
}

// As pair_coeff and fix wall/gran have it.
std::string law_of(const LammpsSetup& setup, double friction, LammpsDeck& deck) {
  if (!setup.known) return "${law}";
  const dem::MaterialSetup& m = setup.material;
  std::string out;
  if (m.law == "linear") {
    const double along = m.normal_damping > 0 ? m.tangential_damping / m.normal_damping : 0;
    out = fmt::format(
        "hooke {:.17g} {:.17g} damping mass_velocity tangential linear_history "
        "{:.17g} {:.17g} {:.17g}",
        m.normal_stiffness, m.normal_damping, m.tangential_stiffness, along, friction);
  } else {
    const char* memory =
        m.tangential_memory == "displacement" ? "mindlin" : "mindlin_rescale/force";
    double normal = m.normal_damping, along = 0;
    std::string damping = "viscoelastic";
    if (m.damping_model == "viscoelastic") {
      along = normal > 0 ? m.tangential_damping / normal : 0;
    } else {
      damping = "tsuji";
      normal = tsuji_restitution(kTsujiShare * m.damping);
      // Both are 2 zeta sqrt(k m): their ratio is that of the roots of 8 G* and 2 E*.
      along = std::sqrt(2 * (1 - m.poisson) / (2 - m.poisson));
      if (kTsujiShare * m.damping > tsuji_alpha(0)) {
        deck.notes.push_back(fmt::format(
            "material.damping = {:g}: LAMMPS damps no more than {:.3g}, with restitution 0",
            m.damping, tsuji_alpha(0) / kTsujiShare));
      }
    }
    out = fmt::format(
        "hertz/material {:.17g} {:.17g} {:.17g} damping {} tangential {} NULL "
        "{:.17g} {:.17g}",
        m.young, normal, m.poisson, damping, memory, along, friction);
  }
  if (m.rolling_friction > 0) {
    out += fmt::format(" rolling sds {:.17g} {:.17g} {:.17g}", m.rolling_stiffness,
                       m.rolling_damping, m.rolling_friction);
  }
  if (m.twisting_friction > 0) {
    out += fmt::format(" twisting sds {:.17g} {:.17g} {:.17g}", m.twisting_stiffness,
                       m.twisting_damping, m.twisting_friction);
  }
  return out;
}

std::string name_of(const dem::Wall& wall, std::size_t number) {
  std::string out = wall.name.empty() ? fmt::format("wall{}", number) : wall.name;
  std::replace_if(
      out.begin(), out.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); },
      '_');
  return out;
}

// Those that LAMMPS has not.
void leave_out_walls(dem::Snapshot& s, LammpsDeck& deck) {
  std::erase_if(s.walls, [&](const dem::Wall& w) {
    if (is_flat(w)) return false;
    deck.notes.push_back(
        fmt::format("wall {} is left out: in.lammps has planes across an axis alone, this is a {}",
                    w.name, w.shape == "plane" ? "plane of another direction" : w.shape));
    return true;
  });
}

std::string walls_of(const dem::Snapshot& s, const LammpsSetup& setup, LammpsDeck& deck) {
  std::string out;
  for (std::size_t k = 0; k < s.walls.size(); ++k) {
    const dem::Wall& w = s.walls[k];
    int axis = 0;
    w.normal.cwiseAbs().maxCoeff(&axis);
    const std::string place = fmt::format("{:.17g}", w.point[axis]);
    const bool low = w.normal[axis] > 0;
    out += fmt::format("fix wall_{} all wall/gran granular {} {}plane {} {} contacts\n",
                       name_of(w, k), law_of(setup, w.friction, deck), kAxes[axis],
                       low ? place : "NULL", low ? "NULL" : place);
  }
  return out;
}

bool has_fixed(const dem::Snapshot& s) {
  return std::any_of(s.grains.begin(), s.grains.end(), [](const auto& g) { return g.fixed; });
}

std::string import_command(const dem::Snapshot& s, const char* state, const LammpsDeck& deck) {
  std::string out = fmt::format(
      "grainfield import --from lammps {0}.grains {0}.contacts --column 'i,j=c_ids[1..2]' --column "
      "'fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]' --column 'sx,sy,sz=c_p[4..6]'{1}{2} --dim {3} --group "
      "/{0}",
      state, has_fixed(s) ? " --fixed type=2" : "", deck.ids.empty() ? "" : " --ids ids.csv",
      s.dim);
  for (std::size_t k = 0; k < s.walls.size(); ++k) {
    const dem::Wall& w = s.walls[k];
    int axis = 0;
    w.normal.cwiseAbs().maxCoeff(&axis);
    const std::string name = name_of(w, k);
    out +=
        fmt::format(" --wall {}:{}={:.10g}:fix=f_wall_{}", name, kAxes[axis], w.point[axis], name);
  }
  return out;
}

std::string dump_of(const dem::Snapshot& s, const char* state) {
  std::string walls;
  for (std::size_t k = 0; k < s.walls.size(); ++k) {
    walls += fmt::format(" f_wall_{}[*]", name_of(s.walls[k], k));
  }
  return fmt::format(
      "dump grains all custom 1 {0}.grains id type x y z radius mass vx vy vz omegax omegay "
      "omegaz{1}\n"
      "dump contacts all local 1 {0}.contacts index c_ids[1] c_ids[2] c_p[*]\n"
      "dump_modify grains format float %.17g sort id\n"
      "dump_modify contacts format float %.17g\n"
      "run 0\n"
      "undump grains\n"
      "undump contacts\n",
      state, walls);
}

std::string rest(const char* label) {
  return fmt::format(
      "variable turn loop 400\n"
      "label {0}\n"
      "run 2500\n"
      "if \"$(v_quiet) > 0\" then \"set group free omega 0 0 0\" \"next turn\" \"jump SELF {0}\"\n"
      "if \"$(v_quiet) > 0\" then \"print 'not at rest: raise the loop of turns'\" \"quit 1\"\n"
      "variable turn delete\n",
      label);
}

std::string input_of(const dem::Snapshot& s, const LammpsSetup& setup, const LammpsIds& ids,
                     LammpsDeck& deck) {
  const dem::MaterialSetup& m = setup.material;
  const double gravity = s.gravity.norm();
  const bool flat = s.dim == 2;
  double largest = 0, weight = 0;
  for (const dem::Grain& g : s.grains) {
    largest = std::max(largest, g.radius);
    if (!g.fixed) weight += g.mass * gravity;
  }
  double elastic = elastic_energy(s, m.law);
  if (!(elastic > 0)) elastic = 1e-4 * weight * largest;  // of spheres that do not touch yet
  const int copies = setup.copies[0] * setup.copies[1];
  const double quiet = setup.kinetic_to_elastic_energy * copies * elastic;
  const char* variables =
      setup.known ? "" : " -var law \"hooke K_N GAMMA_N ...\" -var step SECONDS";
  std::string out = fmt::format(
      "# lmp -in in.lammps{0}, or mpirun -n 8 lmp -in in.lammps{0}. Back:\n# {1} -o lammps.h5\n",
      variables, import_command(s, "unloaded", deck));
  if (const std::string mark = dem::added_forces_note(s.attributes); !mark.empty()) {
    out += fmt::format("# {}; LAMMPS goes on without them.\n", mark);
    deck.notes.push_back(mark + "; LAMMPS goes on without them");
  }
  if (!setup.known) {
    deck.notes.push_back(
        "the packing does not tell its law: in.lammps takes it and the time step from the command "
        "line, as its first line says; with CASE.toml before the packing the deck has both");
  }
  if (!setup.loaded.empty()) {
    out += "# " + import_command(s, "loaded", deck) +
           fmt::format(" --load {}={:.17g},{:.17g},{:.17g} --add -o lammps.h5\n",
                       ids.of(setup.loaded.front()), setup.force.x(), setup.force.y(),
                       setup.force.z());
  }
  out += fmt::format(
      "units si\n{}atom_style sphere\natom_modify map array\nnewton off\nboundary {} {} {}\n"
      "comm_modify vel yes\nread_data packing.data\n{}neighbor {:.6g} bin\n"
      "neigh_modify delay 0 every 1 check yes\ngroup free type 1\ngroup fixed type 2\n"
      "pair_style granular\npair_coeff * * {}\n",
      flat ? "dimension 2\n" : "", s.cell.periodic[0] ? "p" : "f", s.cell.periodic[1] ? "p" : "f",
      flat || s.cell.periodic[2] ? "p" : "f",
      copies > 1 ? fmt::format("replicate {} {} 1\n", setup.copies[0], setup.copies[1]) : "",
      0.2 * largest, law_of(setup, m.friction, deck));
  out += walls_of(s, setup, deck);
  out += fmt::format("timestep {}\nfix move free nve/sphere{}\n",
                     setup.known ? fmt::format("{:.17g}", setup.time_step) : "${step}",
                     flat ? " disc\nfix plane all enforce2d" : "");
  if (gravity > 0) {
    out += fmt::format("fix weight free gravity {:.17g} vector {:.17g} {:.17g} {:.17g}\n", gravity,
                       s.gravity.x() / gravity, s.gravity.y() / gravity, s.gravity.z() / gravity);
  }
  if (setup.background_damping > 0) {
    for (const char axis : {'x', 'y', 'z'}) {
      out += fmt::format("variable damp_{0} atom -{1:.17g}*mass*v{0}\n", axis,
                         setup.background_damping);
    }
    out += "fix damp free addforce v_damp_x v_damp_y v_damp_z\n";
    deck.notes.push_back("rest.background_damping slows displacement alone, not rotation");
  }
  if (setup.local_damping > 0) {
    deck.notes.push_back(
        "motion.local_damping is left out: LAMMPS has none, and comes to rest more slowly");
  }
  if (has_fixed(s)) out += "fix hold fixed freeze\n";
  out += fmt::format(
      "compute ids all property/local patom1 patom2 cutoff radius\n"
      "compute p all pair/local fx fy fz p1 p2 p3 cutoff radius\n"
      "compute motion free ke\ncompute spin free erotate/sphere\n"
      "thermo 2500\nthermo_style custom step atoms c_motion c_spin\n"
      "variable quiet equal \"c_motion+c_spin > {:.17g}\"\n\n",
      quiet);
  deck.notes.push_back(
      "until rest the spin of all spheres is set to 0 every 2500 steps: LAMMPS damps no rotation");
  out += "# The springs of friction begin anew.\n" + rest("unloaded") + dump_of(s, "unloaded");
  if (!setup.loaded.empty()) {
    out += "\ngroup loaded id";
    for (const std::int64_t id : setup.loaded) out += fmt::format(" {}", ids.of(id));
    out += fmt::format("\nfix load loaded addforce {:.17g} {:.17g} {:.17g}\nrun 2500\n",
                       setup.force.x(), setup.force.y(), setup.force.z()) +
           rest("loaded") + dump_of(s, "loaded");
    if (setup.loaded.size() > 1) {
      deck.notes.push_back(
          "import knows a load on one grain: of several the --load of the first is written");
    }
    deck.notes.push_back("the load comes at once, damped, instead of by load.ramp_time");
  }
  return out;
}

}  // namespace

double tsuji_restitution(double alpha) {
  if (!(alpha < tsuji_alpha(0))) return 0;
  if (!(alpha > tsuji_alpha(1))) return 1;
  std::uintmax_t steps = 100;
  const auto [low, high] =
      boost::math::tools::toms748_solve([alpha](double e) { return tsuji_alpha(e) - alpha; }, 0.0,
                                        1.0, boost::math::tools::eps_tolerance<double>(50), steps);
  return 0.5 * (low + high);
}

LammpsDeck lammps_deck(const dem::Snapshot& given, const LammpsSetup& setup) {
  check(given, setup);
  LammpsDeck deck;
  dem::Snapshot packing = given;
  if (!setup.known) leave_out_walls(packing, deck);
  const LammpsIds ids(packing);
  const bool copied = setup.copies[0] * setup.copies[1] > 1;
  if (!ids.kept()) deck.notes.push_back(ids.note(copied));
  if (!ids.kept() && !copied) deck.ids = ids.csv(packing);
  deck.data = data_of(packing, ids);
  deck.input = input_of(packing, setup, ids, deck);
  std::sort(deck.notes.begin(), deck.notes.end());
  deck.notes.erase(std::unique(deck.notes.begin(), deck.notes.end()), deck.notes.end());
  return deck;
}

}  // namespace grainfield::coupling
