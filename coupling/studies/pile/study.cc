#include "coupling/studies/pile/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "coupling/fit/fit_keys.h"
#include "coupling/fit/fit_report.h"
#include "coupling/fit/heap_result.h"
#include "coupling/heap/scaled.h"
#include "coupling/heap/setup.h"
#include "coupling/models/subject.h"
#include "coupling/observe/lines.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/measured_base.h"
#include "coupling/run/summary_keys.h"
#include "coupling/statistics/spread.h"
#include "coupling/studies/pile/keys.h"
#include "coupling/studies/pile/page.h"
#include "coupling/studies/pile/pile_ensemble.h"
#include "coupling/studies/pile/pile_run.h"
#include "dem/snapshot/number.h"
#include "dem/study/setup.h"

namespace grainfield::coupling {
namespace {

class PileAnalysis {
 public:
  PileAnalysis(const Case& value, const std::vector<std::string>& files, int threads)
      : value_(value), files_(files), threads_(threads), piles_(value, files, threads) {}

  StudyResult run() {
    piles_.collect();
    StudyResult out = begin_result(value_, files_);
    add_figures(out.summary, piles_.figures);
    add_fields(out);
    compare_models(out);
    add_own_figures(out.summary);
    const Dip dip = judge_dip(piles_.windows);
    add_dip(out, dip);
    std::optional<Chart> beside;
    if (const MeasuredSetup& measured = value_.get<MeasuredSetup>(); !measured.field.empty()) {
      beside = beside_measured(base_profile(), measured_base(measured), out.summary);
      out.sweep_charts.push_back(*beside);
    }
    const std::string averaged = describe(piles_.methods.front().options);
    const std::shared_ptr<const Fitted> fitted = fit_models(out);
    out.page = [averaged, beside, fitted, flat = flat_piles()](const StudyResult& result,
                                                               const Realization* first) {
      return page(result, first, averaged, beside, fitted.get(), flat);
    };
    return out;
  }

 private:
  // The fits, and the piles' own lines, which stay on the page.
  struct Fitted {
    std::shared_ptr<const EnsembleFits> fits;
    Comparison piles;
  };

  // N/m, over the base between the mean feet.
  BaseProfile base_profile() const {
    const Field base = piles_.base.mean();
    const double left = piles_.mean(&PileFrame::half_left);
    const double right = piles_.mean(&PileFrame::half_right);
    const double unit = piles_.pressure;
    const Column *down = base.find("sigma_yy"), *along = base.find("sigma_xy");
    BaseProfile out;
    out.height = piles_.height / (left + right);
    out.x = (piles_.height * piles_.x.array() - 0.5 * (right - left)) / (left + right);
    out.normal = -unit * down->value;
    out.shear = unit * along->value;
    out.normal_error = unit * down->error;
    out.shear_error = unit * along->error;
    return out;
  }

  // Values of a scaled field in N/m on points in m, in the heap's frame.
  Field in_metres(const Ensemble& ensemble, const AverageOptions& options) const {
    Field field = of_mean_heap(ensemble, piles_.height, piles_.pressure);
    say_averaging(options, field);
    field.attributes["left_deg"] = piles_.mean(&PileFrame::repose_left_deg);
    field.attributes["right_deg"] = piles_.mean(&PileFrame::repose_right_deg);
    return field;
  }

  ObservedLine line(const MethodAverages& a, const Ensemble& values, const LineOf& how) const {
    return observed_line(in_metres(values, a.options), how, piles_.kernel);
  }

  std::vector<ObservedLine> cuts(const MethodAverages& a, const std::string& suffix) const {
    std::vector<ObservedLine> out;
    for (std::size_t k = 1; k < a.lines.size(); ++k) {
      out.push_back(line(a, a.lines[k],
                         {"sigma_yy", fmt::format("height {:g} h{}", piles_.share(k), suffix),
                          fmt::format("height_{:g}", piles_.share(k))}));
    }
    // High cuts of small heaps may have no value at all.
    std::erase_if(out, [](const ObservedLine& cut) {
      return cut.profile.mean.array().isFinite().count() < 3;
    });
    return out;
  }

