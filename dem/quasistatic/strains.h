// Small strains of one packing at rest, each from the same start.
//
// Where a strain changes no contact the tangent stiffness hardly changes, so its factors at the
// start serve all strains (chord method):
//   z_0 = 0,   J dz = -r(z_k),   z_(k+1) = z_k + dz,
// with the residual r of the strained packing and its derivative J at the start. The opposite of a
// strain begins with the opposite of the first dz. A strain for which this does not converge
// quickly is left to strain() (quasistatic.h), whose balance both reach.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>

#include "dem/quasistatic/contact_network.h"
#include "dem/quasistatic/linear_solver.h"
#include "dem/quasistatic/quasistatic.h"

namespace grainfield::dem {

class Strains {
 public:
  /// Strains `start`, which must be at rest to the ratio of the settings. `materials` must
  /// outlive this. Throws as strain().
  Strains(const Snapshot& start, const Materials& materials, const QuasistaticSettings& settings);

  const Snapshot& start() const { return start_; }
  /// As strain() of the start. `steps` of the result is 0 where the factors at the start served.
  /// Its bits do not depend on the strains before. Throws as strain().
  QuasistaticResult strain(const Eigen::Matrix3d& gradient,
                           const std::function<bool(double)>& go_on);

 private:
  using Vector = ContactNetwork::Vector;
  bool enough(const Vector& r) const;
  bool better(const Vector& r, Vector& dz);
  std::optional<Vector> response(const Eigen::Matrix3d& gradient);
  std::optional<QuasistaticResult> by_chords(const Eigen::Matrix3d& gradient,
                                             const std::function<bool(double)>& go_on);

  Snapshot start_;
  const Materials& materials_;
  QuasistaticSettings settings_;
  std::unique_ptr<ContactNetwork> network_;
  ContactNetwork::Matrix tangent_;
  std::unique_ptr<LinearSolver> solver_;  // none: singular
  struct Response {
    Eigen::Matrix3d gradient;
    Vector z;
  };
  std::optional<Response> last_;  // the first step of the last strain that was no opposite
};

}  // namespace grainfield::dem
