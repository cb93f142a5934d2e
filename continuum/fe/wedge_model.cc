// The wedge as a model of the registry, and its further quantities at points.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "continuum/elastic_field.h"
#include "continuum/fe/plugin.h"
#include "continuum/fe/wedge.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

/// Young's modulus and Poisson's ratio of a map. Throws BadParameter where it is not isotropic.
std::function<Eigen::Vector2d(const Eigen::Vector2d&)> measured(const ElasticField& map,
                                                                const std::string& file) {
  constexpr double kIsotropic = 1e-6;
  const auto field = std::make_shared<const ElasticField>(map);
  return [field, file](const Eigen::Vector2d& at) -> Eigen::Vector2d {
    // Plane strain: lambda + 2 mu, lambda, mu.
    const Eigen::Matrix3d c = field->at(at[0], at[1]);
    const double lambda = c(0, 1), mu = c(2, 2);
    if (std::abs(c(0, 0) - c(1, 1)) > kIsotropic * c(0, 0) ||
        std::abs(c(0, 0) - lambda - 2 * mu) > kIsotropic * c(0, 0))
      throw BadParameter(fmt::format(
          "fe_mohr_coulomb_wedge: map {} is not isotropic at ({:.4g}, {:.4g}); allowed: a map with "
          "the columns young,poisson",
          file, at[0], at[1]));
    const double poisson = lambda / (2 * (lambda + mu));
    if (!(poisson >= 0 && poisson < 0.5))
      throw BadParameter(
          fmt::format("fe_mohr_coulomb_wedge: map {} has poisson = {:.4g} at ({:.4g}, {:.4g}); "
                      "allowed: 0 to below 0.5",
                      file, poisson, at[0], at[1]));
    return {2 * mu * (1 + poisson), poisson};
  };
}

/// Centres of congruent triangles that make up the heap.
Points over_the_heap(const WedgeProblem& p) {
  constexpr int kCells = 64;
  const double left = p.height / std::tan(p.left_deg * std::numbers::pi / 180),
               right = p.height / std::tan(p.right_deg * std::numbers::pi / 180);
  const auto mesh =
      fe::triangle_lattice({-left, -p.height}, {right, -p.height}, Eigen::Vector2d::Zero(), kCells);
  Points out(static_cast<Eigen::Index>(mesh.triangles.size()), 2);
  for (Eigen::Index t = 0; t < out.rows(); ++t) {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const int corner : mesh.triangles[static_cast<std::size_t>(t)])
      centre += mesh.vertices[static_cast<std::size_t>(corner)] / 3;
    out.row(t) = centre.transpose();
  }
  return out;
}

class WedgeModel : public Model {
 public:
  explicit WedgeModel(const Settings& s) : problem_(heap_problem(s, false)) {
    if (!s.at("map").empty()) take_map(s.at("map"));
  }

  Stresses stress(const Points& points) override {
    solve();
    Stresses out(points.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const plasticity::Vector4 s = solved_->stress_at(points.row(i).transpose());
      out.row(i) << s[0], s[1], s[3];
    }
    return out;
  }

