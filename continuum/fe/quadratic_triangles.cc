#include "continuum/fe/quadratic_triangles.h"

#include <deal.II/base/quadrature.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/tria.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "continuum/fe/nested_factors.h"

namespace grainfield::continuum::fe {
namespace {

using Eigen::Vector2d;

/// A solution is refined until this share of the right side is left, at most so often: single
/// precision gives six digits at once. Where it does not come so far the factors are of double
/// precision.
constexpr double kRefined = 1e-10;
constexpr int kRefinements = 6;

dealii::Triangulation<2>& build(dealii::Triangulation<2>& out, const TriangleMesh& mesh) {
  std::vector<dealii::Point<2>> vertices;
  for (const auto& v : mesh.vertices) vertices.emplace_back(v[0], v[1]);
  std::vector<dealii::CellData<2>> cells;
  for (const auto& t : mesh.triangles) {
    dealii::CellData<2> cell(3);
    for (std::size_t k = 0; k < 3; ++k) cell.vertices[k] = static_cast<unsigned int>(t[k]);
    cells.push_back(cell);
  }
  out.create_triangulation(vertices, cells, dealii::SubCellData());
  return out;
}

}  // namespace

struct QuadraticTriangles::Impl {
  explicit Impl(const TriangleMesh& triangles)
      : element(dealii::FE_SimplexP<2>(2), 2), dofs(build(mesh, triangles)) {
    dofs.distribute_dofs(element);
  }

