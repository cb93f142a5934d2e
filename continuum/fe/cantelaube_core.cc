// The elastic core of Cantelaube's heap as a boundary value problem: a triangle with its apex at
// the heap's, half tip angle beta_hat, pressed from the sides by the plastic flanks, on a base.
//
// Loads: weight, and on the flanks the traction of the plastic field (closed/cantelaube.h). By
// symmetry only x >= 0 is solved. On the axis either the displacement is continuous, u_x = 0
// without shear, or the material yields there, sigma_xx = K sigma_yy without shear; K = (1 + sin
// phi)/(1 - sin phi) where sigma_xx is the largest compression, or its inverse where sigma_yy is.
// This second condition is met by iteration on the axis' traction, accelerated (Anderson 1965),
// because both sides of it are linear. On the base either the closed form's displacement, or rigid
// and rough, or rigid and smooth, or springs. A yielding axis holds nothing, and its corner with
// another base than the closed form's is singular (rough) or must be pinned by a force (smooth). On
// springs branch plus has a solution; with branch minus, whose axis answers a change of sigma_yy
// with a larger one of sigma_xx, what is found changes without end as the mesh is refined. So a
// yielding axis is solved on the closed form's base and, of branch plus, on springs.
//
// The closed form's stress is linear in the half core, its displacement a polynomial of degree two,
// which elements of degree two hold exactly: they return it to the accuracy of the linear solver,
// provided that the axis' condition is the branch's own. On the axis u_x = -b1 rho_g (y^2 - h^2)/(2
// E'), E' = E/(1 - nu^2): only branch zero is continuous there, the others open or close a gap.
#include <deal.II/grid/grid_generator.h>
#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <numbers>

#include "continuum/closed/cantelaube.h"
#include "continuum/closed/orthotropic.h"
#include "continuum/constants.h"
#include "continuum/fe/plugin.h"
#include "continuum/fe/solved_model.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

using Vector = fe::Vector<2>;
using Point = dealii::Point<2>;

constexpr char kCore[] = "fe_cantelaube_core";
enum Side : unsigned int { axis, flank, base };
/// Nodes of the axis' traction, linear in between, when the axis yields.
constexpr int kAxisNodes = 33;
/// Misfit of the axis' condition at its nodes over rho g h that ends the iteration.
constexpr double kAxisTolerance = 1e-9;
/// Steps that Anderson's acceleration looks back.
constexpr int kAxisMemory = 200;
/// Points of the core's figures along depth and base.
constexpr int kSamples = 201;

/// Fixed point of x -> f(x) for a linear f, from x: least squares over the last steps.
template <typename F>
int anderson(const F& f, Eigen::VectorXd& x, int most, double tolerance, double& misfit) {
  Eigen::MatrixXd changes_x(x.size(), 0), changes_r(x.size(), 0);
  Eigen::VectorXd last_x, last_r;
  for (int step = 1;; ++step) {
    const Eigen::VectorXd r = f(x) - x;
    misfit = r.cwiseAbs().maxCoeff();
    if (misfit <= tolerance || step >= most) return step;
    if (last_x.size() > 0) {
      const auto append = [](Eigen::MatrixXd& m, const Eigen::VectorXd& column) {
        if (m.cols() >= kAxisMemory) m = m.rightCols(kAxisMemory - 1).eval();
        m.conservativeResize(Eigen::NoChange, m.cols() + 1);
        m.col(m.cols() - 1) = column;
      };
      append(changes_x, x - last_x);
      append(changes_r, r - last_r);
    }
    last_x = x;
    last_r = r;
    x += r;
    if (changes_r.cols() > 0) {
      const Eigen::VectorXd weights = changes_r.completeOrthogonalDecomposition().solve(r);
      x -= (changes_x + changes_r) * weights;
    }
  }
}

