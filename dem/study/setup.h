// Plain settings of a discrete-element study, with Roul's table 5.1 as defaults. SI, 2D:
// areal density in kg/m2, stiffness and Young's modulus in N/m.
#pragma once
#include <string>
#include <vector>

namespace grainfield::dem {

/// What a grain looks like. Outlines have their centroid at the origin and lie at random angles.
struct ShapeSetup {
  std::string kind = "rand1";   ///< disk | rand1 (corners at random on a circle or ellipse, Roul) |
                                ///< regular | irregular (pentagons) | outline (given)
  double radius = 0.00275;      ///< m; disk; or of the circle that the corners lie on (rand1 with
                                ///< axis_ratio: ellipse of equal area)
  double polydispersity = 0.3;  ///< sizes uniform in (1 -+ this) times radius or side; below 1
  int corners_min = 6;          ///< rand1, regular: corners, uniform between these two; 3 or more
  int corners_max = 8;
  double axis_ratio = 1;  ///< rand1: major over minor axis of the ellipse that carries the corners
  double side = 0;        ///< m; irregular: mean length of a side; 0: of the regular pentagon whose
                          ///< corners lie on `radius`
  std::vector<double> outline;  ///< outline: x1, y1, x2, y2, ... in units of `radius`, convex
};

struct PackingSetup {
  std::string kind = "layered";   ///< triangular | sqrt3 | layered
  std::string sizes = "uniform";  ///< mono | bidisperse | uniform
  double radius = 0.0045;         ///< m; mono, and the larger of bidisperse
  double radius_small = 0.0035;   ///< m; the smaller of bidisperse
  double fraction_small = 0.5;    ///< share by number of the smaller grains
  double radius_min = 0.0036;     ///< m; uniform
  double radius_max = 0.0054;     ///< m; uniform
  int columns = 64;               ///< lattices: grains in a row
  int rows = 16;                  ///< lattices: rows
  double spacing = 1;             ///< sqrt3: spacing in a row / (sqrt(3) d), up to 1; below 1 rows
                                  ///< two apart do not touch, and a grain has four contacts
  double width = 0.6;             ///< m; layered
  double depth = 0.15;            ///< m; layered: rows are dropped until this height is reached
  double drop_height = 0.008;     ///< m above the surface from which a row is dropped
  std::string floor = "smooth";   ///< smooth (flat wall with friction) | rough (fixed grains)
  double jitter = 0;              ///< lattices: relative spread of radii, uniform +- (0 = perfect)
  std::string shape = "disk";     ///< layered: disk | irregular (pentagons; `sizes` is not used)
  double side = 0.009;            ///< m; irregular: mean length of a side (Roul 5.1)
};

struct MaterialSetup {
  std::string law = "overlap_area";       ///< overlap_area | linear
  double density = 5000;                  ///< kg/m2
  double young = 1e7;                     ///< N/m; overlap_area
  double damping = 0.75;                  ///< gamma of overlap_area, -
  double normal_stiffness = 1e7;          ///< N/m; linear
  double tangential_stiffness = 2e7 / 7;  ///< N/m; linear
  double normal_damping = 500;            ///< 1/s; linear: force m_eff * gamma_n * v_n
  double tangential_damping = 250;        ///< 1/s; linear
  double friction = 0.5;                  ///< grain on grain
  double floor_friction = 0.5;            ///< grain on flat floor
  double wall_friction = 0;               ///< grain on side walls
  double gravity = 9.81;                  ///< m/s2, downwards
};

struct MotionSetup {
  std::string integrator = "verlet";  ///< verlet | gear (same results, ten times shorter steps)
  double time_step = 0;               ///< s; 0 = time_step_fraction of the stable limit
  double time_step_fraction = 0.8;    ///< of the stable limit (engine.h: stable_time_step)
};

struct RestSetup {
  double unbalanced_force_ratio = 1e-6;  ///< mean resultant / mean contact force
  double kinetic_to_elastic_energy = 1e-10;
  double background_damping = 100;  ///< 1/s, acceleration -= this * v while coming to rest
  double max_time = 20;             ///< s of simulated time for any one rest
};

struct LoadSetup {
  double force = 300;             ///< N, downwards on one grain
  std::string method = "damped";  ///< damped: slow damped dynamics | newton: quasi-static solver
  double unbalanced_force_ratio = 1e-8;  ///< newton: to be reached
  double ramp_time = 0.5;                ///< s from 0 to the full force (smooth ramp); damped
  double position = 0.5;  ///< of the width: the top grain nearest to it carries the force
};

/// How a pile is poured (Roul 3.1, 3.11, table 2).
struct SourceSetup {
  std::string kind = "point";  ///< point: grain by grain from above | line: layer by layer
  int grains = 6500;           ///< 3 or more; line: fewer when the pile has come to a point before
  double speed = 0.2;          ///< m/s downwards at the start, of both
  double height = 0.5;         ///< m above the floor; point: of the funnel's mouth
  double interval = 0.1;       ///< s from one grain to the next; point
  double spread = 0.5;  ///< mean radii; point: grains start within +- this from the funnel's axis
  double opening = 0;   ///< m; point: width of the mouth between two immobile plates; 0: no plates,
                        ///< grains fall freely from the mouth (dem/heap/funnel.h)
  double move = 0;      ///< m; point: the funnel moves this far to the right while it pours,
                        ///< from -move/2 to move/2 (asymmetric piles)
  double clearance = 0.008;  ///< m above the pile from which a layer falls; line
  double length = 0.77;      ///< m; line: length of the first layer, about 0.7 of the base of the
                             ///< finished pile; later ones cover the pile's plateau
  double shift = 0;  ///< m; line: each layer's middle lies this far to the right of the last one's
                     ///< (asymmetric piles)
};

/// The ground, y = 0, with side walls at its ends that only catch stray grains: a pile that leans
/// on them is refused.
struct FloorSetup {
  std::string kind = "smooth";  ///< smooth: flat, with material.floor_friction | rough: fixed
                                ///< grains like those of the pile, side by side below y = 0
  double length = 1.6;          ///< m
};

/// Grains at rest sleep while the pile is poured (engine.h: SleepSettings).
struct SleepSetup {
  bool on = true;
  double quiet_time = 1e-2;  ///< s
  double quiet_move = 8e-4;  ///< diameters within quiet_time
  double quiet_force = 0.1;  ///< resultant over the forces on the grain
  double wake_force = 0.15;  ///< likewise
  double wake_speed = 0.5;   ///< sqrt(g d)
  double wake_reach = 2;     ///< d v / sqrt(g d), of a grain that comes at the speed v
};

/// After the rest: gravity is changed, slowly, and the pile comes to rest again. Every change
/// starts from the pile at material.gravity.
struct ChangeSetup {
  std::vector<double> gravity;    ///< m/s2, above 0, one snapshot for each; empty: none
  std::string method = "newton";  ///< newton: quasi-static solver | damped: slow damped dynamics
  double unbalanced_force_ratio = 1e-8;  ///< newton: to be reached
  double ramp_time = 0.5;  ///< s from the old to the new gravity (smooth ramp); damped
};

/// A pile (Roul ch. 3): pour -> settle -> rest with every grain awake -> snapshot "pile" -> for
/// each changed gravity a snapshot "gravity_G", G as {:g} prints it ("gravity_8.829").
struct PileSetup {
  ShapeSetup shape;
  SourceSetup source;
  FloorSetup floor;
  MaterialSetup material = [] {
    MaterialSetup m;
    m.friction = m.floor_friction = 0.54;
    return m;
  }();
  MotionSetup motion;
  RestSetup rest;
  SleepSetup sleep;
  ChangeSetup change;
};

/// A pile of equal disks on the triangular lattice (Liffman et al. 1992): rows that shrink upwards
/// so that the outline follows the slope, on a floor whose friction holds the lowest row.
struct LatticeSetup {
  int base_grains = 45;    ///< disks in the lowest row; at 60 degrees also the number of rows
  double slope_deg = 60;   ///< of the outline, up to 60
  double radius = 0.0045;  ///< m
  double gap = 5e-4;       ///< between neighbours of a row / diameter; 0: they may touch, and carry
                           ///< force where the pile's own weight pushes them together
};

/// The lattice pile comes to rest under its weight: rest -> snapshot "pile". Disks of the lowest
/// row do not spin, as Liffman's static friction acts on their centres (eq. 30, 33).
struct LatticePileSetup {
  LatticeSetup lattice;
  MaterialSetup material = [] {
    MaterialSetup m;
    m.law = "linear";
    m.normal_stiffness = 3.5e8;  // m g/(K d) = 1e-6 with these disks: close to Liffman's hard ones
    m.tangential_stiffness = 1e8;
    m.friction = 0;        // at rest Liffman's grains exert no tangential force on each other
    m.floor_friction = 1;  // above tan 30 degrees, the steepest H/N
    return m;
  }();
  MotionSetup motion;
  RestSetup rest = [] {
    RestSetup r;
    r.unbalanced_force_ratio = 1e-8;
    r.background_damping = 1000;  // about critical for the slowest swing of 45 layers
    return r;
  }();
};

struct PointLoadSetup {
  PackingSetup packing;
  MaterialSetup material;
  MotionSetup motion;
  RestSetup rest;
  LoadSetup load;
};

}  // namespace grainfield::dem
