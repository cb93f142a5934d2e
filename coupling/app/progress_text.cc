#include "coupling/app/progress_text.h"

#include <fmt/format.h>

namespace grainfield::coupling {

std::string duration_text(double seconds) {
  if (!(seconds >= 0)) return "?";
  const auto s = static_cast<long>(seconds + 0.5);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}

std::string progress_text(const EnsembleProgress& p) {
  const std::string awake =
      p.awake > 0 && p.awake < p.grains ? fmt::format(", {} awake", p.awake) : "";
  return fmt::format(
      "{:3.0f} %  {}/{} done  {}  t {:.3f} s  {} grains{}  kinetic {:.1e} J  unbalanced {:.1e}  {} "
      "left",
      100 * p.fraction, p.done, p.total, p.phase, p.simulated_time, p.grains, awake,
      p.kinetic_energy, p.unbalanced_force_ratio, duration_text(p.seconds_left));
}

}  // namespace grainfield::coupling
