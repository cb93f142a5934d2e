// The discrete-element engine, stepped from Python.
#include "dem/engine/engine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "coupling/case/apply.h"
#include "coupling/python/bindings.h"
#include "coupling/python/own_forces.h"
#include "dem/grains/grain_family.h"
#include "dem/laws/material_defaults.h"
#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/run/common.h"
#include "dem/snapshot/added_forces_mark.h"

namespace grainfield::python {
namespace {

using dem::Snapshot;
using Clock = std::chrono::steady_clock;

constexpr double kSliceSeconds = 0.1;  // between two looks at signals

// Keys of [material] and [motion], checked as those of a case.
struct Setup {
  dem::MaterialSetup material;
  dem::MotionSetup motion;
};
Setup read_setup(const std::vector<std::string>& keys, const dem::RoundGrain& grain) {
  coupling::Draft draft;
  draft.value.study.clear();  // of no study: the sections' own setups
  for (const std::string& text : keys) coupling::apply(draft, coupling::parse_override(text));
  const auto given = [&](std::string_view member) {
    return draft.value.given.contains("material." + std::string(member));
  };
  dem::follow_defaults(draft.value.get<dem::MaterialSetup>(), dem::MaterialSetup(), given, grain);
  return {draft.value.get<dem::MaterialSetup>(), draft.value.get<dem::MotionSetup>()};
}

dem::ShapeKind shape_of(const Snapshot& s) {
  const auto polygon = [](const dem::Grain& g) { return !g.outline.empty(); };
  if (s.dim == 2)
    return std::any_of(s.grains.begin(), s.grains.end(), polygon) ? dem::ShapeKind::polygon
                                                                  : dem::ShapeKind::disk;
  const auto super = [](const dem::Grain& g) { return !g.axes.isZero(0); };
  return std::any_of(s.grains.begin(), s.grains.end(), super) ? dem::ShapeKind::superellipsoid
                                                              : dem::ShapeKind::sphere;
}

// Extremes of the free grains; all polygons as light as the lightest for their size.
dem::GrainExtremes extremes_of(const Snapshot& s, dem::ShapeKind shape) {
  if (shape == dem::ShapeKind::superellipsoid)
    throw std::invalid_argument(
        "Engine: found superellipsoids, allowed: disks, polygons and spheres");
  double least_density = std::numeric_limits<double>::infinity();
  dem::GrainExtremes out;
  out.least_mass = out.least_radius = least_density;
  for (const dem::Grain& g : s.grains) {
    if (g.fixed) continue;
    least_density = std::min(least_density, g.mass / g.volume);
    out.least_mass = std::min(out.least_mass, g.mass);
    out.least_radius = std::min(out.least_radius, g.radius);
  }
  if (!(out.least_mass < std::numeric_limits<double>::infinity()))
    throw std::invalid_argument("Engine: the packing has no free grain");
  if (shape != dem::ShapeKind::polygon) return out;
  std::vector<dem::ShapedGrain> shaped;
  for (const dem::Grain& g : s.grains)
    if (!g.fixed) shaped.push_back({g.outline, g.radius, g.volume, 0});
  return dem::extremes_of(shaped, least_density);
}

// A grain of the mean radius of the free grains.
dem::RoundGrain mean_grain(const Snapshot& s) {
  double sum = 0, count = 0;
  for (const dem::Grain& g : s.grains) {
    if (g.fixed) continue;
    sum += g.radius;
    ++count;
  }
  return {s.dim, count > 0 ? sum / count : 0};
}

/// Names of an attribute of added_forces_mark.h.
std::vector<std::string> names_in(const Snapshot& s, const char* attribute) {
  std::vector<std::string> out;
  const auto at = s.attributes.find(attribute);
  if (at == s.attributes.end()) return out;
  const std::string& all = at->second;
  for (std::size_t from = 0; from < all.size();) {
    const std::size_t to = std::min(all.find(", ", from), all.size());
    out.push_back(all.substr(from, to - from));
    from = to + 2;
  }
  return out;
}

class Engine {
 public:
  Engine(const Packing& start, const std::vector<std::string>& keys, int threads) {
    for (const dem::Wall& wall : start.state->walls)
      if (wall.material.empty() && std::isnan(wall.friction))
        throw std::invalid_argument(
            fmt::format("Engine: wall {} has no friction; gf.packing(..., friction=...) sets that "
                        "of walls without their own",
                        wall.name));
    const Setup setup = read_setup(keys, mean_grain(*start.state));
    const dem::ShapeKind shape = shape_of(*start.state);
    const dem::EngineSettings settings = dem::engine_settings(
        setup.material, setup.motion, extremes_of(*start.state, shape), threads, false, 1, shape);
    const py::gil_scoped_release released;
    missing_ = names_in(*start.state, dem::kAddedForces);
    if (missing_.empty()) {
      engine_ = dem::make_engine(settings, *start.state);
    } else {  // step() asks for them
      Snapshot state = *start.state;
      state.attributes.erase(dem::kAddedForces);
      engine_ = dem::make_engine(settings, state);
    }
    dem::added_forces(*engine_).mark_former_forces(names_in(*start.state, dem::kFormerAddedForces));
    dim_ = start.state->dim;
    density_ = setup.material.density;
    all_ = static_cast<std::int64_t>(start.state->grains.size());
  }

