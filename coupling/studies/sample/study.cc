// Samples of grains under compression and shear: their recorded states as tables and curves.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "coupling/run/ensemble.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/grain_keys.h"
#include "coupling/run/recorded.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/sample/block.h"
#include "coupling/studies/sample/figures.h"
#include "coupling/studies/sample/keys.h"
#include "coupling/studies/sample/moduli.h"
#include "coupling/studies/sample/page.h"
#include "coupling/studies/sample/rve_page.h"
#include "coupling/studies/sample/simulation/path.h"
#include "coupling/studies/sample/simulation/sample.h"
#include "coupling/studies/sample/simulation/setup.h"
#include "coupling/studies/sample/state_table.h"
#include "coupling/studies/sample/strength.h"
#include "dem/run/setup.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

// The bound of inertial numbers (GDR MiDi 2004).
constexpr double kQuasiStatic = 1e-3;

const char* strain_name(const std::string& deformation) {
  return deformation == "simple_shear" ? "shear strain"
         : deformation == "isotropic"  ? "strain of the edges"
                                       : "axial strain";
}

SampleCurve curve(const StateTable& table, const std::string& column, const std::string& title) {
  return {title, table.mean(column), table.error(column)};
}

// Less its value in the first state.
SampleCurve risen(const StateTable& table, const std::string& column, const std::string& title) {
  SampleCurve out = curve(table, column, title);
  out.mean.array() -= out.mean[0];
  return out;
}

// It follows from the imposed strain then, or is rounding: nothing to be seen.
bool imposes_volume(const dem::SamplePlan& plan) {
  if (dem::shears(plan)) return plan.constant == "volume";
  return plan.deformation == "uniaxial" || plan.deformation == "isotropic";
}

std::string label_of(const StateTable& table) {
  return table.realizations() > 1 ? fmt::format("grains, mean of {}", table.realizations())
                                  : "grains";
}

SampleReport curves_of(const Case& value, const StateTable& table) {
  const dem::SamplePlan& plan = value.get<dem::SampleSetup>().plan;
  SampleReport out;
  out.title = title_of(value);
  out.subtitle =
      fmt::format("{} {}s in {}, {} law, {}", plan.grains,
                  plan.dim == 3          ? plan.shape.c_str()
                  : plan.shape == "disk" ? "disk"
                                         : "polygon",
                  plan.boundary == "periodic" ? "a periodic cell" : "a box of walls",
                  value.get<dem::SampleSetup>().material.law,
                  plan.deformation == "simple_shear" ? "simple shear at constant " + plan.constant
                                                     : plan.deformation + " deformation");
  out.strain_name = strain_name(plan.deformation);
  out.label = label_of(table);
  out.strain = table.mean("strain");
  out.main = {curve(table, "q_over_p", "q/p")};
  if (!imposes_volume(plan)) {
    out.main.push_back(curve(table, "volumetric_strain", "volumetric strain"));
  }
  out.main.push_back(curve(table, "p", plan.dim == 2 ? "p (N/m)" : "p (Pa)"));
  out.main.push_back(curve(table, "coordination", "contacts of a grain"));
  const Driving driving = driving_of(plan.deformation, plan.dim);
  out.stress_unit = plan.dim == 2 ? "N/m" : "Pa";
  if (plan.deformation == "simple_shear") {
    out.main.push_back(
        curve(table, driving.stress, fmt::format("shear stress ({})", out.stress_unit)));
  }
  if (plan.deformation == "uniaxial") {
    SampleCurve axial = curve(table, driving.stress, "axial stress over its largest");
    const double largest = axial.mean.minCoeff();
    axial.mean /= largest;
    axial.error /= std::fabs(largest);
    out.main.push_back(std::move(axial));
  }
  out.stresses = {curve(table, "p", "p"), curve(table, "q", "q")};
  if (driving.stress.starts_with("sigma")) {
    SampleCurve own = curve(table, driving.stress, driving.meaning);
    if (driving.compression) own.mean = -own.mean;
    out.stresses.push_back(std::move(own));
  }
  out.structure = {curve(table, "coordination_bearing", "contacts of a grain that bears"),
                   curve(table, "fabric_anisotropy", "anisotropy of the fabric"),
                   curve(table, "solid_fraction", "solid fraction"),
                   curve(table, "rattlers", "share of rattlers")};
  out.energies = {curve(table, "work", "work"), risen(table, "elastic_energy", "elastic"),
                  risen(table, "kinetic_energy", "kinetic")};
  if (value.get<dem::SampleSetup>().motion.energy_balance) {
    out.energies.push_back(curve(table, "dissipated", "lost"));
    out.energies.push_back(curve(table, "lost_to_friction", "of it to friction"));
    out.energies.push_back(curve(table, "work_of_law", "work of the law"));
  }
  return out;
}

