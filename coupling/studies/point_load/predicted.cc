#include "coupling/studies/point_load/predicted.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "continuum/model.h"
#include "coupling/elastic_constants/probed.h"
#include "coupling/run/realization_file.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/point_load/layer_probe.h"

namespace grainfield::coupling {
namespace {

struct PredictedColumn {
  const char *key, *unit, *meaning, *parameter;  // of transverse_layer; null: none
  double (*of)(const ProbedPacking&);
};

const std::vector<PredictedColumn>& predicted_columns() {
  using P = const ProbedPacking&;
  static const std::vector<PredictedColumn> columns{
      {"e_h", "Pa", "Young's modulus in the level", "E_h", [](P p) { return p.moduli.e_h; }},
      {"e_v", "Pa", "Young's modulus along z", "E_v", [](P p) { return p.moduli.e_v; }},
      {"nu_h", "-", "Poisson's ratio in the level", "nu_h", [](P p) { return p.moduli.nu_h; }},
      {"nu_v", "-", "strain of the level over that along z when z is loaded", "nu_v",
       [](P p) { return p.moduli.nu_vh; }},
      {"g_v", "Pa", "shear modulus of planes along z", "G_v", [](P p) { return p.moduli.g_vh; }},
      {"e_v_over_e_h", "-", "Young's modulus along z over that in the level", nullptr,
       [](P p) { return p.moduli.e_v / p.moduli.e_h; }},
      {"residual", "-",
       "root of the squared stress that the fit of five constants leaves over all of it", nullptr,
       [](P p) { return p.moduli.residual_transverse; }},
      {"nonlinear_share", "-",
       "nonlinear part of the stress changes over the linear one: |forth + back| / |forth - back|, "
       "0 if linear",
       nullptr, [](P p) { return p.nonlinear; }},
      {"contacts_changed", "-",
       "contacts that are new, gone or begin to slide over all, the largest of the probes", nullptr,
       [](P p) {
         return std::max({p.gained, p.lost, p.sliding});
       }},
  };
  return columns;
}

// transverse_layer with the means over the layers, without that of number `left_out`.
ModelChoice model_of(const std::map<std::string, std::vector<double>>& figures, const char* label,
                     const char* base, int left_out = -1) {
  ModelChoice out{label, "transverse_layer", {{"base", base}}};
  for (const PredictedColumn& column : predicted_columns()) {
    if (column.parameter == nullptr) continue;
    const std::vector<double>& values = figures.at(std::string("predicted.") + column.key);
    double sum = 0;
    int count = 0;
    for (std::size_t r = 0; r < values.size(); ++r) {
      if (static_cast<int>(r) == left_out) continue;
      sum += values[r];
      ++count;
    }
    out.settings[column.parameter] = fmt::format("{:.6g}", sum / count);
  }
  return out;
}

}  // namespace

const std::vector<std::string>& predicted_labels() {
  static const std::vector<std::string> labels{"predicted", "predicted_smooth"};
  return labels;
}

PredictedResponse predicted_response(const std::vector<std::string>& files) {
  PredictedResponse out;
  for (const std::string& file : files) {
    const dem::StateProbes probes =
        dem::probes_of(read_realization(file)["unloaded"], dem::kProbedLayer);
    if (probes.probes.empty()) return {};
    const ProbedPacking one = probed_packing(probes);
    for (const PredictedColumn& column : predicted_columns()) {
      out.figures[std::string("predicted.") + column.key].push_back(column.of(one));
    }
  }
  if (files.empty()) return out;
  std::vector<ModelChoice> models{model_of(out.figures, "predicted", "rough"),
                                  model_of(out.figures, "predicted_smooth", "smooth")};
  try {
    require_models(models, RunFacts{1, 1, 3, 0.5, "", {}});
    out.models = std::move(models);
  } catch (const continuum::BadParameter& e) {
    out.refusal = e.what();
  }
  return out;
}

void PredictedResponse::add_peak(const RunFacts& facts, const Kernel& kernel,
                                 Summary& summary) const {
  if (models.empty()) return;
  const Eigen::MatrixXd below = Eigen::RowVector3d(0, 0, -facts.height);
  const double unit = facts.force / (facts.height * facts.height);
  const auto peak = [&](const ModelChoice& model) {
    const Evaluation e = evaluate_model(model, facts, {{below, Smoothing::marginal, &kernel}});
    return -e.stresses.front()(0, 2) / unit;
  };
  const std::string key = "predicted.peak_over_F_per_h2";
  summary[key] = peak(models.front());
  const int n = static_cast<int>(figures.begin()->second.size());
  if (n < 2) return;
  Eigen::ArrayXd without(n);
  try {
    for (int r = 0; r < n; ++r) without[r] = peak(model_of(figures, "predicted", "rough", r));
  } catch (const continuum::BadParameter&) {
    return;  // without one layer the moduli are no material: the error is unknown
  }
  summary[key + ".standard_error"] =
      std::sqrt((without - without.mean()).square().sum() * (n - 1) / n);
}

std::vector<Section> predicted_sections(const Summary& summary) {
  Table table;
  table.title = "Moduli by uniform strain of the layers, before the load";
  table.caption =
      "Each direction strained forth and back; stress and strain in the middle half of the depth, "
      "means over the layers with their standard errors. The models \"predicted\" (rough base) and "
      "\"predicted_smooth\" have these numbers; nothing in them is fitted.";
  table.header = {"", "layers"};
  const auto add = [&](const std::string& key, const std::string& meaning) {
    const std::string value = shown_with_error(summary, "predicted." + key);
    if (!value.empty()) table.rows.push_back({meaning, value});
  };
  for (const PredictedColumn& column : predicted_columns()) {
    add(column.key,
        std::string(column.meaning) + (column.unit == std::string("Pa") ? " (Pa)" : ""));
  }
  add("peak_over_F_per_h2",
      "largest pressure on the base by the model (F/h²), its jackknife error");
  const auto refusal = summary.find("predicted.refusal");
  if (table.rows.empty()) return {};
  if (refusal != summary.end()) table.caption += " They are refused: see predicted.refusal.";
  return {table};
}

std::vector<SummaryKey> predicted_figures() {
  std::vector<SummaryKey> out;
  for (const PredictedColumn& column : predicted_columns()) {
    out.push_back({std::string("predicted.") + column.key, column.unit,
                   std::string("layer strained uniformly before the load (load.probe_strain): ") +
                       column.meaning});
  }
  out.push_back({"predicted.peak_over_F_per_h2", "-",
                 "largest pressure on the base by the model predicted over F/h^2, seen with the "
                 "kernel; its error by the jackknife over the layers"});
  out.push_back({"predicted.refusal", "text", "why these moduli make no model"});
  return out;
}

}  // namespace grainfield::coupling
