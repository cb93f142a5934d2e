// A pile of polygons or disks, poured grain by grain, with Roul's ch. 3 as defaults. SI, 2D: areal
// density in kg/m2, stiffness and Young's modulus in N/m.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "dem/grains/packing.h"
#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/pouring/source.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"
#include "dem/run/setup.h"
#include "dem/sleep/sleep_settings.h"

namespace grainfield::dem {

/// The ground, y = 0, with side walls at its ends that only catch stray grains: a pile that leans
/// on them is refused.
struct FloorSetup {
  std::string kind = "smooth";  ///< smooth: flat, with material.floor_friction | rough: fixed
                                ///< grains like those of the pile, side by side below y = 0
  double length = 1.6;          ///< m

  auto members() const { return std::tie(kind, length); }
};

/// After the rest: gravity is changed, slowly, and the pile comes to rest again. Every change
/// starts from the pile at material.gravity.
struct ChangeSetup {
  std::vector<double> gravity;    ///< m/s2, above 0, one snapshot for each; empty: none
  std::string method = "newton";  ///< newton: quasi-static solver | damped: slow damped dynamics
  double unbalanced_force_ratio = 1e-8;  ///< newton: to be reached
  double ramp_time = 0.5;  ///< s from the old to the new gravity (smooth ramp); damped

  auto members() const { return std::tie(gravity, method, unbalanced_force_ratio, ramp_time); }
};

/// A pile (Roul ch. 3): pour -> settle -> rest with every grain awake -> snapshot "pile" -> for
/// each changed gravity a snapshot "gravity_G", G as {:g} prints it ("gravity_8.829"); before it
/// was finished, of N grains, a snapshot "poured_N" for each of `record`.
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
  SleepSettings sleep{.on = true};
  ChangeSetup change;
  std::vector<double> record;  ///< numbers of grains, whole, each above the last; empty: none

  auto members() const {
    return std::tie(shape, source, floor, material, motion, rest, sleep, change, record);
  }
};

/// Whether a snapshot of this name is of the pile under another gravity.
bool is_change(const std::string& name);

/// A pile: poured, settled, at rest ("pile"), and at rest under each changed gravity
/// ("gravity_8.829"). Throws
/// std::invalid_argument naming the key of the setup that does not hold. The bits of the result do
/// not depend on threads.
std::unique_ptr<Run> make_pile_run(const PileSetup& setup, std::uint64_t seed, int threads);

/// A pile that stands already: snapshot GROUP/pile of `file`, brought to rest under each of
/// setup.change.gravity; a GROUP/gravity_G that the file holds is taken as it is. Of `setup` only
/// material, motion, rest and change are used. Throws std::invalid_argument when
/// the file is broken, or the pile is another one than the material's (gravity, density, friction,
/// law, or it is out of balance with the stiffness).
std::unique_ptr<Run> make_pile_change_run(const PileSetup& setup, const std::string& file,
                                          const std::string& group, int threads);

/// Throws std::invalid_argument naming the key, as make_pile_run would for any of these seeds, and
/// for more than kMostGrains. At most `draws` grains are drawn beforehand; if more would be, limits
/// that depend on them are taken a little tighter.
Outlook foresee_pile(const PileSetup& setup, const std::vector<std::uint64_t>& seeds,
                     std::int64_t draws);

/// Foresees the time alone of changes of gravity of a pile that stands already.
Outlook foresee_changes(const ChangeSetup& change);

}  // namespace grainfield::dem