std::string counted_realizations(const StateTable& table) {
  return fmt::format("{} realization{}", table.realizations(),
                     table.realizations() == 1 ? "" : "s");
}

// What a packing is that was filled and not loaded: at rest by the bounds of [rest].
std::string packing_sentence(const Case& value, const StateTable& table, const Summary& summary) {
  const dem::SampleSetup& setup = value.get<dem::SampleSetup>();
  const auto first = [&](const char* column) { return table.of(column).row(0).array().eval(); };
  const auto kinetic = first("kinetic_energy"), elastic = first("elastic_energy"),
             unbalanced = first("unbalanced_force_ratio");
  const auto rests = (unbalanced <= setup.rest.unbalanced_force_ratio &&
                      kinetic <= setup.rest.kinetic_to_elastic_energy * elastic)
                         .count();
  const bool all = rests == table.realizations(), none = rests == 0;
  return fmt::format(
      "A packing {}, not loaded: solid fraction {}, {} contacts of a grain, p = {} {}, {}.",
      all    ? "at rest"
      : none ? "that is not at rest"
             : fmt::format("that is at rest in {} of its realizations", rests),
      shown_with_error(summary, "sample.initial_solid_fraction"),
      shown_with_error(summary, "sample.initial_coordination"),
      shown_with_error(summary, "sample.initial_pressure"), setup.plan.dim == 2 ? "N/m" : "Pa",
      counted_realizations(table));
}

std::string sentence(const Case& value, const StateTable& table, const Summary& summary) {
  const dem::SamplePlan& plan = value.get<dem::SampleSetup>().plan;
  if (!is_loaded(plan)) return packing_sentence(value, table, summary);
  const auto has = [&](const char* key) { return summary.count(key) != 0; };
  const auto number = [&](const char* key) { return std::get<double>(summary.at(key)); };
  const char* unit = plan.dim == 2 ? "N/m" : "Pa";
  std::string out = fmt::format("From p = {} {} and the solid fraction {}: ",
                                shown_with_error(summary, "sample.initial_pressure"), unit,
                                shown_with_error(summary, "sample.initial_solid_fraction"));
  if (plan.deformation == "uniaxial" || plan.deformation == "isotropic") {
    out += fmt::format("p is {} {} at the end, the secant modulus {}",
                       shown_with_error(summary, "sample.final_pressure"), unit,
                       shown_with_error(summary, "sample.secant_modulus"));
    if (has("sample.lateral_stress_ratio")) {
      out += fmt::format(", lateral over axial stress {}",
                         shown_with_error(summary, "sample.lateral_stress_ratio"));
    }
  } else if (has("sample.peak_stress_ratio") && number("sample.strain_at_peak") > 0) {
    out += fmt::format("q/p rises to {} at a strain of {}",
                       shown_with_error(summary, "sample.peak_stress_ratio"),
                       shown_with_error(summary, "sample.strain_at_peak"));
  } else {
    out += fmt::format("q/p is largest at the start, {}",
                       shown_with_error(summary, "sample.peak_stress_ratio"));
  }
  if (has("sample.critical_stress_ratio")) {
    out +=
        fmt::format("; beyond {:.0f} % of the strain it is {} at the solid fraction {}",
                    100 * kCriticalFrom, shown_with_error(summary, "sample.critical_stress_ratio"),
                    shown_with_error(summary, "sample.critical_solid_fraction"));
  }
  if (has("sample.strain_at_loss")) {
    out += fmt::format(
        "; strength is lost (p below {:.0f} % of the first, or an inertial number above {:g}) at a "
        "strain of {} in {:.0f} of",
        100 * kLeastPressure, kMostInertia, shown_with_error(summary, "sample.strain_at_loss"),
        number("sample.lost_strength") * static_cast<double>(table.realizations()));
  }
  return out + fmt::format("{} {}.", has("sample.strain_at_loss") ? "" : ";",
                           counted_realizations(table));
}

