// average, strain, structure, model, fit, compare and run: what the commands of these names do.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>

#include "continuum/model.h"
#include "coupling/app/progress_line.h"
#include "coupling/base/signals.h"
#include "coupling/case/shipped_cases.h"
#include "coupling/models/fit_names.h"
#include "coupling/python/bindings.h"
#include "coupling/run/run_request.h"
#include "coupling/structure/packing_structure.h"
#include "coupling/tasks/compare_task.h"
#include "coupling/tasks/fit_task.h"
#include "coupling/tasks/measured_field.h"
#include "coupling/tasks/placement.h"
#include "coupling/tasks/strain_task.h"

namespace grainfield::python {
namespace {

using coupling::GridSize;
using NamedHeld = std::vector<std::pair<std::string, HeldField>>;

coupling::SnapshotName one_of(const Source& source) {
  const auto names = names_of({source});
  if (names.size() == 1) return names.front();
  throw std::invalid_argument(fmt::format("{}: holds {} snapshots, strain takes one",
                                          std::get<std::string>(source), names.size()));
}

template <class Request>
GridSize place(Request& request, const py::object& points, const std::string& grid) {
  GridSize size;
  if (!grid.empty()) size = coupling::parse_grid(grid);
  request.nx = size.columns;
  request.ny = size.rows;
  request.nz = size.layers;
  if (!points.is_none()) request.points = matrix_of(points, "points");
  return size;
}

// Points of another dimension than the packing's would be read beyond their end.
void require_columns(const Eigen::MatrixXd& points, int columns, const std::string& of) {
  if (points.rows() > 0 && points.cols() != columns)
    throw std::invalid_argument(
        fmt::format("points: found {} columns, allowed: {} ({})", points.cols(), columns, of));
}

// Pairs of states before and under the load, as --response takes them.
std::vector<coupling::SnapshotName> pairs_of(const std::vector<Source>& loaded,
                                             const std::vector<Source>& unloaded) {
  const auto after = names_of(loaded), before = names_of(unloaded);
  if (before.size() != after.size())
    throw std::invalid_argument(
        fmt::format("unloaded: found {} states for {} loaded ones", before.size(), after.size()));
  std::vector<coupling::SnapshotName> pairs;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const std::string pair = fmt::format("pair_{}", k);
    pairs.push_back({pair, "loaded", coupling::snapshot_of(after[k])});
    pairs.push_back({pair, "unloaded", coupling::snapshot_of(before[k])});
  }
  return pairs;
}

struct AverageOutcome {
  NamedHeld fields;
  std::vector<std::string> warnings;
  std::string gaps;
  double seconds = 0;  ///< wall time of run_average
};

AverageOutcome average(const std::vector<Source>& sources, const std::vector<Source>& unloaded,
                       const py::object& points, const std::string& grid,
                       const std::vector<double>& cuts, const std::string& frame,
                       const std::string& up, const std::string& method,
                       const std::optional<std::string>& kernel, const std::optional<double>& width,
                       const std::string& free_surface, int least_grains,
                       const std::vector<std::string>& quantities, bool response, bool rings,
                       const std::vector<double>& axis, bool end_at_walls, int threads) {
  coupling::AverageRequest request;
  request.response = response || !unloaded.empty();
  request.frame = frame;
  request.up = up;
  request.cuts = cuts;
  request.rings = rings;
  request.axis = axis;
  coupling::AverageOptions& options = request.options;
  options.method = method;
  if (kernel) options.kernel = *kernel;
  if (width) options.width = *width;
  options.free_surface = free_surface;
  options.least_grains = least_grains;
  options.quantities = quantities;
  options.extend_into_walls = !end_at_walls;
  options.threads = threads;
  settle(request, kernel.has_value(), width.has_value());
  const GridSize size = place(request, points, grid);
  coupling::Gaps gaps;
  AverageOutcome out;
  const Released released(in_files(sources) || in_files(unloaded));
  request.snapshots = unloaded.empty() ? names_of(sources) : pairs_of(sources, unloaded);
  require_few_places(static_cast<double>(request.points.rows()), size,
                     static_cast<double>(request.snapshots.size()));
  if (request.points.rows() > 0 && !request.snapshots.empty()) {
    const auto first = coupling::snapshot_of(request.snapshots.front());
    require_columns(request.points, rings ? 2 : first->dim,
                    rings ? "radius and height" : fmt::format("the packing is {}D", first->dim));
  }
  const auto start = std::chrono::steady_clock::now();
  coupling::NamedFields fields = coupling::run_average(std::move(request), &gaps, &out.warnings);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  out.gaps = gaps.text(fields.front().second.points);
  for (auto& [name, field] : fields) out.fields.emplace_back(name, held(std::move(field)));
  return out;
}

// The field, and what it lacks and why it is doubtful, a sentence each.
std::pair<HeldField, std::vector<std::string>> strain(
    const Source& before, const Source& after, const py::object& points, const std::string& grid,
    const std::string& frame, const std::string& up, const std::string& measure,
    const std::optional<std::string>& support, const std::optional<double>& width, int least_grains,
    int threads) {
  coupling::StrainRequest request;
  request.frame = frame;
  request.up = up;
  request.options.measure = measure;
  if (support) request.options.support = *support;
  if (width) request.options.width = *width;
  request.options.least_grains = least_grains;
  request.options.threads = threads;
  settle(request, support.has_value(), width.has_value());
  const GridSize size = place(request, points, grid);
  require_few_places(static_cast<double>(request.points.rows()), size, 1);
  const Released released(in_files({before, after}));
  request.before = one_of(before);
  request.after = one_of(after);
  if (request.points.rows() > 0) {
    const int dim = coupling::snapshot_of(request.before)->dim;
    require_columns(request.points, dim, fmt::format("the packing is {}D", dim));
  }
  coupling::StrainOutcome outcome = coupling::run_strain(request);
  std::vector<std::string> lines;
  for (std::string* line : {&outcome.report, &outcome.images, &outcome.doubt})
    if (!line->empty()) lines.push_back(std::move(*line));
  return {held(std::move(outcome.field)), std::move(lines)};
}

// A number of each grain.
template <class T, class Get>
py::array_t<T> of_grains(const coupling::PackingStructure& made, Get get) {
  std::vector<T> out;
  for (const coupling::GrainStructure& g : made.grains) out.push_back(static_cast<T>(get(g)));
  return array_of(out);
}

py::dict structure(const Source& source) {
  coupling::PackingStructure made;
  {
    const Released released(in_files({source}));
    made = coupling::packing_structure(*coupling::snapshot_of(one_of(source)));
  }
  using Grain = coupling::GrainStructure;
  py::dict out, grains;
  out["grains_counted"] = made.counts.grains;
  out["rattlers"] = made.counts.rattlers;
  out["coordination"] = made.counts.mean;
  out["coordination_bearing"] = made.counts.mean_bearing;
  out["grains_with_contacts"] = array_of(made.counts.with);
  out["size_factor"] = made.size.measured;
  out["size_factor_theory"] = made.size.theory;
  std::vector<py::array_t<std::int64_t>> chains;
  for (const auto& chain : made.chains.chains) chains.push_back(array_of(chain.grains));
  out["chains"] = chains;
  out["grains_in_chains"] = made.chains.in_chains;
  out["mean_chain_length"] = made.chains.mean_length;
  out["order"] = made.axes ? made.axes->order : NAN;
  out["director_deg"] = made.axes ? made.axes->director_deg : NAN;
  if (made.base) {
    py::dict base;
    base["ids"] = array_of(made.base->ids);
    base["x"] = array_of(made.base->x);
    base["force"] = array_of(made.base->force);
    base["mean"] = made.base->mean;
    base["tail_rate"] = made.tail.rate;
    base["tail_low"] = made.tail.low;
    base["tail_high"] = made.tail.high;
    base["tail_p_value"] = made.tail.p_value;
    out["base"] = base;
  } else {
    out["base"] = py::none();
  }
  grains["contacts"] = of_grains<std::int64_t>(made, [](const Grain& g) { return g.contacts; });
  grains["rattler"] = of_grains<bool>(made, [](const Grain& g) { return g.rattler; });
  grains["stress_trace"] = of_grains<double>(made, [](const Grain& g) { return g.stress_trace; });
  grains["stress_deviator"] =
      of_grains<double>(made, [](const Grain& g) { return g.stress_deviator; });
  grains["compression_angle"] =
      of_grains<double>(made, [](const Grain& g) { return g.compression_angle; });
  grains["fabric_angle"] = of_grains<double>(made, [](const Grain& g) { return g.fabric_angle; });
  grains["long_angle"] = of_grains<double>(made, [](const Grain& g) { return g.long_angle; });
  grains["chain"] = of_grains<std::int64_t>(made, [](const Grain& g) { return g.chain; });
  out["grains"] = grains;
  return out;
}

// A continuum model with its parameters set. Some keep what they have solved, so one thread at a
// time asks it; those of finite elements share MPI, so one at a time of all.
struct Model {
  std::string name;
  int dim = 2;
  std::shared_ptr<continuum::Model> model;
  std::shared_ptr<std::mutex> asked = std::make_shared<std::mutex>();

