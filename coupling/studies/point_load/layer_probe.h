// Small uniform strains of a settled layer of spheres, by Newton's method: what its moduli follow
// from.
//
// Grains whose centres are within a mean diameter of the floor, or of the surface, are held, and
// the others come to rest between them first: what a layer lacks of balance is then in no probe.
// All grains and the edges of the cell move by a homogeneous displacement gradient, the grains
// between the held ones relax, and stress and displacement gradient are read from the slab in the
// middle: of its contacts, those whose branch crosses it by the share within, and along z by
// regression of its grains' displacements on their height (the layer is stiffer below than above,
// so it does not strain as its ends are moved); along x and y the cell says the gradient.
#pragma once
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/quasistatic/strains.h"
#include "dem/run/probe_record.h"

namespace grainfield::dem {

/// What put_probes calls the state of a layer.
inline constexpr const char* kProbedLayer = "layer";
/// Shares of the depth between which the slab lies.
inline constexpr double kSlabLow = 0.25, kSlabHigh = 0.75;

class LayerProber {
 public:
  /// `layer`: at rest, periodic along x and y, its floor's surface at z = 0, its own at `height`,
  /// m. `strain`: size of each strain. `settings` must outlive this. Throws ComputationFailed for a
  /// layer too thin.
  LayerProber(const Snapshot& layer, const EngineSettings& settings, double height, double strain);

  /// Twice the directions: forth and back.
  static int count();
  /// Brings the grains between the held ones to the balance that probes end with. False when go_on
  /// said no (quasistatic.h). Throws ComputationFailed naming load.probe_strain.
  bool settle(const std::function<bool(double)>& go_on);
  /// Stress in the slab before any probe, tension positive, Pa. Throws std::logic_error before
  /// settle.
  const Eigen::Matrix3d& stress_before() const;
  /// The direction of the probe with this number.
  static std::string direction(int number);
  /// That probe's outcome; none when go_on said no. Throws as settle and stress_before.
  std::optional<ProbeOutcome> probe(int number, const std::function<bool(double)>& go_on);

 private:
  /// Stress of a strained state's contacts; the slab is the same material as before.
  Eigen::Matrix3d stress_of(const Snapshot& state, const Eigen::Matrix3d& gradient) const;
  Eigen::Matrix3d gradient_of(const Snapshot& state, const Eigen::Matrix3d& imposed) const;

  /// Throws ComputationFailed naming load.probe_strain.
  [[noreturn]] void fail(const std::string& what, const std::exception& failure) const;

  const EngineSettings& settings_;
  double strain_, low_, high_, area_;
  Snapshot held_;                          // with the held grains fixed
  std::unique_ptr<Strains> strains_;       // of it, once it has settled
  std::optional<Eigen::Matrix3d> before_;  // none: not yet settled
};

}  // namespace grainfield::dem
