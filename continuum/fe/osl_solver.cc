#include "continuum/fe/osl_solver.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/tria.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <chrono>
#include <cmath>

#include "continuum/model.h"
#include "continuum/osl/flux.h"

namespace grainfield::continuum::fe {
namespace {

using osl::Characteristics;
using osl::Flux;
using osl::State;
using Block = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Cell = dealii::Triangulation<2>::active_cell_iterator;

/// A row's residual, over its right side, above which elimination without pivoting between blocks
/// has failed.
constexpr double kResidual = 1e-9;
/// Points that miss the mesh by less than this part of it are on its border.
constexpr double kOnBorder = 1e-9;
/// Gauss points per direction beyond the order: coefficients vary within a cell.
constexpr int kExtraPoints = 2;
/// On the surface: a load over two or more columns is integrated to round-off.
constexpr int kSurfacePoints = 12;

/// deal.II's numbers of a quadrilateral's faces.
enum Face { left = 0, right = 1, up = 2, down = 3 };

/// One cell's equations: coupling to the columns on its left and right, right side.
struct CellSystem {
  Block diagonal, to_left, to_right;
  Vector rhs;
};

}  // namespace

struct OslSolver::Parts {
  osl::Problem problem;
  osl::StripMesh mesh;
  dealii::FE_DGQ<2> element;
  dealii::MappingQ1<2> mapping;
  dealii::Triangulation<2> grid;
  dealii::QGauss<2> points;
  dealii::QGauss<1> face_points;
  dealii::FEValues<2> values;
  dealii::FEFaceValues<2> face_values, beyond_values, surface_values;
  std::vector<Cell> cells;
  int n;                                    ///< shape functions of one component
  Eigen::MatrixXd u;                        ///< column per cell: n coefficients of syy, n of sxy
  double total_weight = 0, total_load = 0;  ///< vertical, what the right sides hold
  std::map<std::string, double> figures;

  Parts(osl::Problem p, osl::StripMesh m, int order)
      : problem(std::move(p)),
        mesh(std::move(m)),
        element(order),
        points(order + kExtraPoints),
        face_points(order + kExtraPoints),
        values(mapping, element, points,
               dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
                   dealii::update_quadrature_points),
        face_values(mapping, element, face_points,
                    dealii::update_values | dealii::update_JxW_values |
                        dealii::update_normal_vectors | dealii::update_quadrature_points),
        beyond_values(mapping, element, face_points, dealii::update_values),
        surface_values(mapping, element, dealii::QGauss<1>(kSurfacePoints),
                       dealii::update_values | dealii::update_JxW_values |
                           dealii::update_normal_vectors | dealii::update_quadrature_points),
        n(static_cast<int>(element.n_dofs_per_cell())) {
    make_grid();
  }

  void make_grid() {
    const int nx = mesh.columns_count(), ny = mesh.rows_count();
    std::vector<dealii::Point<2>> nodes;
    for (const double depth : mesh.rows)
      for (const double column : mesh.columns) nodes.emplace_back(mesh.x(column, depth), depth);
    std::vector<dealii::CellData<2>> quads;
    for (int row = 0; row < ny; ++row) {
      for (int column = 0; column < nx; ++column) {
        const auto first = static_cast<unsigned>(row * (nx + 1) + column);
        const auto below = first + static_cast<unsigned>(nx + 1);
        quads.emplace_back();
        quads.back().vertices = {first, first + 1, below, below + 1};
      }
    }
    grid.create_triangulation(nodes, quads, dealii::SubCellData());
    cells.resize(grid.n_active_cells());
    for (const auto& cell : grid.active_cell_iterators()) cells[cell->active_cell_index()] = cell;
  }

  int columns() const { return mesh.columns_count(); }
  int side_of(int column) const {
    return mesh.columns[column] + mesh.columns[column + 1] < 0 ? -1 : 1;
  }
  bool axis_right_of(int column) const {
    return problem.mirrored && column + 1 < columns() && mesh.columns[column + 1] == 0;
  }

