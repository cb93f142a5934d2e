// The elastic-plastic cone as a model of the registry: wedge.h's body of revolution, turned round.
#include <array>
#include <cmath>
#include <memory>

#include "continuum/constants.h"
#include "continuum/fe/plugin.h"
#include "continuum/fe/wedge.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

/// Places between axis and foot at which the base is looked at.
constexpr int kBasePlaces = 400;

class ConeModel : public Model {
 public:
  explicit ConeModel(const Settings& s) : problem_(heap_problem(s, true)) {}

  Stresses stress(const Points& points) override {
    solve();
    Stresses out = Stresses::Constant(points.rows(), 6, kNan);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const double x = points(i, 0), y = points(i, 1), r = std::hypot(x, y);
      const plasticity::Vector4 s = solved_->stress_at({r, points(i, 2)});
      const double c = r > 0 ? x / r : 1, n = r > 0 ? y / r : 0;
      const double rr = s[0], zz = s[1], tt = s[2], rz = s[3];
      out.row(i) << rr * c * c + tt * n * n, rr * n * n + tt * c * c, zz, rz * n, rz * c,
          (rr - tt) * c * n;
    }
    return out;
  }

  std::vector<Quantity> quantities(const Points& points) override {
    solve();
    const WedgeResult& result = *solved_;
    std::vector<Quantity> out;
    for (const char* name : {"sigma_rr", "sigma_tt", "displacement_r", "displacement_z",
                             "mobilized", "plastic", "plastic_shear", "plastic_volume"})
      out.push_back({name, Eigen::VectorXd::Constant(points.rows(), kNan)});
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Eigen::Vector2d at(std::hypot(points(i, 0), points(i, 1)), points(i, 2));
      const int triangle = result.triangle_at(at);
      if (triangle < 0) continue;
      const plasticity::Vector4 s = result.stress_at(at);
      const Eigen::Vector2d u = result.displacement_at(at);
      const CellMeans means = cell_means(result, triangle);
      const std::array<double, 8> values{
          s[0],          s[2],        u[0],        u[1], result.mobilized_at(at),
          means.plastic, means.shear, means.volume};
      for (std::size_t k = 0; k < values.size(); ++k) out[k].values[i] = values[k];
    }
    return out;
  }

  std::map<std::string, double> figures() const override {
    if (!solved_) return {};
    const WedgeCore core = wedge_core(*solved_);
    std::map<std::string, double> all = heap_figures(*solved_, core);
    all["beta_hat_deg"] = core.right_deg;
    all["beta_hat_misfit"] = core.right_misfit;
    const double scale = problem_.rho_g * problem_.height;
    const double radius = problem_.height / std::tan(problem_.right_deg * kDegree);
    const auto pressure = [&](double r) {
      return -solved_->stress_at({r, -problem_.height})[1] / scale;
    };
    double largest = 0;
    for (int k = 0; k < kBasePlaces; ++k) {
      largest = std::max(largest, pressure(radius * k / kBasePlaces));
    }
    all["base_centre"] = pressure(0);
    all["base_largest"] = largest;
    all["dip_ratio"] = pressure(0) / largest;
    return all;
  }

 private:
  void solve() {
    if (!solved_) solved_ = std::make_unique<WedgeResult>(solve_wedge(problem_));
  }

  WedgeProblem problem_;
  std::unique_ptr<WedgeResult> solved_;
};

const fe::ModelRow cone_row{"fe_cone", fe::made<ConeModel>};

}  // namespace
}  // namespace grainfield::continuum