  void add_fields(StudyResult& out) const {
    for (const MethodAverages& a : piles_.methods) {
      Field map = in_metres(a.map, a.options);
      if (&a == &piles_.methods.front()) out.map = map;
      out.fields.emplace_back(a.method + "_map", std::move(map));
      for (std::size_t k = 0; k < a.lines.size(); ++k) {
        out.fields.emplace_back(
            k == 0 ? a.method + "_base" : fmt::format("{}_height_{:g}", a.method, piles_.share(k)),
            in_metres(a.lines[k], a.options));
      }
      add_method_figures(out.summary, a);
    }
    out.fields.emplace_back("base", in_metres(piles_.base, piles_.methods.front().options));
  }

  Observations observed(const Field& map) const {
    const double h = piles_.height, unit = piles_.pressure;
    const double left = piles_.mean(&PileFrame::repose_left_deg);
    const double right = piles_.mean(&PileFrame::repose_right_deg);
    Observations out;
    out.specimen = Specimen::heap;
    out.realizations = static_cast<int>(files_.size());
    out.scale = scale_of_heaps(
        h, unit,
        fmt::format(" (rho = {:.6g} kg/m2 times mean volume fraction {:.4g}){}",
                    piles_.mean(&PileFrame::grain_density),
                    piles_.mean(&PileFrame::volume_fraction), scaled_alone(out.realizations)));
    out.told.height = out.told.depth = h;
    out.told.numbers = {{"rho_g", unit / h},
                        {"phi_deg", (left + right) / 2},
                        {"left_deg", left},
                        {"right_deg", right}};
    const MethodAverages& first = piles_.methods.front();
    out.lines = {line(first, piles_.base, {"sigma_yy", "base", "base", Smoothing::marginal})};
    for (ObservedLine& cut : cuts(first, "")) out.lines.push_back(std::move(cut));
    out.map = map;
    return out;
  }

  void compare_models(StudyResult& out) const {
    const Observations seen = observed(out.map);
    const std::vector<SeenModel> models = see_models(seen, value_.models);
    out.comparison = compared(seen, models);
    if (!models.empty()) {
      add_models(out, seen, models);
      add_compared(out.summary, seen, out.comparison, 0);
    }
    for (const MethodAverages& a : piles_.methods) {
      out.comparison.beside.push_back(
          line(a, a.lines.front(), {"sigma_yy", "base " + a.method, "base_" + a.method}).profile);
      if (&a == &piles_.methods.front()) continue;
      for (ObservedLine& cut : cuts(a, " " + a.method)) {
        out.comparison.beside.push_back(std::move(cut.profile));
      }
    }
  }

  void add_own_figures(Summary& summary) const {
    std::map<std::string, std::vector<double>> figures;
    std::vector<double> ratios;
    for (const PileFrame& f : piles_.frames) {
      figures["heap.volume_fraction"].push_back(f.volume_fraction);
      ratios.push_back(f.centre_fraction / f.surface_fraction);
    }
    figures["density.ratio"] = ratios;
    const auto &left = piles_.figures.at("dem.repose_angle_left_deg"),
               &right = piles_.figures.at("dem.repose_angle_right_deg");
    for (std::size_t r = 0; r < left.size(); ++r) {
      figures["repose.mean_deg"].push_back((left[r] + right[r]) / 2);
      figures["repose.left_minus_right_deg"].push_back(left[r] - right[r]);
    }
    add_figures(summary, figures);
    for (double& r : ratios) r -= 1;
    summary["density.p_value"] = spread_of(ratios).p_value;
    summary["source.kind"] = value_.get<dem::PileSetup>().source.kind;
    if (value_.get<dem::PileSetup>().source.kind == "point") {
      summary["source.interval"] = value_.get<dem::PileSetup>().source.interval;
    }
    if (value_.get<dem::PileSetup>().sleep.on && value_.get<GrainFiles>().files.empty()) {
      summary["sleep.wake_reach"] = value_.get<dem::PileSetup>().sleep.wake_reach;
    }
    add_grain_steps(summary);
    const Field base = piles_.base.mean();
    const Eigen::VectorXd pressure = -base.find("sigma_yy")->value;
    Eigen::Index at = 0;
    const double largest = pressure.maxCoeff(&at);
    const double centre = pressure[pressure.size() / 2];
    summary["base.centre_pressure"] = centre;
    summary["base.largest_pressure"] = largest;
    summary["base.largest_at"] = std::fabs(piles_.x[at]);
    summary["base.smearing_width"] = piles_.methods.front().options.width;
    summary["dip.ratio"] = centre / largest;
  }

