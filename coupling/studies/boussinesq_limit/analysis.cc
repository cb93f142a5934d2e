#include "coupling/studies/boussinesq_limit/analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include "continuum/progress.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/ensemble.h"
#include "coupling/studies/boussinesq_limit/responses.h"
#include "coupling/studies/boussinesq_limit/settlement.h"
#include "coupling/studies/boussinesq_limit/setup.h"
#include "coupling/studies/point_load/probed_slabs.h"
#include "coupling/studies/point_load/simulation.h"
#include "dem/laws/registry.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/shared/computation_failed.h"
#include "dem/storage_failed.h"

namespace grainfield::coupling {
namespace {

// Balances to which layers are brought before anything is measured, the best that Newton's method
// reaches: a small load on a deep layer changes contact forces by little, and disks that roll
// between others may keep it from the last digits.
constexpr std::array kRests{1e-9, 1e-8, 1e-7};
// Finite elements of the plane are refined to this, far below the grains' noise: where shear is
// soft they need many unknowns for more. In space theirs would pass most_unknowns, so they keep
// their own tolerances, 0.5 % of F/h^2 for the layer and 1 % of F/r^2 for the half space, which is
// that of a load below the surface, too.
constexpr const char *kFiniteElementTolerance = "1e-3", *kToleranceBelow = "1e-2";
// Names of the long parts, for whoever waits.
constexpr const char *kModuli = "moduli of the layers", *kResponse = "response of the layers";
// Models whose settlement is compared: those of a layer on which no contact of the base slides.
const std::set<std::string> kSettled{"homogeneous_rough", "by_depth_rough", "by_depth_centres"};

dem::Materials materials_of(const dem::MaterialSetup& m) {
  dem::Materials out;
  out.law = dem::law_of(m);
  out.friction = m.friction;
  out.rolling = dem::RollingLaw::of(m);
  return out;
}

dem::QuasistaticResult at_rest(const dem::Snapshot& before, const dem::Materials& materials) {
  dem::QuasistaticSettings how;
  for (std::size_t k = 0;; ++k) {
    how.unbalanced_force_ratio = kRests[k];
    try {
      return dem::relax(before, materials, before.gravity, {}, how);
    } catch (const ComputationFailed&) {
      if (k + 1 == kRests.size()) throw;
    }
  }
}

struct RestingLayer {
  dem::Snapshot rest;
  LayerFrame frame;
  std::vector<LoadPlace> places;
};

// Beside the results, which are not written while models read them; each member of a sweep has its
// own.
std::filesystem::path tables_of(const StudyResult& result) {
  const std::filesystem::path first(result.realizations.front());
  auto folder = first.parent_path();
  if (folder.filename() == "checkpoint") folder = folder.parent_path();
  return folder / (".models_of_" + first.stem().string());
}

class Analysis {
 public:
  Analysis(StudyResult& out, int threads)
      : out_(out),
        value_(out.value),
        response_(value_.get<ResponseSetup>()),
        setup_(value_.get<AverageSetup>()),
        load_(value_.get<dem::PointLoadSetup>()),
        dim_(load_.packing.dim),
        materials_(materials_of(load_.material)),
        threads_(threads) {}

  Observations run(std::vector<ModelChoice>& models) {
    tell(kModuli, 0);
    for (const std::string& file : out_.realizations) {
      prepare(read_realization(file));
      tell(kModuli, layers_.size());
    }
    predict(models);  // before the response is known
    return observe();
  }

 private:
  void tell(const char* task, std::size_t layers) const {
    continuum::tell_progress(
        task, static_cast<double>(layers) / static_cast<double>(out_.realizations.size()));
  }