  const dem::Engine& state() const {
    require_idle();
    return *engine_;
  }
  dem::Engine& changing() {
    require_idle();
    return *engine_;
  }
  // Places in memory may change.
  dem::Engine& moving() {
    if (views_ > 0) {
      const std::string text = fmt::format(
          "Engine: {} arrays on its grains are alive, which this may move; delete them first, or "
          "keep copies (positions.copy())",
          views_.load());
      throw py::buffer_error(text);
    }
    return changing();
  }
  int dim() const { return dim_; }
  double density() const { return density_; }
  std::int64_t all() const { return all_; }
  void added() { ++all_; }
  void hold_view() { ++views_; }
  void drop_view() { --views_; }

  void add_force(const py::function& function, const std::string& name, long every,
                 bool in_contacts) {
    dem::added_forces(changing()).add_force(own_force(function, name, every, in_contacts));
    std::erase(missing_, name);
    slice_ = 1;  // a function may take its time
  }
  void remove_force(const std::string& name) {
    dem::TakesAddedForces& forces = dem::added_forces(changing());
    if (std::erase(missing_, name) > 0) return forces.mark_former_forces({name});
    forces.remove_force(name);
  }
  std::vector<std::string> forces() const { return dem::added_forces(*engine_).added_forces(); }
  /// What the start lacks, as nobody has given it yet.
  const std::vector<std::string>& missing() const { return missing_; }
  /// After the present step, step() raises KeyboardInterrupt. Returns whether it was asked before.
  bool interrupt() { return interrupted_.exchange(true); }

  /// Wall time of steps so far, without Python's part.
  double seconds() const { return seconds_; }

