#include "coupling/studies/cone/cone_models.h"

#include <fmt/format.h>

#include <map>

#include "continuum/model.h"
#include "coupling/models/model_record.h"
#include "coupling/models/models.h"
#include "coupling/models/subject.h"
#include "coupling/run/comparison_page.h"

namespace grainfield::coupling {
namespace {

// A models' cone that is higher over the heap is warned of.
constexpr double kHigherCone = 1.1;

// From the heap's frame, whose origin is its highest point, to that of the models.
Eigen::MatrixXd in_models_axes(const ConeEnsemble& cones, Eigen::MatrixXd points) {
  points.col(2).array() -= cones.height() * (cones.spanned() - 1);
  return points;
}

RunFacts facts_of(const ConeEnsemble& cones) {
  RunFacts out;
  out.height = out.depth = cones.height() * cones.spanned();
  out.dim = 3;
  out.numbers = {{"rho_g", cones.pressure() / cones.height()},
                 {"phi_deg", cones.mean(&ConeFrame::repose_deg)}};
  return out;
}

std::vector<ModelProfiles> models_of(const ConeEnsemble& cones, StudyResult& out, ConePage& page,
                                     const std::vector<Profile>& profiles) {
  const double h = cones.height();
  std::vector<PointSet> sets;
  for (const Profile& p : profiles) {
    const Eigen::MatrixXd rings = cones.rings_at(1 - p.depth / h);
    sets.push_back({in_models_axes(cones, h * rings_in_space(rings)),
                    p.key == "base" ? Smoothing::marginal : Smoothing::kernel, &cones.kernel(),
                    true});
  }
  const Eigen::MatrixXd grid = h * rings_in_space(cones.inside());
  sets.push_back({in_models_axes(cones, grid), Smoothing::none, nullptr, true});
  const RunFacts known = facts_of(cones);
  std::vector<ModelProfiles> all;
  double seconds = 0;
  for (const ModelChoice& choice : out.value.models) {
    const Evaluation e = evaluate_model(choice, known, sets);
    seconds += e.seconds;
    ModelProfiles m{choice.label, model_label(choice), family_of(choice.name), {}};
    for (std::size_t s = 0; s + 1 < sets.size(); ++s) {
      m.values.push_back(both_sides(Eigen::VectorXd(-e.stresses[s].col(2))));
    }
    all.push_back(std::move(m));
    page.models.push_back(
        {choice.label, model_label(choice), e.stresses.back().col(2) / cones.pressure()});
    Field field = model_field(choice, known, grid, e.stresses.back(), cones.columns(), 1);
    field.nz = cones.rows();
    field.attributes["apex_z"] = fmt::format("{}", h * (cones.spanned() - 1));
    out.fields.emplace_back("model_" + choice.label, std::move(field));
    add_model(out.summary, choice, over_grains_height(e.figures, cones.spanned()), e.seconds);
  }
  out.summary["time.continuum_s"] = seconds;
  return all;
}

}  // namespace

void check_cone_models(const Case& value) {
  require_subject(value.models, Subject::heap, 3, "compare.models");
}

void compare_cones(const ConeEnsemble& cones, StudyResult& out, ConePage& page) {
  const double h = cones.height(), pressure = cones.pressure();
  const int n = cones.base().realizations();
  const Scale scale = scale_of_heaps(
      h, pressure,
      fmt::format(" (rho = {:.6g} kg/m3 times mean volume fraction {:.4g}); every cone scaled by "
                  "its own; means over the angle at radius |x|; realizations: {}",
                  cones.mean(&ConeFrame::grain_density), cones.mean(&ConeFrame::volume_fraction),
                  n),
      "apex", 3);
  std::vector<Profile> own = cones.profiles();
  if (out.value.models.empty()) {
    out.comparison = without_models(std::move(own), scale, n);
    out.comparison.dim = 3;
  } else {
    std::vector<ModelProfiles> all = models_of(cones, out, page, own);
    out.comparison = compare(std::move(own), std::move(all), scale, n);
    out.comparison.dim = 3;
    for (const auto& [key, figure] : summary_figures(out.comparison, 0)) {
      // The response.* keys speak of a load.
      if (!key.starts_with("response.")) out.summary[key] = figure;
    }
    if (cones.spanned() > kHigherCone) {
      double weight = 0;
      for (const double w : cones.figures().at("cone.model_over_weight")) weight += w / n;
      out.warnings.push_back(fmt::format(
          "The models' cone, which the flank's line spans, is {:.3g} times as high as the grains' "
          "rounded heap and weighs {:.3g} times as much: part of every model's distance is that of "
          "the shapes.",
          cones.spanned(), weight));
    }
  }
}

}  // namespace grainfield::coupling
