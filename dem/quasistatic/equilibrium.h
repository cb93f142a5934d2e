// The equilibrium of a contact network under its present load.
//
// Newton's method alone, or, where contacts rearrange, a flow to the next equilibrium: each grain
// is held back by a drag against its displacement (implicit Euler of overdamped motion), which
// makes every step solvable, and the drag is taken away as it succeeds. Either way it ends at the
// tolerance, or well below the ratio asked for where further steps are slow or dear, or not at all.
//
// Loose grains: in a large packing a few hang so softly that a force of the tolerance moves them
// far. What they do is not linear, and Newton's method would shorten the steps of all grains for
// them. They are settled apart: first all others while these are held, then these alone, and
// then Newton's method takes all together again.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "dem/quasistatic/contact_network.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/quasistatic/sparse_newton.h"

namespace grainfield::dem {

/// By factors, or of a large packing in space by iteration.
std::unique_ptr<LinearSolver> solver_of(const ContactNetwork& network);

class Equilibrium {
 public:
  /// Network and settings must outlive it. `go_on` is asked before every Newton solve and throws to
  /// stop; empty: never asked.
  Equilibrium(ContactNetwork& network, const QuasistaticSettings& settings,
              std::function<void()> go_on);
  Equilibrium(const Equilibrium&) = delete;
  Equilibrium& operator=(const Equilibrium&) = delete;

  /// Residuals are measured in mean contact forces, or in mean resultants while those are larger.
  /// No drag is left.
  void rescale();
  /// By Newton's method alone (`at_once`; loose grains with drag all the same) or with drag where
  /// it is needed. Commits what it reaches; false: it came to no rest.
  bool settle(bool at_once);

  int steps() const { return steps_; }
  int iterations() const { return iterations_; }
  /// How often loose grains have been settled apart.
  int times_apart() const { return times_apart_; }

 private:
  double tolerance() const;
  void reset_drag();
  bool enough(const Eigen::VectorXd& r) const;
  void brake(const Eigen::VectorXd& z);
  std::vector<int> loose_in(const Eigen::VectorXd& step) const;
  bool settle_apart();
  bool settle_part(ContactNetwork& part, Equilibrium& of_part, bool at_once);

  ContactNetwork& network_;
  const QuasistaticSettings& settings_;
  std::function<void()> go_on_;
  bool large_ = false;  // equations are solved by iteration
  std::unique_ptr<LinearSolver> solver_;
  /// What is done about loose grains: a large packing settles them apart. Of its bulk, in which
  /// those that are known are held, further ones are only reported.
  enum class Loose { ignored, reported, apart } about_loose_ = Loose::ignored;
  std::vector<int> loose_;  // numbers of free grains, ascending
  SparseProblem problem_;
  Eigen::VectorXd drag_, unit_;  // share of the contacts' stiffness, and that stiffness
  int steps_ = 0, iterations_ = 0, times_apart_ = 0;
};

}  // namespace grainfield::dem