// For ParaView: the states in order, with the strain as time.
std::string series_of(const StateTable& table, const char* kind) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (Eigen::Index k = 0; k < table.states(); ++k) {
    out += fmt::format("<DataSet timestep=\"{:.9g}\" file=\"states/{}_state_{:03}.vtu\"/>\n",
                       table.of("strain")(k, 0), kind, k);
  }
  return out + "</Collection>\n</VTKFile>\n";
}

std::vector<MemberCurve> member_curves(const SampleReport& report) {
  std::vector<MemberCurve> out;
  for (const SampleCurve& shown : report.main) {
    out.push_back({shown.title, report.strain_name, sample_series(report, shown, "", false)});
  }
  return out;
}

Report page_of(SampleReport report, const StudyResult& result, const Realization* grains) {
  report.judgement = result.comparison.judgement;
  if (grains != nullptr) {
    report.first = &grains->snapshots.front().second;
    report.last = &grains->snapshots.back().second;
  }
  report.figures = figure_rows(result);
  report.made = origin_rows(result);
  return sample_report(report);
}

// rve.csv, rve_hull.vtu, the figures rve.* and their pictures, where the case asks for RVEs.
void add_rves(const Case& value, const std::vector<std::string>& files, SampleReport& report,
              StudyResult& out) {
  const RveSetup& setup = value.get<RveSetup>();
  if (setup.along == 0) return;
  const dem::SamplePlan& plan = value.get<dem::SampleSetup>().plan;
  const RveTable rves = rve_table(files, setup, plan);
  add_figures(out.summary, rve_figures(rves, plan.deformation));
  if (plan.deformation == "simple_shear") add_contraction(rve_contraction(rves), out.summary);
  out.texts.emplace_back("rve.csv", rve_csv(rves));
  if (const std::string hull = rve_vtu(rves); !hull.empty()) {
    out.texts.emplace_back("rve_hull.vtu", hull);
  }
  report.rves = rve_sections(rves, plan.deformation);
  for (const std::string& line : rve_warnings(rves)) {
    report.rves.insert(report.rves.begin(), Text{"", line + ".", true});
  }
  out.sweep_sections = [sections = report.rves](const std::string& member) {
    std::vector<Section> own;
    for (Section section : sections) {
      if (auto* picture = std::get_if<Picture>(&section))
        picture->title = member + ": " + picture->title;
      own.push_back(std::move(section));
    }
    return own;
  };
}

// The figures moduli.* and their table, where the case asks for small strains; block.csv, the
// figures block.* and their pictures, where it asks for a block of finite elements.
void add_moduli(const Case& value, const std::vector<std::string>& files, const StateTable& table,
                SampleReport& report, StudyResult& out) {
  const std::vector<ProbedState> states = probed_moduli(files);
  add_figures(out.summary, moduli_figures(states));
  add_symmetry(states, out.summary);
  report.moduli = moduli_sections(states, out.summary);
  const BlockSetup& setup = value.get<BlockSetup>();
  if (setup.law == "none" || states.empty() || states.back().state != "first") return;
  const dem::SamplePlan& plan = value.get<dem::SampleSetup>().plan;
  const BlockComparison comparison =
      compare_block(setup, table, plan, states.back(), strength_paths(table, plan));
  add_figures(out.summary, block_figures(comparison));
  out.texts.emplace_back("block.csv", block_csv(comparison));
  for (Section& section : block_sections(comparison)) report.moduli.push_back(std::move(section));
}

// A warning of a test too fast to be one of states at rest.
void warn_of_inertia(StudyResult& out) {
  const auto found = out.summary.find("sample.inertial_number");
  if (found == out.summary.end()) return;
  const double number = std::get<double>(found->second);
  if (!(number > kQuasiStatic)) return;
  out.warnings.push_back(fmt::format(
      "The inertial number reaches {:.2g} (sample.inertial_number): above {:g} a test is "
      "not quasi-static and its stresses depend on its speed; a lower "
      "sample.strain_rate lessens it in proportion.",
      number, kQuasiStatic));
}

