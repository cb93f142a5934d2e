#include "coupling/studies/pile/pile_ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/specimen/scaled.h"
#include "coupling/specimen/setup.h"
#include "coupling/studies/pile/figures.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::coupling {
namespace {

// Profiles and maps reach beyond the feet by this factor.
constexpr double kReach = 1.08;
// And beyond what holds most of the mass by this one at the most, where a flank's line is so flat
// that its foot is far outside. In a wedge it is 1.24 half bases.
constexpr double kMostReach = 1.6;
// Mean diameters: narrower kernels see single contacts.
constexpr double kLeastWidth = 0.25;

// Scaled points well inside a heap, where the balance of forces is looked at.
Eigen::MatrixXd inner_points(const PileFrame& frame) {
  const double left = -0.5 * frame.half_left / frame.height;
  const double right = 0.5 * frame.half_right / frame.height;
  Eigen::MatrixXd out = grid_points(left, right, 13, -0.85, -0.6, 4);
  return frame.to_packing(out);
}

}  // namespace

double coordination(const dem::Snapshot& snapshot) {
  double ends = 0, grains = 0;
  const auto free = [&](std::int64_t g) {
    return g >= 0 && !snapshot.grains[static_cast<std::size_t>(g)].fixed;
  };
  for (const dem::Contact& contact : snapshot.contacts) ends += free(contact.i) + free(contact.j);
  for (const dem::Grain& grain : snapshot.grains) grains += grain.fixed ? 0 : 1;
  return ends / grains;
}

PileEnsemble::PileEnsemble(const Case& a_case, const std::vector<std::string>& realizations,
                           int threads)
    : value(a_case), files(realizations) {
  double reach = 0, reach_of_all = 0;
  for (const std::string& file : files) {
    const Realization realization = read_realization(file);
    frames.push_back(pile_frame(realization["pile"]));
    const PileFrame& f = frames.back();
    const auto n = static_cast<double>(files.size());
    height += f.height / n;
    pressure += f.pressure() / n;
    const double feet = kReach * std::max(f.half_left, f.half_right);
    const double own = std::min(feet, kMostReach * f.middle_reach) / f.height;
    reach_of_all = std::max(reach_of_all, own);
    if (f.why_not_a_heap(0).empty()) reach = std::max(reach, own);
  }
  if (reach == 0) reach = reach_of_all;
  // An odd number of points, so that one is under the apex.
  const AverageSetup& setup = value.get<AverageSetup>();
  x = Eigen::VectorXd::LinSpaced(2 * (setup.points / 2) + 1, -reach, reach);
  x[setup.points / 2] = 0;
  columns = static_cast<int>(setup.map_columns);
  rows = static_cast<int>(setup.map_rows);
  grid = grid_points(-reach, reach, columns, -1, 0, rows);
  const double diameter = mean(&PileFrame::diameter);
  methods = methods_of(setup, diameter, threads, 1 + value.get<HeapSetup>().heights.size());
  for (const MethodAverages& a : methods) {
    if (a.options.width >= kLeastWidth * diameter) continue;
    throw std::invalid_argument(fmt::format(
        "average: {} with a width of {:g} m, below {:g} mean grain diameters of {:.4g} m: no "
        "point has enough grains around it; raise the width",
        a.method, a.options.width, kLeastWidth, diameter));
  }
  kernel = seeing_kernel(methods.front().options);
}

double PileEnsemble::mean(double PileFrame::*member) const {
  double sum = 0;
  for (const PileFrame& f : frames) sum += f.*member;
  return sum / static_cast<double>(frames.size());
}

double PileEnsemble::share(std::size_t line) const {
  return line == 0 ? 0 : value.get<HeapSetup>().heights[line - 1];
}

Eigen::MatrixXd PileEnsemble::line(double height_share) const {
  Eigen::MatrixXd out(x.size(), 2);
  out << x, Eigen::VectorXd::Constant(x.size(), height_share - 1);
  return out;
}

void PileEnsemble::collect() {
  for (std::size_t r = 0; r < files.size(); ++r) add(read_realization(files[r]), frames[r]);
}

void PileEnsemble::add(const Realization& realization, const PileFrame& frame) {
  const dem::Snapshot& pile = realization["pile"];
  const double unit = frame.pressure();
  for (MethodAverages& a : methods) {
    const auto on = [&](const Eigen::MatrixXd& points, int nx, int ny) {
      return scaled_field(average(pile, frame.to_packing(points), a.options), points, unit, nx, ny);
    };
    for (std::size_t k = 0; k < a.lines.size(); ++k) a.lines[k].add(on(line(share(k)), 0, 0));
    Field map = on(grid, columns, rows);
    if (a.method == "coarse_graining") {
      // The stress stays smeared over the surface, where it obeys the balance of forces; the volume
      // fraction is that of the part of the kernel inside the heap.
      AverageOptions inside = a.options;
      inside.free_surface = "normalised";
      inside.quantities = {"volume_fraction"};
      const Field fraction = average(pile, frame.to_packing(grid), inside);
      for (Column& column : map.columns) {
        if (column.name == "volume_fraction") {
          column.value = fraction.find("volume_fraction")->value;
        }
      }
    }
    a.map.add(map);
    a.add_balance(balance_residual(pile, inner_points(frame), a.options), files.size());
  }
  const Eigen::VectorXd places = frame.height * x.array() + frame.apex_x;
  base.add(scaled_field(base_profile(pile, places, *kernel), line(0), unit));
  windows.push_back(base_windows(pile, frame, value.get<HeapSetup>()));

  for (const auto& [key, figure] : realization.figures) figures[key].push_back(figure);
  const auto left_by_run = [&](const char* key, double otherwise) {
    const auto at = realization.figures.find(key);
    return at == realization.figures.end() ? otherwise : at->second;
  };
  double weight = 0;
  for (const dem::Grain& grain : pile.grains) {
    if (!grain.fixed) weight += grain.mass * frame.gravity;
  }
  FigureSamples own{{"base.weight_ratio", {dem::base_force(pile).y() / weight}},
                    {"dem.volume_fraction", {frame.volume_fraction}}};
  add_samples(pile_rows(),
              {pile, frame, value.get<HeapSetup>(),
               left_by_run("dem.repose_angle_left_deg", frame.repose_left_deg),
               left_by_run("dem.repose_angle_right_deg", frame.repose_right_deg)},
              own);
  add_samples(window_rows(), windows.back(), own);
  for (const auto& [key, samples] : own) {
    if (!realization.figures.contains(key)) figures[key].push_back(samples.front());
  }
  for (const auto& [name, state] : realization.snapshots) {
    if (dem::is_change(name)) add_change(name, pile, state, frame);
  }
}

void PileEnsemble::add_change(const std::string& name, const dem::Snapshot& pile,
                              const dem::Snapshot& changed, const PileFrame& frame) {
  require_same_grains(pile, changed);
  const BaseWindows before = base_windows(pile, frame, value.get<HeapSetup>());
  const BaseWindows after = base_windows(changed, frame, value.get<HeapSetup>());
  // Pressures in units of the pile's rho g h: the gravity's own factor is taken out.
  const double factor = changed.gravity.norm() / frame.gravity;
  add_samples(change_rows(),
              {coordination(changed), coordination(pile), (after.shoulder - after.centre) / factor,
               before.shoulder - before.centre},
              figures, "change." + name + ".");
}

}  // namespace grainfield::coupling
