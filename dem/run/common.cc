#include "dem/run/common.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dem/hdf5/file.h"
#include "dem/hdf5/replace_file.h"
#include "dem/laws/material_setup.h"
#include "dem/laws/restitution.h"
#include "dem/motion/leaping.h"
#include "dem/motion/motion_setup.h"
#include "dem/quasistatic/sphere_law.h"
#include "dem/quasistatic/superellipsoid_law.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"
#include "dem/run/setup.h"

namespace grainfield::dem {
namespace {

std::string bound_text(const MaterialSetup& m, const MotionSetup& motion, StepBound bound) {
  if (motion.time_step > 0) return "motion.time_step";
  switch (bound) {
    case StepBound::rolling:
      return "the resistance against rolling or twisting";
    case StepBound::dashpots:
      return "the dashpots";
    case StepBound::edges:
      return "polygons edge on edge";
    case StepBound::spring:
      break;
  }
  return stiffness_ratio(m) > 1 ? "the tangential spring" : "the normal spring";
}

}  // namespace

EngineSettings engine_settings(const MaterialSetup& m, const MotionSetup& motion,
                               const GrainExtremes& extremes, int threads, bool irregular,
                               double reserve, ShapeKind shape) {
  if (!(m.gravity > 0)) {
    throw std::invalid_argument(fmt::format(
        "material.gravity: found {:g}, allowed: above 0 (grains need weight to come to rest)",
        m.gravity));
  }
  const auto require_spring = [](const char* kind, double friction, double stiffness) {
    if (!(friction > 0) || stiffness > 0) return;
    throw std::invalid_argument(fmt::format(
        "material.{0}_stiffness: found {1:g}, allowed with material.{0}_friction = {2:g}: above 0 "
        "(without a spring nothing resists {0} at rest)",
        kind, stiffness, friction));
  };
  require_spring("rolling", m.rolling_friction, m.rolling_stiffness);
  if (shape.visit([](auto kind) { return kind.dim; }) == 3) {
    require_spring("twisting", m.twisting_friction, m.twisting_stiffness);
  }
  EngineSettings e;
  e.shape = shape;
  e.law = law_of(m);
  e.rolling = RollingLaw::of(m);
  e.local_damping = motion.local_damping;
  const bool feels_edges =
      std::visit([](const auto& law) { return law.edges != EdgeMeasure::none; }, e.law);
  if (extremes.steepest_edge > 0 && !feels_edges) {
    throw std::invalid_argument(fmt::format(
        "material.law: found {}, allowed for polygons: {} (a spring on the depth alone does not "
        "feel how wide two edges touch, so grains edge on edge keep rocking)",
        m.law, fmt::join(laws_that_feel_edges(), ", ")));
  }
  e.integrator = IntegratorKind::named(motion.integrator);
  check_integrator(e);
  e.energy_balance = motion.energy_balance;
  if (e.energy_balance && !leaps(e.integrator)) {
    throw std::invalid_argument(
        fmt::format("motion.energy_balance: found true with motion.integrator = \"{}\", allowed "
                    "with {}",
                    motion.integrator, fmt::join(integrators_that_leap(), " | ")));
  }
  if (extremes.steepest_edge > 0 && e.rolling.on()) refuse_rolling_polygons();
  check_materials(e);
  check_rolling(e);
  const double limit = stable_time_step(e, extremes);
  e.time_step = motion.time_step > 0 ? motion.time_step : motion.time_step_fraction * limit;
  const bool beyond =
      irregular && e.integrator.visit([](auto kind) { return kind.bears_irregular_edges; });
  const bool own = motion.time_step <= 0 && motion.time_step_fraction <= 1;
  const double most =
      (beyond ? std::min(kMostOfLimit * limit, 2 * stable_time_step(e, extremes.least_mass))
              : limit) /
      (own ? 1 : reserve);
  // A fraction of the limit itself must not fail by its last digit.
  if (e.time_step > most * (1 + 1e-12)) {
    const std::string who =
        beyond ? "for irregular polygons of this material"
               : fmt::format(
                     "(the stable limit) for grains of this shape and material with {}; only "
                     "shape.kind = \"rand1\" or \"irregular\" with verlet may go above it",
                     motion.integrator);
    throw std::invalid_argument(
        motion.time_step > 0
            ? fmt::format("motion.time_step: found {:.4g} s, allowed: at most {:.4g} s {}",
                          e.time_step, most, who)
            : fmt::format("motion.time_step_fraction: found {:g}, allowed: at most {:.3g} {}",
                          motion.time_step_fraction, std::floor(1000 * most / limit) / 1000, who));
  }
  e.step_bound = bound_text(m, motion, step_bound(e, extremes));
  e.friction = m.friction;
  e.gravity_x = 0;
  e.gravity_y = -m.gravity;
  e.threads = threads;
  return e;
}

void check_countable(const char* key, double time, double time_step) {
  if (time <= kMostSteps * time_step) return;
  throw std::invalid_argument(
      fmt::format("{}: found {:g} s in all, allowed: at most {:g} s ({:g} steps of {:g} s, see "
                  "motion.time_step)",
                  key, time, kMostSteps * time_step, kMostSteps, time_step));
}

double round_down(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::floor(value / unit * (1 + 1e-12)) * unit;
}

void check_quasistatic(const std::string& asked, const char* allowed, const MaterialSetup& material,
                       const MotionSetup& motion, ShapeKind shape) {
  // These refuse the laws that they do not know.
  if (shape == ShapeKind::sphere) SphereLaw{law_of(material)};
  if (shape == ShapeKind::superellipsoid) SuperellipsoidLaw{law_of(material)};
  const bool plane = shape.visit([](auto kind) { return decltype(kind)::dim == 2; });
  if (plane && RollingLaw::of(material).on()) {
    throw std::invalid_argument(fmt::format(
        "{} with material.rolling_friction = {:g}, allowed: {} (in the plane the quasi-static "
        "solver knows no resistance against rolling)",
        asked, material.rolling_friction, allowed));
  }
  if (motion.energy_balance) {
    throw std::invalid_argument(
        fmt::format("{} with motion.energy_balance = true, allowed: {} (the quasi-static solver "
                    "follows no energy)",
                    asked, allowed));
  }
}

void check_method(const char* key, const std::string& method, const MaterialSetup& material,
                  const MotionSetup& motion, ShapeKind shape) {
  if (method != "newton") return;
  check_quasistatic(fmt::format("{}: found \"newton\"", key), "\"damped\"", material, motion,
                    shape);
}

void check_superellipsoid_material(const MaterialSetup& material) {
  const auto laws = words_where<AnyLaw>(
      []<class L>() { return ContactLaw<L, 3> && L::measures != Measures::curvature; });
  if (std::find(laws.begin(), laws.end(), material.law) == laws.end()) {
    throw std::invalid_argument(
        fmt::format("material.law: found \"{}\", allowed for superellipsoids: {}", material.law,
                    fmt::join(laws, ", ")));
  }
  if (RollingLaw::of(material).on()) refuse_rolling_superellipsoids();
}

void check_background_damping(const RestSetup& rest, double time_step) {
  if (rest.background_damping * time_step <= 1) return;
  throw std::invalid_argument(fmt::format(
      "rest.background_damping: found {:g}, allowed: at most {:g} 1/s, one over the time step of "
      "{:.3g} s",
      rest.background_damping, round_down(1 / time_step), time_step));
}

Progress progress_of(const Engine& engine, const Diagnostics& state) {
  Progress p;
  p.simulated_time = engine.time();
  p.steps = engine.steps();
  p.grains = engine.grains();
  p.awake = state.awake;
  p.kinetic_energy = state.kinetic_energy;
  p.unbalanced_force_ratio = state.unbalanced_force_ratio;
  return p;
}

Snapshot named_snapshot(const Engine& engine, const std::string& state, std::uint64_t seed,
                        const std::map<std::string, std::string>& attributes) {
  Snapshot s = engine.snapshot();
  s.attributes["state"] = state;
  s.attributes["seed"] = fmt::format("{}", seed);
  for (const auto& [name, text] : attributes) s.attributes[name] = text;
  return s;
}

bool at_rest(const Diagnostics& d, const RestSetup& rest) {
  return d.unbalanced_force_ratio <= rest.unbalanced_force_ratio &&
         d.unbalanced_moment_ratio <= rest.unbalanced_force_ratio && energy_at_rest(d, rest);
}

bool energy_at_rest(const Diagnostics& d, const RestSetup& rest) {
  return d.kinetic_energy <= rest.kinetic_to_elastic_energy * d.elastic_energy;
}

double rest_progress(const Diagnostics& d, const RestSetup& rest) {
  const auto share = [](double value, double goal) {
    return std::clamp(std::log(std::max(value, 1e-300)) / std::log(goal), 0.0, 1.0);
  };
  const double swinging = d.elastic_energy > 0 ? d.kinetic_energy / d.elastic_energy : 1.0;
  const double unbalanced = std::max(d.unbalanced_force_ratio, d.unbalanced_moment_ratio);
  return std::min(share(unbalanced, rest.unbalanced_force_ratio),
                  share(swinging, rest.kinetic_to_elastic_energy));
}

void fail_to_rest(const Diagnostics& d, const RestSetup& rest, const std::string& when,
                  const std::string& remedy) {
  throw ComputationFailed(fmt::format(
      "no rest within rest.max_time = {:g} s ({}): unbalanced force ratio {:.2g}, of moments "
      "{:.2g}, kinetic/elastic energy {:.2g}; raise rest.max_time or rest.background_damping{}",
      rest.max_time, when, d.unbalanced_force_ratio, d.unbalanced_moment_ratio,
      d.kinetic_energy / d.elastic_energy, remedy));
}

void add_reached(const std::string& prefix, const Reached& reached,
                 std::map<std::string, double>& figures) {
  const auto add = [&](const char* name, double value) {
    if (!std::isnan(value)) figures[prefix + name] = value;
  };
  add(".unbalanced_force_ratio", reached.unbalanced_force_ratio);
  add(".load_steps", reached.load_steps);
  add(".iterations", reached.iterations);
}

void add_engine_figures(const Engine& engine, const Diagnostics& state,
                        std::map<std::string, double>& figures) {
  figures["dem.grains"] = engine.grains();
  figures["dem.contacts"] = state.contacts;
  figures["dem.sliding_contacts"] = state.sliding;
  figures["dem.steps"] = static_cast<double>(engine.steps());
  figures["dem.time_step"] = engine.time_step();
  figures["dem.unbalanced_force_ratio"] = state.unbalanced_force_ratio;
  figures["dem.unbalanced_moment_ratio"] = state.unbalanced_moment_ratio;
  figures["dem.unbalanced_force_max_ratio"] = state.max_unbalanced_force / state.mean_contact_force;
  figures["dem.kinetic_to_elastic_energy"] = state.kinetic_energy / state.elastic_energy;
  figures["dem.max_overlap_ratio"] = state.max_overlap_ratio;
  if (!state.energy_followed) return;
  const Diagnostics& d = state;
  const ContactLosses& gone = d.contact_losses;
  figures["energy.kinetic"] = d.kinetic_energy;
  figures["energy.elastic"] = d.elastic_energy;
  figures["energy.lost_in_dashpots"] = gone.dashpot;
  figures["energy.lost_to_friction"] = gone.friction;
  figures["energy.lost_to_rolling"] = gone.rolling;
  figures["energy.lost_to_damping"] = d.damped_energy;
  figures["energy.lost_to_sleep"] = d.stopped_energy;
  figures["energy.brought"] = d.brought_energy;
  figures["energy.work_of_gravity"] = d.gravity_work;
  figures["energy.work_of_load"] = d.applied_work;
  figures["energy.work_of_walls"] = d.wall_work;
  figures["energy.work_of_cell"] = d.cell_work;
  figures["energy.work_of_law"] = gone.law;
  figures["energy.balance_error"] = d.energy_balance() / d.size_of_work();
}

std::string smaller_step(const MotionSetup& m) {
  if (m.time_step > 0 || m.time_step_fraction <= 1) return "";
  return fmt::format(", or lower motion.time_step_fraction, now {:g}", m.time_step_fraction);
}

// Goes up with what a checkpoint of any study holds, and with the order it stands in.
const std::string kLayout = "layout 2; ";

void write_checkpoint(const std::string& file, const std::string& fingerprint,
                      const CheckpointWriter& state, const NamedSnapshots& snapshots) {
  write_in_place_of(file, [&](const std::string& beside) {
    CheckpointWriter w;
    w.put(kLayout + fingerprint);
    w.put(state.bytes());
    hdf5::Handle handle = hdf5::open_for_adding(beside);
    hdf5::write_bytes(handle, "checkpoint", w.bytes());
    hdf5::finish(std::move(handle), file);
    for (const auto& [name, snapshot] : snapshots) write_snapshot(beside, "/" + name, snapshot);
  });
}

std::string read_checkpoint(const std::string& file, const std::string& fingerprint) {
  std::string bytes;
  {
    const hdf5::Handle handle = hdf5::open_for_reading(file);
    bytes = hdf5::read_bytes(handle, "checkpoint", file);
  }
  CheckpointReader r(bytes);
  std::string of, state;
  r.get(of);
  if (of != kLayout + fingerprint) {
    throw OtherSetup(
        fmt::format("{}: the checkpoint is of another {}; start without --resume", file,
                    of.starts_with(kLayout) ? "case or seed" : "version of the program"));
  }
  r.get(state);
  r.finish();
  return state;
}

}  // namespace grainfield::dem
