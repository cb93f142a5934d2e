// Two bodies at prescribed places, or one and a wall: what acts between them, without an engine's
// loop. It shows what a law does with a shape.
#pragma once
#include <array>
#include <limits>
#include <memory>
#include <string>

#include "dem/engine/engine.h"

namespace grainfield::dem {

/// Where a body is and how it moves. In the plane z, and all of the spin but its z component, count
/// for nothing.
struct PairState {
  Vec3 position{0, 0, 0};                         ///< of the centroid, m
  Vec3 velocity{0, 0, 0};                         ///< m/s
  Vec3 spin{0, 0, 0};                             ///< rad/s
  double angle = 0;                               ///< rotation in the plane, rad
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< in space: unit quaternion w, x, y, z
};

/// What acts between the two, all 0 where they do not touch.
struct PairForces {
  bool touching = false;  ///< they overlap
  Vec3 normal{0, 0, 0};   ///< unit, from the first towards the second
  Vec3 point{0, 0, 0};    ///< contact point, m
  Vec3 force{0, 0, 0};    ///< on the first, N; on the second it is the opposite
  /// About the centroids, with those against rolling and twisting, N m; of a wall 0.
  Vec3 torque_first{0, 0, 0}, torque_second{0, 0, 0};
  double normal_force = 0;      ///< repulsion >= 0, N
  double tangential_force = 0;  ///< on the first, N: in the plane along (-n_y, n_x), else its size
  double approach = 0;          ///< closing speed at the contact, m/s
  double depth = 0;             ///< overlap along the normal, m
  double area = 0;              ///< overlap area, m2; in space nan
  double chord = 0;             ///< length of the contact line, m; in space nan
  double stored = 0;            ///< elastic energy, with that of the springs, J
};

class PairContact {
 public:
  virtual ~PairContact() = default;
  /// What acts at these states after the pair has come to them in the time dt, s: what the pair
  /// remembers advances by dt (0: by nothing), as in a step of the engine. It is forgotten where
  /// they do not touch. The state of a wall is its velocity and spin about its point alone.
  virtual PairForces at(const PairState& first, const PairState& second, double dt) = 0;
  /// As if they had never touched.
  virtual void forget() = 0;
  /// What the pair remembers, in bits, and back; throws std::invalid_argument when it does not fit.
  virtual std::string checkpoint() const = 0;
  virtual void restore(const std::string& checkpoint) = 0;
};

/// Contact by the settings' shape, law and friction alone; mass, moments and outline are those of
/// the grains, their places and motion are not used. Throws std::invalid_argument naming the key
/// when the law does not go with the shape, or polygons resist rolling.
std::unique_ptr<PairContact> make_pair_contact(const EngineSettings& settings,
                                               const NewGrain& first, const NewGrain& second);
/// The same of a grain with a plane wall; throws likewise for walls of other shapes.
std::unique_ptr<PairContact> make_pair_contact(const EngineSettings& settings,
                                               const NewGrain& grain, const Wall& wall);

}  // namespace grainfield::dem