  std::vector<Quantity> quantities(const Points& points) override {
    solve();
    const WedgeResult& r = *solved_;
    std::vector<Quantity> out;
    for (const char* name : {"sigma_zz", "displacement_x", "displacement_y", "mobilized", "plastic",
                             "plastic_shear", "plastic_volume"})
      out.push_back({name, Eigen::VectorXd::Constant(points.rows(),
                                                     std::numeric_limits<double>::quiet_NaN())});
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Eigen::Vector2d at = points.row(i).transpose();
      const int triangle = r.triangle_at(at);
      if (triangle < 0) continue;
      const Eigen::Vector2d u = r.displacement_at(at);
      const CellMeans means = cell_means(r, triangle);
      const std::array<double, 7> values{r.stress_at(at)[2], u[0],          u[1],
                                         r.mobilized_at(at), means.plastic, means.shear,
                                         means.volume};
      for (std::size_t k = 0; k < values.size(); ++k) out[k].values[i] = values[k];
    }
    return out;
  }

  MeshField mesh() override {
    solve();
    const WedgeResult& r = *solved_;
    MeshField out;
    const auto corners = static_cast<Eigen::Index>(r.mesh.vertices.size());
    out.corners.resize(corners, 2);
    for (Eigen::Index i = 0; i < corners; ++i)
      out.corners.row(i) = r.mesh.vertices[static_cast<std::size_t>(i)].transpose();
    out.triangles = r.mesh.triangles;
    int column = 0;
    for (const char* name : {"sigma_xx", "sigma_yy", "sigma_zz", "sigma_xy"})
      out.at_corners.push_back({name, r.stress.col(column++)});
    out.at_corners.push_back({"displacement_x", r.displacement.col(0)});
    out.at_corners.push_back({"displacement_y", r.displacement.col(1)});
    const auto triangles = static_cast<Eigen::Index>(r.mesh.triangles.size());
    for (const char* name : {"plastic", "plastic_shear", "plastic_volume", "mobilized"})
      out.in_triangles.push_back({name, Eigen::VectorXd(triangles)});
    for (Eigen::Index t = 0; t < triangles; ++t) {
      const CellMeans means = cell_means(r, static_cast<int>(t));
      const Eigen::Vector2d centre =
          (out.corners.row(r.mesh.triangles[t][0]) + out.corners.row(r.mesh.triangles[t][1]) +
           out.corners.row(r.mesh.triangles[t][2]))
              .transpose() /
          3;
      out.in_triangles[0].values[t] = means.plastic;
      out.in_triangles[1].values[t] = means.shear;
      out.in_triangles[2].values[t] = means.volume;
      out.in_triangles[3].values[t] = r.mobilized_at(centre);
    }
    const WedgeCore core = wedge_core(r);
    const auto rows = static_cast<Eigen::Index>(core.depth.size());
    for (const auto& [name, side] :
         {std::pair("core_left", &core.left), std::pair("core_right", &core.right)}) {
      Points line(rows, 2);
      for (Eigen::Index i = 0; i < rows; ++i)
        line.row(i) << (*side)[static_cast<std::size_t>(i)],
            -core.depth[static_cast<std::size_t>(i)];
      out.lines.emplace_back(name, std::move(line));
    }
    return out;
  }

  std::map<std::string, double> figures() const override {
    if (!solved_) return {};
    const WedgeCore core = wedge_core(*solved_);
    std::map<std::string, double> all = heap_figures(*solved_, core);
    all["thrust_ratio"] = solved_->base_force[0] / solved_->weight;
    all["beta_hat_left_deg"] = core.left_deg;
    all["beta_hat_right_deg"] = core.right_deg;
    all["beta_hat_left_misfit"] = core.left_misfit;
    all["beta_hat_right_misfit"] = core.right_misfit;
    all.insert(map_figures_.begin(), map_figures_.end());
    return all;
  }

 private:
  /// The ground is as stiff as the map's mean over the heap says.
  void take_map(const std::string& file) {
    WedgeProblem& p = problem_;
    const ElasticField field = read_elastic_field(file);
    const Points heap = over_the_heap(p);
    map_figures_["map_share"] =
        field.require_cover("fe_mohr_coulomb_wedge", "heap", heap,
                            "a map in m whose heap has its apex at (0, 0), y up, and height h");
    p.elasticity = measured(field, file);
    double sum = 0;
    for (Eigen::Index i = 0; i < heap.rows(); ++i) sum += p.elasticity(heap.row(i).transpose())[0];
    p.young = sum / static_cast<double>(heap.rows()) / (p.rho_g * p.height);
    map_figures_["map_young"] = p.young;
  }

  void solve() {
    if (!solved_) solved_ = std::make_unique<WedgeResult>(solve_wedge(problem_));
  }

  WedgeProblem problem_;
  std::map<std::string, double> map_figures_;
  std::unique_ptr<WedgeResult> solved_;
};

const fe::ModelRow wedge_row{"fe_mohr_coulomb_wedge", fe::made<WedgeModel>};

}  // namespace
}  // namespace grainfield::continuum