  bool solves() const { return name.starts_with("fe_"); }
};

py::array stress_of(const Model& self, const py::object& points) {
  const Eigen::MatrixXd at = matrix_of(points, "points");
  require_columns(at, self.dim, fmt::format("{} is {}D here", self.name, self.dim));
  Eigen::MatrixXd stress;
  {
    const Released released(self.solves());
    const std::lock_guard alone(*self.asked);
    stress = self.model->stress(at);
  }
  py::array_t<double> out({stress.rows(), stress.cols()});
  auto to = out.mutable_unchecked<2>();
  for (Eigen::Index r = 0; r < stress.rows(); ++r)
    for (Eigen::Index c = 0; c < stress.cols(); ++c) to(r, c) = stress(r, c);
  return out;
}

py::dict quantities_of(const Model& self, const py::object& points) {
  const Eigen::MatrixXd at = matrix_of(points, "points");
  require_columns(at, self.dim, fmt::format("{} is {}D here", self.name, self.dim));
  std::vector<continuum::Quantity> found;
  {
    const Released released(self.solves());
    const std::lock_guard alone(*self.asked);
    found = self.model->quantities(at);
  }
  py::dict out;
  for (const auto& q : found) out[py::str(q.name)] = array_of(q.values);
  return out;
}

py::list models() {
  py::list out;
  for (const auto& info : continuum::registry()) {
    py::dict one, parameters;
    for (const auto& p : info.parameters) {
      py::dict parameter;
      parameter["unit"] = p.unit;
      parameter["meaning"] = p.meaning;
      parameter["source"] = p.source;
      parameter["default"] =
          p.choices.empty() ? py::object(py::float_(p.value)) : py::str(p.choices.front());
      parameter["allowed"] = continuum::allowed(p);
      parameters[py::str(p.name)] = parameter;
    }
    one["name"] = info.name;
    one["summary"] = info.summary;
    one["dim"] = info.dim;
    one["parameters"] = parameters;
    out.append(one);
  }
  return out;
}

coupling::FitOutcome fit(const std::vector<std::string>& files,
                         const std::vector<Packing>& packings,
                         const std::optional<HeldField>& field,
                         const std::vector<std::string>& models, const std::vector<double>& heights,
                         const std::vector<std::string>& components,
                         const std::optional<double>& width_diameters, const std::string& case_name,
                         const std::vector<std::string>& sets, const std::vector<int>& coverage,
                         int draws, const std::string& folder, int threads) {
  coupling::FitRequest request;
  request.inputs = files;
  for (const Packing& packing : packings)
    request.heaps.push_back({"packing", std::to_string(request.heaps.size()), packing.state});
  if (field) request.field = *field->field;
  const int kinds = !files.empty() + !packings.empty() + field.has_value();
  if (kinds != 1)
    throw std::invalid_argument(
        "fit: found inputs of several kinds or none, allowed: files, or packings in memory, or one "
        "field in memory");
  request.case_file = case_name;
  request.overrides = sets;
  request.models = models;
  request.heights = heights;
  request.components = components;
  request.width_diameters = width_diameters;
  request.coverage = coverage;
  request.draws = draws;
  request.folder = folder;
  request.threads = threads;
  const Released released(true);
  return coupling::run_fit(request);
}

coupling::CompareOutcome compare(const std::string& file,
                                 const std::vector<std::pair<std::string, HeldField>>& fields_held,
                                 const std::vector<std::string>& models,
                                 const std::vector<std::string>& fields,
                                 const std::vector<std::string>& components,
                                 const std::vector<double>& heights,
                                 const std::vector<double>& origin, const std::string& folder) {
  coupling::CompareRequest request;
  request.file = file;
  for (const auto& [name, field] : fields_held) request.held.emplace_back(name, *field.field);
  request.fields = fields;
  request.models = models;
  request.lines.components = components;
  request.lines.heights = heights;
  request.lines.origin = origin;
  request.folder = folder;
  const Released released(true);
  return coupling::run_compare(request);
}

std::pair<HeldField, std::string> import_field(const std::string& file, const std::string& geometry,
                                               int dim, double height, double left_deg,
                                               double right_deg, double rho_g, double load,
                                               double width) {
  coupling::MeasuredRequest request;
  request.file = file;
  request.geometry = geometry;
  request.dim = dim;
  request.height = height;
  request.left_deg = left_deg;
  request.right_deg = right_deg;
  request.rho_g = rho_g;
  request.load = load;
  request.width = width;
  const std::string assumed = coupling::settle(request);
  return {held(coupling::measured_field(request)), assumed};
}

py::dict progress_dict(const coupling::EnsembleProgress& p) {
  py::dict out;
  out["text"] = coupling::progress_text(p);
  out["phase"] = p.phase;
  out["done"] = p.done;
  out["total"] = p.total;
  out["fraction"] = p.fraction;
  out["simulated_time"] = p.simulated_time;
  out["grains"] = p.grains;
  out["awake"] = p.awake;
  out["kinetic_energy"] = p.kinetic_energy;
  out["unbalanced_force_ratio"] = p.unbalanced_force_ratio;
  out["seconds_left"] = p.seconds_left;
  return out;
}

// Python's exception out of a callback or a signal stops the run as Ctrl-C does; it is thrown when
// the run has saved its state.
class Callbacks {
 public:
  template <class Call>
  void operator()(Call call) {
    const py::gil_scoped_acquire acquired;
    if (failed_) return;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      call();
    } catch (py::error_already_set& error) {
      failed_ = true;
      signal_ = error.matches(PyExc_KeyboardInterrupt);
      error_ = std::current_exception();
      coupling::interrupt_polled_work();
    }
  }
  /// What a callback threw; not KeyboardInterrupt, which Interrupted stands for with its text.
  void rethrow() const {
    if (failed_ && !signal_) std::rethrow_exception(error_);
  }

