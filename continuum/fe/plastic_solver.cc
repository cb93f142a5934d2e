#include "continuum/fe/plastic_solver.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "continuum/fe/newton.h"
#include "continuum/model.h"

namespace grainfield::continuum::fe {
namespace {

using Eigen::Vector2d;
using plasticity::Matrix4;
using plasticity::Regime;
using plasticity::Returned;
using plasticity::Vector4;

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

/// xx, yy, zz, xy of a strain in the plane.
Vector4 in_space(const Eigen::Vector3d& e) { return {e[0], e[1], 0, e[2]}; }
Eigen::Vector3d in_plane(const Vector4& s) { return {s[0], s[1], s[3]}; }
Eigen::Matrix3d in_plane(const Matrix4& m) {
  Eigen::Matrix3d out;
  out << m(0, 0), m(0, 1), m(0, 3), m(1, 0), m(1, 1), m(1, 3), m(3, 0), m(3, 1), m(3, 3);
  return out;
}

/// A node on the ground.
struct ContactNode {
  std::array<unsigned int, 2> unknowns;
  double length = 0;  ///< of the base that it stands for
  double gap = 0;     ///< vertical displacement of the ground's spring, below 0 under pressure
  double shear = 0;   ///< horizontal displacement of the spring, without what has slipped
  bool active = true;
};

/// Force of the ground on a node after a move, and minus its derivative.
struct ContactForce {
  Vector2d force = Vector2d::Zero();
  Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();
  double shear = 0;  ///< of the spring afterwards
};

/// `relaxed`: how much of what is beyond the limit of friction slips in this step, of 1.
ContactForce contact_force(const ContactNode& node, const Ground& ground, const Vector2d& move,
                           double relaxed) {
  ContactForce out;
  const double k = ground.stiffness * node.length;
  const double gap = node.gap + move[1], shear = node.shear + move[0];
  if (gap > 0) return out;  // lifted off: the spring along the ground is forgotten
  out.force[1] = -k * gap;
  out.stiffness(1, 1) = k;
  const double most = ground.friction * out.force[1];
  if (std::abs(k * shear) <= most) {
    out.force[0] = -k * shear;
    out.stiffness(0, 0) = k;
    out.shear = shear;
  } else {
    const double sign = shear > 0 ? 1 : -1;
    out.shear = (1 - relaxed) * shear + relaxed * sign * most / k;
    out.force[0] = -k * out.shear;
    out.stiffness(0, 0) = (1 - relaxed) * k;
    out.stiffness(0, 1) = -relaxed * sign * ground.friction * k;
  }
  return out;
}

}  // namespace

struct PlasticSolver::Impl {
  Impl(const TriangleMesh& mesh, const Material& material, const Supports& supports,
       const Ground& ground_, PlasticSettings settings_)
      : settings(std::move(settings_)), ground(ground_), grid(mesh) {
    const auto& cells = grid.cells;
    displacement = zeros();
    for (const QuadraticCell& cell : cells) {
      for (std::size_t q = 0; q < kPoints; ++q) {
        PointState& state = points.emplace_back();
        state.position = cell.points[q];
        state.area = cell.areas[q];
      }
    }
    for (const QuadraticCell& cell : cells)
      laws.emplace_back(material((cell.points[0] + cell.points[1] + cell.points[2]) / 3));
    body.assign(cells.size(), Vector2d::Zero());
    surface = zeros();
    active.assign(cells.size(), true);
    find_supports(supports);
    find_free();
  }