  void add_grain_steps(Summary& summary) const {
    const auto grains = piles_.figures.find("dem.grains");
    const auto steps = piles_.figures.find("dem.steps");
    if (grains == piles_.figures.end() || steps == piles_.figures.end()) return;
    double sum = 0;
    for (std::size_t r = 0; r < files_.size(); ++r) sum += grains->second[r] * steps->second[r];
    summary["dem.grain_steps"] = sum;
  }

  // What is said of each pile that is no heap.
  std::vector<std::string> no_heaps() const {
    std::vector<std::string> out;
    for (std::size_t r = 0; r < piles_.frames.size(); ++r) {
      std::string why = piles_.frames[r].no_heap(r);
      if (!why.empty()) out.push_back(std::move(why));
    }
    return out;
  }

  void add_dip(StudyResult& out, const Dip& dip) const {
    out.summary["dip.window_ratio"] = dip.window_ratio;
    out.summary["dip.difference"] = dip.difference.mean;
    out.summary["dip.standard_error"] = dip.difference.standard_error;
    out.summary["dip.p_value"] = dip.difference.p_value;
    out.summary["dip.verdict"] = dip.verdict;
    Judgement& judgement = out.comparison.judgement;
    if (const auto none = no_heaps(); !none.empty()) {
      const std::string count = fmt::format("in {} of {} piles", none.size(), files_.size());
      out.warnings.push_back(fmt::format(
          "no heap formed {}: {}{}; apex, slopes and shoulders mean little there; more grains, or "
          "more friction, make one",
          count, none.front(), none.size() == 1 ? "" : ", and others"));
      judgement.findings.push_back(fmt::format("No heap formed {}.", count));
    }
    for (std::string& line : dip_lines(dip)) judgement.findings.push_back(std::move(line));
  }

  // The models of [fit] with free constants: their judgement, lines and constants become the run's,
  // and the piles' lines stand beside theirs. Null without such models.
  std::shared_ptr<const Fitted> fit_models(StudyResult& out) const {
    const FitSetup& setup = value_.get<FitSetup>();
    if (setup.models.empty()) return nullptr;
    const auto observe = [&](const FitSetup& with) {
      return observe_heaps(with, heaps_of_runs(files_), threads_);
    };
    HeapResult made = heap_result(value_, observe(setup), threads_, observe);
    for (auto& [key, figure] : made.study.summary) out.summary.insert_or_assign(key, figure);
    out.constants = std::move(made.study.constants);
    out.texts = std::move(made.study.texts);
    out.overview = std::move(made.study.overview);
    const auto fitted = std::make_shared<Fitted>(
        Fitted{made.fits, std::exchange(out.comparison, std::move(made.study.comparison))});
    Comparison& now = out.comparison;
    now.judgement.findings = fitted->piles.judgement.findings;
    for (const auto* lines : {&fitted->piles.profiles, &fitted->piles.beside}) {
      now.beside.insert(now.beside.end(), lines->begin(), lines->end());
    }
    return fitted;
  }

