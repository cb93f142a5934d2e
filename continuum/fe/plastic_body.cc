#include "continuum/fe/plastic_body.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace grainfield::continuum::fe {
namespace {

using Eigen::Vector2d;
using plasticity::Matrix4;
using plasticity::Regime;
using plasticity::Returned;
using plasticity::Vector4;

/// xx, yy, zz, xy of a strain in the plane.
Vector4 in_space(const Eigen::Vector3d& e) { return {e[0], e[1], 0, e[2]}; }
Eigen::Matrix3d in_plane(const Matrix4& m) {
  Eigen::Matrix3d out;
  out << m(0, 0), m(0, 1), m(0, 3), m(1, 0), m(1, 1), m(1, 3), m(3, 0), m(3, 1), m(3, 3);
  return out;
}

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

PlasticBody::PlasticBody(const TriangleMesh& mesh, const PlasticSolver::Material& material,
                         const PlasticSolver::Supports& supports, const Ground& ground_,
                         PlasticSettings settings_)
    : settings(std::move(settings_)), ground(ground_), grid(mesh, settings.revolution) {
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

Eigen::VectorXd PlasticBody::zeros() const {
  return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid.unknowns()));
}

void PlasticBody::find_supports(const PlasticSolver::Supports& supports) {
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
      contacts[found->second].length += grid.share(edge, node);
    }
  }
}

void PlasticBody::find_free() {
  free.assign(grid.unknowns(), false);
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    if (active[c])
      for (const unsigned int i : grid.cells[c].unknowns) free[i] = true;
  for (ContactNode& node : contacts) node.active = free[node.unknowns[0]];
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = free[i] && !fixed[i];
}

Eigen::VectorXd PlasticBody::forces_of(const PlasticSolver::Traction& traction) const {
  Eigen::VectorXd out = zeros();
  for (const BoundaryEdge& edge : grid.edges) {
    const Vector2d pressure = traction(edge.middle);
    for (std::size_t node = 0; node < 3; ++node)
      for (std::size_t d = 0; d < 2; ++d)
        out[edge.unknowns[node][d]] +=
            pressure[static_cast<Eigen::Index>(d)] * grid.share(edge, node);
  }
  return out;
}

Eigen::VectorXd PlasticBody::forces_of(const std::vector<Vector2d>& force) const {
  Eigen::VectorXd out = zeros();
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    if (active[c]) grid.cells[c].scatter(grid.cells[c].weight * force[c], out);
  return out;
}

Vector4 PlasticBody::trial(std::size_t c, std::size_t q, const CellVector& u) const {
  const QuadraticCell& cell = grid.cells[c];
  Vector4 out = points[c * kPoints + q].elastic_strain + in_space(cell.strain[q] * u);
  if (settings.revolution) out[2] += cell.hoop[q].dot(u);
  return out;
}

CellVector PlasticBody::forces_of(std::size_t c, std::size_t q, const Vector4& stress) const {
  const QuadraticCell& cell = grid.cells[c];
  CellVector out = cell.areas[q] * cell.strain[q].transpose() * in_plane(stress);
  if (settings.revolution) out += cell.areas[q] * stress[2] * cell.hoop[q].transpose();
  return out;
}

CellMatrix PlasticBody::stiffness_of(std::size_t c, std::size_t q, const Matrix4& tangent) const {
  const QuadraticCell& cell = grid.cells[c];
  if (!settings.revolution) {
    return cell.areas[q] * cell.strain[q].transpose() * in_plane(tangent) * cell.strain[q];
  }
  Eigen::Matrix<double, 4, kUnknowns> strain;
  strain << cell.strain[q].topRows<2>(), cell.hoop[q], cell.strain[q].row(2);
  return cell.areas[q] * strain.transpose() * tangent * strain;
}

Returned PlasticBody::update(std::size_t c, std::size_t q, const CellVector& u) const {
  const Vector4 trial = this->trial(c, q, u);
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

Eigen::VectorXd PlasticBody::internal(const Eigen::VectorXd& u) const {
  Eigen::VectorXd out = zeros();
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    if (!active[c]) continue;
    const QuadraticCell& cell = grid.cells[c];
    const CellVector local = cell.gather(u);
    CellVector f = CellVector::Zero();
    for (std::size_t q = 0; q < kPoints; ++q) f += forces_of(c, q, update(c, q, local).stress);
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

bool PlasticBody::factorize(const Eigen::VectorXd& u, bool elastic) {
  grid.clear_matrix();
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    if (!active[c]) continue;
    const QuadraticCell& cell = grid.cells[c];
    const CellVector local = cell.gather(u);
    CellMatrix k = CellMatrix::Zero();
    for (std::size_t q = 0; q < kPoints; ++q) {
      Matrix4 tangent = laws[c].elasticity();
      if (!elastic) tangent = update(c, q, local).tangent + settings.tangent_floor * tangent;
      k += stiffness_of(c, q, tangent);
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

void PlasticBody::clear_held(Eigen::VectorXd& x) const {
  for (std::size_t i = 0; i < free.size(); ++i)
    if (!free[i]) x[static_cast<Eigen::Index>(i)] = 0;
}

void PlasticBody::elastic_guess(const Eigen::VectorXd& target, Eigen::VectorXd& u) {
  if (!factorize(zeros(), true)) return;
  Eigen::VectorXd r = target - internal(zeros());
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    if (!active[c]) continue;
    const QuadraticCell& cell = grid.cells[c];
    const CellVector local = cell.gather(u);
    CellVector f = CellVector::Zero();
    for (std::size_t q = 0; q < kPoints; ++q) f -= stiffness_of(c, q, laws[c].elasticity()) * local;
    cell.scatter(f, r);
  }
  clear_held(r);
  grid.solve(r);
  clear_held(r);
  u += r;
}

void PlasticBody::accept(const Eigen::VectorXd& u) {
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    if (!active[c]) continue;
    const CellVector local = grid.cells[c].gather(u);
    for (std::size_t q = 0; q < kPoints; ++q) {
      const Returned r = update(c, q, local);
      PointState& p = points[c * kPoints + q];
      if (r.regime != Regime::elastic) {
        Vector4 plastic = trial(c, q, local) - r.elastic_strain;
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

double PlasticBody::overstress() const {
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

}  // namespace grainfield::continuum::fe