  // At rest to many digits; and its moduli.
  void prepare(const Realization& one) {
    const dem::Snapshot& before = one["unloaded"];
    RestingLayer layer;
    const dem::QuasistaticResult rest = at_rest(before, materials_);
    layer.rest = rest.state;
    layer.frame = layer_frame(layer.rest);
    layer.places =
        load_places(layer.rest, layer.frame, response_.loads, response_.grains, response_.span);
    if (layer.places.empty())
      throw ComputationFailed("response.loads: the layer has no surface grain that touches others");
    figures_["moduli.unbalanced_force_ratio"].push_back(rest.unbalanced_force_ratio);
    figures_["rest.contacts_changed"].push_back(rest.contacts_gained + rest.contacts_lost);
    double below = 0;
    for (const LoadPlace& place : layer.places) below += place.depth;
    figures_["response.load_depth"].push_back(below / static_cast<double>(layer.places.size()));
    const auto probed = probe_slabs(
        layer.rest, materials_, layer.frame.surface,
        {response_.strain, static_cast<int>(response_.slabs), static_cast<int>(response_.strips)});
    slabs_.push_back(probed->slabs);
    wholes_.push_back({probed->whole});
    figures_["moduli.nonlinear_share"].push_back(probed->nonlinear);
    figures_["moduli.contacts_changed"].push_back(probed->contacts_changed);
    const auto count = static_cast<double>(out_.realizations.size());
    depth_ += layer.frame.depth() / count;
    diameter_ += mean_diameter(layer.rest) / count;
    half_ = std::min(half_, reach_of(layer.places, layer.frame, dim_));
    layers_.push_back(std::move(layer));
  }

  // A table that models read.
  std::string write_table(const std::string& name, const std::vector<SlabModuli>& slabs,
                          double depth) {
    const std::string text = moduli_table(slabs, depth, false);
    out_.texts.emplace_back(name, text);
    const auto folder = tables_of(out_);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    const auto path = folder / name;
    std::ofstream file(path);
    if (!(file << text) || !file.flush())
      throw dem::StorageFailed(fmt::format("{}: cannot be written", path.string()));
    return path.string();
  }

  ModelChoice finite_elements(const std::string& name, const std::string& moduli) const {
    ModelChoice out{"", name, {{"moduli", moduli}}};
    if (dim_ == 2) out.settings["tolerance"] = kFiniteElementTolerance;
    return out;
  }

  // Mean depth of the loaded grains' centres, m.
  double centres() const {
    double below = 0;
    for (const double one : figures_.at("response.load_depth")) below += one;
    return below / static_cast<double>(layers_.size());
  }

  // The model of what is below the centres of the loaded grains, where the contacts end.
  ModelChoice below_centres(ModelChoice model) const {
    model.below = centres();
    if (model.name.ends_with("_layer"))
      model.settings["h"] = fmt::format("{:.15g}", depth_ - model.below);  // as in its table
    return model;
  }
  std::vector<SlabModuli> below_centres(std::vector<SlabModuli> slabs) const {
    for (SlabModuli& slab : slabs) slab.depth -= centres();
    const auto last = slabs.end() - 1;
    slabs.erase(slabs.begin(),
                std::find_if(slabs.begin(), last, [](const SlabModuli& s) { return s.depth > 0; }));
    return slabs;
  }

  // The whole layer with the load inside it, as deep as the centres of the loaded grains.
  ModelChoice loaded_inside(const std::string& moduli) const {
    ModelChoice out = finite_elements("fe_elastic_layer", moduli);
    out.settings["load_depth"] = fmt::format("{:.6g}", centres() / depth_);
    if (dim_ == 3) out.settings["tolerance"] = kToleranceBelow;
    return out;
  }

  // Numbers of a model from the same measurement.
  ModelChoice of_constants(const std::string& name) const {
    ModelChoice out{"", name, {}};
    for (std::size_t k = 0; k < 5; ++k)
      out.settings[limit_constants()[k]] = fmt::format("{:.9g}", whole_.mean[k]);
    return out;
  }

