#include "coupling/studies/point_load/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/layer.h"
#include "coupling/models/model_record.h"
#include "coupling/models/models.h"
#include "coupling/models/subject.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/grain_keys.h"
#include "coupling/run/realization_file.h"
#include "coupling/studies/point_load/keys.h"
#include "coupling/studies/point_load/page.h"
#include "coupling/studies/point_load/predicted.h"
#include "coupling/studies/point_load/space.h"
#include "dem/study/setup.h"

namespace grainfield::coupling {
namespace {

// One averaging method over the ensemble.
struct Averaged {
  std::string method;
  AverageOptions options;
  std::vector<Ensemble> profiles;  // one per depth
  Ensemble map, unloaded_map;
  double balance_rms = 0, balance_largest = 0;
};

struct Collected {
  std::vector<Averaged> methods;
  Ensemble base, base_unloaded;
  std::map<std::string, std::vector<double>> figures;
};

// Points inside the layer, away from its edges, where the balance of forces is looked at.
Eigen::MatrixXd inner_points(const LayerFrame& frame) {
  const double w = frame.width(), h = frame.depth();
  return grid_points(frame.left + 0.1 * w, frame.right - 0.1 * w, 17, frame.floor + 0.15 * h,
                     frame.surface - 0.25 * h, 5);
}

Field in_models_frame(Field field, const Eigen::MatrixXd& points, int nx, int ny) {
  field.points = points;
  field.nx = nx;
  field.ny = ny;
  return field;
}

class PointLoadAnalysis {
 public:
  PointLoadAnalysis(const Case& value, const std::vector<std::string>& files, int threads,
                    const ModelEvaluator& evaluate)
      : value_(value),
        files_(files),
        evaluate_(evaluate),
        setup_(value.get<AverageSetup>()),
        layer_(mean_layer(files)) {
    const double half =
        setup_.half_width > 0 ? std::min(setup_.half_width, layer_.half_width) : layer_.half_width;
    x_ = Eigen::VectorXd::LinSpaced(setup_.points, -half, half);
    for (const double share : setup_.depths) {
      lines_.push_back(
          line_points(-half, half, static_cast<int>(setup_.points), -share * layer_.depth));
    }
    columns_ = static_cast<int>(setup_.map_columns);
    rows_ = static_cast<int>(setup_.map_rows);
    grid_ = grid_points(-half, half, columns_, -layer_.depth, 0, rows_);
    for (const auto& method : setup_.methods) {
      Averaged a;
      a.method = method;
      a.options = average_options(setup_, method, layer_.diameter, threads);
      a.profiles.resize(lines_.size());
      collected_.methods.push_back(std::move(a));
    }
    kernel_ = seeing_kernel(collected_.methods.front().options);
  }

  StudyResult run() {
    for (const auto& file : files_) add(read_realization(file));
    StudyResult out = begin_result(value_, files_);
    add_fields(out);
    add_models(out);
    add_own_figures(out.summary);
    add_comparison(out.summary, out.comparison, out.comparison.profiles.size() - 1);
    out.page = layer_page;
    out.overview = layer_overview();
    return out;
  }

 private:
  void add(const Realization& r) {
    const dem::Snapshot &unloaded = r["unloaded"], &loaded = r["loaded"];
    const LayerFrame frame = layer_frame(unloaded, loaded.loaded_grain);
    for (auto& a : collected_.methods) {
      for (std::size_t d = 0; d < lines_.size(); ++d) {
        a.profiles[d].add(in_models_frame(
            response(unloaded, loaded, frame.to_packing(lines_[d]), a.options), lines_[d], 0, 0));
      }
      const Eigen::MatrixXd grid = frame.to_packing(grid_);
      a.map.add(
          in_models_frame(response(unloaded, loaded, grid, a.options), grid_, columns_, rows_));
      a.unloaded_map.add(
          in_models_frame(average(unloaded, grid, a.options), grid_, columns_, rows_));
      const BalanceResidual balance = balance_residual(loaded, inner_points(frame), a.options);
      a.balance_rms += balance.rms / static_cast<double>(files_.size());
      a.balance_largest = std::max(a.balance_largest, balance.largest);
    }
    const Eigen::VectorXd x = x_.array() + frame.load_x;
    Eigen::MatrixXd base(x_.size(), 2);
    base << x_, Eigen::VectorXd::Constant(x_.size(), -layer_.depth);
    collected_.base.add(in_models_frame(base_response(unloaded, loaded, x, *kernel_), base, 0, 0));
    collected_.base_unloaded.add(in_models_frame(base_profile(unloaded, x, *kernel_), base, 0, 0));
    for (const auto& [key, figure] : r.figures) collected_.figures[key].push_back(figure);
    collected_.figures["response.total_over_load"].push_back(total_over_load(unloaded, loaded));
  }

