#include "coupling/studies/solvers/models_only.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/averaging/average.h"
#include "coupling/models/model_record.h"
#include "coupling/studies/point_load/page.h"

namespace grainfield::coupling {
namespace {

// Points of a plane through the load, as the models want them: (x, y) or (x, 0, z).
Eigen::MatrixXd in_space(const Eigen::MatrixXd& plane, int dim) {
  if (dim == 2) return plane;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(plane.rows(), 3);
  out.col(0) = plane.col(0);
  out.col(2) = plane.col(1);
  return out;
}

}  // namespace

void require_depths(const ProblemSetup& setup) {
  const double deepest = *std::max_element(setup.depths.begin(), setup.depths.end());
  if (deepest <= setup.height) return;
  throw std::invalid_argument(fmt::format(
      "problem.depths: found {:g}, allowed: up to problem.height = {:g}", deepest, setup.height));
}

StudyResult compare_models(const Case& value, const std::vector<ModelChoice>& choices,
                           const ModelsOnly& where) {
  const RunFacts& facts = where.facts;
  const int dim = facts.dim, vertical = dim == 2 ? 1 : 2;
  std::vector<double> depths = where.depths;
  std::sort(depths.begin(), depths.end());

  std::vector<PointSet> sets;
  for (const double depth : depths) {
    sets.push_back(
        {in_space(line_points(-where.half_width, where.half_width, where.points, -depth), dim)});
  }
  // The map leaves out a load, where stresses may be infinite.
  constexpr int kColumns = 61, kRows = 31;
  const Eigen::MatrixXd grid = grid_points(-where.half_width, where.half_width, kColumns,
                                           -depths.back(), -0.1 * depths.back(), kRows);
  sets.push_back({in_space(grid, dim)});

  StudyResult out = begin_result(value, {});
  std::vector<Profile> profiles;
  std::vector<ModelProfiles> models;
  double seconds = 0;
  for (const auto& choice : choices) {
    const Evaluation e = evaluate_model(choice, facts, sets);
    seconds += e.seconds;
    add_model(out.summary, choice, e.figures, e.seconds);
    Field field = model_field(choice, facts, grid, e.stresses.back(), kColumns, kRows);
    if (&choice == &choices.front()) {
      out.map = field;
      for (std::size_t d = 0; d < depths.size(); ++d) {
        Profile p;
        p.name = fmt::format("depth {:g} m", depths[d]);
        p.key = fmt::format("depth_{:g}", depths[d]);
        p.depth = depths[d];
        p.quantity = dim == 2 ? "-sigma_yy" : "-sigma_zz";
        p.unit = dim == 2 ? "N/m" : "Pa";
        p.x = sets[d].points.col(0);
        p.mean = -e.stresses[d].col(vertical);
        p.independent_length = p.x[1] - p.x[0];
        profiles.push_back(std::move(p));
      }
    } else {
      ModelProfiles m;
      m.key = choice.label;
      m.label = model_label(choice);
      m.family = family_of(choice.name);
      for (std::size_t d = 0; d < depths.size(); ++d) {
        m.values.emplace_back(-e.stresses[d].col(vertical));
      }
      models.push_back(std::move(m));
      out.model_maps.push_back({model_label(choice), e.stresses.back().col(vertical)});
    }
    out.fields.emplace_back("model_" + choice.label, std::move(field));
  }
  out.summary["time.continuum_s"] = seconds;
  out.comparison =
      compare(std::move(profiles), std::move(models), scale_of_load(where.load, facts.height));
  // No grains here: the first model is the reference, and there is nothing to support.
  std::string sentence;
  for (const auto& result : out.comparison.results) {
    sentence +=
        fmt::format("{}{} differs from {} by {:.2g} % (relative L2)", sentence.empty() ? "" : "; ",
                    result.label, choices.front().label, 100 * result.overall.rel_l2);
  }
  Judgement judgement;
  judgement.best = out.comparison.judgement.best;
  judgement.findings = {sentence + "."};
  out.comparison.judgement = std::move(judgement);
  add_comparison(out.summary, out.comparison, out.comparison.profiles.size() - 1);
  out.page = layer_page;
  out.overview = layer_overview();
  return out;
}

}  // namespace grainfield::coupling
