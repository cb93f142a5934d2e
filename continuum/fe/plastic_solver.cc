#include "continuum/fe/plastic_solver.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "continuum/fe/plastic_body.h"
#include "continuum/model.h"
#include "dem/newton/newton.h"

namespace grainfield::continuum::fe {
namespace {

using Eigen::Vector2d;

/// A step that needs no more Newton iterations is followed by one twice as large.
constexpr int kQuick = 8;
/// A step is stretched to a stage's end where less than this part of it would remain.
constexpr double kSliver = 0.01;
/// Steps of viscoplastic time, over the time of relaxation: the first, the shortest that is tried,
/// the longest before the material without viscosity is tried.
constexpr double kFirstTime = 1, kLeastTime = 1e-3, kLongTime = 1e4;
/// Most Newton iterations in one of them: a shorter one is better than more.
constexpr int kCreepIterations = 10;
/// Flow without rest: so many steps and so many times of relaxation later the overstress is more
/// than this share.
constexpr std::size_t kPatience = 20;
constexpr double kPatientTime = 5, kFading = 0.5;
/// So many ever shorter steps without rest: the load that the body bears has been reached.
constexpr int kRestless = 3;

}  // namespace

struct PlasticSolver::Impl : PlasticBody {
  using PlasticBody::PlasticBody;

  /// The increment to these external forces; u comes in as first guess with the prescribed values.
  /// Not more than what is left of settings.work.
  NewtonReport solve(const Eigen::VectorXd& target, Eigen::VectorXd& u, int iterations) {
    NewtonProblem problem;
    problem.residual = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r) {
      r = (internal(at) - target) / settings.force_scale;
      clear_held(r);
      return true;
    };
    problem.factorize = [&](const Eigen::VectorXd& at, const Eigen::VectorXd&) {
      return factorize(at);
    };
    problem.solve = [&](const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
      x = settings.force_scale * rhs;
      grid.solve(x);
      clear_held(x);
    };
    const NewtonReport report =
        newton(problem,
               {settings.tolerance, std::clamp(settings.work - spent, 1, iterations),
                settings.displacement_scale},
               u);
    spent += report.iterations;
    return report;
  }

  bool settled(const NewtonReport& report) const {
    return report.converged || report.history.back() <= settings.stalled;
  }

  /// How the same increment ends in viscoplastic time.
  enum class Creep {
    rest,
    flow,       ///< the overstress does not fall: it slides
    no_steps,   ///< settings.viscous_steps are used up
    no_newton,  ///< Newton's method fails in the shortest step of time too
    no_work,    ///< settings.work is used up
  };

  /// Nothing has changed unless it comes to rest.
  Creep creep(const Eigen::VectorXd& forces, Eigen::VectorXd u, LoadStep& step) {
    step.overstress = 0;
    step.viscous_steps = 0;
    Creep end = Creep::no_steps;
    const auto points_before = points;
    const auto contacts_before = contacts;
    const Eigen::VectorXd displacement_before = displacement;
    double time = kFirstTime;
    std::vector<double> left, clock{0};  // overstress after each step; time
    while (static_cast<int>(left.size()) < settings.viscous_steps && time >= kLeastTime &&
           spent < settings.work) {
      // A long step of time is as good as none: the material without viscosity.
      relaxed = time > kLongTime ? 1 : time / (1 + time);
      Eigen::VectorXd move = u;
      const NewtonReport report =
          solve(forces, move, std::min(kCreepIterations, settings.iterations));
      step.iterations += report.iterations;
      if (!settled(report)) {
        time = std::min(time, kLongTime) / 4;
        continue;
      }
      accept(move);
      u.setZero();
      left.push_back(overstress());
      clock.push_back(clock.back() + time);
      step.history = report.history;
      step.overstress = left.back();
      step.viscous_steps = static_cast<int>(left.size());
      if (relaxed == 1 || left.back() <= settings.overstress) {
        relaxed = 1;
        return Creep::rest;
      }
      if (left.size() > kPatience &&
          clock.back() - clock[clock.size() - 1 - kPatience] > kPatientTime &&
          left.back() > kFading * left[left.size() - 1 - kPatience]) {
        end = Creep::flow;
        break;
      }
      time *= report.iterations <= kQuick / 2 ? 4 : report.iterations <= kQuick ? 2 : 1;
    }
    if (time < kLeastTime) end = Creep::no_newton;
    if (spent >= settings.work) end = Creep::no_work;
    relaxed = 1;
    points = points_before;
    contacts = contacts_before;
    displacement = displacement_before;
    return end;
  }

