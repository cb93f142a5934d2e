// How models of a layer under a point load are seen: through the kernel in the plane, through its
// marginal on the base. Lengths in units of h, stresses of F/h; load at (0, 0), y up, base y = -1.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "continuum/closed/orthotropic_layer.h"
#include "coupling/averaging/kernel.h"
#include "coupling/models/observation_operator.h"
#include "coupling/observe/data.h"

namespace grainfield::coupling {

class LayerSight {
 public:
  /// `points`: n x 2, -1 <= y < 0; those with y = -1 are on the base. `kernel`: its width over h.
  LayerSight(const Eigen::MatrixXd& points, const Kernel& kernel);

  /// The model smoothed at the points, n x 3. `half_plane`: it goes on below the base. One call of
  /// `stress`.
  Eigen::MatrixXd seen(const StressFunction& stress, bool half_plane) const {
    return (half_plane ? half_plane_ : layer_).seen(stress);
  }
  /// The same of an orthotropic layer under F = 1 with h = 1, by its transform: the smoothing is a
  /// product there.
  Eigen::MatrixXd seen(const continuum::OrthotropicWaves& waves) const;

  const Places& places() const { return places_; }

 private:
  struct Level {
    std::vector<Eigen::Index> points;
    Eigen::Index first = 0, count = 0;  // of its depths in shares_
    Eigen::MatrixXd weight;             // wave numbers x depths
  };
  void make_levels(const Eigen::MatrixXd& points, const Kernel& kernel);

  Places places_;
  ObservationOperator layer_, half_plane_;
  std::vector<Level> levels_;
  Eigen::VectorXd shares_, waves_, measure_;  // depths, u, its weight du/pi
  Eigen::MatrixXd cosine_, sine_;             // points x wave numbers
};

}  // namespace grainfield::coupling
