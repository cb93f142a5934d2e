// Does the continuum limit exist? Layers at rest, their moduli by small strains, what elasticity
// predicts from these, and then the linear response of the grains beside it.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "coupling/observe/declaration.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/grain_keys.h"
#include "coupling/studies/boussinesq_limit/analysis.h"
#include "coupling/studies/boussinesq_limit/limits.h"
#include "coupling/studies/boussinesq_limit/responses.h"
#include "coupling/studies/boussinesq_limit/setup.h"
#include "coupling/studies/point_load/finished_layers.h"
#include "coupling/studies/point_load/keys.h"
#include "coupling/studies/point_load/layer_study.h"
#include "coupling/studies/point_load/simulation.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::coupling {
namespace {

std::optional<double> share_of(const Realization& one, int dem::ContactChanges::*count) {
  const dem::Snapshot *before = one.find("unloaded"), *after = one.find("loaded");
  if (before == nullptr || after == nullptr || before->contacts.empty()) return std::nullopt;
  return dem::compare_contacts(*before, *after).*count /
         static_cast<double>(before->contacts.size());
}

std::optional<double> weights_of(const Realization& one) {
  const dem::Snapshot *before = one.find("unloaded"), *after = one.find("loaded");
  if (before == nullptr || after == nullptr) return std::nullopt;
  return dem::total_applied_force(*after).norm() / mean_weight(*before);
}

// A layer that an earlier run left, whatever load it carried.
dem::RunResult finished_layer(const Case& value, const FinishedRun& place) {
  dem::RunResult out;
  for (const std::string& state : kLayerStates)
    out.snapshots.emplace_back(state, dem::read_snapshot(place.file, place.group + "/" + state));
  const int dim = value.get<dem::PointLoadSetup>().packing.dim;
  if (const int found = out.snapshots.front().second.dim; found != dim) {
    throw std::invalid_argument(fmt::format("packing.dim: found {}, the layer {}:{} has {}", dim,
                                            place.file, place.group, found));
  }
  require_same_material(value.get<dem::PointLoadSetup>().material, out.snapshots.front().second,
                        place);
  return out;
}

std::unique_ptr<dem::Run> make_limit_layer(const Case& value, std::int64_t number, int threads) {
  if (value.get<GrainFiles>().files.empty()) return make_layer(value, number, threads);
  return run_of(finished_layer(value, finished_run(value, number, kLayerStates, kLayerStudy)));
}

dem::Outlook foresee_limit_layer(const Case& value, std::int64_t draws) {
  if (value.get<GrainFiles>().files.empty()) return foresee_layer(value, draws);
  try_finished_runs(value, kLayerStates, kLayerStudy,
                    [&](const FinishedRun& layer) { finished_layer(value, layer); });
  return {};
}

void check_limit(const Case& value) {
  const auto& setup = value.get<dem::PointLoadSetup>();
  if (setup.packing.dim == 3 && setup.packing.sides != "periodic") {
    throw std::invalid_argument(
        "packing.sides: found \"walls\", allowed: \"periodic\" (layers in space are strained in "
        "cells that repeat)");
  }
  check_one_load(value);
}

std::vector<SummaryKey> limit_figures() {
  std::vector<SummaryKey> out;
  for (const std::string& name : limit_constants()) {
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
      {"moduli.unbalanced_force_ratio", "-",
       "of the layers that moduli and responses are measured on: mean resultant over mean contact "
       "force that Newton's method reached"},
      {"rest.contacts_changed", "-", "contacts gained and lost by Newton's method before it"},
      {"response.places", "-", "places of the load on a layer"},
      {"response.load_depth", "m", "mean depth of the loaded grains' centres below the surface"},
      {"response.settlement", "-",
       "mean displacement of the loaded grains, downwards, times E_v/F, in space times E_v h/F"},
      {"settlement.*.surface", "-",
       "mean settlement of the grains' surface, h/4 to h from the load, over that of MODEL"},
      {"settlement.*.axis", "-", "the same below the load, h/4 to 3h/4 deep"},
      {"time.settlement_s", "s", "wall time of the models' settlements"},
      {"linearity.first_opens", "-",
       "load over a grain's weight at which the first contact is open, by the linear response "
       "alone: median over the places"},
      {"linearity.first_slides", "-", "at which the first contact begins to slide"},
      {"linearity.first_changes", "-", "at which the first contact does either"},
      {"linearity.hundredth_changes", "-", "at which a hundredth of the layer's contacts have"},
      {"response.out_of_balance", "-", "largest share of a load that base and sides do not carry"},
      {"response.base_over_load", "-", "share of the load that the base carries"},
      {"layer.depth_diameters", "-", "the same over the grains' mean diameter", "depth / d"},
      {"layer.half_width_depths", "-", "where profiles end, over h"},
  };
  out.insert(out.end(), own.begin(), own.end());
  return out;
}

}  // namespace

Study boussinesq_limit_study() {
  Study out = layer_study();
  out.name = "boussinesq-limit";
  out.meaning =
      "layers under small loads on many surface grains, one at a time, beside elasticity with the "
      "moduli of the same layers: to what share it is right, by depth";
  out.sections.push_back(kResponseKeys);
  out.without = {"load.probe_strain",  "average.methods",       "average.rve_shape",
                 "average.rve_radius", "average.rve_diameters", "average.map_columns",
                 "average.map_rows"};
  out.check = check_limit;
  out.models_optional = true;
  out.make_run = make_limit_layer;
  out.foresee = foresee_limit_layer;
  out.figures = {point_load_figures, limit_figures, limit_keys};
  out.averaged = [](const Case& value) -> std::vector<AveragedValues> {
    const auto& average = value.get<AverageSetup>();
    const double profiles = 2 * static_cast<double>(average.depths.size() + 1);
    return {{{{"average.points", static_cast<double>(average.points)}}, profiles}};
  };
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
       .predicted = predict_and_observe,
       .more =
           [](StudyResult& r) {
             remove_tables(r);
             add_limits(r);
           },
       .told = told_limits});
  return out;
}

}  // namespace grainfield::coupling
