// Keys of samples under compression and shear: [sample].
#include "coupling/studies/sample/keys.h"

#include "coupling/case/declare.h"
#include "coupling/run/grain_keys.h"
#include "coupling/studies/sample/simulation/grains.h"
#include "coupling/studies/sample/simulation/setup.h"
#include "dem/grains/loose.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(dem::SampleSetup, plan.MEMBER)

namespace grainfield::coupling {
namespace {

using std::string;
constexpr const char* kStress = "N/m (3D: Pa)";

std::vector<string> both(std::vector<string> first, const std::vector<string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

void grains(SectionKeys& s) {
  s.number("dim", "-", IN(dim), {2, 3},
           "dimensions: disks or polygons, or spheres or superellipsoids");
  const auto plane = dem::sample_shapes(2), space = dem::sample_shapes(3);
  s.word("shape", IN(shape), both(plane, space),
         "disks, polygons in Roul's way (rand1) or regular ones; spheres or superellipsoids");
  s.words_of_dimensions(plane, space);
  s.number("grains", "-", IN(grains), {1, 1e7},
           "more: less scatter between realizations and weaker boundaries");
  s.word("sizes", IN(sizes), {"mono", "bidisperse", "uniform"},
         "radii: all equal, two sizes, or uniform in radius (1 -+ polydispersity)");
  s.number("radius", "m", IN(radius), kRadius,
           "of the circle or sphere that carries a grain, its mean; bidisperse: the larger one; "
           "superellipsoids: the unit of their semi-axes");
  s.number("polydispersity", "-", IN(polydispersity), {0, 0.9},
           "half the width of the radii over their mean; more keeps crystals away");
  s.only("sample.sizes", {"uniform"});
  s.number("size_ratio", "-", IN(size_ratio), {1, 100},
           "larger over smaller radius; the smaller one sets the time step");
  s.only("sample.sizes", {"bidisperse"});
  s.number("fraction_small", "-", IN(fraction_small), {0, 1},
           "share of the smaller grains, by number");
  s.only("sample.sizes", {"bidisperse"});
  s.number("corners_min", "-", IN(corners_min), {3, 64}, "fewest corners of a polygon");
  s.only("sample.shape", {"rand1", "regular"});
  s.number("corners_max", "-", IN(corners_max), {3, 64},
           "most corners; the number is drawn between both");
  s.only("sample.shape", {"rand1", "regular"});
  declare_superellipsoid_keys(s, "sample.shape",
                              {IN(axis_min), IN(axis_max), IN(exponent_min), IN(exponent_max)});
  s.word("axes_times", IN(axes_times), {"one", "sizes"},
         "the semi-axes are drawn as they are, or times a size drawn as sample.sizes says");
  s.only("sample.shape", {"superellipsoid"});
}

void place(SectionKeys& s) {
  s.word("boundary", IN(boundary), {"periodic", "walls"},
         "a cell that repeats itself and flows, or a box of walls that move");
  s.number("height_ratio", "-", IN(height_ratio), {0.05, 20},
           "edge along the last axis (y, in 3D z) over the others, at the start");
  s.number(
      "start_fraction", "-", IN(start_fraction), {0.01, dem::kMostLoose2},
      "solid fraction of the grains placed at random; lower: a longer compression, less memory "
      "of the places");
  s.word(
      "filling", IN(filling), {"placed", "dropped"},
      "the box is filled by its compression alone; or grains fall into it under gravity, the lid "
      "is put on the highest, the gap below filled with spheres, and then gravity taken away "
      "(walls)",
      "Wellmann 6");
  s.space();
  const auto dropped = [&] { s.only("sample.filling", {"dropped"}); };
  s.number("base_fraction", "-", IN(base_fraction), {0.02, 1},
           "solid fraction at which the base would be filled up to sample.height_ratio; lower: a "
           "wider base and a lower bed");
  dropped();
  s.number("drop_gravity", "m/s2", IN(drop_gravity), kAcceleration, "downwards, while they fall");
  dropped();
  s.number("drop_damping", "1/s", IN(drop_damping), {1e-6, 1e9},
           "of all motion while they fall: velocities decay so fast; higher: they fall at gravity "
           "over this and come to rest sooner",
           "Wellmann 6");
  dropped();
}

void gap(SectionKeys& s) {
  s.word(
      "gap", IN(gap), {"hanging", "fitted"},
      "spheres between the lid and dropped grains: of drawn radii, touching the lid alone, which "
      "comes down by part of a grain until they bear; or each as large as its place allows, up "
      "to the largest semi-axis, so that it touches lid and grains",
      "Wellmann 4");
  s.only("sample.filling", {"dropped"});
}

void compression(SectionKeys& s) {
  s.word("compression", IN(compression), {"isotropic", "uniaxial"},
         "all edges shorten, or the one along the last axis");
  s.word("compress_to", IN(compress_to), {"pressure", "solid_fraction", "strain", "none"},
         "what ends the compression: the pressure that servos then hold, a solid fraction, or a "
         "strain; none, with sample.filling = dropped: the first state is the box as it was "
         "filled, without compression and rest");
  s.number("pressure", kStress, IN(pressure), Range{1e-6, 1e15}.with_zero(),
           "held by servos, compression positive; higher: denser, with larger overlaps");
  s.only("sample.compress_to", {"pressure"});
  s.number("solid_fraction", "-", IN(solid_fraction), {0.01, 1.3},
           "volume of the grains over that of the box; overlaps count twice");
  s.only("sample.compress_to", {"solid_fraction"});
  s.number("compression_strain", "-", IN(compression_strain), {0, 0.9},
           "share by which every edge that moves shortens");
  s.only("sample.compress_to", {"strain"});
  s.number("compression_rate", "1/s", IN(compression_rate), {1e-6, 1e6},
           "of an edge, and of servos at most; slower: a calmer start and a longer run");
  s.word("prepared_with", IN(prepared_with), {"same_friction", "other_friction"},
         "friction until the first rest: that of [material], or sample.prepared_friction; then the "
         "grains go on with that of [material], and a lower one lets them slide as they begin to "
         "move");
  s.number("prepared_friction", "-", IN(prepared_friction), {0, 10},
           "between grains, and of walls at most; lower: a denser first state");
  s.only("sample.prepared_with", {"other_friction"});
  s.number("precompression", "-", IN(precompression), {0, 0.9},
           "strain by which the last axis alone shortens before the first state, at "
           "sample.strain_rate",
           "Wellmann 28");
  s.word("settle", IN(settle), {"rest", "none"},
         "after a precompression the grains rest, or the first state is taken at once, as a state "
         "on the way of a compression",
         "Wellmann 6");
}

void probes(SectionKeys& s) {
  s.word("probe", IN(probe), {"none", "prepared", "first", "both"},
         "where elastic moduli are measured by small strains, each from the same grains at rest: "
         "nowhere, after the preparation (the first rest), in the first state, in both");
  s.space();
  s.number("probe_strain", "-", IN(probe_strain), {1e-9, 1e-2},
           "of each of them; much below the overlaps (pressure over stiffness), so that contacts "
           "neither come nor go");
  s.only("sample.probe", {"prepared", "first", "both"});
}

void deformation(SectionKeys& s) {
  s.word("deformation", IN(deformation), {"simple_shear", "axial", "uniaxial", "isotropic"},
         "the last axis' planes slide along x; the last axis shortens while servos hold the "
         "others' stress; it alone shortens; all shorten alike");
  s.word("constant", IN(constant), {"volume", "stress"},
         "of a simple shear: the volume, or the normal stress across the planes that slide");
  s.only("sample.deformation", {"simple_shear"});
  s.word("sides", IN(sides), {"tilting", "upright"},
         "of a simple shear between walls: the sides tilt with the lid, or stay upright, which "
         "forbids a uniform shear");
  s.only("sample.boundary", {"walls"});
  s.only("sample.deformation", {"simple_shear"});
  s.number("strain", "-", IN(strain), {1e-6, 1e3},
           "imposed: tangent of the shear; of an edge its logarithm in a cell, its share between "
           "walls");
  s.number("strain_rate", "1/s", IN(strain_rate), {1e-6, 1e6},
           "of the same; slower: less inertia (sample.inertial_number), a better held stress and a "
           "longer run");
  s.number("ramp_time", "s", IN(ramp_time), kTime, "from rest to the full rate, between walls");
  s.only("sample.boundary", {"walls"});
  s.number("records", "-", IN(records), {1, 999},
           "recorded states after the first one, at equal steps of strain; more: finer curves and "
           "larger files");
}

void unloading(SectionKeys& s) {
  s.word("unload", IN(unload), {"none", "strain", "stress"},
         "after the last strain the deformation is taken back: not, by a share of the strain, or "
         "until the axial stress has fallen (to a thousandth of the largest at the latest)",
         "Wellmann fig. 12");
  s.number("unload_strain", "-", IN(unload_strain), {1e-6, 2}, "share of the strain; 1: all of it");
  s.only("sample.unload", {"strain"});
  s.number("unload_stress", "-", IN(unload_stress), {0, 10},
           "share of the first state's axial stress at which it ends; 1: what is left of the "
           "strain there is plastic");
  s.only("sample.unload", {"stress"});
  s.number("unload_records", "-", IN(unload_records), {1, 999},
           "recorded states of the unloading, at equal steps of what ends it");
  s.only("sample.unload", {"strain", "stress"});
}

}  // namespace

void declare_sample_keys(SectionKeys s) {
  grains(s);
  place(s);
  gap(s);
  compression(s);
  probes(s);
  deformation(s);
  unloading(s);
}

}  // namespace grainfield::coupling

#undef IN
