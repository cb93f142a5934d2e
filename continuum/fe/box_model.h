// A box of elastic material under a load at the origin, solved on adaptively refined meshes: what
// the layers and the half space share. Internal to fe/: needs deal.II.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "continuum/fe/solved_model.h"
#include "continuum/settings.h"

namespace grainfield::continuum::fe {

/// Values that differ from a border's coordinate by less than this part of the domain are on it.
inline constexpr double kOnBorder = 1e-9;

/// What layers and half spaces share: the box |x| <= half width (its mirrored half x >= 0, in 3D
/// also y >= 0), bottom <= vertical <= 0, refinement until the stresses
/// at probe points stand still, and the way from points of the full space into the meshed part.
/// The settings have F, degree, tolerance, refinements, most_unknowns and iterations. A mesh of its
/// own needs probes() and scale() to fit it.
template <int dim>
class BoxModel : public SolvedModel<dim> {
 public:
  BoxModel(const std::string& name, const Settings& s, double tolerance, int degree)
      : SolvedModel<dim>(name, static_cast<int>(nonzero_or(s, "degree", degree)),
                         static_cast<int>(number_of(s, "iterations"))),
        load_(number_of(s, "F")),
        tolerance_(nonzero_or(s, "tolerance", tolerance)),
        refinements_(static_cast<int>(number_of(s, "refinements"))),
        most_unknowns_(number_of(s, "most_unknowns")) {}

  Stresses stress(const Points& points) override {
    this->solve_once([this] {
      build_mesh(solver_->mesh());
      solve();
    });
    std::vector<dealii::Point<dim>> inside;
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      if (const auto p = fold(points.row(i))) {
        inside.push_back(*p);
        rows.push_back(i);
      }
    }
    Stresses out =
        Stresses::Constant(points.rows(), kStresses<dim>, std::numeric_limits<double>::quiet_NaN());
    const Eigen::MatrixXd found = stress_in_mesh(inside);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      const auto point = points.row(rows[n]);
      for (int c = 0; c < kStresses<dim>; ++c)
        out(rows[n], c) =
            (mirrored_ ? mirror_sign<dim>(point, c) : 1) * found(static_cast<Eigen::Index>(n), c);
    }
    return out;
  }

 protected:
  virtual void build_mesh(dealii::parallel::distributed::Triangulation<dim>& mesh) = 0;
  virtual ElasticProblem<dim> problem() const = 0;
  /// Where the stress must stand still, and the stress against which its change is measured.
  virtual std::vector<dealii::Point<dim>> probes() const = 0;
  virtual double scale(const dealii::Point<dim>& probe) const = 0;
  /// What the elements' stress is added to.
  virtual Stress<dim> closed_part(const dealii::Point<dim>&) const { return {}; }
  virtual double refinement_weight(const dealii::Point<dim>&) const { return 1; }

  BoundaryCondition<dim> mirror_plane(int axis) const {
    BoundaryCondition<dim> mirror;
    mirror.fixed[axis] = true;
    return mirror;
  }
  static dealii::Point<dim> horizontal_and_height(double x, double height) {
    dealii::Point<dim> p;
    p[0] = x;
    p[dim - 1] = height;
    return p;
  }

  double load_;
  bool mirrored_ = true;                ///< only x >= 0 is meshed; false: in 2D the whole width
  double half_width_ = 0, bottom_ = 0;  ///< of the box; set by build_mesh
  using SolvedModel<dim>::figures_;

 private:
  void solve() {
    const auto equations = problem();
    const auto points = probes();
    Eigen::MatrixXd before;
    for (int cycle = 0;; ++cycle) {
      solver_->solve(equations);
      const Eigen::MatrixXd after = solver_->stress_at(points);
      figures_["refinement_cycles"] = cycle;
      if (cycle > 0) {
        double change = 0;
        for (std::size_t n = 0; n < points.size(); ++n) {
          const auto row = static_cast<Eigen::Index>(n);
          change =
              std::max(change, (after - before).row(row).cwiseAbs().maxCoeff() / scale(points[n]));
        }
        figures_["change"] = change;
        if (change <= tolerance_) return;
        if (cycle >= refinements_)
          throw ComputationFailed(fmt::format(
              "{}: the stress still changes by {:.1e} of its scale in refinement {}, {:.0e} is "
              "asked; raise refinements, degree or tolerance",
              name_, change, cycle, tolerance_));
      }
      before = after;
      solver_->refine_worst(kRefinedShare, most_unknowns_, "refinements",
                            [this](const dealii::Point<dim>& p) { return refinement_weight(p); });
    }
  }

  Eigen::MatrixXd stress_in_mesh(const std::vector<dealii::Point<dim>>& points) const {
    Eigen::MatrixXd found = solver_->stress_at(points);
    for (std::size_t n = 0; n < points.size(); ++n) {
      const auto closed = closed_part(points[n]);
      for (int c = 0; c < kStresses<dim>; ++c) found(static_cast<Eigen::Index>(n), c) += closed[c];
    }
    return found;
  }

  /// The point's image in the meshed part; none outside the domain.
  std::optional<dealii::Point<dim>> fold(const Eigen::RowVectorXd& point) const {
    dealii::Point<dim> p;
    const double slack = kOnBorder * half_width_;
    for (int d = 0; d < dim - 1; ++d) {
      if (!(std::abs(point(d)) <= half_width_ + slack)) return std::nullopt;
      p[d] = std::clamp(mirrored_ ? std::abs(point(d)) : point(d), -half_width_, half_width_);
    }
    const double height = point(dim - 1);
    if (!(height < 0) || !(height >= bottom_ - slack)) return std::nullopt;
    p[dim - 1] = std::max(height, bottom_);
    return p;
  }

  using SolvedModel<dim>::solver_;
  using SolvedModel<dim>::name_;

  double tolerance_;
  int refinements_;
  double most_unknowns_;
};

}  // namespace grainfield::continuum::fe