  void predict(std::vector<ModelChoice>& models) {
    const std::vector<SlabModuli> slabs = over_realizations(slabs_);
    whole_ = over_realizations(wholes_).front();
    for (std::size_t k = 0; k < limit_constants().size(); ++k) {
      const std::string key = "moduli." + limit_constants()[k];
      out_.summary[key] = whole_.mean[k];
      if (std::isfinite(whole_.error[k])) out_.summary[key + ".standard_error"] = whole_.error[k];
    }
    const double growth =
        slabs.back().mean[SlabConstants::e_v] / slabs.front().mean[SlabConstants::e_v];
    out_.summary["moduli.growth"] = growth;
    out_.summary["moduli.residual"] = whole_.residual_transverse;
    const std::string by_depth = write_table("moduli_by_depth.csv", slabs, depth_);
    const std::string homogeneous = write_table("moduli_homogeneous.csv", {whole_}, depth_);
    const bool space = dim_ == 3;
    const auto add = [&](const std::string& label, ModelChoice model, const std::string& base) {
      model.label = label;
      if (!base.empty()) model.settings["base"] = base;
      if (kSettled.contains(label))
        settling_.emplace_back(model, label.starts_with("by_depth") ? by_depth : homogeneous);
      models.push_back(std::move(model));
    };
    const auto add_all = [&](const std::string& moduli, const ModelChoice& layer,
                             const ModelChoice& half_space, const ModelChoice& lower_layer,
                             const ModelChoice& lower_half_space) {
      for (const char* base : {"rough", "smooth"}) add(moduli + "_" + base, layer, base);
      add(moduli + "_half_space", half_space, "");
      add(moduli + "_centres", below_centres(lower_layer), "rough");
      add(moduli + "_half_space_centres", below_centres(lower_half_space), "");
    };
    const auto layer = [&](const std::string& table) {
      return finite_elements("fe_elastic_layer", table);
    };
    const auto half_space = [&](const std::string& table) {
      return finite_elements("fe_elastic_half_space", table);
    };
    const ModelChoice even = space ? of_constants("transverse_layer") : layer(homogeneous);
    const ModelChoice even_half_space =
        space ? of_constants("transverse_half_space") : half_space(homogeneous);
    add_all("homogeneous", even, even_half_space, even, even_half_space);
    if (!response_.finite_elements) return;
    const std::string lower =
        write_table("moduli_by_depth_below_centres.csv", below_centres(slabs), depth_ - centres());
    add_all("by_depth", layer(by_depth), half_space(by_depth), layer(lower), half_space(lower));
    add("by_depth_inside", loaded_inside(by_depth), "rough");
  }

  SeenThrough through(double width) const {
    AverageSetup setup = setup_;
    setup.width = width;
    SeenThrough out;
    out.options = average_options(setup, "coarse_graining", diameter_, threads_);
    out.kernel = seeing_kernel(out.options, dim_);
    return out;
  }

  Observations observe() {
    const double force = dem::force_of_load(load_);
    if (setup_.half_width > 0) half_ = std::min(half_, setup_.half_width);
    const std::vector<SeenThrough> both{
        through(setup_.width > 0 ? setup_.width : setup_.width_diameters * diameter_),
        through(response_.width_depths * depth_)};
    const auto points = static_cast<Eigen::Index>(setup_.points);
    const Eigen::VectorXd x = dim_ == 2 ? Eigen::VectorXd::LinSpaced(points, -half_, half_)
                                        : Eigen::VectorXd::LinSpaced(points / 2 + 1, 0, half_);
    std::vector<double> depths;
    for (const double share : setup_.depths) depths.push_back(share * depth_);
    std::vector<std::vector<Ensemble>> lines(both.size(), std::vector<Ensemble>(depths.size() + 1));
    Observations seen;
    seen.specimen = Specimen::layer;
    seen.realizations = static_cast<int>(layers_.size());
    seen.scale = scale_of_load(force, depth_, dim_);
    const double least = *std::min_element(depths.begin(), depths.end());
    seen.told = {force, depth_, dim_, least, "", {}};
    const auto levels = static_cast<Eigen::Index>(std::max(1.0, std::floor(depth_ / diameter_)));
    const double first = 0.5 * depth_ / static_cast<double>(levels);
    const SettlementPlaces places{x, Eigen::VectorXd::LinSpaced(levels, first, depth_ - first),
                                  diameter_};
    std::vector<MeanResponse> responses;
    tell(kResponse, 0);
    for (const RestingLayer& layer : layers_) {
      const MeanResponse& one = responses.emplace_back(mean_response(
          layer.rest, materials_, layer.frame, layer.places, force, depths, depth_, places, both));
      for (std::size_t t = 0; t < both.size(); ++t) {
        for (std::size_t d = 0; d <= depths.size(); ++d) lines[t][d].add(one.lines[t][d]);
      }
      figures_["response.places"].push_back(one.places);
      figures_["response.out_of_balance"].push_back(one.out_of_balance);
      figures_["response.base_over_load"].push_back(one.base_share);
      add_end(one.end, mean_weight(layer.rest));
      tell(kResponse, responses.size());
    }
    compare_settlements(responses, places, seen.told);
    add_figures(out_.summary, figures_);
    out_.summary["layer.depth"] = depth_;
    out_.summary["layer.depth_diameters"] = depth_ / diameter_;
    out_.summary["layer.mean_diameter"] = diameter_;
    out_.summary["layer.half_width_depths"] = half_ / depth_;
    const std::vector<std::string> names{"w_diameters", "w_depths"};
    for (std::size_t t = 0; t < both.size(); ++t) {
      for (std::size_t d = 0; d <= depths.size(); ++d) {
        const bool base = d == depths.size();
        const std::string place =
            base ? std::string("base") : fmt::format("depth_{:g}", setup_.depths[d]);
        seen.lines.push_back(observed_line(
            lines[t][d].with_samples(),
            {dim_ == 3 ? "sigma_zz" : "sigma_yy",
             fmt::format("{}, w = {:.3g} m", place, both[t].options.width), place + "_" + names[t],
             base ? Smoothing::marginal : Smoothing::kernel, dim_ == 3},
            both[t].kernel));
      }
    }
    return seen;
  }

