// Small uniform strains of a settled layer, by Newton's method: what its moduli follow from, of the
// middle of the layer or of slabs one upon the other.
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

#include "dem/laws/materials.h"
#include "dem/quasistatic/strains.h"
#include "dem/run/probe_record.h"

namespace grainfield::dem {

/// What put_probes calls the state of a layer.
inline constexpr const char* kProbedLayer = "layer";
/// Shares of the depth between which the slab lies.
inline constexpr double kSlabLow = 0.25, kSlabHigh = 0.75;

/// Between two heights above the floor, m.
struct Slab {
  double low = 0, high = 0;
};
/// `count` slabs of equal thickness between the held grains of a layer, from the floor upwards;
/// they keep half a diameter away from held ones. Throws ComputationFailed where they would be
/// thinner than a diameter.
std::vector<Slab> slabs_of(const Snapshot& layer, double height, int count);

class LayerProber {
 public:
  /// `layer`: at rest, in space periodic along x and y, its floor's surface at z = 0, its own at
  /// `height`, m. `strain`: size of each strain. `settings` must outlive this. `slabs`: empty: the
  /// one in the middle. Throws ComputationFailed for a layer too thin.
  LayerProber(const Snapshot& layer, const Materials& settings, double height, double strain,
              std::vector<Slab> slabs = {}, int strips = 1);

  /// Twice the directions: forth and back.
  static int count(int dim = 3);
  int count_here() const { return count(held_.dim); }
  /// Brings the grains between the held ones to the balance that probes end with. False when go_on
  /// said no (quasistatic.h). Throws ComputationFailed naming load.probe_strain.
  bool settle(const std::function<bool(double)>& go_on);
  /// Stress in a part before any probe, tension positive, Pa. Throws std::logic_error before
  /// settle.
  const Eigen::Matrix3d& stress_before(std::size_t part = 0) const;
  /// The direction of the probe with this number.
  static std::string direction(int number, int dim = 3);
  /// That probe's outcome; none when go_on said no. Throws as settle and stress_before.
  std::optional<ProbeOutcome> probe(int number, const std::function<bool(double)>& go_on);
  /// That probe's outcomes in all parts: for each slab itself, and then its strips where there are
  /// several.
  std::optional<std::vector<ProbeOutcome>> probe_parts(int number,
                                                       const std::function<bool(double)>& go_on);
  std::size_t parts() const { return parts_.size(); }

 private:
  /// A slab, or a strip of one.
  struct Part {
    Slab slab;
    double area;         // seen from above, in the plane a length
    bool all_along_x;    // of the cell
    double left, right;  // otherwise: from there to there
  };
  void cut(const std::vector<Slab>& slabs, int strips);
  double share_in(const Part& part, const Contact& c) const;
  /// Stress of a strained state's contacts; the part is the same material as before.
  Eigen::Matrix3d stress_of(const Part& part, const Snapshot& state,
                            const Eigen::Matrix3d& gradient) const;
  Eigen::Matrix3d gradient_of(const Part& part, const Snapshot& state,
                              const Eigen::Matrix3d& imposed) const;
  double place_in_cell(double x) const;

  /// Throws ComputationFailed naming load.probe_strain.
  [[noreturn]] void fail(const std::string& what, const std::exception& failure) const;

  const Materials& settings_;
  double strain_;
  int up_;                               // axis
  double left_ = 0, right_ = 0;          // in the plane: of what is not held at the sides
  Snapshot held_;                        // with the held grains fixed
  std::vector<Part> parts_;              // the first one is a slab
  std::unique_ptr<Strains> strains_;     // of it, once it has settled
  std::vector<Eigen::Matrix3d> before_;  // of each part; empty: not yet settled
};

}  // namespace grainfield::dem