  dealii::Triangulation<2> mesh;
  dealii::FESystem<2> element;
  dealii::DoFHandler<2> dofs;
  std::vector<double> matrices;  // of the cells, by rows
  std::vector<NestedEntry> entries;
  std::optional<NestedFactors<float>> factors;
  std::optional<NestedFactors<double>> exact;
  bool single = true;  // which of them hold the matrix
};

CellVector QuadraticCell::gather(const Eigen::VectorXd& u) const {
  CellVector out;
  for (std::size_t i = 0; i < kUnknowns; ++i) out[static_cast<int>(i)] = u[unknowns[i]];
  return out;
}

void QuadraticCell::scatter(const CellVector& f, Eigen::VectorXd& out) const {
  for (std::size_t i = 0; i < kUnknowns; ++i) out[unknowns[i]] += f[static_cast<int>(i)];
}

QuadraticTriangles::QuadraticTriangles(const TriangleMesh& mesh, bool revolution)
    : impl_(std::make_unique<Impl>(mesh)), revolution_(revolution) {
  const auto& element = impl_->element;
  const auto& dofs = impl_->dofs;
  positions.resize(dofs.n_dofs());
  components.resize(dofs.n_dofs());
  corner_unknowns.resize(mesh.vertices.size());
  const dealii::Quadrature<2> rule({{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}},
                                   std::vector<double>(kPoints, 1. / 6));
  const dealii::MappingFE<2> mapping{dealii::FE_SimplexP<2>(1)};
  dealii::FEValues<2> values(mapping, element, rule,
                             dealii::update_values | dealii::update_gradients |
                                 dealii::update_quadrature_points | dealii::update_JxW_values);
  const dealii::Quadrature<2> nodes(element.base_element(0).get_unit_support_points());
  dealii::FEValues<2> at_nodes(mapping, element, nodes, dealii::update_quadrature_points);
  std::vector<dealii::types::global_dof_index> indices(kUnknowns), on_edge(kNodes);
  for (const auto& cell : dofs.active_cell_iterators()) {
    values.reinit(cell);
    at_nodes.reinit(cell);
    cell->get_dof_indices(indices);
    QuadraticCell& out = cells.emplace_back();
    out.weight.setZero();
    for (unsigned int q = 0; q < kPoints; ++q) {
      const auto& p = values.quadrature_point(q);
      out.points[q] = {p[0], p[1]};
      out.areas[q] = values.JxW(q) * (revolution ? 2 * std::numbers::pi * p[0] : 1);
      out.hoop[q].setZero();
    }
    for (unsigned int i = 0; i < kUnknowns; ++i) {
      const auto [component, node] = element.system_to_component_index(i);
      const auto& p = at_nodes.quadrature_point(node);
      out.unknowns[i] = static_cast<unsigned int>(indices[i]);
      positions[indices[i]] = {p[0], p[1]};
      components[indices[i]] = component;
      for (unsigned int q = 0; q < kPoints; ++q) {
        const auto gradient = values.shape_grad(i, q);
        auto& b = out.strain[q];
        b(0, i) = component == 0 ? gradient[0] : 0;
        b(1, i) = component == 1 ? gradient[1] : 0;
        b(2, i) = component == 0 ? gradient[1] : gradient[0];
        out.weight(i, component) += values.shape_value(i, q) * out.areas[q];
        if (revolution && component == 0) {
          out.hoop[q][i] = values.shape_value(i, q) / out.points[q][0];
        }
      }
    }
    for (unsigned int v = 0; v < 3; ++v) {
      out.corners[v] = static_cast<int>(cell->vertex_index(v));
      for (unsigned int d = 0; d < 2; ++d)
        corner_unknowns[cell->vertex_index(v)][d] =
            static_cast<unsigned int>(cell->vertex_dof_index(v, d));
    }
    for (const unsigned int f : cell->face_indices()) {
      const auto face = cell->face(f);
      if (!face->at_boundary()) continue;
      face->get_dof_indices(on_edge);
      BoundaryEdge& edge = edges.emplace_back();
      for (unsigned int node = 0; node < 3; ++node)
        for (unsigned int d = 0; d < 2; ++d)
          edge.unknowns[node][d] = static_cast<unsigned int>(on_edge[2 * node + d]);
      edge.middle = {face->center()[0], face->center()[1]};
      edge.length = face->measure();
    }
  }
}

QuadraticTriangles::~QuadraticTriangles() = default;

double QuadraticTriangles::share(const BoundaryEdge& edge, std::size_t node) const {
  const double part = edge.length * (node < 2 ? 1. / 6 : 4. / 6);
  return revolution_ ? 2 * std::numbers::pi * positions[edge.unknowns[node][0]][0] * part : part;
}

void QuadraticTriangles::clear_matrix() {
  impl_->matrices.assign(cells.size() * kUnknowns * kUnknowns, 0);
  impl_->entries.clear();
}

void QuadraticTriangles::add(const QuadraticCell& cell, const CellMatrix& values,
                             const std::vector<bool>& free) {
  double* matrix = impl_->matrices.data() +
                   static_cast<std::size_t>(&cell - cells.data()) * kUnknowns * kUnknowns;
  for (std::size_t i = 0; i < kUnknowns; ++i)
    for (std::size_t j = 0; j < kUnknowns; ++j, ++matrix)
      if (free[cell.unknowns[i]] && free[cell.unknowns[j]])
        *matrix += values(static_cast<int>(i), static_cast<int>(j));
}

void QuadraticTriangles::add(unsigned int row, unsigned int column, double value) {
  impl_->entries.push_back({row, column, value});
}

template <typename Scalar>
NestedFactors<Scalar> QuadraticTriangles::dissect() const {
  std::vector<std::vector<unsigned int>> unknowns_of;
  std::vector<Vector2d> centres;
  Vector2d extents = Vector2d::Zero();
  for (const QuadraticCell& cell : cells) {
    unknowns_of.emplace_back(cell.unknowns.begin(), cell.unknowns.end());
    centres.push_back((cell.points[0] + cell.points[1] + cell.points[2]) / 3);
    Vector2d low = cell.points[0], high = low;
    for (const Vector2d& p : cell.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    extents += high - low;
  }
  for (Vector2d& centre : centres) centre = centre.cwiseQuotient(extents);
  return {std::move(unknowns_of), std::move(centres), unknowns()};
}

bool QuadraticTriangles::factorize_exactly() const {
  if (!impl_->exact) impl_->exact.emplace(dissect<double>());
  impl_->single = false;
  return impl_->exact->factorize(impl_->matrices, impl_->entries);
}

bool QuadraticTriangles::factorize() {
  if (!impl_->factors) impl_->factors.emplace(dissect<float>());
  impl_->single = impl_->factors->factorize(impl_->matrices, impl_->entries);
  return impl_->single || factorize_exactly();
}

void QuadraticTriangles::solve(Eigen::VectorXd& x) const {
  const Eigen::VectorXd right = x;
  x.setZero();
  Eigen::VectorXd left = right, better = x;
  double before = left.norm();
  if (!std::isfinite(before)) {
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  const double aim = kRefined * before;
  for (int k = 0; k <= kRefinements && before > aim; ++k) {
    if (impl_->single)
      impl_->factors->solve(left);
    else
      impl_->exact->solve(left);
    better = x + left;
    left = right - product(better);
    const double size = left.norm();
    // Not a number, or hardly better than before: these factors give no more. There are none better
    // than those of double precision.
    if (!(size < before / 2) && (k > 0 || impl_->single)) break;
    before = size;
    x = better;
  }
  if (before <= aim || !impl_->single) return;
  if (!factorize_exactly()) {
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  x = right;
  solve(x);
}

Eigen::VectorXd QuadraticTriangles::product(const Eigen::VectorXd& x) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(x.size());
  const double* matrix = impl_->matrices.data();
  for (const QuadraticCell& cell : cells) {
    cell.scatter(Eigen::Map<const CellMatrix>(matrix) * cell.gather(x), out);
    matrix += kUnknowns * kUnknowns;
  }
  for (const auto& entry : impl_->entries) out[entry.row] += entry.value * x[entry.column];
  return out;
}

TriangleMesh triangle_lattice(const Vector2d& left, const Vector2d& right, const Vector2d& apex,
                              int n) {
  TriangleMesh out;
  const auto index = [n](int r, int i) { return r * (n + 1) - r * (r - 1) / 2 + i; };
  for (int r = 0; r <= n; ++r)
    for (int i = 0; i + r <= n; ++i)
      out.vertices.push_back((left * (n - i - r) + right * i + apex * r) / n);
  for (int r = 0; r < n; ++r) {
    for (int i = 0; i + r < n; ++i) {
      out.triangles.push_back({index(r, i), index(r, i + 1), index(r + 1, i)});
      if (i + r + 1 < n)
        out.triangles.push_back({index(r, i + 1), index(r + 1, i + 1), index(r + 1, i)});
    }
  }
  return out;
}

}  // namespace grainfield::continuum::fe
