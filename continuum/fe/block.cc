// Hexahedra with trilinear displacements. The nodes of the boundary move as E x, with E the strain
// of the block; inside u = E x + w with w = 0 on the boundary. The unknowns are w of the nodes
// inside and those components of E whose stress is held:
//   int B^T sigma(E + B w) dV = 0,     (1/V) int sigma_aa dV = held stress,
// the second being the first tested with the strain of E_aa (Hill and Mandel). Newton's method with
// the law's exact tangent; the few unknowns are solved by a complete orthogonal decomposition,
// which gives the least change where the tangent is singular: at an edge of the yield surface with
// both lateral stresses held only their sum is determined.
#include "continuum/fe/block.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "continuum/model.h"
#include "continuum/plasticity/mohr_coulomb_space.h"

namespace grainfield::continuum::fe {
namespace {

using plasticity::Matrix6;
using plasticity::ReturnedSpace;
using plasticity::Vector6;

// Largest residual over the scale of stress at which a step has converged; iterations after which
// it is halved; a part of a path is begun with this many steps and given up below the last.
constexpr double kConverged = 1e-11;
constexpr int kIterations = 30, kFirstSteps = 8;
constexpr double kLeastStep = 1e-6;
// Pivots of the tangent below this share of the largest are rounding.
constexpr double kSingular = 1e-9;

Vector6 vector_of(const Eigen::Matrix3d& m, double shear) {
  Vector6 out;
  out << m(0, 0), m(1, 1), m(2, 2), shear * m(1, 2), shear * m(0, 2), shear * m(0, 1);
  return out;
}

Eigen::Matrix3d matrix_of(const Vector6& v, double shear) {
  Eigen::Matrix3d out;
  out << v[0], v[5] / shear, v[4] / shear, v[5] / shear, v[1], v[3] / shear, v[4] / shear,
      v[3] / shear, v[2];
  return out;
}

// A point of integration: how its strain depends on the unknowns inside, and its elastic strain.
struct Point {
  double weight = 0;               // share of the block's volume
  std::vector<Eigen::Index> rows;  // unknowns inside that it feels
  Eigen::Matrix<double, 6, Eigen::Dynamic> strain_of;
  Vector6 elastic = Vector6::Zero(), trial = Vector6::Zero();
};

class Block {
 public:
  Block(const BlockMaterial& material, const Eigen::Matrix3d& stress, int cells)
      : material_(material), hooke_(hooke()) {
    if (material.plastic) law_.emplace(material.constants);
    make_mesh(cells);
    const Vector6 start = vector_of(stress, 1);
    scale_ = std::max(start.cwiseAbs().maxCoeff(), kSmallStrain * material.constants.E);
    const Vector6 elastic =
        plasticity::elastic_strain_in_space(start, material.constants.E, material.constants.nu);
    for (Point& p : points_) p.elastic = answer(elastic).elastic_strain;
  }

  // From the present strain to `load`; true when it was found.
  bool step(const BlockLoad& load, const Vector6& strain);
  void accept(const Vector6& strain);
  BlockState state() const;
  const Vector6& strain() const { return strain_; }
  // Where the next step ends, when it has been found.
  const Vector6& reached() const { return reached_; }
  Vector6 mean_stress() const;

 private:
  // The scale of stress is at least that of this strain.
  static constexpr double kSmallStrain = 1e-6;

  Matrix6 hooke() const {
    return plasticity::hooke_in_space(material_.constants.E, material_.constants.nu);
  }
  ReturnedSpace answer(const Vector6& trial) const {
    if (law_) return plasticity::return_in_space(*law_, trial);
    ReturnedSpace out;
    out.stress = hooke_ * trial;
    out.elastic_strain = trial;
    out.tangent = hooke_;
    return out;
  }
  void make_mesh(int cells);

