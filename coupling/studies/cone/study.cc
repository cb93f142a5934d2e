// Cones poured from a point, rained, or left by a lifted cylinder: base pressure, dip, stress
// inside, against models of cones.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/models/subject.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/grain_keys.h"
#include "coupling/run/realization_file.h"
#include "coupling/run/summary_keys.h"
#include "coupling/specimen/cone_windows.h"
#include "coupling/studies/cone/cone_ensemble.h"
#include "coupling/studies/cone/cone_file.h"
#include "coupling/studies/cone/figures.h"
#include "coupling/studies/cone/keys.h"
#include "coupling/studies/cone/page.h"
#include "coupling/studies/cone/simulation.h"
#include "coupling/studies/pile/figures.h"
#include "coupling/studies/pile/keys.h"
#include "coupling/studies/pile/simulation.h"

namespace grainfield::coupling {
namespace {

// A models' cone that is higher over the heap is warned of.
constexpr double kHigherCone = 1.1;

Observations observed(const ConeEnsemble& cones) {
  const double h = cones.height, pressure = cones.pressure;
  Observations out;
  out.specimen = Specimen::heap;
  out.realizations = cones.base.realizations();
  out.scale = scale_of_heaps(
      h, pressure,
      fmt::format(" (rho = {:.6g} kg/m3 times mean volume fraction {:.4g}); every cone scaled by "
                  "its own; means over the angle at radius |x|; realizations: {}",
                  cones.mean(&ConeFrame::grain_density), cones.mean(&ConeFrame::volume_fraction),
                  out.realizations),
      "apex", 3);
  // The heap's frame has its origin at the highest point, that of the models where flanks meet.
  out.apex = h * (cones.spanned() - 1);
  out.told.height = out.told.depth = h * cones.spanned();
  out.told.dim = 3;
  out.told.numbers = {{"rho_g", pressure / h}, {"phi_deg", cones.mean(&ConeFrame::repose_deg)}};
  out.lines = cones.lines();
  out.map.points = h * rings_in_space(cones.inside);
  out.map.nx = cones.columns;
  out.map.ny = 1;
  out.map.nz = cones.rows;
  return out;
}

// A warning where the models' cone is another body than the heap.
void compare_cones(const ConeEnsemble& cones, StudyResult& out, ConePage& page) {
  const Observations seen = observed(cones);
  const std::vector<SeenModel> models = see_models(seen, out.value.models);
  out.comparison = compared(seen, models);
  if (models.empty()) return;
  add_models(out, seen, models);
  for (const SeenModel& m : models) {
    page.models.push_back({m.choice.label, m.profiles.label, m.map.col(2) / cones.pressure});
  }
  add_compared(out.summary, seen, out.comparison, 0);
  if (cones.spanned() <= kHigherCone) return;
  double weight = 0;
  for (const double w : cones.figures.at("cone.model_over_weight")) {
    weight += w / seen.realizations;
  }
  out.warnings.push_back(fmt::format(
      "The models' cone, which the flank's line spans, is {:.3g} times as high as the grains' "
      "rounded heap and weighs {:.3g} times as much: part of every model's distance is that of "
      "the shapes.",
      cones.spanned(), weight));
}

void add_cone_fields(const Case& value, const ConeEnsemble& cones, StudyResult& out,
                     ConePage& page) {
  for (const MethodAverages& a : cones.methods) {
    Field inside = cones.in_metres(a.map, a.options);
    inside.nx = cones.columns;
    inside.ny = 1;
    inside.nz = cones.rows;
    out.fields.emplace_back(a.method + "_inside", std::move(inside));
    for (std::size_t k = 0; k < a.lines.size(); ++k) {
      out.fields.emplace_back(
          fmt::format("{}_height_{:g}", a.method, value.get<HeapSetup>().heights[k]),
          cones.in_metres(a.lines[k], a.options));
    }
    add_method_figures(out.summary, a);
  }
  page.base = cones.base.mean();
  page.base.nx = page.base.ny = cones.columns;
  page.rings = cones.base_rings.mean();
  page.inside = cones.methods.front().map.mean();
  page.inside.nx = cones.columns;
  page.inside.nz = cones.rows;
  Field square = cones.in_metres(cones.base, cones.methods.front().options);
  square.nx = square.ny = cones.columns;
  square.nz = 1;
  out.fields.emplace_back("base", std::move(square));
  out.fields.emplace_back("base_rings",
                          cones.in_metres(cones.base_rings, cones.methods.front().options));
}

void add_base_figures(const ConeEnsemble& cones, const std::string& source, Summary& summary) {
  const Field base = cones.base_rings.mean();
  const Eigen::VectorXd pressure = -base.find("sigma_zz")->value;
  // The floor pulls the grains inwards with -sigma_rz.
  const Eigen::VectorXd shear = base.find("sigma_rz")->value;
  Eigen::Index at = 0, shear_at = 0;
  for (Eigen::Index k = 1; k < pressure.size(); ++k) {
    if (pressure[k] > pressure[at]) at = k;
    if (shear[k] > shear[shear_at]) shear_at = k;
  }
  add_values(base_rows(),
             {pressure[0], pressure[at], cones.radii[at], cones.methods.front().options.width},
             summary);
  add_values(cones_rows(), {source, shear[shear_at], cones.radii[shear_at]}, summary);
}

void add_dip(const ConeEnsemble& cones, StudyResult& out) {
  const Dip dip = judge_dip(cones.windows);
  add_values(dip_rows(), dip, out.summary);
  Judgement& judgement = out.comparison.judgement;
  judgement.findings = dip_lines(dip);
  if (std::isnan(dip.centre)) {
    judgement.findings = {fmt::format(
        "Whether there is a dip cannot be said: of some cone fewer than {} contacts with the base "
        "are within heap.centre = {:g} of the foot's radius; raise it, or take more grains.",
        kLeastInDisk, out.value.get<HeapSetup>().centre)};
  }
}

// How the cones were built: as the case says, or as their files do.
std::string source_of(const Case& value, const std::vector<std::string>& files) {
  if (value.get<GrainFiles>().files.empty()) return value.get<dem::ConeSetup>().plan.source;
  std::set<std::string> sources;
  for (const std::string& file : files) {
    const dem::Snapshot cone = read_realization(file)["pile"];
    const auto at = cone.attributes.find("source");
    sources.insert(at == cone.attributes.end() ? "" : at->second);
  }
  return sources.size() == 1 ? *sources.begin() : "";
}

StudyResult analyse_cones(const Case& value, const std::vector<std::string>& files, int threads) {
  ConeEnsemble cones(value, files, threads);
  cones.collect();
  StudyResult out = begin_result(value, files);
  out.warnings = cones.warnings();
  add_figures(out.summary, cones.figures);
  ConePage page;
  page.averaged = describe(cones.methods.front().options);
  add_cone_fields(value, cones, out, page);
  compare_cones(cones, out, page);
  add_base_figures(cones, source_of(value, files), out.summary);
  add_dip(cones, out);
  out.page = [page](const StudyResult& result, const Realization* first) {
    return cone_page(result, first, page);
  };
  out.overview = {{"shoulder pressure (rho g h)", "dip.shoulder", ""}};
  return out;
}

// The cone of a file as a run leaves it. Throws std::invalid_argument "grains.files: ..." for a
// snapshot that is none, and as dem::check_same_cone, naming the key, where it is another one than
// the case's.
dem::RunResult finished_cone(const FinishedRun& place, const dem::ConeSetup& setup) {
  const dem::Snapshot cone = dem::read_snapshot(place.file, place.group + "/pile");
  const std::string where = fmt::format("{}:{}/pile", place.file, place.group);
  if (cone.dim != 3) {
    throw std::invalid_argument(fmt::format("grains.files: {} is 2D, a 3D one is needed", where));
  }
  const auto free = std::count_if(cone.grains.begin(), cone.grains.end(),
                                  [](const dem::Grain& g) { return !g.fixed; });
  if (free == 0 || !has_base(cone)) {
    throw std::invalid_argument(
        fmt::format("grains.files: {} has no {}", where,
                    free > 0 ? "base: a wall \"floor\" or fixed grains" : "free grain"));
  }
  dem::check_same_cone(setup, cone, where);
  dem::RunResult out;
  out.snapshots.emplace_back("pile", cone);
  out.figures["dem.grains"] = static_cast<double>(free);
  return out;
}

dem::ConeSetup setup_of_cone(const Case& value) {
  dem::ConeSetup out = value.get<dem::ConeSetup>();
  out.sleep = value.get<dem::PileSetup>().sleep;  // the section's keys are those of piles
  return out;
}

const std::vector<std::string> kConeStates{"pile"};

std::unique_ptr<dem::Run> make_cone(const Case& value, std::int64_t number, int threads) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::make_cone_run(setup_of_cone(value), realization_seed(value, number), threads);
  }
  return run_of(
      finished_cone(finished_run(value, number, kConeStates, "cone"), setup_of_cone(value)));
}

