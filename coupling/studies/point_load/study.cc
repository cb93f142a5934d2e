#include "coupling/studies/point_load/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/fit/fit_keys.h"
#include "coupling/models/subject.h"
#include "coupling/observe/setup.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/grain_keys.h"
#include "coupling/studies/point_load/finished_layers.h"
#include "coupling/studies/point_load/fitted.h"
#include "coupling/studies/point_load/keys.h"
#include "coupling/studies/point_load/layer_study.h"
#include "coupling/studies/point_load/loaded_layers.h"
#include "coupling/studies/point_load/page.h"
#include "coupling/studies/point_load/predicted.h"
#include "coupling/studies/point_load/simulation.h"
#include "coupling/studies/point_load/space.h"
#include "dem/run/setup.h"

namespace grainfield::coupling {
namespace {

// Points inside the layer, away from its edges, where the balance of forces is looked at.
Eigen::MatrixXd inner_points(const LayerFrame& frame) {
  const double w = frame.width(), h = frame.depth();
  return grid_points(frame.left + 0.1 * w, frame.right - 0.1 * w, 17, frame.floor + 0.15 * h,
                     frame.surface - 0.25 * h, 5);
}

class PlaneAnalysis {
 public:
  PlaneAnalysis(const Case& value, const std::vector<std::string>& files, int threads)
      : all_(value, files, threads, 2, 1) {
    const double half = all_.half;
    x_ = Eigen::VectorXd::LinSpaced(all_.setup.points, -half, half);
    grid_ = grid_points(-half, half, all_.columns, -all_.layer.depth, 0, all_.rows);
  }

  StudyResult run(const ModelEvaluator& evaluate) {
    for (const auto& file : all_.files) add(read_realization(file));
    StudyResult out = begin_result(all_.value, all_.files);
    add_fields(out);
    const Observations seen = all_.observed(base_, out.map);
    const std::vector<SeenModel> models = see_models(seen, all_.value.models, evaluate);
    add_models(out, seen, models);
    out.comparison = compared(seen, models);
    all_.add_doubts(out.comparison.judgement.doubts);
    all_.add_own_figures(out.summary);
    add_compared(out.summary, seen, out.comparison, seen.lines.size() - 1);
    out.page = layer_page;
    out.overview = layer_overview();
    return out;
  }

 private:
  void add(const Realization& r) {
    const dem::Snapshot &unloaded = r["unloaded"], &loaded = r["loaded"];
    const LayerFrame frame = layer_frame(unloaded, loaded.loaded_grain);
    const Eigen::MatrixXd grid = frame.to_packing(grid_);
    for (MethodAverages& a : all_.methods) {
      const auto on_grid = [&](Field field) {
        return in_models_frame(std::move(field), grid_, all_.columns, all_.rows);
      };
      for (std::size_t d = 0; d < a.lines.size(); ++d) {
        const Eigen::MatrixXd at =
            line_points(-all_.half, all_.half, static_cast<int>(x_.size()), all_.height(d));
        a.lines[d].add(
            in_models_frame(response(unloaded, loaded, frame.to_packing(at), a.options), at));
      }
      a.map.add(on_grid(response(unloaded, loaded, grid, a.options)));
      a.beside.front().add(on_grid(average(unloaded, grid, a.options)));
      a.add_balance(balance_residual(loaded, inner_points(frame), a.options), all_.files.size());
    }
    const Eigen::VectorXd x = x_.array() + frame.load_x;
    Eigen::MatrixXd base(x_.size(), 2);
    base << x_, Eigen::VectorXd::Constant(x_.size(), -all_.layer.depth);
    base_.add(in_models_frame(base_response(unloaded, loaded, x, *all_.kernel), base));
    base_unloaded_.add(in_models_frame(base_profile(unloaded, x, *all_.kernel), base));
    all_.add_figures_of(r);
  }

  void add_fields(StudyResult& out) const {
    const auto add = [&](const std::string& name, Field field, const MethodAverages& a) {
      out.fields.emplace_back(name, all_.described(std::move(field), a.options));
    };
    for (const MethodAverages& a : all_.methods) {
      add(a.method + "_response", a.map.mean(), a);
      if (&a == &all_.methods.front()) out.map = out.fields.back().second;
      add(a.method + "_unloaded", a.beside.front().mean(), a);
      for (std::size_t d = 0; d < a.lines.size(); ++d) {
        // With the layers' single values, by which `compare` judges as this run does.
        add(fmt::format("{}_depth_{:g}", a.method, all_.setup.depths[d]), a.lines[d].with_samples(),
            a);
      }
    }
    add("base_response", base_.with_samples(), all_.methods.front());
    add("base_unloaded", base_unloaded_.mean(), all_.methods.front());
    out.base_unloaded = out.fields.back().second;
  }