 private:
  bool failed_ = false, signal_ = false;
  std::exception_ptr error_;
};

py::dict run(const std::string& case_name, const std::string& folder,
             const std::vector<std::string>& sets, bool quick, bool resume, int threads,
             double checkpoint_seconds, long stop_after_steps, const py::object& progress,
             const py::object& note) {
  const OneRun alone;
  coupling::RunRequest request;
  request.file = case_name;
  request.folder = folder;
  request.sets = sets;
  request.quick = quick;
  request.resume = resume;
  request.threads = threads;
  request.checkpoint_seconds = checkpoint_seconds;
  request.stop_after_steps = stop_after_steps;
  coupling::RunPlan plan = coupling::plan_run(request);
  const coupling::Ranks ranks;
  plan.options.threads = coupling::threads_for(threads, ranks);
  py::dict out;
  std::vector<std::string> warnings = plan.value.without_effect;
  Callbacks call;
  plan.options.progress = [&](const coupling::EnsembleProgress& p) {
    call([&] {
      if (!progress.is_none()) progress(progress_dict(p));
    });
  };
  const auto tell = [&](const std::string& text) {
    call([&] {
      if (!note.is_none()) note(text);
    });
  };
  plan.options.note = tell;
  plan.options.warn = [&](const std::string& text) { warnings.push_back(text); };
  try {
    const py::gil_scoped_release released;
    coupling::run_case(plan.value, ranks, plan.options);
  } catch (const coupling::Interrupted&) {
    call.rethrow();
    throw;
  }
  call.rethrow();
  if (ranks.first()) {
    const std::string deep = coupling::deep_overlap(
        plan.value, coupling::read_summary(plan.options.folder + "/summary.json"));
    if (!deep.empty()) warnings.push_back(deep);
  }
  out["folder"] = plan.options.folder;
  out["warnings"] = warnings;
  out["first"] = ranks.first();
  return out;
}

}  // namespace

