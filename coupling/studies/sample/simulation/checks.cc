#include "dem/space/kinematics3.h"
#include "dem/space/space3.h"
// After three dimensions, whose laws are asked for.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/studies/sample/simulation/checks.h"
#include "coupling/studies/sample/simulation/drop.h"
#include "coupling/studies/sample/simulation/goal.h"
#include "coupling/studies/sample/simulation/path.h"
#include "coupling/studies/sample/simulation/probe.h"
#include "coupling/studies/sample/simulation/sample.h"
#include "dem/run/common.h"
#include "dem/shapes/superellipsoid.h"
#include "dem/shared/refuse.h"
#include "dem/space/moving_cell.h"

namespace grainfield::dem {
namespace {

// A servo's target over the stiffness of the contacts: beyond, grains overlap by a tenth.
constexpr double kMostLoad = 0.1;
// Walls may come as near as this many of the largest radii.
constexpr double kLeastBox = 4;
// Solid fraction that no compression to a pressure goes beyond, about; smaller cells are refused.
constexpr double kDense2 = 0.95, kDense3 = 0.8;
// Below these no packing carries load (random loose ones of round grains: 0.77, 0.55).
constexpr double kLoosest2 = 0.7, kLoosest3 = 0.5;
// A wall passes at most this share of the smallest radius a step. The engine refuses a half; boxes
// differ a little with the sizes that are drawn.
constexpr double kMostMove = 0.45;
// Sides may tilt to this tangent, and an edge may lose this share of itself.
constexpr double kMostTilt = 1, kMostShortening = 0.9;
// Memory of a grain with its contacts, and in each recorded state.
constexpr double kBytesOfGrain = 4000, kBytesOfRecord = 1500;

template <class Words>
bool holds(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Ranges that are ranges, a law that they offer their curvatures to, no resistance against rolling.
void check_superellipsoids(const SampleSetup& s) {
  const SamplePlan& p = s.plan;
  if (p.axis_max < p.axis_min) {
    refuse("sample.axis_max", fmt::format("found {:g}, allowed: at least sample.axis_min = {:g}",
                                          p.axis_max, p.axis_min));
  }
  if (p.exponent_max < p.exponent_min) {
    refuse("sample.exponent_max",
           fmt::format("found {:g}, allowed: at least sample.exponent_min = {:g}", p.exponent_max,
                       p.exponent_min));
  }
  for (const double e : {p.exponent_min, p.exponent_max}) {
    superellipsoid({p.axis_min, p.axis_min, p.axis_min}, {e, e});
  }
  check_superellipsoid_material(s.material);
}

void check_dimension(const SampleSetup& s) {
  const SamplePlan& p = s.plan;
  const auto& shapes = sample_shapes(p.dim);
  if (!holds(shapes, p.shape)) {
    refuse("sample.shape",
           fmt::format("found \"{}\", allowed with sample.dim = {}: {}; it is a shape of "
                       "{}D",
                       p.shape, p.dim, fmt::join(shapes, ", "), 5 - p.dim));
  }
  const auto laws = p.dim == 2 ? laws_in<2>() : laws_in<3>();
  if (!holds(laws, s.material.law)) {
    throw std::invalid_argument(
        fmt::format("material.law: found \"{}\", allowed with sample.dim = {}: {}; it is a law of "
                    "{}D",
                    s.material.law, p.dim, fmt::join(laws, ", "), 5 - p.dim));
  }
  if (p.shape == "superellipsoid") check_superellipsoids(s);
  const double most = most_start_fraction(p);
  if (p.start_fraction > most) {
    refuse("sample.start_fraction",
           fmt::format("found {:g}, allowed with {}: up to {:g}, "
                       "at which random places without overlap become rare",
                       p.start_fraction,
                       p.shape == "superellipsoid" ? "superellipsoids of these axes"
                                                   : fmt::format("sample.dim = {}", p.dim),
                       p.shape == "superellipsoid" ? round_down(most) : most));
  }
  if (p.corners_max < p.corners_min) {
    refuse("sample.corners_max", fmt::format("found {}, allowed: at least sample.corners_min = {}",
                                             p.corners_max, p.corners_min));
  }
}

bool has_servo(const SamplePlan& p) {
  return p.compress_to == "pressure" || p.deformation == "axial" ||
         (p.deformation == "simple_shear" && p.constant == "stress");
}

void check_servo(const SamplePlan& p) {
  if (has_servo(p) && !(p.pressure > 0)) {
    const char* by = p.compress_to == "pressure" ? "compress_to = \"pressure\""
                     : p.deformation == "axial"  ? "deformation = \"axial\""
                                                 : "constant = \"stress\"";
    refuse("sample.pressure",
           fmt::format("found {:g}: a servo without a target, allowed with sample.{}: "
                       "above 0",
                       p.pressure, by));
  }
  if (p.compress_to != "pressure" && has_servo(p)) {
    refuse("sample.compress_to",
           fmt::format(
               "found \"{}\", allowed with sample.{}: \"pressure\", which the servo goes "
               "on to hold",
               p.compress_to,
               p.deformation == "axial" ? "deformation = \"axial\"" : "constant = \"stress\""));
  }
  if (p.deformation == "axial" && p.compression != "isotropic") {
    refuse("sample.compression",
           fmt::format("found \"{}\", allowed with sample.deformation = \"axial\": "
                       "isotropic, because the lateral walls hold the pressure",
                       p.compression));
  }
}

// A strain before the first state, and the way back.
void check_path(const SamplePlan& p) {
  if (starts_as_filled(p) && !is_dropped(p)) {
    refuse("sample.compress_to",
           fmt::format("found \"none\", allowed with sample.filling = \"{}\": "
                       "pressure, solid_fraction, strain",
                       p.filling));
  }
  if (p.precompression > 0 && any_led(p, SamplePhase::deform)) {
    refuse("sample.precompression",
           fmt::format(
               "found {:g}, allowed with sample.{}: 0, because servos hold the pressure",
               p.precompression,
               p.deformation == "axial" ? "deformation = \"axial\"" : "constant = \"stress\""));
  }
  if (p.precompression > kMostShortening) {
    refuse("sample.precompression",
           fmt::format("found {:g}, allowed: up to {:g}", p.precompression, kMostShortening));
  }
  if (p.unload == "stress" && shears(p)) {
    refuse("sample.unload",
           "found \"stress\", allowed with sample.deformation = \"simple_shear\": none, "
           "strain, because its axial stress drives nothing");
  }
}

// Gravity wants walls in space, and something that calms the grains.
void check_drop(const SamplePlan& p) {
  if (!is_dropped(p)) return;
  if (p.dim != 3)
    refuse("sample.filling", "found \"dropped\", allowed with sample.dim = 2: placed");
  if (is_periodic(p)) {
    refuse("sample.filling",
           "found \"dropped\", allowed with sample.boundary = \"periodic\": placed, because a cell "
           "has no floor");
  }
  if (p.base_fraction <= p.start_fraction) {
    refuse("sample.base_fraction",
           fmt::format("found {:g}, allowed: above sample.start_fraction = {:g}", p.base_fraction,
                       p.start_fraction));
  }
}

// Until the highest grain has come down and what is left of its motion has died away, s, about.
double drop_time(const SamplePlan& p, double height) {
  constexpr double kDecays = 5;
  return std::sqrt(2 * height / p.drop_gravity) + height * p.drop_damping / p.drop_gravity +
         kDecays / p.drop_damping;
}

// Small strains want three dimensions, and something that calms the grains.
void check_probes(const SampleSetup& s) {
  const SamplePlan& p = s.plan;
  if (p.probe == "none") return;
  if (p.dim != 3) {
    refuse("sample.probe", fmt::format("found \"{}\", allowed with sample.dim = 2: none", p.probe));
  }
  if (!(s.rest.background_damping > 0)) {
    throw std::invalid_argument(fmt::format(
        "rest.background_damping: found {:g}, allowed with sample.probe = \"{}\": above "
        "0, for the grains must come to rest after each small strain",
        s.rest.background_damping, p.probe));
  }
}

void check_strains(const SamplePlan& p) {
  for (const auto& [key, rate] : {std::pair("compression_rate", p.compression_rate),
                                  std::pair("strain_rate", p.strain_rate)}) {
    if (!(rate > 0 && std::isfinite(rate))) {
      refuse(std::string("sample.") + key, fmt::format("found {:g} 1/s, allowed: above 0", rate));
    }
  }
  if (p.compress_to == "solid_fraction" && p.solid_fraction <= p.start_fraction) {
    refuse("sample.solid_fraction",
           fmt::format("found {:g}, allowed: above sample.start_fraction = {:g}", p.solid_fraction,
                       p.start_fraction));
  }
  if (p.deformation != "simple_shear" && p.strain > kMostShortening) {
    refuse("sample.strain",
           fmt::format("found {:g}, allowed with sample.deformation = \"{}\": up to {:g}", p.strain,
                       p.deformation, kMostShortening));
  }
  if (p.deformation == "simple_shear" && p.boundary == "walls" && p.sides == "tilting" &&
      p.strain > kMostTilt) {
    refuse("sample.strain",
           fmt::format("found {:g}, allowed with sample.sides = \"tilting\": up to {:g}; a "
                       "periodic cell shears without end",
                       p.strain, kMostTilt));
  }
}

// Share of its start's that an axis' edge has at the end, at least; `target`: of the volume after
// the compression.
double shrunk(const SamplePlan& p, int axis, double target) {
  const bool last = axis == p.dim - 1;
  double share = 1;
  if (p.compression == "isotropic") {
    share = p.dim == 2 ? std::sqrt(target) : std::cbrt(target);
  } else if (last) {
    share = target;
  }
  if (p.deformation == "isotropic" ||
      (last && (p.deformation == "axial" || p.deformation == "uniaxial"))) {
    share *= p.boundary == "walls" ? 1 - p.strain : std::exp(-p.strain);
  }
  if (last) share *= p.boundary == "walls" ? 1 - p.precompression : std::exp(-p.precompression);
  return share;
}

// Volume after the compression over that at the start, about.
double volume_share(const SamplePlan& p) {
  if (starts_as_filled(p)) return 1;
  if (p.compress_to == "strain") {
    return std::pow(1 - p.compression_strain, p.compression == "isotropic" ? p.dim : 1);
  }
  const double dense = p.dim == 2 ? kDense2 : kDense3;
  return p.start_fraction / (p.compress_to == "pressure" ? dense : p.solid_fraction);
}

void check_size(const SamplePlan& p, const std::array<double, 3>& box) {
  const double most = sample_radii(p).most;
  const double needed = (p.boundary == "walls" ? kLeastBox : kLeastCell) * most;
  for (int a = 0; a < p.dim; ++a) {
    const double edge = box[a] * shrunk(p, a, volume_share(p));
    if (edge >= needed) continue;
    const double factor = std::pow(needed / edge, p.dim);
    refuse("sample.grains",
           fmt::format("found {}: the {} is too small for its grains, an edge of {:.3g} m at the "
                       "end with grains of radius {:.3g} m, allowed: {:.3g} m; take {:.0f} grains, "
                       "a more even sample.height_ratio or less strain",
                       p.grains, p.boundary == "walls" ? "box" : "cell", edge, most, needed,
                       std::ceil(std::min(1e18, p.grains * factor))));
  }
}

// Grains that fill the loosest packing that bears load, or what the compression is to bring, at the
// least, are shortened further by a wall or a cell that nothing gives way to.
void check_density(const SamplePlan& p) {
  const bool both = p.deformation == "isotropic";
  const double shortened = p.boundary == "walls" ? 1 - p.strain : std::exp(-p.strain);
  double share = both ? std::pow(shortened, p.dim) : p.deformation == "uniaxial" ? shortened : 1;
  share *= p.boundary == "walls" ? 1 - p.precompression : std::exp(-p.precompression);
  double least = p.dim == 2 ? kLoosest2 : kLoosest3;
  if (!compresses_to_pressure(p)) least = p.start_fraction / volume_share(p);
  const bool walls = p.boundary == "walls";
  // `power`: of the edge's share in the volume's.
  const auto judge = [&](const char* key, double found, double fraction, int power, bool linear) {
    if (fraction <= kTooDense) return;
    const double edge =
        (linear ? 1 - found : std::exp(-found)) * std::pow(fraction / kTooDense, 1.0 / power);
    const double most = std::max(0.0, linear ? 1 - edge : -std::log(edge));
    refuse(std::string("sample.") + key,
           fmt::format("found {:g}, allowed: up to {:g}; grains would be crushed, they would "
                       "fill {:.3g} of the {} at least, where {:g} is the most",
                       found, round_down(most), fraction, walls ? "box" : "cell", kTooDense));
  };
  if (p.compress_to == "strain") {
    judge("compression_strain", p.compression_strain, least,
          p.compression == "isotropic" ? p.dim : 1, true);
  }
  if (share < 1 && p.precompression > p.strain) {
    judge("precompression", p.precompression, least / share, 1, walls);
  } else {
    judge("strain", p.strain, least / share, both ? p.dim : 1, walls);
  }
}

void check_speeds(const SamplePlan& p, const std::array<double, 3>& box, double time_step) {
  const double longest = std::max(box[0], box[p.dim - 1]);
  const bool walls = p.boundary == "walls";
  // A cell's edges, its grains by their distance from the corner, and walls by their own speed.
  const double most = walls ? kMostMove * sample_radii(p).least / (longest * time_step)
                            : 0.5 * kMostStrainPerStep / time_step;
  const auto check = [&](const char* key, double rate) {
    if (rate <= most) return;
    refuse(std::string("sample.") + key,
           walls ? fmt::format("found {:g} 1/s: a wall would pass {:.3g} m a step, allowed: up to "
                               "{:g} 1/s, {:g} radii of the smallest grain a step of {:.3g} s",
                               rate, rate * longest * time_step, round_down(most), kMostMove,
                               time_step)
                 : fmt::format("found {:g} 1/s, allowed: up to {:g} 1/s, a strain of {:g} in a "
                               "step of {:.3g} s",
                               rate, round_down(most), 0.5 * kMostStrainPerStep, time_step));
  };
  check("compression_rate", p.compression_rate);
  check("strain_rate", p.strain_rate);
}

// The stiffness of a mean grain's contacts, as a stress: Pa (N/m).
double stiffness_of(const SampleSetup& s) {
  const double r = sample_radii(s.plan).mean;
  const double k =
      std::visit([&](const auto& law) { return law.stiffness(r); }, law_of(s.material));
  return s.plan.dim == 2 ? k : k / (2 * r);
}

}  // namespace

void SampleGroundwork::check(const Setup& s) {
  check_dimension(s);
  check_servo(s.plan);
  check_strains(s.plan);
  check_path(s.plan);
  check_probes(s);
  check_drop(s.plan);
  const double most = kMostLoad * stiffness_of(s);
  if (has_servo(s.plan) && s.plan.pressure > most) {
    refuse("sample.pressure",
           fmt::format("found {:g}, allowed: up to {:g} with contacts of this stiffness (grains "
                       "would overlap by a tenth)",
                       s.plan.pressure, round_down(most)));
  }
}

std::vector<ShapedGrain> SampleGroundwork::draw(const Setup& s, Random& random,
                                                Allowance& allowance) {
  return draw_sample(s.plan, random, allowance);
}

SampleFrame SampleGroundwork::settings(const Setup& s, const std::vector<ShapedGrain>& grains,
                                       double reserve) {
  const SamplePlan& p = s.plan;
  const GrainExtremes extremes = sample_extremes(p, s.material.density, grains);
  SampleFrame out;
  const ShapeKind shape = p.shape == "superellipsoid" ? ShapeKind::superellipsoid
                          : p.dim == 3                ? ShapeKind::sphere
                          : p.shape == "disk"         ? ShapeKind::disk
                                                      : ShapeKind::polygon;
  out.settings =
      engine_settings(s.material, s.motion, extremes, 1, p.shape == "rand1", reserve, shape);
  out.settings.gravity_x = out.settings.gravity_y = out.settings.gravity_z = 0;
  const double step = out.settings.time_step;
  check_background_damping(s.rest, step);
  const SamplePlan filled = as_filled(p);
  const auto box = sample_box(filled, mean_volume(p));
  check_density(filled);
  check_size(filled, box);
  check_speeds(p, box, step);
  double longest = 0;  // share of an edge that the compression takes
  for (int a = 0; a < p.dim; ++a) {
    SamplePlan alone = filled;
    alone.deformation = "simple_shear";
    longest = std::max(longest, 1 - shrunk(alone, a, volume_share(filled)));
  }
  out.compression_time = longest / p.compression_rate;
  if (is_dropped(p)) out.drop_time = drop_time(p, sample_box(p, mean_volume(p))[2]);
  const double ramp = p.boundary == "walls" ? 0.5 * p.ramp_time : 0;
  out.deformation_time = p.strain / p.strain_rate + ramp;
  if (p.precompression > 0) out.deformation_time += p.precompression / p.strain_rate + ramp;
  // The strain of an unloading to a stress, at most, about.
  if (unloads(p)) {
    const double back = p.unload == "strain" ? p.unload_strain : 1;
    out.deformation_time += back * p.strain / p.strain_rate + ramp;
  }
  return out;
}

double widest_first_edge(const SamplePlan& plan) {
  SamplePlan p = as_filled(plan);
  const auto box = sample_box(p, mean_volume(p));
  // No deformation yet.
  p.deformation = "simple_shear";
  const double loose = p.dim == 2 ? kLoosest2 : kLoosest3;
  const double share =
      p.compress_to == "pressure" ? std::min(1.0, p.start_fraction / loose) : volume_share(p);
  double least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < p.dim; ++a) least = std::min(least, box[a] * shrunk(p, a, share));
  return least;
}

Outlook SampleGroundwork::outlook(const Setup& s, const SampleFrame& frame) {
  const SamplePlan& p = s.plan;
  Outlook out;
  out.take_step(frame.settings);
  out.grains = p.grains;
  out.bytes = p.grains * (kBytesOfGrain + kBytesOfRecord * states_of(p));
  out.bytes_key = "sample.grains";
  Times times;
  times.add("sample.drop_damping", frame.drop_time);
  times.add("sample.compression_rate", frame.compression_time);
  times.add("sample.strain_rate", frame.deformation_time);
  times.add("rest.background_damping", probe_time(s, out.time_step));
  times.put_into(out);
  return out;
}

Outlook foresee_sample(const SampleSetup& setup, const std::vector<std::uint64_t>& seeds,
                       std::int64_t draws) {
  return foresee<SampleGroundwork>(setup, seeds, draws);
}

}  // namespace grainfield::dem
