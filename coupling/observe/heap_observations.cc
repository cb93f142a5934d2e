// Stresses of heaps from the grains.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "coupling/averaging/average.h"
#include "coupling/averaging/kernel.h"
#include "coupling/import/packing_warnings.h"
#include "coupling/observe/heap_rows.h"
#include "coupling/run/realization_file.h"
#include "coupling/specimen/heap_field.h"
#include "dem/snapshot/added_forces_mark.h"

namespace grainfield::coupling {
namespace {

constexpr double kRange = 2;                   // of the Lucy kernel, widths
constexpr double kLevel = 1e-6;                // of gravity: its part along the floor
constexpr std::size_t kAddedForcesKind = 100;  // of warnings: behind those of a check

// `added`: the attributes of forces of a Python function, taken where there are none yet.
PileFrame frame_of(const HeapReader& heaps, std::size_t k, PackingWarnings& warnings,
                   std::map<std::string, std::string>& added) {
  const dem::Snapshot heap = heaps.read(k);  // its messages name the file
  try {
    if (heap.dim != 2) {
      throw std::invalid_argument(
          fmt::format("is 3D; fits of heaps need a 2D packing; {}", kCompareCones));
    }
    if (heap.contacts.empty())
      throw std::invalid_argument(
          "has no contacts, so no stress; add them with their forces, or let the engine settle it");
    const dem::Vec3& g = heap.gravity;
    if (!(g.y() < 0 && std::fabs(g.x()) < kLevel * -g.y())) {
      throw std::invalid_argument(
          fmt::format("found gravity ({:g}, {:g}), needed: downwards, along -y (import --gravity)",
                      g.x(), g.y()));
    }
    const PackingCheck check = check_packing(heap);
    if (const std::string text = tension_in(check); !text.empty()) {
      throw std::invalid_argument(text);
    }
    warnings.add(heaps.name(k), check);
    warnings.add(kAddedForcesKind, heaps.name(k), dem::added_forces_note(heap.attributes));
    dem::copy_added_forces(heap.attributes, added);
    PileFrame frame = pile_frame(heap);
    if (!(frame.pressure() > 0)) {
      throw std::invalid_argument("has no weight: gravity, masses or heights are 0");
    }
    return frame;
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(fmt::format("{}: {}", heaps.name(k), e.what()));
  }
}

// All but those of these numbers, from 1.
HeapReader without(const HeapReader& all, const std::vector<double>& numbers) {
  const std::vector<std::size_t> kept = kept_realizations(all.count, numbers);
  return {kept.size(), [read = all.read, kept](std::size_t k) { return read(kept[k]); },
          [name = all.name, kept](std::size_t k) { return name(kept[k]); }};
}

}  // namespace

HeapReader heaps_of_runs(const std::vector<std::string>& files) {
  return {files.size(), [files](std::size_t k) { return read_realization(files[k])["pile"]; },
          [files](std::size_t k) { return files[k]; }};
}

Observations observe_heaps(const FitSetup& setup, const HeapReader& all_heaps, int threads) {
  const HeapReader heaps = without(all_heaps, setup.leave_out);
  Observations out;
  PackingWarnings warnings;
  std::map<std::string, std::string> added;
  double height = 0, diameter = 0, least = std::numeric_limits<double>::infinity();
  const auto count = static_cast<double>(heaps.count);
  for (std::size_t k = 0; k < heaps.count; ++k) {
    out.frames.push_back(frame_of(heaps, k, warnings, added));
    if (const std::string& flying = out.frames.back().in_flight; !flying.empty()) {
      out.warnings.push_back(fmt::format("{}: {}", heaps.name(k), flying));
    }
    height += out.frames.back().height / count;
    least = std::min(least, out.frames.back().height);
    diameter += out.frames.back().diameter / count;
  }
  const HeapSlopes slopes = slopes_of(setup, out.frames);
  for (std::string& line : warnings.lines()) out.warnings.push_back(std::move(line));
  out.width = setup.width_diameters * diameter;
  warn_of_low_heights(setup.heights, least, out.width, out);
  warn_of_unlike_heaps(heaps.name, out);
  warn_of_round_tops(out);
  warn_of_set_slopes(setup, out);
  AverageOptions options;
  options.method = "coarse_graining";
  options.kernel = "lucy";
  options.width = out.width;
  options.threads = threads;
  options.quantities = {"sigma"};
  const auto kernel = make_kernel(options.kernel, out.width);
  out.kernel = make_kernel(options.kernel, out.width / height);
  const double length = kernel->independent_length();
  out.facts = facts_of(setup, slopes, *out.kernel);

  std::vector<Eigen::Vector2d> places;
  HeapPlaces at;
  for (const double share : setup.heights) {
    const double depth = 1 - share, reach = kRange * out.width / height;
    const double from = reach - depth / slopes.left(), to = depth / slopes.right() - reach;
    out.data.levels.push_back(fmt::format("{:g}", share));
    if (to - from <= 0) continue;
    const int n = 2 * static_cast<int>((to - from) / 2 * height / (0.5 * length)) + 1;
    const double middle = (from + to) / 2, half = (to - from) / 2;
    for (int k = 0; k < n; ++k) {
      places.emplace_back(n > 1 ? middle + half * (2.0 * k / (n - 1) - 1) : middle, -depth);
      at.level.push_back(static_cast<int>(out.data.levels.size()) - 1);
    }
  }
  // Lines of the fit and the page's grid in one averaging.
  out.maps = heap_map_grid(slopes);
  const auto n = static_cast<Eigen::Index>(places.size());
  Field field;
  field.points.resize(n + out.maps.points.rows(), 2);
  for (Eigen::Index k = 0; k < n; ++k) {
    field.points.row(k) = places[static_cast<std::size_t>(k)].transpose();
    at.chosen.push_back(k);
  }
  field.points.bottomRows(out.maps.points.rows()) = out.maps.points;
  at.map_from = n;
  field.realizations = static_cast<int>(heaps.count);
  for (const std::string& name : kPlaneStress) {
    field.add(name, "N/m").samples.resize(field.points.rows(), field.realizations);
  }
  for (std::size_t r = 0; r < heaps.count; ++r) {
    const PileFrame& frame = out.frames[r];
    const Field one = average(heaps.read(r), frame.to_packing(field.points), options);
    for (Column& column : field.columns) {
      column.samples.col(static_cast<Eigen::Index>(r)) = one.find(column.name)->value;
    }
    at.pressure.push_back(frame.pressure());
  }
  take_values(setup, field, at, heaps.name, out);
  if (!added.empty()) out.scale.note += "; " + dem::added_forces_note(added);
  return out;
}

}  // namespace grainfield::coupling
