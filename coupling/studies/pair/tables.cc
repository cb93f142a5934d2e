#include "coupling/studies/pair/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numeric>
#include <utility>

namespace grainfield::coupling {
namespace {

using NamedUnits = std::vector<std::pair<const char*, const char*>>;  // column, with its unit

const NamedUnits& profile_units() {
  static const NamedUnits all{{"time", "time_s"},
                              {"depth", "depth_m"},
                              {"area", "area_m2"},
                              {"normal_force", "normal_force_N"},
                              {"tangential_force", "tangential_force_N"},
                              {"torque_first", "torque_first_Nm"},
                              {"torque_second", "torque_second_Nm"},
                              {"kinetic", "kinetic_J"},
                              {"stored", "stored_J"},
                              {"dissipated", "dissipated_J"},
                              {"x", "x_m"},
                              {"y", "y_m"},
                              {"angle", "angle_rad"}};
  return all;
}

const NamedUnits& loop_units() {
  static const NamedUnits all{{"loop_work_over_energy", "work_over_energy"},
                              {"loop_stored_most", "stored_most_J"},
                              {"loop_crossings", "crossings"}};
  return all;
}

std::string cell(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.9g}", value); }

std::string columns_csv(const std::vector<RecordedColumns>& realizations, const NamedUnits& units,
                        const char* index) {
  std::string out = "realization";
  if (*index != 0) out += fmt::format(",{}", index);
  for (const auto& [column, unit] : units) out += fmt::format(",{}", unit);
  out += "\n";
  for (std::size_t r = 0; r < realizations.size(); ++r) {
    const std::size_t rows = realizations[r].at(units.front().first).size();
    for (std::size_t k = 0; k < rows; ++k) {
      out += *index != 0 ? fmt::format("{},{}", r, k) : fmt::format("{}", r);
      for (const auto& [column, unit] : units)
        out += fmt::format(",{}", cell(realizations[r].at(column)[k]));
      out += "\n";
    }
  }
  return out;
}

double mean_of(const std::map<std::string, std::vector<double>>& figures, const std::string& key) {
  const auto at = figures.find(key);
  if (at == figures.end()) return PairClosedForm::kNone;
  const std::vector<double>& all = at->second;
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

}  // namespace

RecordedColumns pair_profile(const Realization& realization, const std::string& file) {
  return recorded_columns(realization.snapshots.front().second, "pair", dem::kPairColumns, file);
}

RecordedColumns pair_loops(const Realization& realization, const std::string& file) {
  const dem::Snapshot& state = realization.snapshots.front().second;
  if (!state.attributes.contains(std::string("pair:") + dem::kLoopColumns[0])) return {};
  return recorded_columns(state, "pair", dem::kLoopColumns, file);
}

std::string pair_profiles_csv(const std::vector<RecordedColumns>& realizations) {
  return columns_csv(realizations, profile_units(), "");
}

std::string pair_loops_csv(const std::vector<RecordedColumns>& realizations) {
  return columns_csv(realizations, loop_units(), "loop");
}

std::vector<PairImpact> pair_impacts(const dem::PairSetup& setup,
                                     const std::map<std::string, std::vector<double>>& figures) {
  std::vector<PairImpact> out;
  if (setup.kind != "collision") return out;
  for (const dem::PairLaunch& launch : dem::pair_launches(setup)) {
    PairImpact one;
    one.speed = launch.speed;
    one.angle = launch.angle;
    one.of_speeds = out.size() <= setup.speeds.size();
    one.of_angles = out.empty() || out.size() > setup.speeds.size();
    const auto figure = [&](const char* name) { return mean_of(figures, launch.name + name); };
    one.restitution_normal = figure("restitution_normal");
    one.restitution_tangential = figure("restitution_tangential");
    one.duration = figure("duration");
    one.max_depth = figure("max_depth");
    one.max_force = figure("max_force");
    one.energy_lost = figure("energy_lost");
    one.parted = figure("parted");
    one.closed = pair_closed_form(setup, launch.speed, launch.angle);
    out.push_back(one);
  }
  return out;
}

std::string pair_impacts_csv(const std::vector<PairImpact>& impacts) {
  std::string out =
      "speed_m_per_s,angle_deg,restitution_normal,restitution_tangential,duration_s,max_depth_m,"
      "max_force_N,energy_lost,parted,closed_form_restitution_normal,"
      "closed_form_restitution_tangential,closed_form_duration_s,closed_form_max_depth_m,"
      "closed_form_max_force_N\n";
  for (const PairImpact& i : impacts) {
    std::vector<std::string> cells;
    for (const double value : {i.speed, i.angle, i.restitution_normal, i.restitution_tangential,
                               i.duration, i.max_depth, i.max_force, i.energy_lost, i.parted,
                               i.closed.restitution_normal, i.closed.restitution_tangential,
                               i.closed.duration, i.closed.max_depth, i.closed.max_force}) {
      cells.push_back(cell(value));
    }
    out += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return out;
}

}  // namespace grainfield::coupling