  LoadedLayers all_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd grid_;
  Ensemble base_, base_unloaded_;
};

}  // namespace

StudyResult analyse_point_load(const Case& value, const std::vector<std::string>& realizations,
                               int threads, const ModelEvaluator& evaluate) {
  return PlaneAnalysis(value, realizations, threads).run(evaluate);
}

void check_point_load(const Case& value) {
  const auto& p = value.get<dem::PointLoadSetup>().packing;
  if (p.radius_min > p.radius_max) {
    throw std::invalid_argument(
        fmt::format("packing.radius_min: found {:g}, allowed: up to packing.radius_max = {:g}",
                    p.radius_min, p.radius_max));
  }
  if (p.sizes == "bidisperse" && p.radius_small > p.radius) {
    throw std::invalid_argument(
        fmt::format("packing.radius_small: found {:g}, allowed: up to packing.radius = {:g}",
                    p.radius_small, p.radius));
  }
  check_one_load(value);
  const auto& load = value.get<dem::PointLoadSetup>().load;
  if (const auto& files = value.get<GrainFiles>().files; p.dim == 3 && !files.empty()) {
    throw std::invalid_argument(fmt::format(
        "grains.files: found {} with packing.dim = 3, allowed: none in 3D", files.size()));
  }
  if (const auto& fitted = value.get<FitSetup>().models; p.dim == 3 && !fitted.empty()) {
    throw std::invalid_argument(
        fmt::format("fit.models: found \"{}\" with packing.dim = 3, allowed: none in 3D, where "
                    "compare.models names models with their constants",
                    fitted.front()));
  }
  check_fit(value);
  require_subject(value.models, Subject::load, p.dim, "compare.models");
  for (const ModelChoice& model : value.models) {
    const auto& taken = predicted_labels();
    if (load.probe_strain == 0 ||
        std::find(taken.begin(), taken.end(), model.label) == taken.end()) {
      continue;
    }
    throw std::invalid_argument(fmt::format(
        "compare.models: found \"{}\" with load.probe_strain = {:g}, allowed: another name (it is "
        "that of the model with the measured moduli)",
        model.label, load.probe_strain));
  }
}

Study point_load_study() {
  Study out = layer_study();
  out.name = "point-load";
  out.meaning =
      "grains under a load on one of them: stress models compared with the response or fitted to "
      "it";
  out.former = {{"point-load-verdict",
                 {fmt::format("fit.models=[\"{}\"]", fmt::join(kUsualLayerModels, "\", \"")),
                  "fit.finite_elements=[\"fe_elastic_layer\", \"fe_orthotropic_layer\"]",
                  "fit.bootstrap=100"},
                 {{"verdict", "fit"}}}};
  out.check = check_point_load;
  out.averaged = [](const Case& value) {
    const auto& average = value.get<AverageSetup>();
    return averaged_values(average, average.depths.size() + 1);
  };
  out.figures = {point_load_figures, predicted_figures};
  fit_layer_models(out);
  out.without = {"fit.heights",  "fit.leave_out", "fit.width_diameters",
                 "fit.left_deg", "fit.right_deg", "fit.friction_deg",
                 "fit.huber"};
  out.make_run = make_layer;
  out.foresee = foresee_layer;
  out.left_unused = [](const Case& value) -> std::string {
    const auto& setup = value.get<dem::PointLoadSetup>();
    if (setup.packing.dim == 2) return unused_runs(value, kLayerStates, kLayerStudy);
    if (setup.load.radius == 0) return "";
    return fmt::format(
        "load.radius: found {:g}: the models beside stay those of a load on one point",
        setup.load.radius);
  };
  out.analyse = [](const Case& value, const std::vector<std::string>& files, int threads) {
    if (value.get<dem::PointLoadSetup>().packing.dim == 3) {
      return analyse_space_load(value, files, threads);
    }
    if (!value.get<FitSetup>().models.empty()) return analyse_fitted_load(value, files, threads);
    return analyse_point_load(value, files, threads);
  };
  return out;
}

}  // namespace grainfield::coupling
