// Cones poured from a point, rained, or left by a lifted cylinder: base pressure, dip, stress
// inside, against models of cones.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "coupling/averaging/average.h"
#include "coupling/heap/cone_windows.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/grain_keys.h"
#include "coupling/run/realization_file.h"
#include "coupling/run/summary_keys.h"
#include "coupling/studies/cone/cone_ensemble.h"
#include "coupling/studies/cone/cone_models.h"
#include "coupling/studies/cone/finished_cones.h"
#include "coupling/studies/cone/keys.h"
#include "coupling/studies/cone/page.h"
#include "coupling/studies/pile/keys.h"
#include "dem/study/cone.h"

namespace grainfield::coupling {
namespace {

void add_cone_fields(const Case& value, const ConeEnsemble& cones, StudyResult& out,
                     ConePage& page) {
  for (const ConeAverages& a : cones.methods()) {
    Field inside = cones.in_metres(a.inside, a.options);
    inside.nx = cones.columns();
    inside.ny = 1;
    inside.nz = cones.rows();
    out.fields.emplace_back(a.method + "_inside", std::move(inside));
    for (std::size_t k = 0; k < a.cuts.size(); ++k) {
      out.fields.emplace_back(
          fmt::format("{}_height_{:g}", a.method, value.get<HeapSetup>().heights[k]),
          cones.in_metres(a.cuts[k], a.options));
    }
    const std::string prefix = "average." + a.method + ".";
    out.summary[prefix + "balance_rms"] = a.balance_rms;
    out.summary[prefix + "balance_largest"] = a.balance_largest;
    out.summary[a.method == "coarse_graining" ? "average.width" : "average.rve_radius"] =
        a.options.width;
  }
  page.base = cones.base().mean();
  page.base.nx = page.base.ny = cones.columns();
  page.rings = cones.base_rings().mean();
  page.inside = cones.methods().front().inside.mean();
  page.inside.nx = cones.columns();
  page.inside.nz = cones.rows();
  Field square = cones.in_metres(cones.base(), cones.methods().front().options);
  square.nx = square.ny = cones.columns();
  square.nz = 1;
  out.fields.emplace_back("base", std::move(square));
  out.fields.emplace_back("base_rings",
                          cones.in_metres(cones.base_rings(), cones.methods().front().options));
}

void add_base_figures(const ConeEnsemble& cones, Summary& summary) {
  const Field base = cones.base_rings().mean();
  const Eigen::VectorXd pressure = -base.find("sigma_zz")->value;
  // The floor pulls the grains inwards with -sigma_rz.
  const Eigen::VectorXd shear = base.find("sigma_rz")->value;
  Eigen::Index at = 0, shear_at = 0;
  for (Eigen::Index k = 1; k < pressure.size(); ++k) {
    if (pressure[k] > pressure[at]) at = k;
    if (shear[k] > shear[shear_at]) shear_at = k;
  }
  summary["base.centre_pressure"] = pressure[0];
  summary["base.largest_pressure"] = pressure[at];
  summary["base.largest_at"] = cones.radii()[at];
  summary["base.largest_shear"] = shear[shear_at];
  summary["base.largest_shear_at"] = cones.radii()[shear_at];
  summary["base.smearing_width"] = cones.methods().front().options.width;
  summary["dip.ratio"] = pressure[0] / pressure[at];
}

void add_dip(const ConeEnsemble& cones, StudyResult& out) {
  const Dip dip = judge_dip(cones.windows());
  out.summary["dip.window_ratio"] = dip.window_ratio;
  out.summary["dip.difference"] = dip.difference.mean;
  out.summary["dip.standard_error"] = dip.difference.standard_error;
  out.summary["dip.p_value"] = dip.difference.p_value;
  out.summary["dip.verdict"] = dip.verdict;
  Judgement& judgement = out.comparison.judgement;
  judgement.noun = "cone";
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
  add_figures(out.summary, cones.figures());
  ConePage page;
  page.averaged = describe(cones.methods().front().options);
  add_cone_fields(value, cones, out, page);
  compare_cones(cones, out, page);
  const std::string source = source_of(value, files);
  if (!source.empty()) out.summary["cone.source"] = source;
  add_base_figures(cones, out.summary);
  add_dip(cones, out);
  out.page = [page](const StudyResult& result, const Realization* first) {
    return cone_page(result, first, page);
  };
  out.overview = {{"shoulder pressure (rho g h)", "dip.shoulder", ""}};
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
    check_cone_models(value);
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
  out.longest_part = [](const Case&, const dem::Outlook& outlook) -> LongestPart {
    if (outlook.time_key != "cone.rate") return {};
    return {"pouring", "; sleeping makes it less"};
  };
  out.analyse = analyse_cones;
  return out;
}

}  // namespace grainfield::coupling
