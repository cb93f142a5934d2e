#include "coupling/studies/sample/simulation/record.h"

#include <fmt/format.h>

namespace grainfield::dem {

std::string state_name(std::size_t number) { return fmt::format("state_{:03}", number); }

Snapshot sample_record(const Engine& engine, const SamplePlan& plan, std::size_t number,
                       double strain, std::uint64_t seed) {
  Snapshot s = engine.snapshot();
  const Diagnostics d = engine.measure();
  const auto put = [&](const char* name, double value) {
    s.attributes[name] = fmt::format("{:.17g}", value);
  };
  s.attributes["state"] = state_name(number);
  s.attributes["seed"] = fmt::format("{}", seed);
  s.attributes["boundary"] = plan.boundary;
  s.attributes["deformation"] = plan.deformation;
  put("strain", strain);
  put("strain_rate", plan.strain_rate);
  put("kinetic_energy", d.kinetic_energy);
  put("elastic_energy", d.elastic_energy);
  put("work", d.cell_work + d.wall_work);
  put("unbalanced_force_ratio", d.unbalanced_force_ratio);
  if (d.energy_followed) {
    put("lost_in_dashpots", d.contact_losses.dashpot);
    put("lost_to_friction", d.contact_losses.friction);
    put("lost_to_rolling", d.contact_losses.rolling);
    put("lost_to_damping", d.damped_energy);
    put("work_of_law", d.contact_losses.law);
    put("energy_balance", d.energy_balance());
  }
  return s;
}

}  // namespace grainfield::dem
