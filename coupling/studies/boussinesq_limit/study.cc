// Does the continuum limit exist? Layers at rest, their moduli by small strains, what elasticity
// predicts from these, and then the linear response of the grains beside it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>

#include "coupling/compare/beyond_noise.h"
#include "coupling/observe/declaration.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/grain_keys.h"
#include "coupling/studies/boussinesq_limit/responses.h"
#include "coupling/studies/boussinesq_limit/setup.h"
#include "coupling/studies/point_load/finished_layers.h"
#include "coupling/studies/point_load/keys.h"
#include "coupling/studies/point_load/probed_slabs.h"
#include "coupling/studies/point_load/simulation.h"
#include "dem/laws/registry.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/shared/computation_failed.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/storage_failed.h"

namespace grainfield::coupling {
namespace {

// Balances to which layers are brought before anything is measured, the best that Newton's method
// reaches: a small load on a deep layer changes contact forces by little, and disks that roll
// between others may keep it from the last digits.
constexpr std::array kRests{1e-9, 1e-8, 1e-7};
// Finite elements are refined to this, far below the grains' noise: where shear is soft they need
// many unknowns for more.
constexpr const char* kFiniteElementTolerance = "1e-3";
constexpr double kEvidence = 0.1;  // "right to x %" is told below this

dem::Materials materials_of(const dem::MaterialSetup& m) {
  dem::Materials out;
  out.law = dem::law_of(m);
  out.friction = m.friction;
  out.rolling = dem::RollingLaw::of(m);
  return out;
}

dem::QuasistaticResult at_rest(const dem::Snapshot& before, const dem::Materials& materials) {
  dem::QuasistaticSettings how;
  for (const double ratio : kRests) {
    how.unbalanced_force_ratio = ratio;
    try {
      return dem::relax(before, materials, before.gravity, {}, how);
    } catch (const ComputationFailed&) {
      if (ratio == kRests.back()) throw;
    }
  }
  return {};
}

struct RestingLayer {
  dem::Snapshot rest;
  LayerFrame frame;
  std::vector<LoadPlace> places;
};

const std::vector<std::string>& constant_names() {
  static const std::vector<std::string> names{"E_h", "E_v", "nu_h", "nu_v", "G_v", "E", "nu"};
  return names;
}

class LimitAnalysis {
 public:
  LimitAnalysis(StudyResult& out, int threads)
      : out_(out),
        value_(out.value),
        response_(value_.get<ResponseSetup>()),
        setup_(value_.get<AverageSetup>()),
        load_(value_.get<dem::PointLoadSetup>()),
        dim_(load_.packing.dim),
        materials_(materials_of(load_.material)),
        threads_(threads) {}

  Observations run(std::vector<ModelChoice>& models) {
    for (const std::string& file : out_.realizations) prepare(read_realization(file));
    predict(models);  // before the response is known
    return observe();
  }

 private:
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
    figures_["rest.unbalanced_force_ratio"].push_back(rest.unbalanced_force_ratio);
    figures_["rest.contacts_changed"].push_back(rest.contacts_gained + rest.contacts_lost);
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

  std::string write_table(const std::string& name, const std::vector<SlabModuli>& slabs) {
    const std::string text = moduli_table(slabs, depth_, false);
    // Beside the results: models read it while results are not written yet, and it stays there.
    auto folder = std::filesystem::path(out_.realizations.front()).parent_path();
    if (folder.filename() == "checkpoint") folder = folder.parent_path();
    const auto path = folder / name;
    std::ofstream file(path);
    if (!(file << text) || !file.flush())
      throw dem::StorageFailed(fmt::format("{}: cannot be written", path.string()));
    return path.string();
  }

  static ModelChoice finite_elements(const std::string& name, const std::string& moduli) {
    return {"", name, {{"moduli", moduli}, {"tolerance", kFiniteElementTolerance}}};
  }

  // Numbers of a model from the same measurement.
  ModelChoice of_constants(const std::string& label, const std::string& name) const {
    ModelChoice out{label, name, {}};
    for (std::size_t k = 0; k < 5; ++k)
      out.settings[constant_names()[k]] = fmt::format("{:.9g}", whole_.mean[k]);
    return out;
  }