dem::Outlook foresee_cones(const Case& value, std::int64_t draws) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::foresee_cone(setup_of_cone(value), realization_seeds(value), draws);
  }
  try_finished_runs(value, kConeStates, "cone",
                    [&](const FinishedRun& cone) { finished_cone(cone, setup_of_cone(value)); });
  return {};
}

}  // namespace

Study cone_study() {
  Study out;
  out.name = "cone";
  out.meaning = "cones of spheres or superellipsoids: base pressure and dip, repose, stress inside";
  out.sections = {kGrainFilesKeys, kMaterialKeys, kMotionKeys,  kRestKeys,
                  kConeKeys,       kSleepKeys,    kAverageKeys, kHeapKeys};
  out.material = [](Case& c) -> dem::MaterialSetup& { return c.get<dem::ConeSetup>().material; };
  out.grain_radius = [](const Case& c) { return c.get<dem::ConeSetup>().plan.radius; };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<dem::ConeSetup>().motion; };
  out.rest = [](Case& c) -> dem::RestSetup& { return c.get<dem::ConeSetup>().rest; };
  out.figures = {cone_figures};
  out.models_optional = true;
  out.check = [](const Case& value) {
    check_heap_windows(value.get<HeapSetup>());
    require_subject(value.models, Subject::heap, 3, "compare.models");
  };
  out.averaged = [](const Case& value) {
    return averaged_values(value.get<AverageSetup>(), value.get<HeapSetup>().heights.size() + 1);
  };
  out.without = {"average.depths", "average.half_width", "heap.axis_from", "heap.axis_to"};
  out.fills = {"rho_g", "phi_deg", "h", "dim", "depth"};
  out.dimension = [](const Case&) { return 3; };
  out.dimension_key = "study";
  out.make_run = make_cone;
  out.foresee = foresee_cones;
  out.left_unused = [](const Case& value) { return unused_runs(value, kConeStates, "cone"); };
  out.longest_part = [](const Case& value, const dem::Outlook& outlook) -> LongestPart {
    if (outlook.time_key != "cone.rate") return {};
    if (!setup_of_cone(value).sleep.on) return {"pouring", ""};
    return {"pouring", "; sleeping makes it less"};
  };
  out.analyse = analyse_cones;
  return out;
}

}  // namespace grainfield::coupling