  // A row for every changed gravity, from the least one.
  static Table changes_of(const Summary& summary) {
    Table table{
        "Changed gravity",
        "Means over the piles with standard errors; against each pile under its own gravity.",
        {"gravity", "contacts per grain, ratio", "contacts opened", "closed", "brought to sliding",
         "largest displacement / r", "dip's change (rho g h)"},
        {}};
    const std::string first = "change.gravity_", last = ".coordination_ratio";
    std::map<double, std::string> changes;
    for (const auto& [key, unused] : summary) {
      if (!key.starts_with(first) || !key.ends_with(last)) continue;
      const std::string name = key.substr(0, key.size() - last.size());
      if (const auto gravity = dem::parse_number(name.substr(first.size()))) {
        changes[*gravity] = name;
      }
    }
    for (const auto& [gravity, name] : changes) {
      std::vector<std::string> row{fmt::format("{:g} m/s2", gravity)};
      for (const char* what :
           {".coordination_ratio", ".contacts_lost", ".contacts_gained", ".newly_sliding",
            ".max_displacement_over_radius", ".dip_difference_change"}) {
        row.push_back(shown_with_error(summary, name + what));
      }
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  // "no line fits a flank of 2 of 3 piles"; empty: of all piles both slopes are known.
  std::string flat_piles() const {
    std::size_t flat = 0;
    for (const PileFrame& f : piles_.frames) {
      flat += std::isnan(f.repose_left_deg + f.repose_right_deg) ? 1U : 0U;
    }
    if (flat == 0) return "";
    return fmt::format("no line fits a flank of {} of {} piles", flat, piles_.frames.size());
  }

  // Figures without a value say why, where it is the flanks.
  static void add_reasons(ReportRows& rows, const std::string& flat) {
    for (auto& [name, value] : rows) {
      const bool slope = name.find("repose") != std::string::npos;
      const bool window = name.find("(pile.volume_fraction_") != std::string::npos ||
                          name.find("(density.") != std::string::npos;
      if (!value.starts_with("-") || (value.size() > 1 && value[1] != ' ')) continue;
      if (slope && !flat.empty()) value = "- (" + flat + ")";
      if (window) value = "- (a pile is too small or too flat for these windows)";
    }
  }

  static Report page(const StudyResult& result, const Realization* first,
                     const std::string& averaged, const std::optional<Chart>& beside,
                     const Fitted* fitted, const std::string& flat) {
    PileReport in;
    if (beside) in.beside = beside->picture();
    in.title = title_of(result.value);
    // What stands, which is not what the case says where piles are taken from files.
    double grains = result.value.get<dem::PileSetup>().source.grains;
    if (const auto standing = result.summary.find("dem.grains"); standing != result.summary.end()) {
      if (const auto* mean = std::get_if<double>(&standing->second)) grains = *mean;
    }
    in.subtitle = fmt::format("{} pile{}, {:.0f} grains each", result.realizations.size(),
                              result.realizations.size() == 1 ? "" : "s", grains);
    if (first != nullptr) {
      in.pile = first->find("pile");
      for (const auto& [name, state] : first->snapshots) {
        if (&state == in.pile) continue;
        in.changed.emplace_back(fmt::format("g = {:g} m/s2", state.gravity.norm()), &state);
      }
    }
    in.comparison = fitted != nullptr ? fitted->piles : result.comparison;
    in.comparison.judgement = result.comparison.judgement;
    if (fitted != nullptr) {
      in.fit_pictures = fit_pictures(*fitted->fits);
      in.fit_tables = fit_tables(*fitted->fits);
    }
    in.map = result.map;
    in.averaged = averaged;
    in.figures = figure_rows(result);
    add_reasons(in.figures, flat);
    in.changes = changes_of(result.summary);
    in.made = origin_rows(result);
    return pile_report(in);
  }

  const Case& value_;
  const std::vector<std::string>& files_;
  int threads_;
  PileEnsemble piles_;
};

}  // namespace

StudyResult analyse_pile(const Case& value, const std::vector<std::string>& realizations,
                         int threads) {
  return PileAnalysis(value, realizations, threads).run();
}

Study pile_study() {
  Study out;
  out.name = "pile";
  out.meaning =
      "grains poured into a pile: base pressure and dip, repose, stress and density, and stress "
      "models compared with them or fitted to them";
  out.former = {
      {"pile-fit", {fmt::format("fit.models=[\"{}\"]", fmt::join(kUsualHeapModels, "\", \""))}}};
  describe_piles(out);
  out.sections.push_back(kChangeKeys);
  out.sections.push_back(kAverageKeys);
  out.sections.push_back(kHeapKeys);
  fit_heap_models(out);
  out.sections.push_back(kMeasuredKeys);
  out.figures.push_back(measured_figures);
  out.check = [](const Case& value) {
    check_heap_windows(value.get<HeapSetup>());
    require_subject(value.models, Subject::heap, 2, "compare.models");
    check_fit(value);
    const MeasuredSetup& measured = value.get<MeasuredSetup>();
    if (!measured.field.empty()) measured_base(measured);
  };
  out.averaged = [](const Case& value) {
    return averaged_values(value.get<AverageSetup>(), value.get<HeapSetup>().heights.size() + 1);
  };
  out.without = {"average.depths", "average.half_width", "fit.base", "fit.coverage",
                 "fit.coverage_draws"};
  out.fills = {"rho_g", "phi_deg", "left_deg", "right_deg", "h", "dim", "depth"};
  out.make_run = [](const Case& value, std::int64_t number, int threads) {
    return make_pile(value, value.get<dem::PileSetup>(), number, threads);
  };
  out.foresee = [](const Case& value, std::int64_t draws) {
    return foresee_pile(value, value.get<dem::PileSetup>(), draws);
  };
  out.analyse = analyse_pile;
  return out;
}

}  // namespace grainfield::coupling
