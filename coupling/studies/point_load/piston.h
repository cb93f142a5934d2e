// A piston that comes down on one grain at a given speed, as Roul loads his layers.
#pragma once
#include <cstdint>
#include <memory>

#include "dem/engine/added_forces.h"
#include "dem/laws/material_setup.h"

namespace grainfield::dem {

/// Where a piston stands when it begins to move.
struct Stroke {
  std::int64_t id = -1;  ///< the grain that it touches
  double start = 0;      ///< s
  double height = 0;     ///< of the grain's centre then, m
  double end = 0;        ///< s, when the grain resisted with the whole force; until then 0
};

/// Its face moves down with the speed and presses the grain down with stiffness times the way that
/// the grain has fallen behind, up to the whole force. So the grain moves with the piston while
/// the layer gives way by more than a contact.
class Piston final : public AddedForce {
 public:
  Piston(const Stroke& stroke, double speed, double stiffness, double force);

  /// N/m, of the contacts of grains in the plane.
  static double stiffness(const MaterialSetup& material);

  bool in_contacts() const override { return false; }
  Loads loads(const std::shared_ptr<const GrainsNow>& grains,
              const std::shared_ptr<const ContactsNow>& contacts) override;

  /// At the last step, N.
  double force() const { return force_; }
  bool presses_fully() const { return force_ >= whole_; }
  /// Throws ComputationFailed: the whole force has not been met within so many seconds.
  [[noreturn]] void fail(double time) const;

 private:
  Stroke stroke_;
  double speed_, stiffness_, whole_;  // m/s, N/m, N
  double force_ = 0;
};

}  // namespace grainfield::dem