  void predict(std::vector<ModelChoice>& models) {
    const std::vector<SlabModuli> slabs = over_realizations(slabs_);
    whole_ = over_realizations(wholes_).front();
    for (std::size_t k = 0; k < constant_names().size(); ++k) {
      const std::string key = "moduli." + constant_names()[k];
      out_.summary[key] = whole_.mean[k];
      if (std::isfinite(whole_.error[k])) out_.summary[key + ".standard_error"] = whole_.error[k];
    }
    const double growth =
        slabs.back().mean[SlabConstants::e_v] / slabs.front().mean[SlabConstants::e_v];
    out_.summary["moduli.growth"] = growth;
    out_.summary["moduli.residual"] = whole_.residual_transverse;
    const std::string by_depth = write_table("moduli_by_depth.csv", slabs);
    const std::string homogeneous = write_table("moduli_homogeneous.csv", {whole_});
    const bool space = dim_ == 3;
    for (const char* base : {"rough", "smooth"}) {
      ModelChoice one = space ? of_constants("", "transverse_layer")
                              : finite_elements("fe_elastic_layer", homogeneous);
      one.label = fmt::format("homogeneous_{}", base);
      one.settings["base"] = base;
      models.push_back(one);
    }
    models.push_back(space ? of_constants("", "transverse_half_space")
                           : finite_elements("fe_elastic_half_space", homogeneous));
    models.back().label = "homogeneous_half_space";
    if (!response_.finite_elements) return;
    for (const char* base : {"rough", "smooth"}) {
      models.push_back(finite_elements("fe_elastic_layer", by_depth));
      models.back().label = fmt::format("by_depth_{}", base);
      models.back().settings["base"] = base;
    }
    models.push_back(finite_elements("fe_elastic_half_space", by_depth));
    models.back().label = "by_depth_half_space";
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
    const double unit = whole_.mean[SlabConstants::e_v] / force * (dim_ == 3 ? depth_ : 1);
    std::string moved = "realization,place,at_over_h,displacement\n";
    for (std::size_t r = 0; r < layers_.size(); ++r) {
      const RestingLayer& layer = layers_[r];
      const MeanResponse one = mean_response(layer.rest, materials_, layer.frame, layer.places,
                                             force, depths, depth_, x, both);
      for (std::size_t t = 0; t < both.size(); ++t) {
        for (std::size_t d = 0; d <= depths.size(); ++d) lines[t][d].add(one.lines[t][d]);
      }
      figures_["response.places"].push_back(one.places);
      figures_["response.settlement"].push_back(one.settlement * unit);
      figures_["response.out_of_balance"].push_back(one.out_of_balance);
      figures_["response.base_over_load"].push_back(one.base_share);
      for (Eigen::Index k = 0; k < x.size(); ++k) {
        if (std::isfinite(one.surface[k]))
          moved +=
              fmt::format("{},surface,{:.5g},{:.6g}\n", r, x[k] / depth_, one.surface[k] * unit);
      }
      for (Eigen::Index k = 0; k < one.axis.size(); ++k) {
        const double at = (static_cast<double>(k) + 0.5) / static_cast<double>(one.axis.size());
        if (std::isfinite(one.axis[k]))
          moved += fmt::format("{},axis,{:.5g},{:.6g}\n", r, at, one.axis[k] * unit);
      }
    }
    out_.texts.emplace_back("displacements.csv", moved);
    add_figures(out_.summary, figures_);
    out_.summary["layer.depth"] = depth_;
    out_.summary["layer.depth_diameters"] = depth_ / diameter_;
    out_.summary["layer.mean_diameter"] = diameter_;
    out_.summary["layer.half_width_depths"] = half_ / depth_;
    Observations seen;
    seen.specimen = Specimen::layer;
    seen.realizations = static_cast<int>(layers_.size());
    seen.scale = scale_of_load(force, depth_, dim_);
    const double least = *std::min_element(depths.begin(), depths.end());
    seen.told = {force, depth_, dim_, least, "", {}};
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
  double depth_ = 0, diameter_ = 0, half_ = std::numeric_limits<double>::infinity();
  FigureSamples figures_;
};

// Samples and model at some of the comparison's places, one below the other.
struct Taken {
  Eigen::MatrixXd samples;
  Eigen::VectorXd model;
};
template <class Wanted>
Taken taken(const Comparison& c, const ModelProfiles& model, const Wanted& wanted) {
  std::vector<std::pair<std::size_t, Eigen::Index>> places;
  for (std::size_t p = 0; p < c.profiles.size(); ++p) {
    for (Eigen::Index k = 0; k < c.profiles[p].x.size(); ++k) {
      if (c.profiles[p].samples.rows() > 0 && wanted(c.profiles[p], k)) places.emplace_back(p, k);
    }
  }
  Taken out;
  if (places.empty()) return out;
  out.samples.resize(static_cast<Eigen::Index>(places.size()), c.profiles.front().samples.cols());
  out.model.resize(out.samples.rows());
  for (Eigen::Index row = 0; row < out.model.size(); ++row) {
    const auto& [p, k] = places[static_cast<std::size_t>(row)];
    out.samples.row(row) = c.profiles[p].samples.row(k);
    out.model[row] = model.values[p][k];
  }
  return out;
}

// limit.MODEL.REGION.WIDTH.*: the misfit beyond the noise.
void add_limits(StudyResult& out) {
  const Comparison& c = out.comparison;
  for (const ModelProfiles& model : c.models) {
    for (const std::string width : {"w_diameters", "w_depths"}) {
      const auto of_width = [&](const Profile& p) { return p.key.ends_with(width); };
      const auto add = [&](const std::string& region, const auto& wanted) {
        const Taken t = taken(c, model, wanted);
        if (t.samples.cols() < 2) return;
        const BeyondNoise b = misfit_beyond_noise(t.samples, t.model);
        const std::string key = fmt::format("limit.{}.{}.{}", model.key, region, width);
        const auto put = [&](const char* name, double number) {
          if (std::isfinite(number)) out.summary[key + name] = number;
        };
        put(".squared", b.squared);
        put(".squared.standard_error", b.error);
        put(".noise", b.noise);
        put(".right_to", b.right_to());
      };
      add("base",
          [&](const Profile& p, Eigen::Index) { return of_width(p) && p.key.starts_with("base"); });
      add("axis", [&](const Profile& p, Eigen::Index k) {
        return of_width(p) && std::fabs(p.x[k]) <= 1e-9 * c.scale.h;
      });
      add("all", [&](const Profile& p, Eigen::Index) { return of_width(p); });
    }
  }
}

// "right to x %" where the bound is below kEvidence.
std::string told_of(const StudyResult& r) {
  const auto number = [&](const std::string& key) -> std::optional<double> {
    const auto found = r.summary.find(key);
    if (found == r.summary.end()) return std::nullopt;
    return std::get<double>(found->second);
  };
  std::string out;
  for (const ModelProfiles& model : r.comparison.models) {
    const auto right = number(fmt::format("limit.{}.base.w_depths.right_to", model.key));
    if (!right) continue;
    if (!out.empty()) out += "; ";
    out += *right < kEvidence
               ? fmt::format("{} is right to {:.2g} %", model.key, 100 * *right)
               : fmt::format("{}: not resolved (below {:.2g} %)", model.key, 100 * *right);
  }
  const double deep = number("layer.depth_diameters").value_or(0);
  if (out.empty()) {
    return fmt::format("Fewer than three layers, {:.3g} diameters deep, bound no misfit.", deep);
  }
  return fmt::format(
      "On the base of layers {:.3g} diameters deep, seen at a fixed share of the "
      "depth, with 95 %: {}.",
      deep, out);
}

std::optional<double> share_of(const Realization& one, int dem::ContactChanges::*count) {
  const dem::Snapshot *before = one.find("unloaded"), *after = one.find("loaded");
  if (before == nullptr || after == nullptr || before->contacts.empty()) return std::nullopt;
  return dem::compare_contacts(*before, *after).*count /
         static_cast<double>(before->contacts.size());
}

std::optional<double> weights_of(const Realization& one) {
  const dem::Snapshot *before = one.find("unloaded"), *after = one.find("loaded");
  if (before == nullptr || after == nullptr) return std::nullopt;
  double mass = 0;
  int free = 0;
  for (const dem::Grain& g : before->grains) {
    if (g.fixed) continue;
    mass += g.mass;
    ++free;
  }
  return dem::total_applied_force(*after).norm() / (mass / free * before->gravity.norm());
}

// A layer that an earlier run left, whatever load it carried.
std::unique_ptr<dem::Run> make_limit_layer(const Case& value, std::int64_t number, int threads) {
  if (value.get<GrainFiles>().files.empty()) return make_layer(value, number, threads);
  const FinishedRun place = finished_run(value, number, kLayerStates, kLayerStudy);
  dem::RunResult out;
  for (const std::string& state : kLayerStates)
    out.snapshots.emplace_back(state, dem::read_snapshot(place.file, place.group + "/" + state));
  const int dim = value.get<dem::PointLoadSetup>().packing.dim;
  if (const int found = out.snapshots.front().second.dim; found != dim) {
    throw std::invalid_argument(fmt::format("packing.dim: found {}, the layer {}:{} has {}", dim,
                                            place.file, place.group, found));
  }
  return run_of(std::move(out));
}

dem::Outlook foresee_limit_layer(const Case& value, std::int64_t draws) {
  if (value.get<GrainFiles>().files.empty()) return foresee_layer(value, draws);
  return {};
}

void check_limit(const Case& value) {
  const auto& setup = value.get<dem::PointLoadSetup>();
  if (setup.packing.shape == "superellipsoid") {
    throw std::invalid_argument(
        "packing.shape: found \"superellipsoid\", allowed: disk, irregular (linear response is of "
        "disks, polygons and spheres)");
  }
  if (setup.packing.dim == 3 && setup.packing.sides != "periodic") {
    throw std::invalid_argument(
        "packing.sides: found \"walls\", allowed: \"periodic\" (spheres are strained in cells that "
        "repeat)");
  }
}

std::vector<SummaryKey> limit_figures() {
  std::vector<SummaryKey> out;
  for (const std::string& name : constant_names()) {
    const bool ratio = name.starts_with("nu");
    out.push_back({"moduli." + name, ratio ? "-" : "Pa",
                   "elastic constant of the layers by small strains, between their held grains (in "
                   "the plane N/m)"});
  }
  const std::vector<SummaryKey> own{
      {"moduli.growth", "-", "E_v of the lowest slab over that of the uppermost"},
      {"moduli.residual", "-",
       "root of the squared stress that five constants leave over all of it"},
      {"moduli.nonlinear_share", "-",
       "even part of the stress changes by the strains over the odd"},
      {"moduli.contacts_changed", "-", "contacts that are new, gone or begin to slide by a strain"},
      {"rest.unbalanced_force_ratio", "-",
       "mean resultant over mean contact force to which Newton's method brought a layer"},
      {"rest.contacts_changed", "-", "contacts gained and lost by Newton's method before it"},
      {"response.places", "-", "places of the load on a layer"},
      {"response.settlement", "-",
       "mean displacement of the loaded grains, downwards, times E_v/F, in space times E_v h/F"},
      {"response.out_of_balance", "-", "largest share of a load that base and sides do not carry"},
      {"response.base_over_load", "-", "share of the load that the base carries"},
      {"layer.depth_diameters", "-", "the same over the grains' mean diameter", "depth / d"},
      {"layer.half_width_depths", "-", "where profiles end, over h"},
      {"limit.*.*.*.squared", "-",
       "misfit beyond noise: sum of (grains - MODEL)^2 less the variance of the mean, over the sum "
       "of MODEL^2; of region base | axis | all, averaged at w_diameters | w_depths"},
      {"limit.*.*.*.noise", "-", "the variance that was taken away"},
      {"limit.*.*.*.right_to", "-",
       "root of its upper bound, 95 % one-sided: the model is right to this share"},
  };
  out.insert(out.end(), own.begin(), own.end());
  return out;
}

}  // namespace

Study boussinesq_limit_study() {
  Study out;
  out.name = "boussinesq-limit";
  out.meaning =
      "layers under small loads on many surface grains, one at a time, beside elasticity with the "
      "moduli of the same layers: to what share it is right, by depth";
  out.sections = {kGrainFilesKeys, kPackingKeys, kMaterialKeys, kMotionKeys,
                  kRestKeys,       kLoadKeys,    kAverageKeys,  kResponseKeys};
  out.without = {"load.probe_strain",    "average.methods",       "average.rve_shape",
                 "average.rve_radius",   "average.rve_diameters", "average.map_columns",
                 "average.map_rows",     "packing.axis_min",      "packing.axis_max",
                 "packing.exponent_min", "packing.exponent_max"};
  out.material = [](Case& c) -> dem::MaterialSetup& {
    return c.get<dem::PointLoadSetup>().material;
  };
  out.grain_radius = [](const Case& c) {
    return dem::mean_radius(c.get<dem::PointLoadSetup>().packing);
  };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<dem::PointLoadSetup>().motion; };
  out.rest = [](Case& c) -> dem::RestSetup& { return c.get<dem::PointLoadSetup>().rest; };
  out.check = check_limit;
  out.fills = {"F", "h", "dim", "depth"};
  out.models_optional = true;
  out.make_run = make_limit_layer;
  out.foresee = foresee_limit_layer;
  out.figures = {point_load_figures, limit_figures};
  out.averaged = [](const Case& value) -> std::vector<AveragedValues> {
    const auto& average = value.get<AverageSetup>();
    const double profiles = 2 * static_cast<double>(average.depths.size() + 1);
    return {{{{"average.points", static_cast<double>(average.points)}}, profiles}};
  };
  out.dimension = [](const Case& value) { return value.get<dem::PointLoadSetup>().packing.dim; };
  out.dimension_key = "packing.dim";
  declare(
      out,
      {.observed = {{"linearity.weights", "-",
                     "load of the simulation over the mean weight of a grain", weights_of},
                    {"linearity.gained", "-", "share of the contacts that this load closed",
                     [](const Realization& r) {
                       return share_of(r, &dem::ContactChanges::gained);
                     }},
                    {"linearity.lost", "-", "share that it opened",
                     [](const Realization& r) { return share_of(r, &dem::ContactChanges::lost); }},
                    {"linearity.sliding", "-", "share that it brought to the Coulomb limit",
                     [](const Realization& r) {
                       return share_of(r, &dem::ContactChanges::newly_sliding);
                     }}},
       .predicted = [](StudyResult& r, std::vector<ModelChoice>& models,
                       int threads) { return LimitAnalysis(r, threads).run(models); },
       .more = add_limits,
       .told = told_of});
  return out;
}

}  // namespace grainfield::coupling