  // In slices, between which signals are looked at: the bits are those of one call.
  void step(long n) {
    require_idle();
    if (!missing_.empty())
      throw std::invalid_argument(fmt::format(
          "Engine: this packing comes from a run with forces of a Python function: found none of "
          "{}; add each with add_force or add_contact_force(function, name=...), or go on without "
          "by remove_force(name)",
          fmt::join(missing_, ", ")));
    struct Busy {
      explicit Busy(std::atomic<bool>& flag) : flag_(flag) { flag_ = true; }
      ~Busy() { flag_ = false; }
      std::atomic<bool>& flag_;
    } busy(busy_);
    interrupted_ = false;
    for (long left = n, slice = std::min(left, slice_); left > 0; slice = std::min(left, slice_)) {
      const auto start = Clock::now();
      {
        const py::gil_scoped_release released;
        engine_->step(slice);
      }
      left -= slice;
      const double took = std::chrono::duration<double>(Clock::now() - start).count();
      seconds_ += took;
      if (took < kSliceSeconds / 2 && slice == slice_ && slice_ < (1L << 30)) slice_ *= 2;
      if (took > 2 * kSliceSeconds && slice_ > 1) slice_ /= 2;
      if (interrupted_.exchange(false)) PyErr_SetNone(PyExc_KeyboardInterrupt);
      if (PyErr_Occurred() != nullptr || PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  }

 private:
  void require_idle() const {
    if (busy_) throw std::runtime_error("Engine: another thread is stepping it; wait for its end");
  }

  std::unique_ptr<dem::Engine> engine_;
  int dim_ = 2;
  double density_ = 0, seconds_ = 0;
  std::int64_t all_ = 0;
  long slice_ = 64;
  std::atomic<int> views_ = 0;
  std::atomic<bool> busy_ = false, interrupted_ = false;
  std::vector<std::string> missing_;
};

using Held = std::shared_ptr<Engine>;

// What an array on the engine's memory holds: the engine, and the count of such arrays.
struct ViewToken {
  Held engine;
};
py::capsule token_of(const Held& engine) {
  engine->hold_view();
  return py::capsule(new ViewToken{engine}, [](void* held) {
    auto* token = static_cast<ViewToken*>(held);
    token->engine->drop_view();
    delete token;
  });
}

py::array array_on(const Held& self, const std::string& name) {
  const dem::GrainArrays at = self->state().arrays();
  const py::capsule token = token_of(self);
  if (name == "ids") return view<std::int64_t>(at.ids, {at.count}, {sizeof(std::int64_t)}, token);
  const int spins = at.dim == 2 ? 1 : 3;
  const double* first = name == "position"   ? at.position
                        : name == "velocity" ? at.velocity
                        : name == "spin"     ? at.spin
                                             : at.radius;
  const int parts = name == "radius" ? 1 : name == "spin" ? spins : at.dim;
  if (parts == 1) return view<double>(first, {at.count}, {at.stride}, token);
  return view<double>(first, {at.count, parts}, {at.stride, sizeof(double)}, token);
}

dem::Vec3 vector_in(const std::vector<double>& v, int dim, const std::string& what) {
  if (v.size() != static_cast<std::size_t>(dim))
    throw std::invalid_argument(
        fmt::format("{}: found {} numbers, allowed: {}", what, v.size(), dim));
  return {v[0], v[1], dim == 3 ? v[2] : 0};
}
// About z in the plane.
dem::Vec3 turning_in(const std::vector<double>& v, int dim, const std::string& what) {
  const std::size_t wanted = dim == 2 ? 1 : 3;
  if (v.size() != wanted)
    throw std::invalid_argument(
        fmt::format("{}: found {} numbers, allowed: {}", what, v.size(), wanted));
  return dim == 2 ? dem::Vec3(0, 0, v[0]) : dem::Vec3(v[0], v[1], v[2]);
}

void require_grain(const Engine& engine, std::int64_t id, const std::string& what) {
  if (id >= 0 && id < engine.all()) return;
  throw std::invalid_argument(
      fmt::format("{}: found grain {}, allowed: 0 to {}", what, id, engine.all() - 1));
}

void apply(Engine& self, std::int64_t grain, const std::vector<double>& force,
           const std::vector<std::int64_t>& beside, double start, double ramp) {
  require_grain(self, grain, "apply");
  for (const std::int64_t id : beside) require_grain(self, id, "apply");
  const dem::Vec3 f = vector_in(force, self.dim(), "force");
  dem::AppliedForce out;
  out.id = grain;
  out.fx = f.x();
  out.fy = f.y();
  out.fz = f.z();
  out.start = start;
  out.ramp = ramp;
  self.changing().apply(out, beside);
}

void move_wall(Engine& self, const std::string& name, const std::vector<double>& velocity,
               const std::vector<double>& angular_velocity,
               const std::optional<std::vector<double>>& centre, double ramp,
               const std::optional<py::dict>& servo) {
  dem::WallMotion motion;
  motion.velocity = vector_in(velocity, self.dim(), "velocity");
  motion.angular_velocity = turning_in(angular_velocity, self.dim(), "angular_velocity");
  if (centre) motion.centre = vector_in(*centre, self.dim(), "centre");
  motion.ramp = ramp;
  if (servo) {
    dem::WallServo& s = motion.servo.emplace();
    for (const auto& [key, value] : *servo) {
      const auto word = key.cast<std::string>();
      if (word == "force")
        s.force = value.cast<double>();
      else if (word == "stress")
        s.stress = value.cast<double>();
      else if (word == "area")
        s.area = value.cast<double>();
      else if (word == "between")
        s.between = value.cast<std::vector<std::array<std::string, 2>>>();
      else if (word == "direction")
        s.direction = vector_in(value.cast<std::vector<double>>(), self.dim(), "direction");
      else if (word == "max_speed")
        s.max_speed = value.cast<double>();
      else if (word == "gain")
        s.gain = value.cast<double>();
      else
        throw std::invalid_argument(
            fmt::format("servo: found \"{}\", allowed: force, stress, area, between, direction, "
                        "max_speed, gain",
                        word));
    }
  }
  self.changing().set_wall_motion(name, motion);
}

std::int64_t add(Engine& self, const std::vector<double>& position, double radius,
                 const std::vector<double>& velocity, const std::optional<double>& density,
                 bool fixed) {
  const dem::Vec3 x = vector_in(position, self.dim(), "position");
  const dem::Vec3 v =
      velocity.empty() ? dem::Vec3(0, 0, 0) : vector_in(velocity, self.dim(), "velocity");
  dem::NewGrain grain;
  grain.x = x.x();
  grain.y = x.y();
  grain.z = x.z();
  grain.vx = v.x();
  grain.vy = v.y();
  grain.vz = v.z();
  grain.radius = radius;
  grain.density = density.value_or(self.density());
  grain.fixed = fixed;
  for (const auto& [what, value] : {std::pair{"radius", radius}, {"density", grain.density}})
    if (!(value > 0))
      throw std::invalid_argument(fmt::format("{}: found {:g}, allowed: above 0", what, value));
  const std::int64_t id = self.moving().add(grain);
  self.added();
  return id;
}

py::dict measure(const Engine& self) {
  const dem::Diagnostics d = self.state().measure();
  py::dict out;
  out["kinetic_energy"] = d.kinetic_energy;
  out["elastic_energy"] = d.elastic_energy;
  out["potential_energy"] = d.potential_energy;
  out["mean_contact_force"] = d.mean_contact_force;
  out["unbalanced_force_ratio"] = d.unbalanced_force_ratio;
  out["unbalanced_moment_ratio"] = d.unbalanced_moment_ratio;
  out["max_overlap_ratio"] = d.max_overlap_ratio;
  out["height"] = d.height;
  out["contacts"] = d.contacts;
  out["sliding"] = d.sliding;
  out["awake"] = d.awake;
  out["wall_work"] = d.wall_work;
  out["applied_work"] = d.applied_work;
  if (d.energy_followed) {
    out["dissipated_energy"] = d.dissipated_energy();
    out["energy_balance"] = d.energy_balance();
  }
  return out;
}

py::dict walls(const Engine& self) {
  const auto part = [&](const dem::Vec3& v) {
    py::array_t<double> out(self.dim());
    std::copy_n(v.data(), self.dim(), out.mutable_data());
    return out;
  };
  py::dict out;
  for (const dem::Wall& wall : self.state().walls()) {
    py::dict one;
    one["point"] = part(wall.point);
    one["normal"] = part(wall.normal);
    one["velocity"] = part(wall.velocity);
    one["force"] = part(wall.force);
    out[py::str(wall.name)] = one;
  }
  return out;
}

}  // namespace

void add_engine(py::module_& module) {
  py::class_<Engine, Held>(module, "Engine")
      .def(py::init<const Packing&, const std::vector<std::string>&, int>(), py::arg("start"),
           py::arg("keys"), py::arg("threads"))
      .def("array", array_on)
      .def("step", &Engine::step)
      .def("apply", apply)
      .def("move_wall", move_wall)
      .def("add", add)
      .def("set_gravity",
           [](Engine& self, const std::vector<double>& g) {
             const dem::Vec3 gravity = vector_in(g, self.dim(), "gravity");
             self.changing().set_gravity(gravity.x(), gravity.y(), gravity.z());
           })
      .def("set_damping",
           [](Engine& self, double rate) {
             if (!(rate >= 0 && rate * self.state().time_step() <= 1))
               throw std::invalid_argument(fmt::format(
                   "damping: found {:g}, allowed: 0 to {:g} 1/s, one over the time step", rate,
                   1 / self.state().time_step()));
             self.changing().set_background_damping(rate);
           })
      .def("add_force", &Engine::add_force, py::arg("function"), py::arg("name"), py::arg("every"),
           py::arg("in_contacts"))
      .def("remove_force", &Engine::remove_force)
      .def("forces", &Engine::forces)
      .def("interrupt", &Engine::interrupt)
      .def("measure", measure)
      .def("walls", walls)
      .def("snapshot",
           [](const Engine& self) {
             // No other thread may step it meanwhile: the lock of Python stays.
             Snapshot now = self.state().snapshot();
             if (!self.missing().empty())
               now.attributes[dem::kAddedForces] =
                   fmt::format("{}", fmt::join(self.missing(), ", "));
             return Packing{std::make_shared<const Snapshot>(std::move(now))};
           })
      .def("image", [](const Engine& self) { return py::bytes(self.state().checkpoint()); })
      .def_property_readonly("dim", &Engine::dim)
      .def_property_readonly("time", [](const Engine& e) { return e.state().time(); })
      .def_property_readonly("steps", [](const Engine& e) { return e.state().steps(); })
      .def_property_readonly("time_step", [](const Engine& e) { return e.state().time_step(); })
      .def_property_readonly("seconds", &Engine::seconds)
      .def_property_readonly("grains", &Engine::all);
}

}  // namespace grainfield::python