  BlockMaterial material_;
  std::optional<plasticity::MohrCoulombLaw> law_;  // none: elastic
  Matrix6 hooke_;
  std::vector<Point> points_;
  Eigen::Index inside_ = 0;  // unknowns of the nodes inside
  double scale_ = 1;
  Vector6 strain_ = Vector6::Zero(), reached_ = Vector6::Zero();
  Eigen::VectorXd w_, next_;  // displacement inside beside E x; of the step
};

void Block::make_mesh(int cells) {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::subdivided_hyper_cube(mesh, static_cast<unsigned>(cells));
  const dealii::FESystem<3> element(dealii::FE_Q<3>(1), 3);
  dealii::DoFHandler<3> dofs(mesh);
  dofs.distribute_dofs(element);
  const dealii::IndexSet edge = dealii::DoFTools::extract_boundary_dofs(dofs);
  std::vector<Eigen::Index> row(dofs.n_dofs(), -1);
  for (std::size_t k = 0; k < row.size(); ++k) {
    if (!edge.is_element(static_cast<unsigned>(k))) row[k] = inside_++;
  }
  const dealii::QGauss<3> quadrature(2);
  dealii::FEValues<3> values(element, quadrature,
                             dealii::update_gradients | dealii::update_JxW_values);
  std::vector<dealii::types::global_dof_index> local(element.n_dofs_per_cell());
  for (const auto& cell : dofs.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(local);
    for (const unsigned q : values.quadrature_point_indices()) {
      Point p;
      p.weight = values.JxW(q);
      for (const unsigned i : values.dof_indices()) {
        if (row[local[i]] >= 0) p.rows.push_back(row[local[i]]);
      }
      p.strain_of.resize(6, static_cast<Eigen::Index>(p.rows.size()));
      Eigen::Index column = 0;
      for (const unsigned i : values.dof_indices()) {
        if (row[local[i]] < 0) continue;
        const auto a = static_cast<int>(element.system_to_component_index(i).first);
        Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
        for (unsigned b = 0; b < 3; ++b) {
          gradient(a, static_cast<int>(b)) =
              values.shape_grad_component(i, q, static_cast<unsigned>(a))[b];
        }
        p.strain_of.col(column++) = vector_of(0.5 * (gradient + gradient.transpose()), 2);
      }
      points_.push_back(std::move(p));
    }
  }
  w_ = next_ = Eigen::VectorXd::Zero(inside_);
}

bool Block::step(const BlockLoad& load, const Vector6& wanted) {
  std::vector<int> held;
  for (int a = 0; a < 3; ++a) {
    if (load.held[static_cast<std::size_t>(a)]) held.push_back(a);
  }
  const Eigen::Index unknowns = inside_ + static_cast<Eigen::Index>(held.size());
  reached_ = wanted;
  for (const int a : held) reached_[a] = strain_[a];
  next_ = w_;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(unknowns);
    for (std::size_t h = 0; h < held.size(); ++h) {
      residual[inside_ + static_cast<Eigen::Index>(h)] = -load.stress[held[h]];
    }
    for (Point& p : points_) {
      const auto n = static_cast<Eigen::Index>(p.rows.size());
      // Its strain's dependence on all unknowns that it feels, those of E behind.
      Eigen::Matrix<double, 6, Eigen::Dynamic> of(6, n + static_cast<Eigen::Index>(held.size()));
      of.leftCols(n) = p.strain_of;
      Vector6 change = reached_ - strain_;
      std::vector<Eigen::Index> rows = p.rows;
      for (Eigen::Index k = 0; k < n; ++k) {
        const Eigen::Index r = rows[static_cast<std::size_t>(k)];
        change += p.strain_of.col(k) * (next_[r] - w_[r]);
      }
      for (std::size_t h = 0; h < held.size(); ++h) {
        of.col(n + static_cast<Eigen::Index>(h)) = Vector6::Unit(held[h]);
        rows.push_back(inside_ + static_cast<Eigen::Index>(h));
      }
      p.trial = p.elastic + change;
      const ReturnedSpace found = answer(p.trial);
      const Eigen::VectorXd force = p.weight * (of.transpose() * found.stress);
      const Eigen::MatrixXd stiffness = p.weight * (of.transpose() * found.tangent * of);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        residual[rows[i]] += force[static_cast<Eigen::Index>(i)];
        for (std::size_t j = 0; j < rows.size(); ++j) {
          matrix(rows[i], rows[j]) +=
              stiffness(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        }
      }
    }
    if (unknowns == 0 || residual.cwiseAbs().maxCoeff() <= kConverged * scale_) return true;
    if (!residual.allFinite()) return false;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
    factors.setThreshold(kSingular);
    factors.compute(matrix);
    const Eigen::VectorXd move = factors.solve(residual);
    next_ -= move.head(inside_);
    for (std::size_t h = 0; h < held.size(); ++h) {
      reached_[held[h]] -= move[inside_ + static_cast<Eigen::Index>(h)];
    }
  }
  return false;
}

void Block::accept(const Vector6& strain) {
  for (Point& p : points_) p.elastic = answer(p.trial).elastic_strain;
  strain_ = strain;
  w_ = next_;
}

Vector6 Block::mean_stress() const {
  Vector6 out = Vector6::Zero();
  for (const Point& p : points_) out += p.weight * (hooke_ * p.elastic);
  return out;
}

BlockState Block::state() const {
  BlockState out;
  out.strain = matrix_of(strain_, 2);
  out.stress = matrix_of(mean_stress(), 1);
  return out;
}

// One part of the path; halves the step that fails.
void follow(Block& block, const BlockLoad& load, std::size_t part) {
  const Vector6 from = block.strain();
  const Vector6 stress_from = block.mean_stress();
  Vector6 to = from;
  to.head<3>() = load.strain;
  to[4] = load.shear;
  double done = 0, step = 1.0 / kFirstSteps;
  while (done < 1) {
    const double share = std::min(1.0, done + step);
    BlockLoad part_load = load;
    part_load.stress =
        stress_from.head<3>() + share * (load.stress - Eigen::Vector3d(stress_from.head<3>()));
    if (block.step(part_load, from + share * (to - from))) {
      block.accept(block.reached());
      done = share;
      step = std::min(1.0 / kFirstSteps, 2 * step);
      continue;
    }
    step /= 2;
    if (step < kLeastStep) {
      throw ComputationFailed(fmt::format(
          "block of finite elements: no equilibrium beyond {:.4g} of part {} of its path; the "
          "material bears no more of the stress that is held",
          done, part + 1));
    }
  }
}

}  // namespace

std::vector<BlockState> solve_block(const BlockMaterial& material,
                                    const Eigen::Matrix3d& initial_stress,
                                    const std::vector<BlockLoad>& path, int cells) {
  if (cells < 1) {
    throw BadParameter(
        fmt::format("block of finite elements: cells = {}; allowed: at least 1", cells));
  }
  Block block(material, initial_stress, cells);
  const Eigen::Matrix3d before = block.state().stress;
  const Vector6 elastic_before = plasticity::elastic_strain_in_space(
      vector_of(before, 1), material.constants.E, material.constants.nu);
  std::vector<BlockState> out{block.state()};
  for (std::size_t k = 0; k < path.size(); ++k) {
    follow(block, path[k], k);
    BlockState& state = out.emplace_back(block.state());
    const Vector6 elastic = plasticity::elastic_strain_in_space(
        vector_of(state.stress, 1), material.constants.E, material.constants.nu);
    const Vector6 plastic = vector_of(state.strain, 2) - (elastic - elastic_before);
    state.plastic_strain = matrix_of(plastic, 2).norm();
  }
  return out;
}

}  // namespace grainfield::continuum::fe