// states.csv and states_of_realizations.csv (state_table.h), the figures sample.* with their
// spread, the report. Throws what StateTable throws.
StudyResult analyse_sample(const Case& value, const std::vector<std::string>& files) {
  const StateTable table(files);
  StudyResult out = begin_result(value, files);
  add_figures(out.summary, simulated_figures(files));
  const dem::SamplePlan& plan = value.get<dem::SampleSetup>().plan;
  add_figures(out.summary, sample_samples(table, plan));
  if (is_loaded(plan)) add_figures(out.summary, strength_figures(strength_paths(table, plan)));
  warn_of_inertia(out);
  out.comparison.realizations = static_cast<int>(files.size());
  out.comparison.judgement.findings = {sentence(value, table, out.summary)};
  out.texts = {{"states.csv", table.csv()},
               {"states_of_realizations.csv", table.csv_of_realizations()}};
  if (value.output.vtu) {
    for (const char* kind : {"grains", "contacts", "chains"}) {
      out.texts.emplace_back(fmt::format("{}.pvd", kind), series_of(table, kind));
    }
  }
  SampleReport report = curves_of(value, table);
  add_moduli(value, files, table, report, out);
  add_rves(value, files, report, out);
  out.member_curves = member_curves(report);
  out.page = [report](const StudyResult& result, const Realization* first) {
    return page_of(report, result, first);
  };
  return out;
}

const std::vector<std::string> kFilled{"state_000"};

std::unique_ptr<dem::Run> make_filled(const Case& value, const FinishedRun& filled,
                                      std::uint64_t seed, int threads) {
  const dem::Snapshot state = dem::read_snapshot(filled.file, filled.group + "/" + kFilled.front());
  return dem::make_sample_run(value.get<dem::SampleSetup>(), seed, threads, &state);
}

std::unique_ptr<dem::Run> make_sample(const Case& value, std::int64_t number, int threads) {
  const std::uint64_t seed = realization_seed(value, number);
  if (!value.get<GrainFiles>().files.empty()) {
    return make_filled(value, finished_run(value, number, kFilled, "sample"), seed, threads);
  }
  return dem::make_sample_run(value.get<dem::SampleSetup>(), seed, threads);
}

}  // namespace

Study sample_study() {
  Study out;
  out.name = "sample";
  out.meaning = "grains in a cell or a box, compressed and sheared: stress, volume and fabric";
  out.sections = {kGrainFilesKeys, kMaterialKeys, kMotionKeys, kRestKeys,
                  kSampleKeys,     kRveKeys,      kBlockKeys};
  out.needs = {{"material.wall_friction", "sample.boundary", {"walls"}}};
  out.material = [](Case& c) -> dem::MaterialSetup& { return c.get<dem::SampleSetup>().material; };
  out.grain_radius = [](const Case& c) { return c.get<dem::SampleSetup>().plan.radius; };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<dem::SampleSetup>().motion; };
  out.rest = [](Case& c) -> dem::RestSetup& { return c.get<dem::SampleSetup>().rest; };
  out.figures = {sample_figures,      rve_summary_keys,      contraction_figures,
                 moduli_summary_keys, strength_summary_keys, block_summary_keys};
  out.without = {"material.gravity", "material.floor_friction", "compare.models", "output.fields"};
  out.models_optional = true;
  out.dimension = [](const Case& value) { return value.get<dem::SampleSetup>().plan.dim; };
  out.dimension_key = "sample.dim";
  out.check = [](const Case& value) {
    const dem::SamplePlan& plan = value.get<dem::SampleSetup>().plan;
    if (!value.get<GrainFiles>().files.empty() && plan.filling != "dropped") {
      throw std::invalid_argument(fmt::format(
          "grains.files: found files of filled boxes, allowed with sample.filling = \"{}\": []",
          plan.filling));
    }
    check_rves(value.get<RveSetup>(), plan);
    check_block(value.get<BlockSetup>(), plan);
  };
  out.make_run = make_sample;
  out.foresee = [](const Case& value, std::int64_t draws) {
    if (!value.get<GrainFiles>().files.empty()) {
      try_finished_runs(value, kFilled, "sample", [&](const FinishedRun& filled) {
        make_filled(value, filled, realization_seed(value, 0), 1);
      });
    }
    return dem::foresee_sample(value.get<dem::SampleSetup>(), realization_seeds(value), draws);
  };
  out.left_unused = [](const Case& value) { return unused_runs(value, kFilled, "sample"); };
  out.analyse = [](const Case& value, const std::vector<std::string>& files, int) {
    return analyse_sample(value, files);
  };
  return out;
}

}  // namespace grainfield::coupling
