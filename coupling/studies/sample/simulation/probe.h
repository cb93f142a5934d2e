// Small strains of a sample at rest, one after the other, each from the same state.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coupling/studies/sample/simulation/setup.h"
#include "dem/run/archive.h"
#include "dem/run/probe_record.h"

namespace grainfield::dem {

/// Directions in which the sample's boundary can be strained alone: in a cell all six; between
/// walls the three axes, and xz where the walls' friction can carry a shear.
std::vector<std::string> probe_directions(const SampleSetup& setup);

/// What the probes of all states that the plan asks for take, s, at least: motions, looks at the
/// rest, and the decay from a rest that is reached to the calm that they begin from.
double probe_time(const SampleSetup& setup, double time_step);

/// Probes a sample: cell and walls stand still until the grains are calmer than any strain would
/// disturb them (walls that servos lead go on to hold their pressure until then); then for each
/// direction, forth and back, its edges are strained by sample.probe_strain and the grains rest
/// again. Every probe begins from the same bits, and the engine is given back as it came: the
/// sample's path does not know of them.
class SampleProber {
 public:
  using Make = std::function<std::unique_ptr<Engine>()>;

  explicit SampleProber(const SampleSetup& setup) : setup_(setup) {}

  /// `state`: "prepared" or "first". `held`: walls are led by servos, which go on until it is calm.
  void begin(Engine& engine, const std::string& state, bool held);
  /// Steps until decide() has something to do.
  long until_due() const;
  /// `steps` have been made; make() gives an engine as empty_engine does. True when all is done,
  /// or when the state cannot be probed, which its record says: it bears no load, or its motion
  /// does not die away (frictionless grains with a law that is no gradient go on for ever).
  bool decide(std::unique_ptr<Engine>& engine, long steps, const Make& make);
  /// Share of the probes that are done.
  double share() const;
  /// All states so far.
  const std::vector<StateProbes>& found() const { return found_; }
  void visit(Archive& archive);

 private:
  enum class Stage : int { calm, move, hold };

  void enter(Stage stage);
  void stand_still(Engine& engine) const;
  void move(Engine& engine);
  void note(const Engine& engine, const Make& make);
  void give_back(std::unique_ptr<Engine>& engine, const Make& make);
  bool is_calm(const Diagnostics& d) const;
  std::string hopeless(const Diagnostics& d, double time_step);
  int count() const { return 2 * static_cast<int>(probe_directions(setup_).size()); }

  const SampleSetup& setup_;
  std::string state_, origin_, base_;  // checkpoints: as it came, and calm
  int number_ = -1;                    // of the probe; -1: before the first one
  Stage stage_ = Stage::calm;
  long steps_ = 0, move_ = 0;  // of the stage; of a motion
  double energy_ = 0;          // elastic, as it came, J
  double unrest_ = 0;          // kinetic over elastic energy some time ago
  std::vector<StateProbes> found_;
};

}  // namespace grainfield::dem