  void cell_terms(int column, CellSystem& out) {
    out.diagonal = Block::Zero(2 * n, 2 * n);
    out.to_left.resize(0, 0);
    out.to_right.resize(0, 0);
    out.rhs = Vector::Zero(2 * n);
    for (unsigned q = 0; q < values.n_quadrature_points; ++q) {
      const auto& at = values.quadrature_point(q);
      const Characteristics c = osl::characteristics(problem, at[0], at[1], side_of(column));
      const double weight = problem.weight(at[0], at[1]);
      const double push = problem.side_force ? problem.side_force(at[0], at[1]) : 0;
      total_weight += weight * values.JxW(q);
      for (int i = 0; i < n; ++i) {
        const double test = values.shape_value(i, q) * values.JxW(q);
        const auto slope = values.shape_grad(i, q) * values.JxW(q);
        out.rhs[i] += weight * test;
        out.rhs[n + i] += push * test;
        for (int j = 0; j < n; ++j) {
          const double trial = values.shape_value(j, q);
          // -(u . dt/dy + A u . dt/dx)
          out.diagonal(i, j) -= trial * slope[1];
          out.diagonal(i, n + j) -= trial * slope[0];
          out.diagonal(n + i, j) -= trial * slope[0] * c.eta;
          out.diagonal(n + i, n + j) -= trial * (slope[1] + slope[0] * c.mu);
        }
      }
    }
  }

  /// Adds matrix * (trial function j of `trials`) tested on this cell's face.
  void couple(const osl::Matrix& matrix, const dealii::FEFaceValues<2>& trials, unsigned q,
              Block& block) const {
    for (int i = 0; i < n; ++i) {
      const double test = face_values.shape_value(i, q) * face_values.JxW(q);
      if (test == 0) continue;
      for (int j = 0; j < n; ++j) {
        const double product = test * trials.shape_value(j, q);
        block(i, j) += matrix(0, 0) * product;
        block(i, n + j) += matrix(0, 1) * product;
        block(n + i, j) += matrix(1, 0) * product;
        block(n + i, n + j) += matrix(1, 1) * product;
      }
    }
  }

  /// A known outward flux.
  void known(const State& flux, const dealii::FEFaceValues<2>& face, unsigned q,
             Vector& rhs) const {
    for (int i = 0; i < n; ++i) {
      const double test = face.shape_value(i, q) * face.JxW(q);
      rhs[i] -= flux[0] * test;
      rhs[n + i] -= flux[1] * test;
    }
  }

  State on_face(const dealii::FEFaceValues<2>& trials, unsigned q, int cell) const {
    State state = State::Zero();
    for (int j = 0; j < n; ++j)
      state += trials.shape_value(j, q) * State(u(j, cell), u(n + j, cell));
    return state;
  }

  /// The surface, a layer's top or a heap's slopes: both characteristics must enter there.
  void surface_terms(int face, int index, int column, CellSystem& out) {
    surface_values.reinit(cells[index], face);
    for (unsigned q = 0; q < surface_values.n_quadrature_points; ++q) {
      const auto& at = surface_values.quadrature_point(q);
      const auto& normal = surface_values.normal_vector(q);
      const Characteristics c = osl::characteristics(problem, at[0], at[1], side_of(column));
      const Flux flux = osl::upwind_flux(c, normal[0], normal[1]);
      if (mesh.spread > 0) osl::require_entering(problem, c, flux, mesh.spread, at[0], at[1]);
      if (!problem.surface) continue;
      const State entering = flux.other * problem.surface(at[0], at[1]);
      total_load -= entering[0] * surface_values.JxW(q);
      known(entering, surface_values, q, out.rhs);
    }
  }

  void side_term(int face, int column, unsigned q, CellSystem& out) {
    const auto& at = face_values.quadrature_point(q);
    const int sign = face == Face::left ? -1 : 1;
    const Characteristics c = osl::characteristics(problem, at[0], at[1], side_of(column));
    if (problem.sides == osl::Sides::walls) {
      couple(osl::wall_flux(c, problem.wall_friction, sign).own, face_values, q, out.diagonal);
      return;
    }
    const Flux flux = osl::upwind_flux(c, sign, 0);
    couple(flux.own, face_values, q, out.diagonal);
    if (problem.beyond) known(flux.other * problem.beyond(at[0], at[1]), face_values, q, out.rhs);
  }

  void inner_side_term(int face, int column, unsigned q, CellSystem& out) {
    const auto& at = face_values.quadrature_point(q);
    const auto& normal = face_values.normal_vector(q);
    Flux flux;
    if (axis_right_of(face == Face::left ? column - 1 : column)) {
      const Flux through = osl::axis_flux(osl::characteristics(problem, at[0], at[1], -1),
                                          osl::characteristics(problem, at[0], at[1], 1));
      flux = face == Face::right ? through : Flux{-through.other, -through.own};
    } else {
      flux = osl::upwind_flux(osl::characteristics(problem, at[0], at[1], side_of(column)),
                              normal[0], normal[1]);
    }
    couple(flux.own, face_values, q, out.diagonal);
    if (flux.other.isZero(0)) return;
    Block& block = face == Face::left ? out.to_left : out.to_right;
    if (block.size() == 0) block = Block::Zero(2 * n, 2 * n);
    couple(flux.other, beyond_values, q, block);
  }

