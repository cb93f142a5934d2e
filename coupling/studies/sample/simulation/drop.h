// A sample that is dropped into its box: the lid comes down to the highest grain, and the gap below
// it is filled with spheres (Wellmann, section 6).
#pragma once
#include "coupling/studies/sample/simulation/setup.h"
#include "dem/random/random.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

inline bool is_dropped(const SamplePlan& p) { return p.filling == "dropped"; }

/// The same sample as one whose box is filled from the beginning, with the solid fraction that its
/// base is made for.
SamplePlan as_filled(const SamplePlan& plan);

/// What gravity has left: grains at rest on the floor.
struct FilledBox {
  Snapshot snapshot;       ///< lid on, gap filled, without gravity; all at rest
  int spheres = 0;         ///< in the gap
  double height = 0;       ///< of the lid above the floor, m
  double solid_share = 0;  ///< volume of all grains over that of the box
};

/// The lid touches the highest point of a grain; spheres that touch it, with radii drawn as the
/// plan draws those of its grains (superellipsoids: a semi-axis), are put in at random places where
/// they overlap nothing, until none finds room any more. plan.gap "fitted": each is as large as its
/// place and the largest of those radii allow, so that it touches what is below.
FilledBox put_lid_on(const Snapshot& bed, const SamplePlan& plan, double density, Random& random);

/// A recorded state as such a box: its grains at rest and without their contacts, which a law of
/// its own finds anew. What it holds beyond plan.grains counts as spheres of the gap. Throws
/// std::invalid_argument naming the key that does not go with the state.
FilledBox filled_box(const Snapshot& state, const SamplePlan& plan, double density);

}  // namespace grainfield::dem
