#include "coupling/studies/pair/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numeric>
#include <utility>

#include "coupling/result/csv.h"

namespace grainfield::coupling {
namespace {

using dem::PairColumn;

std::vector<const char*> names_of(std::span<const PairColumn> columns) {
  std::vector<const char*> out;
  for (const PairColumn& column : columns) out.push_back(column.name);
  return out;
}

// `index`: heading of the row's number in its realization; empty: it is left out.
std::string columns_csv(const std::vector<RecordedColumns>& realizations,
                        std::span<const PairColumn> columns, const std::string& index) {
  Csv out;
  out.add("realization");
  if (!index.empty()) out.add(index);
  for (const PairColumn& column : columns) out.add(csv_heading(column.name, column.unit));
  out.end_row();
  for (std::size_t r = 0; r < realizations.size(); ++r) {
    const std::size_t rows = realizations[r].at(columns.front().name).size();
    for (std::size_t k = 0; k < rows; ++k) {
      out.add(r);
      if (!index.empty()) out.add(k);
      for (const PairColumn& column : columns) out.add(realizations[r].at(column.name)[k]);
      out.end_row();
    }
  }
  return out.text();
}

double mean_of(const std::map<std::string, std::vector<double>>& figures, const std::string& key) {
  const auto at = figures.find(key);
  if (at == figures.end()) return PairClosedForm::kNone;
  const std::vector<double>& all = at->second;
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

}  // namespace

RecordedColumns pair_profile(const Realization& realization, const std::string& file) {
  return recorded_columns(realization.snapshots.front().second, "pair", names_of(dem::kPairColumns),
                          file);
}

RecordedColumns pair_loops(const Realization& realization, const std::string& file) {
  const dem::Snapshot& state = realization.snapshots.front().second;
  if (!state.tables.contains("loops")) return {};
  return recorded_columns(state, "loops", names_of(dem::kLoopColumns), file);
}

std::string pair_profiles_csv(const std::vector<RecordedColumns>& realizations) {
  return columns_csv(realizations, dem::kPairColumns, "");
}

std::string pair_loops_csv(const std::vector<RecordedColumns>& realizations) {
  return columns_csv(realizations, dem::kLoopColumns, "loop");
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
  Csv out;
  out.row("speed_m_per_s", "angle_deg", "restitution_normal", "restitution_tangential",
          "duration_s", "max_depth_m", "max_force_N", "energy_lost", "parted",
          "closed_form_restitution_normal", "closed_form_restitution_tangential",
          "closed_form_duration_s", "closed_form_max_depth_m", "closed_form_max_force_N");
  for (const PairImpact& i : impacts) {
    out.row(i.speed, i.angle, i.restitution_normal, i.restitution_tangential, i.duration,
            i.max_depth, i.max_force, i.energy_lost, i.parted, i.closed.restitution_normal,
            i.closed.restitution_tangential, i.closed.duration, i.closed.max_depth,
            i.closed.max_force);
  }
  return out.text();
}

}  // namespace grainfield::coupling