  Eigen::VectorXd zeros() const {
    return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid.unknowns()));
  }

  /// Fixed unknowns, and nodes on the ground with Simpson's weights along it.
  void find_supports(const Supports& supports) {
    fixed.assign(grid.unknowns(), false);
    std::map<unsigned int, std::size_t> contact_of;
    for (const BoundaryEdge& edge : grid.edges) {
      const bool grounded = supports(edge.middle).contact;
      for (std::size_t node = 0; node < 3; ++node) {
        const auto [x, y] = edge.unknowns[node];
        const Support support = supports(grid.positions[x]);
        if (support.fixed[0]) fixed[x] = true;
        if (support.fixed[1]) fixed[y] = true;
        if (!grounded) continue;
        const auto [found, added] = contact_of.emplace(x, contacts.size());
        if (added) contacts.push_back({{x, y}});
        contacts[found->second].length += edge.length * (node < 2 ? 1. / 6 : 4. / 6);
      }
    }
  }

  /// Unknowns that are solved for: not prescribed, and of a node of an active cell.
  void find_free() {
    free.assign(grid.unknowns(), false);
    for (std::size_t c = 0; c < grid.cells.size(); ++c)
      if (active[c])
        for (const unsigned int i : grid.cells[c].unknowns) free[i] = true;
    for (ContactNode& node : contacts) node.active = free[node.unknowns[0]];
    for (std::size_t i = 0; i < free.size(); ++i) free[i] = free[i] && !fixed[i];
  }

  /// Nodal forces of tractions on the boundary, with Simpson's weights.
  Eigen::VectorXd forces_of(const Traction& traction) const {
    Eigen::VectorXd out = zeros();
    for (const BoundaryEdge& edge : grid.edges) {
      const Vector2d force = edge.length * traction(edge.middle);
      for (std::size_t node = 0; node < 3; ++node)
        for (std::size_t d = 0; d < 2; ++d)
          out[edge.unknowns[node][d]] +=
              force[static_cast<Eigen::Index>(d)] * (node < 2 ? 1. / 6 : 4. / 6);
    }
    return out;
  }

  Eigen::VectorXd forces_of(const std::vector<Vector2d>& force) const {
    Eigen::VectorXd out = zeros();
    for (std::size_t c = 0; c < grid.cells.size(); ++c)
      if (active[c]) grid.cells[c].scatter(grid.cells[c].weight * force[c], out);
    return out;
  }

  Returned update(std::size_t c, std::size_t q, const CellVector& u) const {
    const Vector4 trial =
        points[c * kPoints + q].elastic_strain + in_space(grid.cells[c].strain[q] * u);
    const plasticity::MohrCoulombLaw& law = laws[c];
    Returned out = law(trial);
    if (relaxed < 1 && out.regime != Regime::elastic) {
      const double rest = 1 - relaxed;
      out.stress = relaxed * out.stress + rest * (law.elasticity() * trial);
      out.elastic_strain = relaxed * out.elastic_strain + rest * trial;
      out.tangent = relaxed * out.tangent + rest * law.elasticity();
    }
    return out;
  }

  /// Internal forces less what the ground gives.
  Eigen::VectorXd internal(const Eigen::VectorXd& u) const {
    Eigen::VectorXd out = zeros();
    for (std::size_t c = 0; c < grid.cells.size(); ++c) {
      if (!active[c]) continue;
      const QuadraticCell& cell = grid.cells[c];
      const CellVector local = cell.gather(u);
      CellVector f = CellVector::Zero();
      for (std::size_t q = 0; q < kPoints; ++q)
        f += cell.areas[q] * cell.strain[q].transpose() * in_plane(update(c, q, local).stress);
      cell.scatter(f, out);
    }
    for (const ContactNode& node : contacts) {
      if (!node.active) continue;
      const auto [x, y] = node.unknowns;
      const Vector2d f = contact_force(node, ground, {u[x], u[y]}, relaxed).force;
      out[x] -= f[0];
      out[y] -= f[1];
    }
    return out;
  }

  /// Assembles and factorizes the tangent at u, or with elastic cells.
  bool factorize(const Eigen::VectorXd& u, bool elastic = false) {
    grid.clear_matrix();
    for (std::size_t c = 0; c < grid.cells.size(); ++c) {
      if (!active[c]) continue;
      const QuadraticCell& cell = grid.cells[c];
      const CellVector local = cell.gather(u);
      CellMatrix k = CellMatrix::Zero();
      for (std::size_t q = 0; q < kPoints; ++q) {
        Matrix4 tangent = laws[c].elasticity();
        if (!elastic) tangent = update(c, q, local).tangent + settings.tangent_floor * tangent;
        k += cell.areas[q] * cell.strain[q].transpose() * in_plane(tangent) * cell.strain[q];
      }
      grid.add(cell, k, free);
    }
    for (const ContactNode& node : contacts) {
      if (!node.active) continue;
      const auto [x, y] = node.unknowns;
      const Eigen::Matrix2d k = contact_force(node, ground, {u[x], u[y]}, relaxed).stiffness;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          const unsigned int row = i == 0 ? x : y, column = j == 0 ? x : y;
          if (free[row] && free[column]) grid.add(row, column, k(i, j));
        }
    }
    for (unsigned int i = 0; i < free.size(); ++i)
      if (!free[i]) grid.add(i, i, laws.front().constants().E);
    return grid.factorize();
  }

  void clear_held(Eigen::VectorXd& x) const {
    for (std::size_t i = 0; i < free.size(); ++i)
      if (!free[i]) x[static_cast<Eigen::Index>(i)] = 0;
  }

  /// The increment to these external forces; u comes in as first guess with the prescribed values.
  NewtonReport solve(const Eigen::VectorXd& target, Eigen::VectorXd& u, int iterations) {
    NewtonProblem problem;
    problem.residual = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r) {
      r = (internal(at) - target) / settings.force_scale;
      clear_held(r);
    };
    problem.factorize = [&](const Eigen::VectorXd& at) { return factorize(at); };
    problem.solve = [&](const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
      x = settings.force_scale * rhs;
      grid.solve(x);
      clear_held(x);
    };
    return newton(problem, {settings.tolerance, iterations}, u);
  }

  /// Spreads the prescribed values of u as elastic cells would: without that the cells at the
  /// border take the whole increment, and Newton starts far off.
  void elastic_guess(const Eigen::VectorXd& target, Eigen::VectorXd& u) {
    if (!factorize(zeros(), true)) return;
    Eigen::VectorXd r = target - internal(zeros());
    for (std::size_t c = 0; c < grid.cells.size(); ++c) {
      if (!active[c]) continue;
      const QuadraticCell& cell = grid.cells[c];
      const CellVector local = cell.gather(u);
      CellVector f = CellVector::Zero();
      for (std::size_t q = 0; q < kPoints; ++q)
        f -= cell.areas[q] * cell.strain[q].transpose() * in_plane(laws[c].elasticity()) *
             cell.strain[q] * local;
      cell.scatter(f, r);
    }
    clear_held(r);
    grid.solve(r);
    clear_held(r);
    u += r;
  }

  void accept(const Eigen::VectorXd& u) {
    for (std::size_t c = 0; c < grid.cells.size(); ++c) {
      if (!active[c]) continue;
      const CellVector local = grid.cells[c].gather(u);
      for (std::size_t q = 0; q < kPoints; ++q) {
        const Returned r = update(c, q, local);
        PointState& p = points[c * kPoints + q];
        if (r.regime != Regime::elastic) {
          Vector4 plastic =
              p.elastic_strain + in_space(grid.cells[c].strain[q] * local) - r.elastic_strain;
          p.plastic_strain += plastic;
          plastic[3] /= 2;
          const Eigen::Vector3d principal = plasticity::principal(plastic);
          p.plastic_shear += principal[0] - principal[2];
        }
        p.stress = r.stress;
        p.elastic_strain = r.elastic_strain;
        p.regime = r.regime;
      }
    }
    for (ContactNode& node : contacts) {
      if (!node.active) continue;
      const auto [x, y] = node.unknowns;
      node.shear = contact_force(node, ground, {u[x], u[y]}, relaxed).shear;
      node.gap += u[y];
    }
    displacement += u;
  }

  bool settled(const NewtonReport& report) const {
    return report.converged || report.history.back() <= settings.stalled;
  }

  /// Largest difference of the stress from what the material bears, in the heap and in friction on
  /// the ground, over the stress scale.
  double overstress() const {
    double most = 0;
    for (std::size_t c = 0; c < grid.cells.size(); ++c) {
      if (!active[c]) continue;
      for (std::size_t q = 0; q < kPoints; ++q) {
        const PointState& p = points[c * kPoints + q];
        most = std::max(most, (laws[c](p.elastic_strain).stress - p.stress).cwiseAbs().maxCoeff());
      }
    }
    for (const ContactNode& node : contacts) {
      if (!node.active || node.gap > 0) continue;
      most = std::max(most, ground.stiffness * (std::abs(node.shear) + ground.friction * node.gap));
    }
    return most / settings.stress_scale;
  }

  /// How the same increment ends in viscoplastic time.
  enum class Creep {
    rest,
    flow,       ///< the overstress does not fall: it slides
    no_steps,   ///< settings.viscous_steps are used up
    no_newton,  ///< Newton's method fails in the shortest step of time too
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
    while (static_cast<int>(left.size()) < settings.viscous_steps && time >= kLeastTime) {
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
          if (step < settings.least_step || (restless >= kRestless && reached > 0))
            throw ComputationFailed(fmt::format(
                "{}: no equilibrium found beyond {:.4g} of the load{}; Newton's method stopped at "
                "a residual of {:.1e} in iteration {} ({}){}",
                settings.name, reached, stage > 0 ? fmt::format(" of stage {}", stage + 1) : "",
                report.history.back(), report.iterations, report.why, what(end, record)));
          continue;
        }
      }
      step = target - reached;
      if (report.converged && report.iterations <= kQuick) step *= 2;
      reached = target;
      restless = 0;
      record.stage = stage;
      record.load = reached;
      steps.push_back(record);
      record = {};
    }
    body = body_force;
    surface = pressed;
    ++stage;
  }

  PlasticSettings settings;
  Ground ground;
  QuadraticTriangles grid;
  std::vector<plasticity::MohrCoulombLaw> laws;  ///< of the cells
  std::vector<bool> active, fixed, free;         ///< cells; unknowns
  std::vector<PointState> points;
  std::vector<ContactNode> contacts;
  Eigen::VectorXd displacement;
  std::vector<Vector2d> body;  ///< force on each cell now
  Eigen::VectorXd surface;     ///< of the tractions, now
  std::vector<LoadStep> steps;
  int stage = 0;
  double relaxed =
      1;  ///< t / (1 + t) of the present step of viscoplastic time; 1: rate-independent
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
      f += grid.cells[c].areas[q] * grid.cells[c].strain[q].transpose() *
           in_plane(impl_->points[c * kPoints + q].stress);
    grid.cells[c].scatter(f, forces);
  }
  Vector2d out = Vector2d::Zero();
  for (std::size_t i = 0; i < grid.unknowns(); ++i)
    if (where(grid.positions[i]))
      out[static_cast<Eigen::Index>(grid.components[i])] += forces[static_cast<Eigen::Index>(i)];
  return out;
}

}  // namespace grainfield::continuum::fe