  std::string what(Creep end, const LoadStep& step) const {
    switch (end) {
      case Creep::flow:
        return fmt::format(", in viscoplastic time the overstress stayed at {:.1e}",
                           step.overstress);
      case Creep::no_steps:
        return fmt::format(", in viscoplastic time the overstress was still {:.1e} after {} steps",
                           step.overstress, settings.viscous_steps);
      case Creep::no_newton:
        return ", nor was one found in viscoplastic time";
      case Creep::no_work:
      case Creep::rest:
        break;
    }
    return "";
  }

  void load(const std::vector<Vector2d>& body_force, const Displacement& moved,
            const Traction& traction) {
    const Eigen::VectorXd pressed = traction ? forces_of(traction) : surface;
    const Eigen::VectorXd from = forces_of(body) + surface, to = forces_of(body_force) + pressed;
    Eigen::VectorXd move = zeros(), rate = zeros();  // prescribed; of the last step
    if (moved)
      for (std::size_t i = 0; i < fixed.size(); ++i)
        if (fixed[i])
          move[static_cast<Eigen::Index>(i)] =
              moved(grid.positions[i])[static_cast<Eigen::Index>(grid.components[i])];
    double reached = 0, step = std::min(1., settings.first_step);
    spent = 0;
    LoadStep record;
    int restless = 0;  // steps in a row that slid in viscoplastic time
    while (reached < 1) {
      const double target = reached + (1 + kSliver) * step >= 1 ? 1 : reached + step;
      const Eigen::VectorXd forces = from + target * (to - from);
      Eigen::VectorXd u = (target - reached) * rate;
      clear_held(u);
      u += (target - reached) * move;
      if (moved && rate.isZero(0)) elastic_guess(forces, u);
      const NewtonReport report = solve(forces, u, settings.iterations);
      record.iterations += report.iterations;
      if (settled(report)) {
        record.history = report.history;
        record.overstress = 0;
        record.viscous_steps = 0;
        accept(u);
        rate = u / (target - reached);
      } else {
        rate.setZero();
        const bool crept = target - reached <= settings.viscous_step;
        const Creep end = crept ? creep(forces, (target - reached) * move, record) : Creep::rest;
        if (!crept || end != Creep::rest) {
          restless += end == Creep::flow;
          step = (target - reached) / (crept ? 4 : 2);
          const bool tired = spent >= settings.work;
          if (step < settings.least_step || (restless >= kRestless && reached > 0) || tired)
            throw ComputationFailed(fmt::format(
                "{}: no equilibrium found beyond {:.4g} of the load{}; Newton's method stopped at "
                "a residual of {:.1e} in iteration {} ({}){}{}",
                settings.name, reached, stage > 0 ? fmt::format(" of stage {}", stage + 1) : "",
                report.history.back(), report.iterations, report.why, what(end, record),
                tired ? fmt::format("; work = {} iterations are used up: raise work", settings.work)
                      : ""));
          continue;
        }
      }
      step = target - reached;
      if (report.converged && report.iterations <= kQuick) step *= 2;
      reached = target;
      if (settings.progress) settings.progress(reached);
      restless = 0;
      record.stage = stage;
      record.load = reached;
      steps.push_back(record);
      record = {};
      if (reached < 1 && spent >= settings.work)
        throw ComputationFailed(
            fmt::format("{}: no equilibrium found beyond {:.4g} of the load{}; work = {} "
                        "iterations of Newton's "
                        "method are used up: raise work",
                        settings.name, reached,
                        stage > 0 ? fmt::format(" of stage {}", stage + 1) : "", settings.work));
    }
    body = body_force;
    surface = pressed;
    ++stage;
  }