  void assemble(int row, int column, CellSystem& out) {
    const int index = row * columns() + column;
    values.reinit(cells[index]);
    cell_terms(column, out);
    for (const int face : {Face::left, Face::right, Face::up, Face::down}) {
      const bool border = cells[index]->at_boundary(face), side = face < Face::up;
      // All rays meet in the apex.
      if (face == Face::up && border && mesh.spread > 0) continue;
      if (border && (face == Face::up || (side && mesh.spread > 0))) {
        surface_terms(face, index, column, out);
        continue;
      }
      face_values.reinit(cells[index], face);
      if (!border && face != Face::down)
        beyond_values.reinit(cells[index]->neighbor(face),
                             cells[index]->neighbor_of_neighbor(face));
      for (unsigned q = 0; q < face_values.n_quadrature_points; ++q) {
        if (face == Face::down)
          couple(osl::Matrix::Identity(), face_values, q, out.diagonal);
        else if (face == Face::up)
          known(-on_face(beyond_values, q, index - columns()), face_values, q, out.rhs);
        else if (border)
          side_term(face, column, q, out);
        else
          inner_side_term(face, column, q, out);
      }
    }
  }

  /// Block elimination from left to right and back.
  void solve_row(int row) {
    const int nx = columns();
    std::vector<CellSystem> systems(nx);
    std::vector<Eigen::PartialPivLU<Block>> factors;
    std::vector<Block> carried(nx);  // inverse(diagonal) * to_right
    std::vector<Vector> x(nx);
    factors.reserve(nx);
    for (int i = 0; i < nx; ++i) {
      assemble(row, i, systems[i]);
      const CellSystem& s = systems[i];
      const bool from_left = i > 0 && s.to_left.size() > 0;
      Block diagonal = s.diagonal;
      if (from_left && carried[i - 1].size() > 0) diagonal -= s.to_left * carried[i - 1];
      factors.emplace_back(diagonal);
      x[i] = factors[i].solve(from_left ? Vector(s.rhs - s.to_left * x[i - 1]) : s.rhs);
      if (s.to_right.size() > 0) carried[i] = factors[i].solve(s.to_right);
    }
    for (int i = nx - 2; i >= 0; --i)
      if (carried[i].size() > 0) x[i] -= carried[i] * x[i + 1];
    double off = 0, size = 0;
    for (int i = 0; i < nx; ++i) {
      const CellSystem& s = systems[i];
      Vector rest = s.diagonal * x[i] - s.rhs;
      if (i > 0 && s.to_left.size() > 0) rest += s.to_left * x[i - 1];
      if (i + 1 < nx && s.to_right.size() > 0) rest += s.to_right * x[i + 1];
      off += rest.squaredNorm();
      size += (s.diagonal * x[i]).squaredNorm() + s.rhs.squaredNorm();
      u.col(row * nx + i) = x[i];
    }
    const double residual = off == 0 ? 0 : std::sqrt(off / size);
    if (!(residual <= kResidual))
      throw ComputationFailed(fmt::format(
          "model {}: the row at depth {:.6g} to {:.6g} was left with a residual of {:.2g} (at most "
          "{:.0e}); lower order, or choose columns and rows so that cells are less slender",
          problem.name, mesh.rows[row], mesh.rows[row + 1], residual, kResidual));
    figures["residual"] = std::max(figures["residual"], residual);
  }

