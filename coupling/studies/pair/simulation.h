// Two bodies, or one and a wall: a free collision through the engine, or a prescribed path. It
// shows what a contact law does with its parameters.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"

namespace grainfield::dem {

/// The second body rests at the origin (a wall: the plane x = 0); the first comes from the left.
struct PairSetup {
  std::string kind = "collision";  ///< collision: free, without gravity | path: prescribed
  std::string shape = "disk";      ///< disk | rand1 | regular | outline | sphere (3D)
  std::string partner = "grain";   ///< the second body: grain | wall
  double radius = 0.01;            ///< m; of polygons: of the circle that the corners lie on
  double radius_second = 0;        ///< m; 0: as the first
  int corners = 6;                 ///< rand1, regular
  double axis_ratio = 1;           ///< rand1
  std::vector<double> outline;     ///< outline: x1, y1, x2, y2, ... in units of the radius
  double turned_first = 0, turned_second = 0;  ///< deg; rand1: beside the angle that is drawn
  double speed = 0.1;                          ///< m/s, of the first; path: along it
  double angle = 0;                            ///< deg, of its velocity to the x axis; collision
  double offset = 0;                           ///< of its centroid from the x axis, over the radius
  std::vector<double> spin_first, spin_second;  ///< rad/s: one number, in 3D three; none: 0
  std::vector<double> speeds;                   ///< collision: further ones at these speeds, m/s
  std::vector<double> angles;                   ///< and at these angles, deg
  std::string path = "loop";  ///< approach | slide | roll | loop | random | waypoints
  /// How far the first comes beyond touching, over the radius; loop: the middle of its ellipse.
  double depth = 0.02;
  double amplitude = 0.1;         ///< slide, loop: over the radius
  double swing = 10;              ///< roll, loop: deg
  int turns = 1;                  ///< approach, slide, roll
  int steps = 2000;               ///< of a path, at least: more where its work needs it
  int loops = 100;                ///< random
  std::vector<double> waypoints;  ///< x, y (radii, from touching), angle (rad), and so on
  int records = 200;              ///< rows of the profile, about
  MaterialSetup material = [] {
    MaterialSetup m;
    m.gravity = 0;
    return m;
  }();
  MotionSetup motion = [] {
    MotionSetup m;
    m.time_step_fraction = 0.01;  // some hundred steps of an impact
    return m;
  }();

  auto members() const {
    return std::tie(kind, shape, partner, radius, radius_second, corners, axis_ratio, outline,
                    turned_first, turned_second, speed, angle, offset, spin_first, spin_second,
                    speeds, angles, path, depth, amplitude, swing, turns, steps, loops, waypoints,
                    records, material, motion);
  }
  bool is_3d() const { return shape == "sphere"; }
};

/// A column of a table that the run leaves, with its unit.
struct PairColumn {
  const char *name, *unit;
};

/// Columns of the profile: table "pair" of the first snapshot. x, y, angle: place of the first
/// body and its turning about z.
inline constexpr PairColumn kPairColumns[] = {{"time", "s"},
                                              {"depth", "m"},
                                              {"area", "m2"},
                                              {"normal_force", "N"},
                                              {"tangential_force", "N"},
                                              {"torque_first", "Nm"},
                                              {"torque_second", "Nm"},
                                              {"kinetic", "J"},
                                              {"stored", "J"},
                                              {"dissipated", "J"},
                                              {"x", "m"},
                                              {"y", "m"},
                                              {"angle", "rad"}};

/// For every path of path = "random", table "loops" of the first snapshot: its work over the
/// largest energy stored on it, that energy, and how often the outlines crossed at most.
inline constexpr PairColumn kLoopColumns[] = {
    {"work_over_energy", "1"}, {"stored_most", "J"}, {"crossings", "1"}};

/// One of the collisions asked for.
struct PairLaunch {
  double speed = 0, angle = 0;       ///< m/s, deg
  std::string name;                  ///< its figures begin so: "pair.", "pair.speed_0.1."
  std::string speed_key, angle_key;  ///< where both are given: "pair.speeds", "pair.angle"
};

/// In the order in which they are run: the setup's own, then those of its speeds, then its angles.
std::vector<PairLaunch> pair_launches(const PairSetup& setup);

/// Snapshots "state_00", ... in the order of time. Throws std::invalid_argument naming the key.
std::unique_ptr<Run> make_pair_run(const PairSetup& setup, std::uint64_t seed, int threads);
/// The same refusals, for as many of the seeds as cost no more than drawing `most` bodies.
Outlook foresee_pair(const PairSetup& setup, const std::vector<std::uint64_t>& seeds,
                     std::int64_t most);

}  // namespace grainfield::dem