  std::vector<LoadStep> steps;
  int stage = 0;
  int spent = 0;  ///< Newton iterations in this call of load()
};

PlasticSolver::PlasticSolver(const TriangleMesh& mesh, const Material& material,
                             const Supports& supports, const Ground& ground,
                             PlasticSettings settings)
    : impl_(std::make_unique<Impl>(mesh, material, supports, ground, std::move(settings))) {}
PlasticSolver::~PlasticSolver() = default;

void PlasticSolver::activate(const std::vector<bool>& cells) {
  impl_->active = cells;
  impl_->find_free();
}

void PlasticSolver::load(const std::vector<Vector2d>& body_force, const Displacement& displacement,
                         const Traction& traction) {
  impl_->load(body_force, displacement, traction);
}

const std::vector<PointState>& PlasticSolver::points() const { return impl_->points; }
const std::vector<LoadStep>& PlasticSolver::steps() const { return impl_->steps; }
int PlasticSolver::unknowns() const { return static_cast<int>(impl_->grid.unknowns()); }

Eigen::MatrixXd PlasticSolver::corner_stress() const {
  const auto& grid = impl_->grid;
  const auto corners = static_cast<Eigen::Index>(grid.corner_unknowns.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(corners, 4);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(corners);
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    if (!impl_->active[c]) continue;
    // The linear function through the three points, at the corners.
    Eigen::Matrix3d through;
    Eigen::Matrix<double, 3, 4> values;
    const PointState* at = &impl_->points[c * kPoints];
    const Vector2d centre = (at[0].position + at[1].position + at[2].position) / 3;
    for (int q = 0; q < kPoints; ++q) {
      through.row(q) << 1, (at[q].position - centre).transpose();
      values.row(q) = at[q].stress.transpose();
    }
    const Eigen::Matrix<double, 3, 4> linear = through.inverse() * values;
    for (const int corner : grid.cells[c].corners) {
      const unsigned int x = grid.corner_unknowns[static_cast<std::size_t>(corner)][0];
      const Vector2d p = grid.positions[x] - centre;
      sum.row(corner) += Eigen::RowVector3d(1, p[0], p[1]) * linear;
      count[corner] += 1;
    }
  }
  for (Eigen::Index i = 0; i < corners; ++i) {
    if (count[i] > 0)
      sum.row(i) /= count[i];
    else
      sum.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return sum;
}

Eigen::MatrixXd PlasticSolver::corner_displacement() const {
  const auto& corners = impl_->grid.corner_unknowns;
  Eigen::MatrixXd out(corners.size(), 2);
  for (std::size_t i = 0; i < corners.size(); ++i)
    out.row(static_cast<Eigen::Index>(i)) << impl_->displacement[corners[i][0]],
        impl_->displacement[corners[i][1]];
  return out;
}

Vector2d PlasticSolver::reaction(const std::function<bool(const Vector2d&)>& where) const {
  const auto& grid = impl_->grid;
  Eigen::VectorXd forces = -impl_->forces_of(impl_->body) - impl_->surface;
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    if (!impl_->active[c]) continue;
    CellVector f = CellVector::Zero();
    for (std::size_t q = 0; q < kPoints; ++q)
      f += impl_->forces_of(c, q, impl_->points[c * kPoints + q].stress);
    grid.cells[c].scatter(f, forces);
  }
  Vector2d out = Vector2d::Zero();
  for (std::size_t i = 0; i < grid.unknowns(); ++i)
    if (where(grid.positions[i]))
      out[static_cast<Eigen::Index>(grid.components[i])] += forces[static_cast<Eigen::Index>(i)];
  return out;
}

}  // namespace grainfield::continuum::fe