void add_commands(py::module_& module) {
  py::class_<AverageOutcome>(module, "AverageOutcome")
      .def_readonly("fields", &AverageOutcome::fields)
      .def_readonly("warnings", &AverageOutcome::warnings)
      .def_readonly("gaps", &AverageOutcome::gaps)
      .def_readonly("seconds", &AverageOutcome::seconds);
  module.def("average", average, py::kw_only(), py::arg("sources"), py::arg("unloaded"),
             py::arg("points"), py::arg("grid"), py::arg("cuts"), py::arg("frame"), py::arg("up"),
             py::arg("method"), py::arg("kernel"), py::arg("width"), py::arg("free_surface"),
             py::arg("least_grains"), py::arg("quantities"), py::arg("response"), py::arg("rings"),
             py::arg("axis"), py::arg("end_at_walls"), py::arg("threads"));
  module.def("strain", strain, py::kw_only(), py::arg("before"), py::arg("after"),
             py::arg("points"), py::arg("grid"), py::arg("frame"), py::arg("up"),
             py::arg("measure"), py::arg("support"), py::arg("width"), py::arg("least_grains"),
             py::arg("threads"));
  module.def("structure", structure);
  module.def("import_field", import_field);
  module.def("measured_doubts",
             [](const HeldField& field) { return coupling::measured_doubts(*field.field); });
  module.def("name_of_measured",
             [](const HeldField& field) { return coupling::name_of_measured(*field.field); });
  module.def("fit", fit, py::kw_only(), py::arg("files"), py::arg("packings"), py::arg("field"),
             py::arg("models"), py::arg("heights"), py::arg("components"),
             py::arg("width_diameters"), py::arg("case"), py::arg("sets"), py::arg("coverage"),
             py::arg("draws"), py::arg("folder"), py::arg("threads"));
  module.def("compare", compare, py::kw_only(), py::arg("file"), py::arg("held"), py::arg("models"),
             py::arg("fields"), py::arg("components"), py::arg("heights"), py::arg("origin"),
             py::arg("folder"));
  module.def("run", run, py::kw_only(), py::arg("case"), py::arg("folder"), py::arg("sets"),
             py::arg("quick"), py::arg("resume"), py::arg("threads"), py::arg("checkpoint_seconds"),
             py::arg("stop_after_steps"), py::arg("progress"), py::arg("note"));
  module.def("finish_ranks", coupling::finish_ranks);
  module.def("cases", [] {
    std::vector<std::string> names;
    for (const auto& file : coupling::shipped_cases()) names.push_back(file.string());
    return names;
  });
  module.def("models", models);
  py::class_<Model>(module, "Model")
      .def(py::init([](const std::string& name, const continuum::Settings& settings) {
        const coupling::ModelChoice choice = coupling::in_registry({name, name, settings});
        return Model{name,
                     continuum::dimension(continuum::find_model(choice.name), choice.settings),
                     continuum::make_model(choice.name, choice.settings)};
      }))
      .def_readonly("name", &Model::name)
      .def_readonly("dim", &Model::dim)
      .def("stress", stress_of)
      .def("quantities", quantities_of)
      .def("figures", [](const Model& self) { return self.model->figures(); });
}

}  // namespace grainfield::python
