// What the models that own an elastic solver share: when it is made, figures, mirrored halves.
// Internal to fe/: needs deal.II.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "continuum/fe/elastic_solver.h"
#include "continuum/fe/parallel.h"
#include "continuum/model.h"

namespace grainfield::continuum::fe {

/// Share of the error indicator whose cells are refined in a cycle.
inline constexpr double kRefinedShare = 0.8;

/// Sign of a stored stress component at a point that was mirrored into the meshed part, where no
/// horizontal coordinate is below 0: each horizontal index of a mirrored direction flips it.
template <int dim, typename Point>
double mirror_sign(const Point& point, int component) {
  const auto [a, b] = stress_components<dim>()[static_cast<std::size_t>(component)];
  double sign = 1;
  if (a == b) return sign;
  for (const int axis : {a, b})
    if (axis < dim - 1 && point(axis) < 0) sign = -sign;
  return sign;
}

template <int dim>
class SolvedModel : public Model {
 public:
  SolvedModel(std::string name, int degree, int iterations)
      : degree_(degree), iterations_(iterations), name_(std::move(name)) {}

  /// The solver's, and the model's own where both have one of a name.
  std::map<std::string, double> figures() const override {
    auto all = figures_;
    if (solver_) all.insert(solver_->figures().begin(), solver_->figures().end());
    return all;
  }

 protected:
  /// The first time: makes the solver, with which `work` meshes and solves. None is kept of a
  /// failure.
  template <typename Work>
  void solve_once(const Work& work) {
    if (solver_) return;
    solver_ =
        std::make_unique<ElasticSolver<dim>>(communicator(ranks_), degree_, iterations_, name_);
    try {
      work();
    } catch (...) {
      solver_.reset();
      throw;
    }
  }

  int degree_, iterations_;
  std::string name_;
  std::unique_ptr<ElasticSolver<dim>> solver_;
  std::map<std::string, double> figures_;

 private:
  Ranks ranks_ = chosen_ranks();
};

}  // namespace grainfield::continuum::fe