  void add_end(const LinearEnd& end, double weight) {
    const auto add = [&](const char* key, double load) {
      if (std::isfinite(load)) figures_[key].push_back(load / weight);
    };
    add("linearity.first_opens", end.opening);
    add("linearity.first_slides", end.sliding);
    add("linearity.first_changes", end.first);
    add("linearity.hundredth_changes", end.hundredth);
  }

  // Settlements of the grains beside those of models that have been given their moduli before.
  void compare_settlements(const std::vector<MeanResponse>& layers, const SettlementPlaces& places,
                           const RunFacts& facts) {
    const double unit = whole_.mean[SlabConstants::e_v] / facts.force * (dim_ == 3 ? depth_ : 1);
    std::string head = "realization,place,at_over_h,displacement";
    std::vector<Settlements> models;
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& [model, table] : settling_) {
      head += "," + model.label;
      models.push_back(
          predicted_settlements(model, facts, continuum::read_moduli_by_depth(table), places));
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    out_.summary["time.settlement_s"] = taken.count();
    std::string rows;
    for (std::size_t r = 0; r < layers.size(); ++r) {
      const Settlements& grains = layers[r].settled;
      const auto write = [&](const char* place, const Eigen::VectorXd& at,
                             Eigen::VectorXd Settlements::*part) {
        for (Eigen::Index k = 0; k < at.size(); ++k) {
          if (!std::isfinite((grains.*part)[k])) continue;
          rows += fmt::format("{},{},{:.5g},{:.6g}", r, place, at[k] / depth_,
                              (grains.*part)[k] * unit);
          for (const Settlements& model : models)
            rows += fmt::format(",{:.6g}", (model.*part)[k] * unit);
          rows += '\n';
        }
      };
      write("surface", places.surface, &Settlements::surface);
      write("axis", places.axis, &Settlements::axis);
      figures_["response.settlement"].push_back(layers[r].settlement * unit);
      for (std::size_t m = 0; m < models.size(); ++m) {
        const std::string key = "settlement." + settling_[m].first.label;
        const auto add = [&](const char* name, const MeanSettlement& mean) {
          if (std::isfinite(mean.of)) figures_[key + name].push_back(mean.of / mean.other);
        };
        add(".surface", mean_on_surface(grains, models[m], places, depth_));
        add(".axis", mean_on_axis(grains, models[m], places, depth_));
      }
    }
    out_.texts.emplace_back("displacements.csv", head + "\n" + rows);
  }

  StudyResult& out_;
  const Case& value_;
  const ResponseSetup& response_;
  const AverageSetup& setup_;
  const dem::PointLoadSetup& load_;
  int dim_;
  dem::Materials materials_;
  int threads_;
  std::vector<RestingLayer> layers_;
  std::vector<std::vector<SlabModuli>> slabs_, wholes_;
  SlabModuli whole_;
  std::vector<std::pair<ModelChoice, std::string>> settling_;  // with the table of its moduli
  double depth_ = 0, diameter_ = 0, half_ = std::numeric_limits<double>::infinity();
  FigureSamples figures_;
};

}  // namespace

const std::vector<std::string>& limit_constants() {
  static const std::vector<std::string> names{"E_h", "E_v", "nu_h", "nu_v", "G_v", "E", "nu"};
  return names;
}

Observations predict_and_observe(StudyResult& result, std::vector<ModelChoice>& models,
                                 int threads) {
  return Analysis(result, threads).run(models);
}

void remove_tables(const StudyResult& result) {
  std::error_code error;
  std::filesystem::remove_all(tables_of(result), error);
}

}  // namespace grainfield::coupling