  Profile profile(const Ensemble& ensemble, const std::string& name, const std::string& key,
                  double depth) const {
    const Field mean = ensemble.mean();
    const Column& column = *mean.find("sigma_yy");
    Profile out;
    out.name = name;
    out.key = key;
    out.depth = depth;
    out.x = x_;
    out.mean = -column.value;
    out.error = column.error;
    out.samples = -ensemble.samples("sigma_yy");
    out.independent_length = kernel_->independent_length();
    return out;
  }

  std::vector<Profile> profiles() const {
    std::vector<Profile> out;
    const Averaged& first = collected_.methods.front();
    for (std::size_t d = 0; d < lines_.size(); ++d) {
      const double share = setup_.depths[d];
      out.push_back(profile(first.profiles[d],
                            fmt::format("depth {:g} h ({:.4g} m)", share, share * layer_.depth),
                            fmt::format("depth_{:g}", share), share * layer_.depth));
    }
    out.push_back(profile(collected_.base, "base", "base", layer_.depth));
    return out;
  }

  // What `grainfield compare` needs to know of a field.
  Field described(Field field, const AverageOptions& options) const {
    field.attributes["method"] = options.method;
    field.attributes["kernel"] = options.kernel;
    field.attributes["width"] = fmt::format("{}", options.width);
    field.attributes["h"] = fmt::format("{}", layer_.depth);
    field.attributes["F"] = fmt::format("{}", value_.get<dem::PointLoadSetup>().load.force);
    field.attributes["frame"] = "models: load at (0, 0), surface y = 0";
    return field;
  }

  void add_fields(StudyResult& out) const {
    for (const auto& a : collected_.methods) {
      Field map = described(a.map.mean(), a.options);
      if (&a == &collected_.methods.front()) out.map = map;
      out.fields.emplace_back(a.method + "_response", std::move(map));
      out.fields.emplace_back(a.method + "_unloaded", described(a.unloaded_map.mean(), a.options));
      double largest = 0, error = 0;
      Eigen::Index n = 0;
      for (std::size_t d = 0; d < lines_.size(); ++d) {
        Field line = described(a.profiles[d].mean(), a.options);
        const Column& column = *line.find("sigma_yy");
        for (Eigen::Index i = 0; i < column.value.size(); ++i) {
          if (std::isnan(column.value[i])) continue;
          largest = std::max(largest, std::fabs(column.value[i]));
          if (column.error.size() > i && !std::isnan(column.error[i])) {
            error += column.error[i];
            ++n;
          }
        }
        out.fields.emplace_back(fmt::format("{}_depth_{:g}", a.method, setup_.depths[d]),
                                std::move(line));
      }
      const std::string prefix = "average." + a.method + ".";
      out.summary[prefix + "balance_rms"] = a.balance_rms;
      out.summary[prefix + "balance_largest"] = a.balance_largest;
      if (n > 0 && largest > 0) {
        out.summary[prefix + "fluctuation"] = error / static_cast<double>(n) / largest;
      }
    }
    const AverageOptions& first = collected_.methods.front().options;
    out.base_unloaded = described(collected_.base_unloaded.mean(), first);
    out.fields.emplace_back("base_response", described(collected_.base.mean(), first));
    out.fields.emplace_back("base_unloaded", out.base_unloaded);
  }

  void add_models(StudyResult& out) const {
    std::vector<PointSet> sets;
    for (const auto& line : lines_) sets.push_back({line, Smoothing::kernel, kernel_.get()});
    Eigen::MatrixXd base(x_.size(), 2);
    base << x_, Eigen::VectorXd::Constant(x_.size(), -layer_.depth);
    sets.push_back({base, Smoothing::marginal, kernel_.get()});
    sets.push_back({grid_, Smoothing::none, nullptr});

    const double least_share = *std::min_element(setup_.depths.begin(), setup_.depths.end());
    const RunFacts facts{value_.get<dem::PointLoadSetup>().load.force,
                         layer_.depth,
                         2,
                         least_share * layer_.depth,
                         "",
                         {}};
    std::vector<ModelProfiles> models;
    double seconds = 0;
    for (const auto& choice : value_.models) {
      const Evaluation e = evaluate_(choice, facts, sets);
      seconds += e.seconds;
      ModelProfiles m;
      m.key = choice.label;
      m.label = model_label(choice);
      m.family = family_of(choice.name);
      for (std::size_t s = 0; s + 1 < sets.size(); ++s)
        m.values.emplace_back(-e.stresses[s].col(1));
      models.push_back(std::move(m));
      const Eigen::MatrixXd& map = e.stresses.back();
      out.model_maps.push_back({model_label(choice), map.col(1)});
      out.fields.emplace_back("model_" + choice.label,
                              model_field(choice, facts, grid_, map, columns_, rows_));
      add_model(out.summary, choice, e.figures, e.seconds);
    }
    out.summary["time.continuum_s"] = seconds;
    out.comparison =
        compare(profiles(), std::move(models), scale_of_load(facts.force, facts.height));
    out.comparison.judgement.noun = "layer";
  }

