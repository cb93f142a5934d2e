// The analysis of piles: their fields, models beside them, figures, the dip, the fits.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "coupling/fit/heap_result.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/measured_base.h"
#include "coupling/run/summary_keys.h"
#include "coupling/specimen/scaled.h"
#include "coupling/specimen/setup.h"
#include "coupling/studies/pile/figures.h"
#include "coupling/studies/pile/page.h"
#include "coupling/studies/pile/pile_ensemble.h"
#include "coupling/studies/pile/study.h"

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
    add_values(source_rows(), value_, out.summary);
    add_values(piles_rows(), {value_, piles_.figures}, out.summary);
    add_values(base_rows(), base_facts(), out.summary);
    const Dip dip = judge_dip(piles_.windows);
    add_dip(out, dip);
    std::optional<Chart> beside;
    if (const MeasuredSetup& measured = value_.get<MeasuredSetup>(); !measured.field.empty()) {
      beside = beside_measured(base_profile(), measured_base(measured), out.summary);
      out.sweep_charts.push_back(*beside);
    }
    const std::string averaged = describe(piles_.methods.front().options);
    const std::shared_ptr<const FittedPiles> fitted = fit_models(out);
    out.page = [averaged, beside, fitted, flat = unfitted_flanks_note()](const StudyResult& result,
                                                                         const Realization* first) {
      return pile_page(result, first, {averaged, flat, beside, fitted.get()});
    };
    return out;
  }

 private:
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

  BaseFacts base_facts() const {
    const Field base = piles_.base.mean();
    const Eigen::VectorXd pressure = -base.find("sigma_yy")->value;
    Eigen::Index at = 0;
    const double largest = pressure.maxCoeff(&at);
    return {pressure[pressure.size() / 2], largest, std::fabs(piles_.x[at]),
            piles_.methods.front().options.width};
  }

  // What is said of each pile that is no heap.
  std::vector<std::string> reasons_not_heaps() const {
    std::vector<std::string> out;
    for (std::size_t r = 0; r < piles_.frames.size(); ++r) {
      std::string why = piles_.frames[r].why_not_a_heap(r);
      if (!why.empty()) out.push_back(std::move(why));
    }
    return out;
  }

  void add_dip(StudyResult& out, const Dip& dip) const {
    add_values(dip_rows(), dip, out.summary);
    Judgement& judgement = out.comparison.judgement;
    if (const auto none = reasons_not_heaps(); !none.empty()) {
      const std::string count = fmt::format("in {} of {} piles", none.size(), files_.size());
      out.warnings.push_back(fmt::format(
          "no heap formed {}: {}{}; apex, slopes and shoulders mean little there; more grains, or "
          "more friction, make one",
          count, none.front(), none.size() == 1 ? "" : ", and others"));
      judgement.findings.push_back(fmt::format("No heap formed {}.", count));
    }
    for (std::string& line : dip_lines(dip)) judgement.findings.push_back(std::move(line));
    if (dip.verdict != "undecided" && value_.get<FitSetup>().models.empty()) {
      judgement.findings.emplace_back(
          "To learn which theories they support, run in the folder of the results: grainfield fit "
          "snapshots.h5");
    }
  }

  // The models of [fit] with free constants: their judgement, lines and constants become the run's,
  // and the piles' lines stand beside theirs. Null without such models.
  std::shared_ptr<const FittedPiles> fit_models(StudyResult& out) const {
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
    const auto fitted = std::make_shared<FittedPiles>(
        FittedPiles{made.fits, std::exchange(out.comparison, std::move(made.study.comparison))});
    Comparison& now = out.comparison;
    now.judgement.findings = fitted->piles.judgement.findings;
    for (const auto* lines : {&fitted->piles.profiles, &fitted->piles.beside}) {
      now.beside.insert(now.beside.end(), lines->begin(), lines->end());
    }
    return fitted;
  }

  // "no line fits a flank of 2 of 3 piles"; empty: of all piles both slopes are known.
  std::string unfitted_flanks_note() const {
    std::size_t flat = 0;
    for (const PileFrame& f : piles_.frames) {
      flat += std::isnan(f.repose_left_deg + f.repose_right_deg) ? 1U : 0U;
    }
    if (flat == 0) return "";
    return fmt::format("no line fits a flank of {} of {} piles", flat, piles_.frames.size());
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

}  // namespace grainfield::coupling
