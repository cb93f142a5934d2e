#include "coupling/run/grain_keys.h"

#include <algorithm>

#include "coupling/case/declare.h"
#include "dem/laws/material_defaults.h"
#include "dem/laws/registry.h"
#include "dem/motion/registry.h"

// A key bound to the member of the same name in the setup of the case's study.
#define MATERIAL(TYPE, MEMBER) [](Case& c) -> TYPE& { return material_of(c).MEMBER; }
#define MOTION(TYPE, MEMBER) [](Case& c) -> TYPE& { return motion_of(c).MEMBER; }
#define REST(TYPE, MEMBER) [](Case& c) -> TYPE& { return rest_of(c).MEMBER; }

namespace grainfield::coupling {
namespace {

using std::string;
constexpr const char* kBoth = "Roul tables 5.1, 2";
constexpr const char* kLuding = "Luding 2008";

// The words of `some` that `others` do not have.
std::vector<string> only_in(const std::vector<string>& some, const std::vector<string>& others) {
  std::vector<string> out;
  for (const string& word : some) {
    if (std::find(others.begin(), others.end(), word) == others.end()) out.push_back(word);
  }
  return out;
}

dem::MaterialSetup& material_of(Case& c) {
  const Study* study = find_study(c.study);
  return study != nullptr && study->material != nullptr ? study->material(c)
                                                        : c.get<dem::MaterialSetup>();
}

dem::MotionSetup& motion_of(Case& c) {
  const Study* study = find_study(c.study);
  return study != nullptr && study->motion != nullptr ? study->motion(c)
                                                      : c.get<dem::MotionSetup>();
}

dem::RestSetup& rest_of(Case& c) {
  const Study* study = find_study(c.study);
  return study != nullptr && study->rest != nullptr ? study->rest(c) : c.get<dem::RestSetup>();
}

}  // namespace

void declare_material_keys(SectionKeys s) {
  s.word("law", +MATERIAL(string, law), dem::words_of<dem::AnyLaw>(),
         "contact law: elastic force from the overlap area, the same as the gradient of an energy, "
         "linear spring and dashpot, Hertz' contact of spheres with Mindlin's tangential "
         "stiffness, linear spring with its critical dashpot, or Hertz' contact of two curvatures "
         "with Mindlin's two compliances",
         "Roul 2.3");
  const auto plane = dem::laws_in<2>(), space = dem::laws_in<3>();
  s.words_of_dimensions(only_in(plane, space), only_in(space, plane));
  s.number("density", "kg/m2 (3D: kg/m3)", +MATERIAL(double, density), {1e-3, 1e6},
           "density of the grains, in 2D areal; heavier grains: longer time step", kBoth);
  s.number("young", "N/m (3D: Pa)", +MATERIAL(double, young), kStiffness,
           "Young's modulus of the grains; stiffer: smaller overlaps and a shorter "
           "time step",
           kBoth);
  s.only("material.law", {"overlap_area", "energy", "hertz", "hertz_elliptic"});
  s.number(
      "poisson", "-", +MATERIAL(double, poisson), {-0.999, 0.5},
      "Poisson's ratio of the grains; more: stiffer across the contact, softer along it; at -1 "
      "no shape would change",
      "Thornton et al. 2013");
  s.space();
  s.only("material.law", {"hertz", "hertz_elliptic"});
  s.number("least_radius", "-", +MATERIAL(double, least_radius), {1e-6, 1},
           "least radius of curvature of a contact, 1/(2B), over that of the spheres of equal "
           "volume: at edges; smaller: softer there",
           "Wellmann 9-13");
  s.space();
  s.only("material.law", {"hertz_elliptic"});
  s.number("most_radius", "-", +MATERIAL(double, most_radius), {1, 1e6},
           "largest radius of curvature of a contact, 1/(2A), likewise: on flat faces; larger: "
           "stiffer there, and a shorter time step",
           "Wellmann 9-13");
  s.space();
  s.only("material.law", {"hertz_elliptic"});
  s.word("tangential_memory", +MATERIAL(string, tangential_memory), {"force", "displacement"},
         "what the spring of friction keeps as the contact's radius changes: its force, which "
         "shrinks with the radius while the contact unloads, or its displacement, as LAMMPS' "
         "gran/hertz/history, which makes energy where a sheared contact is pressed together",
         "Thornton et al. 2013");
  s.space();
  s.only("material.law", {"hertz", "hertz_elliptic"});
  s.word("damping_model", +MATERIAL(string, damping_model), {"critical", "viscoelastic"},
         "dashpots of the share material.damping of the critical one, or, as LAMMPS' "
         "gran/hertz/history, of normal_damping and tangential_damping times the contact's radius");
  s.space();
  s.only("material.law", {"hertz"});
  s.number("damping", "-", +MATERIAL(double, damping), {0, 1000},
           "gamma of the normal dashpot; hertz with damping_model \"critical\": of both dashpots, "
           "penalty and hertz_elliptic: of the normal one, 1 is critical; more dissipates faster",
           kBoth);
  s.only("material.law", {"overlap_area", "energy", "hertz", "penalty", "hertz_elliptic"});
  s.number("tangential_ratio", "-", +MATERIAL(double, tangential_ratio), {0, 1000},
           "tangential spring over young; Roul's formula as printed amounts to about 38 times 2/7");
  s.only("material.law", {"overlap_area", "energy"});
  s.word("energy", +MATERIAL(string, energy), {"square", "power"},
         "energy of an overlap: of the square of its area, or of its 5/3 power, which is "
         "overlap_area for disks");
  s.only("material.law", {"energy"});
  s.number(
      "linear_share", "-", +MATERIAL(double, linear_share), {1e-6, 1},
      "power: below this overlap area over l0^2 the force per chord is linear; less is stiffer "
      "edge on edge, and a shorter time step");
  s.only("material.energy", {"power"});
  s.number("normal_stiffness", "N/m", +MATERIAL(double, normal_stiffness), kStiffness,
           "normal spring");
  s.only("material.law", {"linear", "penalty"});
  s.number("tangential_stiffness", "N/m", +MATERIAL(double, tangential_stiffness), {0, 1e15},
           "tangential spring; 2/7 of the normal one for spheres, 1/3 for disks, makes both swing "
           "in step");
  s.follows(dem::followed_by("tangential_stiffness"));
  s.only("material.law", {"linear", "penalty"});
  s.number("restitution", "-", +MATERIAL(double, restitution), {1e-12, 1},
           "share of the speed that two equal round grains of the nominal size keep when they meet "
           "head on: the normal dashpot follows from it. linear and viscoelastic hertz dashpots "
           "have a scale and follow the default, too; where the dashpot is given, this follows it");
  s.only("material.law", {"linear", "penalty", "hertz", "hertz_elliptic"});
  s.remarked();
  s.number("normal_damping", "1/s (hertz: 1/(m s))", +MATERIAL(double, normal_damping), kRate,
           "normal force of the dashpot per reduced mass and approach velocity; hertz: and per "
           "radius of the contact, with damping_model \"viscoelastic\"");
  s.follows(dem::followed_by("normal_damping"));
  s.only("material.law", {"linear", "hertz"});
  s.number("tangential_damping", "1/s (hertz: 1/(m s))", +MATERIAL(double, tangential_damping),
           kRate,
           "tangential force of the dashpot per reduced mass and slip velocity; hertz: likewise");
  s.follows(dem::followed_by("tangential_damping"));
  s.only("material.law", {"linear", "hertz"});
  s.number(
      "friction", "-", +MATERIAL(double, friction), {0, 10},
      "Coulomb coefficient grain on grain; more merges the two peaks of the sqrt(3) lattice into "
      "one",
      kBoth);
  s.number("floor_friction", "-", +MATERIAL(double, floor_friction), {0, 10},
           "Coulomb coefficient grain on flat floor; the fixed grains of a rough one have "
           "material.friction",
           kBoth);
  s.number("wall_friction", "-", +MATERIAL(double, wall_friction), {0, 10},
           "Coulomb coefficient grain on side walls; above 0 the walls carry weight");
  s.number("gravity", "m/s2", +MATERIAL(double, gravity), kAcceleration, "downwards", kBoth);
  s.number(
      "rolling_friction", "-", +MATERIAL(double, rolling_friction), {0, 10},
      "rolling resistance of round grains: the pseudo-force against rolling is at most this times "
      "the "
      "normal force, so a disk rests on slopes up to this tangent; 0: none. Not with polygons or "
      "Newton's method",
      kLuding);
  s.number("rolling_stiffness", "N/m", +MATERIAL(double, rolling_stiffness), {0, 1e15},
           "rolling spring: pseudo-force per rolling displacement; stiffer: shorter time step",
           kLuding);
  s.number("rolling_damping", "kg/s", +MATERIAL(double, rolling_damping), {0, 1e12},
           "rolling dashpot: pseudo-force per rolling velocity", kLuding);
  s.number(
      "twisting_friction", "m", +MATERIAL(double, twisting_friction), {0, 1e3},
      "resistance against twisting: its moment is at most this times the normal force; 0: none",
      kLuding);
  s.space();
  s.number("twisting_stiffness", "N m", +MATERIAL(double, twisting_stiffness), {0, 1e15},
           "twisting spring: moment per angle; stiffer: shorter time step", kLuding);
  s.space();
  s.number("twisting_damping", "N m s", +MATERIAL(double, twisting_damping), {0, 1e12},
           "twisting dashpot: moment per twisting rate", kLuding);
  s.space();
}

void declare_motion_keys(SectionKeys s) {
  s.word("integrator", +MOTION(string, integrator), dem::words_of<dem::AnyIntegrator>(),
         "velocity Verlet; Gear's predictor-corrector of fifth order (in the plane; shorter stable "
         "step); or leapfrog with a fourth-order Runge-Kutta turning (superellipsoids)",
         "Roul 2.5, Wellmann 2");
  s.number("time_step", "s", +MOTION(double, time_step), Range{1e-12, 1}.with_zero(),
           "0: time_step_fraction of the stable limit");
  s.number("time_step_fraction", "-", +MOTION(double, time_step_fraction), {1e-6, 2.5},
           "share of the stable limit; less is more exact and takes longer. Above 1 for irregular "
           "polygons (rand1, irregular) with verlet only: the limit holds for chains of equal "
           "grains edge "
           "on edge",
           "Roul 2.10");
  s.only("motion.time_step", {"0.0"});
  s.number(
      "local_damping", "-", +MOTION(double, local_damping), {0, 0.99},
      "Cundall's alpha: against each component of the motion this share of the force along it; "
      "moves no equilibrium, but makes falling slower. Not with gear",
      "Cundall 1987");
  s.flag("energy_balance", +MOTION(bool, energy_balance),
         "every contact accounts for what becomes of energy (slower): figures energy.*. Not "
         "with gear or Newton's method");
}

void declare_rest_keys(SectionKeys s) {
  s.number("unbalanced_force_ratio", "-", +REST(double, unbalanced_force_ratio), kRatioOfForces,
           "at rest: mean resultant over mean contact force, and mean moment over radius likewise, "
           "are below this");
  s.number("kinetic_to_elastic_energy", "-", +REST(double, kinetic_to_elastic_energy), {1e-28, 0.1},
           "at rest: kinetic over elastic energy is below this");
  s.number("background_damping", "1/s", +REST(double, background_damping), kRate,
           "acceleration -= this * velocity while coming to rest; more ends slow swinging sooner, "
           "far more makes settling creep");
  s.number("max_time", "s", +REST(double, max_time), kTime,
           "simulated time after which a packing that is not at rest counts as failed");
}

}  // namespace grainfield::coupling

#undef REST
#undef MOTION
#undef MATERIAL
