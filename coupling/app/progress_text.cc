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
  if (p.phase.empty()) {
    return fmt::format("{:3.0f} %  {}/{} done{}", 100 * p.fraction, p.done, p.total,
                       p.done < p.total ? "  starting" : "");
  }
  const std::string awake =
      p.awake > 0 && p.awake < p.grains ? fmt::format(", {} awake", p.awake) : "";
  // The quasi-static solver has neither time nor speeds.
  const bool moving = p.simulated_time > 0;
  const std::string time = moving ? fmt::format("  t {:.3f} s", p.simulated_time) : "";
  const std::string forces = moving ? fmt::format("  kinetic {:.1e} J  unbalanced {:.1e}",
                                                  p.kinetic_energy, p.unbalanced_force_ratio)
                                    : "";
  return fmt::format("{:3.0f} %  {}/{} done  {}{}  {} grains{}{}  {} left", 100 * p.fraction,
                     p.done, p.total, p.phase, time, p.grains, awake, forces,
                     duration_text(p.seconds_left));
}

}  // namespace grainfield::coupling