class CantelaubeCore : public fe::SolvedModel<2> {
 public:
  explicit CantelaubeCore(const Settings& s)
      : fe::SolvedModel<2>(kCore, static_cast<int>(number_of(s, "degree")),
                           static_cast<int>(number_of(s, "iterations"))),
        h_(number_of(s, "h")),
        rho_g_(number_of(s, "rho_g")),
        nu_(number_of(s, "nu")),
        phi_(number_of(s, "phi_deg") * kDegree),
        base_(s.at("base")),
        springs_(number_of(s, "base_stiffness")),
        cells_(static_cast<int>(number_of(s, "refinement"))),
        cycles_(static_cast<int>(number_of(s, "adaptive"))),
        most_unknowns_(number_of(s, "most_unknowns")),
        axis_iterations_(static_cast<int>(number_of(s, "axis_iterations"))) {
    const std::string& branch = s.at("branch");
    beta_hat_ = core_angle(phi_, branch == "zero"   ? CoreBranch::zero
                                 : branch == "plus" ? CoreBranch::plus
                                                    : CoreBranch::minus);
    const double chosen = number_of(s, "beta_hat_deg");
    if (!std::isnan(chosen)) {
      beta_hat_ = chosen * kDegree;
      if (!(chosen < 90 - number_of(s, "phi_deg")))
        throw BadParameter(fmt::format(
            "model {}: beta_hat_deg = {:g} is not inside the heap; allowed: above 0 and below "
            "90 - phi_deg = {:g} deg",
            kCore, chosen, 90 - number_of(s, "phi_deg")));
    }
    t_ = std::tan(beta_hat_);
    const std::string& condition = s.at("axis");
    yields_ = condition == "yields" || (condition == "branch" && branch != "zero");
    if (condition == "branch" && !std::isnan(chosen))
      throw BadParameter(fmt::format(
          "model {}: beta_hat_deg is set with axis = branch; allowed: axis = continuous or yields",
          kCore));
    if (yields_ && base_ != "closed" && !(base_ == "elastic" && branch == "plus"))
      throw BadParameter(
          fmt::format("model {}: base = {} is not solved with a yielding axis (axis = {}, branch = "
                      "{}); allowed: base = closed, base = elastic with branch = plus, or axis = "
                      "continuous",
                      kCore, base_, condition, branch));
    const double active = (1 - std::sin(phi_)) / (1 + std::sin(phi_));
    ratio_ = branch == "plus" ? active : 1 / active;
    const SectorField field = cantelaube_field(phi_, beta_hat_, rho_g_);
    core_ = field.linear(2);
    flank_ = field.linear(3);
    young_ = 1000 * rho_g_ * h_;
  }