  /// Vertical force through base and sides.
  void measure_forces() {
    figures["weight"] = total_weight;
    figures["load"] = total_load;
    const int last = (mesh.rows_count() - 1) * columns();
    for (int i = 0; i < columns(); ++i) {
      face_values.reinit(cells[last + i], Face::down);
      for (unsigned q = 0; q < face_values.n_quadrature_points; ++q)
        figures["base_force"] += on_face(face_values, q, last + i)[0] * face_values.JxW(q);
    }
    if (mesh.spread == 0) {
      for (int row = 0; row < mesh.rows_count(); ++row) {
        for (const int face : {Face::left, Face::right}) {
          const int column = face == Face::left ? 0 : columns() - 1,
                    sign = face == Face::left ? -1 : 1;
          face_values.reinit(cells[row * columns() + column], face);
          for (unsigned q = 0; q < face_values.n_quadrature_points; ++q) {
            const auto& at = face_values.quadrature_point(q);
            const auto c = osl::characteristics(problem, at[0], at[1], side_of(column));
            const State inside = on_face(face_values, q, row * columns() + column);
            State through;
            if (problem.sides == osl::Sides::walls) {
              through = osl::wall_flux(c, problem.wall_friction, sign).own * inside;
            } else {
              const Flux flux = osl::upwind_flux(c, sign, 0);
              through = flux.own * inside;
              if (problem.beyond) through += flux.other * problem.beyond(at[0], at[1]);
            }
            figures["side_force"] += through[0] * face_values.JxW(q);
          }
        }
      }
    }
    const double largest =
        std::max({std::abs(figures["weight"]), std::abs(figures["load"]),
                  std::abs(figures["base_force"]), std::numeric_limits<double>::min()});
    figures["force_balance"] = std::abs(figures["base_force"] + figures["side_force"] -
                                        figures["weight"] - figures["load"]) /
                               largest;
  }
};

OslSolver::OslSolver(osl::Problem problem, osl::StripMesh mesh, int order) {
  osl::check_mesh(problem, mesh);
  if (order < 0 || order > kMostOrder)
    throw BadParameter(fmt::format("model {}: order = {} is out of range; allowed: 0 to {}",
                                   problem.name, order, kMostOrder));
  parts_ = std::make_unique<Parts>(std::move(problem), std::move(mesh), order);
}

OslSolver::~OslSolver() = default;

const std::map<std::string, double>& OslSolver::figures() const { return parts_->figures; }

void OslSolver::solve() {
  Parts& p = *parts_;
  const auto start = std::chrono::steady_clock::now();
  p.total_weight = p.total_load = 0;
  p.figures = {{"base_force", 0},
               {"side_force", 0},
               {"residual", 0},
               {"cells", static_cast<double>(p.cells.size())}};
  p.figures["unknowns"] = p.figures["cells"] * 2 * p.n;
  p.u = Eigen::MatrixXd::Zero(2 * p.n, static_cast<Eigen::Index>(p.cells.size()));
  for (int row = 0; row < p.mesh.rows_count(); ++row) p.solve_row(row);
  p.measure_forces();
  p.figures["solve_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

State OslSolver::at(double x, double depth) const {
  const Parts& p = *parts_;
  const State outside = State::Constant(std::numeric_limits<double>::quiet_NaN());
  const auto& rows = p.mesh.rows;
  const auto& columns = p.mesh.columns;
  const double tall = rows.back() * kOnBorder;
  if (!(depth >= -tall && depth <= rows.back() + tall)) return outside;
  const double y = std::clamp(depth, 0., rows.back());
  // The apex itself: no weight above it.
  if (p.mesh.spread > 0 && !(y > 0)) return std::abs(x) <= tall ? State(State::Zero()) : outside;
  const double wide = (columns.back() - columns.front()) * kOnBorder;
  double s = p.mesh.column(x, y);
  if (!(s >= columns.front() - wide && s <= columns.back() + wide)) return outside;
  s = std::clamp(s, columns.front(), columns.back());
  const auto cell_of = [](const std::vector<double>& borders, double value) {
    const auto above = std::upper_bound(borders.begin() + 1, borders.end() - 1, value);
    return static_cast<int>(above - borders.begin()) - 1;
  };
  const int column = cell_of(columns, s), row = cell_of(rows, y);
  const dealii::Point<2> unit((s - columns[column]) / (columns[column + 1] - columns[column]),
                              (y - rows[row]) / (rows[row + 1] - rows[row]));
  State out = State::Zero();
  const int cell = row * p.columns() + column;
  for (int j = 0; j < p.n; ++j)
    out += p.element.shape_value(j, unit) * State(p.u(j, cell), p.u(p.n + j, cell));
  return out;
}

Eigen::Vector2d OslSolver::errors(const osl::StateField& exact) const {
  Parts& p = *parts_;
  const dealii::QGauss<2> fine(p.element.degree + 4);
  dealii::FEValues<2> values(
      p.mapping, p.element, fine,
      dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t cell = 0; cell < p.cells.size(); ++cell) {
    values.reinit(p.cells[cell]);
    for (unsigned q = 0; q < fine.size(); ++q) {
      const auto& at = values.quadrature_point(q);
      State off = -exact(at[0], at[1]);
      for (int j = 0; j < p.n; ++j)
        off += values.shape_value(j, q) * State(p.u(j, static_cast<Eigen::Index>(cell)),
                                                p.u(p.n + j, static_cast<Eigen::Index>(cell)));
      sum += off.cwiseAbs2() * values.JxW(q);
    }
  }
  return sum.cwiseSqrt();
}

}  // namespace grainfield::continuum::fe