  void add_own_figures(Summary& summary) const {
    add_figures(summary, collected_.figures);
    summary["layer.depth"] = layer_.depth;
    summary["layer.F_over_h"] = value_.get<dem::PointLoadSetup>().load.force / layer_.depth;
    summary["layer.mean_diameter"] = layer_.diameter;
    for (const auto& a : collected_.methods) {
      summary[a.method == "coarse_graining" ? "average.width" : "average.rve_radius"] =
          a.options.width;
    }
  }

  const Case& value_;
  const std::vector<std::string>& files_;
  const ModelEvaluator& evaluate_;
  const AverageSetup& setup_;
  MeanLayer layer_;
  Eigen::VectorXd x_;
  std::vector<Eigen::MatrixXd> lines_;
  Eigen::MatrixXd grid_;
  int columns_ = 0, rows_ = 0;
  Collected collected_;
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace

StudyResult analyse_point_load(const Case& value, const std::vector<std::string>& realizations,
                               int threads, const ModelEvaluator& evaluate) {
  StudyResult out = PointLoadAnalysis(value, realizations, threads, evaluate).run();
  return out;
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
  const auto& load = value.get<dem::PointLoadSetup>().load;
  if (p.dim == 3 && load.weights > 0 && load.force != dem::LoadSetup().force) {
    throw std::invalid_argument(
        fmt::format("load.force: found {:g} beside load.weights = {:g}, allowed: with load.weights "
                    "= 0 (spheres are loaded with so many weights of a grain otherwise)",
                    load.force, load.weights));
  }
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
  Study out;
  out.name = "point-load";
  out.meaning = "grains under a load on one of them against continuum models";
  out.sections = {kPackingKeys, kMaterialKeys, kMotionKeys, kRestKeys, kLoadKeys, kAverageKeys};
  out.material = [](Case& c) -> dem::MaterialSetup& {
    return c.get<dem::PointLoadSetup>().material;
  };
  out.grain_radius = [](const Case& c) {
    return dem::mean_radius(c.get<dem::PointLoadSetup>().packing);
  };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<dem::PointLoadSetup>().motion; };
  out.rest = [](Case& c) -> dem::RestSetup& { return c.get<dem::PointLoadSetup>().rest; };
  out.check = check_point_load;
  out.averaged = [](const Case& value) {
    const auto& average = value.get<AverageSetup>();
    return averaged_values(average, average.depths.size() + 1);
  };
  out.figures = {point_load_figures, predicted_figures};
  out.fills = {"F", "h", "dim", "depth"};
  out.make_run = [](const Case& value, std::int64_t number, int threads) {
    return dem::make_point_load_run(value.get<dem::PointLoadSetup>(),
                                    realization_seed(value, number), threads);
  };
  out.foresee = [](const Case& value, std::int64_t draws) {
    return dem::foresee_point_load(value.get<dem::PointLoadSetup>(), realization_seeds(value),
                                   draws);
  };
  out.left_unused = [](const Case& value) -> std::string {
    const auto& setup = value.get<dem::PointLoadSetup>();
    if (setup.packing.dim == 2 || setup.load.radius == 0) return "";
    return fmt::format(
        "load.radius: found {:g}: the models beside stay those of a load on one point",
        setup.load.radius);
  };
  out.analyse = [](const Case& value, const std::vector<std::string>& files, int threads) {
    if (value.get<dem::PointLoadSetup>().packing.dim == 3) {
      return analyse_space_load(value, files, threads);
    }
    return analyse_point_load(value, files, threads);
  };
  out.dimension = [](const Case& value) { return value.get<dem::PointLoadSetup>().packing.dim; };
  out.dimension_key = "packing.dim";
  return out;
}

}  // namespace grainfield::coupling