  Stresses stress(const Points& points) override {
    solve();
    Stresses out = Stresses::Constant(points.rows(), 3, std::numeric_limits<double>::quiet_NaN());
    std::vector<Point> inside;
    std::vector<Eigen::Index> rows;
    const double slope = std::tan(std::numbers::pi / 2 - phi_), slack = 1e-9 * h_;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const double x = std::abs(points(i, 0)), y = points(i, 1);
      if (!(y <= 0) || !(y >= -h_ - slack) || !(x <= -slope * y + slack)) continue;
      if (x <= -t_ * y) {
        rows.push_back(i);
        inside.push_back(into_mesh(x, y));
      } else {
        out.row(i) = flank_ * Eigen::Vector2d(x, y);
      }
      out(i, 2) *= fe::mirror_sign<2>(points.row(i), 2);
    }
    const Eigen::MatrixXd found = solver_->stress_at(inside);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      out.row(rows[n]) = found.row(static_cast<Eigen::Index>(n));
      out(rows[n], 2) *= fe::mirror_sign<2>(points.row(rows[n]), 2);
    }
    return out;
  }

 private:
  /// Points of the closed triangle, drawn in by round-off.
  Point into_mesh(double x, double y) const {
    const double depth = std::clamp(-y, 0., h_);
    return {std::min(x, t_ * depth) * (1 - 1e-12), -depth};
  }

  Vector flank_traction(const Point& p, const Vector& normal) const {
    const Eigen::Vector3d s = flank_ * Eigen::Vector2d(p[0], p[1]);
    Vector t;
    t[0] = s[0] * normal[0] + s[2] * normal[1];
    t[1] = s[2] * normal[0] + s[1] * normal[1];
    return t;
  }

  /// The closed form's, with the foot of the axis at rest and no rotation there.
  Vector closed_displacement(const Point& p) const {
    const PlaneModuli m = plane_strain_moduli(young_, nu_);
    // Strains xx, yy, 2 xy of a linear stress: columns x and y.
    const Eigen::Matrix<double, 3, 2> strain = compliance(m) * core_;
    const double x = p[0], y = p[1];
    Vector u;
    u[0] = strain(0, 0) * x * x / 2 + strain(0, 1) * x * y - strain(1, 0) * (y * y - h_ * h_) / 2;
    u[1] = strain(1, 0) * x * y + strain(1, 1) * (y * y - h_ * h_) / 2 +
           (strain(2, 0) - strain(0, 1)) * x * x / 2;
    return u;
  }

  void build_mesh() {
    auto& mesh = solver_->mesh();
    dealii::GridGenerator::simplex(mesh, {Point(0, 0), Point(0, -h_), Point(t_ * h_, -h_)});
    for (const auto& cell : mesh.active_cell_iterators()) {
      for (const auto& face : cell->face_iterators()) {
        if (!face->at_boundary()) continue;
        const Point middle = face->center();
        face->set_boundary_id(middle[0] < 1e-9 * h_          ? axis
                              : middle[1] < -h_ * (1 - 1e-9) ? base
                                                             : flank);
      }
    }
    mesh.refine_global(static_cast<unsigned int>(cells_));
  }

  fe::ElasticProblem<2> problem(const Eigen::VectorXd& axis_stress) const {
    fe::ElasticProblem<2> out;
    out.E = young_;
    out.nu = nu_;
    out.body_force = [this](const Point&) {
      Vector f;
      f[1] = -rho_g_;
      return f;
    };
    out.boundaries[flank].traction = [this](const Point& p, const Vector& normal) {
      return flank_traction(p, normal);
    };
    if (yields_) {
      out.boundaries[axis].traction = [this, axis_stress](const Point& p, const Vector&) {
        const double at = -p[1] / h_ * (kAxisNodes - 1);
        const int k = std::clamp(static_cast<int>(at), 0, kAxisNodes - 2);
        Vector t;
        t[0] = -(axis_stress[k] + (at - k) * (axis_stress[k + 1] - axis_stress[k]));
        return t;
      };
    } else {
      out.boundaries[axis].fixed[0] = true;
    }
    auto& ground = out.boundaries[base];
    if (base_ == "closed" || base_ == "rough") ground.fixed = {true, true};
    if (base_ == "smooth") ground.fixed[1] = true;
    if (base_ == "closed")
      ground.displacement = [this](const Point& p) { return closed_displacement(p); };
    if (base_ == "elastic") ground.spring[0] = ground.spring[1] = springs_ * young_ / h_;
    return out;
  }

  void solve_axis() {
    if (!yields_) {
      solver_->solve(problem({}));
      return;
    }
    std::vector<Point> nodes;
    for (int k = 0; k < kAxisNodes; ++k) nodes.push_back(into_mesh(0, -h_ * k / (kAxisNodes - 1)));
    if (axis_stress_.size() == 0) {
      axis_stress_.resize(kAxisNodes);
      for (int k = 0; k < kAxisNodes; ++k)
        axis_stress_[k] = rho_g_ * nodes[static_cast<std::size_t>(k)][1];
    }
    double misfit = 0;
    figures_["axis_iterations"] = anderson(
        [&](const Eigen::VectorXd& stress) -> Eigen::VectorXd {
          solver_->solve(problem(stress));
          return ratio_ * solver_->stress_at(nodes).col(1);
        },
        axis_stress_, axis_iterations_, kAxisTolerance* rho_g_* h_, misfit);
    figures_["axis_misfit"] = misfit / (rho_g_ * h_);
    if (!(misfit <= kAxisTolerance * rho_g_ * h_)) {
      throw ComputationFailed(fmt::format(
          "{}: the axis misses its yield condition by {:.1e} rho_g h after {} solves, {:.0e} is "
          "asked; raise axis_iterations, or take axis = continuous",
          kCore, misfit / (rho_g_ * h_), axis_iterations_, kAxisTolerance));
    }
  }

  void solve() {
    solve_once([this] {
      build_mesh();
      solve_axis();
      for (int cycle = 0; cycle < cycles_; ++cycle) {
        solver_->refine_worst(fe::kRefinedShare, most_unknowns_, "adaptive");
        solve_axis();
      }
      measure();
    });
  }

  /// What tells the solution from the closed form.
  void measure() {
    const double unit = rho_g_ * h_;
    std::vector<Point> ray, bottom, axis_points;
    for (int k = 1; k < kSamples; ++k) {
      const double depth = h_ * k / kSamples, x = t_ * h_ * (k - 1) / (kSamples - 1);
      ray.push_back(into_mesh(t_ * depth, -depth));
      axis_points.push_back(into_mesh(0, -depth));
      bottom.push_back(into_mesh(x, -h_));
    }
    const Eigen::MatrixXd on_ray = solver_->stress_at(ray), on_base = solver_->stress_at(bottom),
                          on_axis = solver_->stress_at(axis_points);
    // The component of the stress along the core's boundary that equilibrium leaves free.
    double jump = 0, error = 0, mobilised = 0, largest = 0;
    const double s = std::sin(beta_hat_), c = std::cos(beta_hat_);
    const auto along = [&](const Eigen::Vector3d& v) {
      return v[0] * s * s + v[1] * c * c - 2 * v[2] * s * c;
    };
    for (int k = 0; k < kSamples - 1; ++k) {
      const auto n = static_cast<std::size_t>(k);
      const Eigen::Vector3d outside = flank_ * Eigen::Vector2d(ray[n][0], ray[n][1]);
      const double depth = -ray[n][1] / h_;
      if (depth > 0.05 && depth < 0.95)
        jump = std::max(jump, std::abs(along(on_ray.row(k).transpose()) - along(outside)) / unit);
      for (const auto& [stress, at] : {std::pair(on_ray.row(k), ray[n]),
                                       {on_base.row(k), bottom[n]},
                                       {on_axis.row(k), axis_points[n]}}) {
        const Eigen::Vector3d exact = core_ * Eigen::Vector2d(at[0], at[1]);
        error = std::max(error, (stress.transpose() - exact).cwiseAbs().maxCoeff() / unit);
        if (-at[1] > 0.05 * h_)
          mobilised = std::max(mobilised, mobilised_sine(stress.transpose()) / std::sin(phi_));
      }
      largest = std::max(largest, -on_base(k, 1));
    }
    figures_["beta_hat_deg"] = beta_hat_ / kDegree;
    figures_["flank_jump"] = jump;
    figures_["closed_form_error"] = error;
    figures_["mobilised_sine_ratio"] = mobilised;
    figures_["base_centre"] = -on_base(0, 1) / unit;
    figures_["base_largest"] = largest / unit;
    figures_["dip_ratio"] = -on_base(0, 1) / largest;
    figures_["axis_ratio"] = on_axis(kSamples / 2, 0) / on_axis(kSamples / 2, 1);
  }

  double h_, rho_g_, nu_, phi_, beta_hat_ = 0, t_ = 0, ratio_ = 1, young_ = 1;
  std::string base_;
  double springs_;
  int cells_, cycles_;
  double most_unknowns_;
  int axis_iterations_;
  bool yields_ = false;
  LinearStress core_, flank_;
  Eigen::VectorXd axis_stress_;
};

const fe::ModelRow core_row{kCore, fe::made<CantelaubeCore>};

}  // namespace
}  // namespace grainfield::continuum
