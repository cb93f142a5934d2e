#include "coupling/specimen/pile_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "continuum/constants.h"
#include "coupling/averaging/layer.h"
#include "coupling/specimen/carried.h"
#include "coupling/specimen/surface.h"
#include "coupling/specimen/volume_fraction.h"

namespace grainfield::coupling {
namespace {

// The highest part of a small heap, in the middle of which its apex is taken to lie.
constexpr double kHighest = 0.9;
constexpr double kMiddle = 0.95;   // of the mass: all but grains that have rolled off
constexpr int kGap = 2;            // columns without grains that part a heap
constexpr double kOnePiece = 0.8;  // of the area at least, in a heap
constexpr double kLeastSlope = 5;  // degrees: flatter is a layer

// Apex and feet from the columns themselves.
void measure_small_heap(const Surface& surface, PileFrame& frame) {
  double sum = 0, left = kNan, right = kNan;
  int count = 0;
  for (std::size_t k = 0; k < surface.top.size(); ++k) {
    const double x = surface.middle(k);
    if (surface.top[k] > 0) {
      if (std::isnan(left)) left = x - surface.column / 2;
      right = x + surface.column / 2;
    }
    if (surface.top[k] >= kHighest * frame.height) {
      sum += x;
      ++count;
    }
  }
  frame.apex_x = sum / count;
  frame.half_left = frame.apex_x - left;
  frame.half_right = right - frame.apex_x;
}

// Share of the area below the surface in the largest run of columns without a gap of two, such as
// a grain that has rolled off leaves.
double largest_piece(const Surface& surface) {
  double all = 0, piece = 0, largest = 0;
  int empty = 0;
  for (const double top : surface.top) {
    empty = top > 0 ? 0 : empty + 1;
    if (empty >= kGap) piece = 0;
    piece += top;
    all += top;
    largest = std::max(largest, piece);
  }
  return all > 0 ? largest / all : 1;
}

// Distance from x within which this share of the free grains' mass lies, m.
double reach_of_mass(const dem::Snapshot& pile, double x, double share) {
  std::vector<std::pair<double, double>> away;  // distance, mass
  double all = 0;
  for (const dem::Grain& grain : pile.grains) {
    if (grain.fixed) continue;
    away.emplace_back(std::fabs(grain.position.x() - x), grain.mass);
    all += grain.mass;
  }
  std::sort(away.begin(), away.end());
  double within = 0;
  for (const auto& [distance, mass] : away) {
    within += mass;
    if (within >= share * all) return distance;
  }
  return away.back().first;
}

// A rough floor lies at the tops of the fixed grains that carry: there a pile's own floor is zero,
// and its plane is out of reach below.
double floor_of(const dem::Snapshot& pile) {
  double tops = 0;
  int contacts = 0;
  for (const dem::Contact& contact : pile.contacts) {
    if (contact.j < 0) continue;
    const dem::Grain& a = pile.grains[static_cast<std::size_t>(contact.i)];
    const dem::Grain& b = pile.grains[static_cast<std::size_t>(contact.j)];
    if (a.fixed == b.fixed) continue;
    const dem::Grain& carries = a.fixed ? a : b;
    tops += carries.position.y() + carries.radius;
    ++contacts;
  }
  if (contacts > 0) return tops / contacts;
  for (const dem::Wall& wall : pile.walls) {
    if (wall.name == "floor") return wall.point.y();
  }
  return layer_frame(pile).floor;
}

// Positions of grains only: what the measures of a heap look at.
dem::Snapshot on_floor_zero(dem::Snapshot pile, double floor) {
  for (dem::Grain& grain : pile.grains) grain.position.y() -= floor;
  return pile;
}

// Takes out what is in flight and says so.
std::string without_grains_in_flight(dem::Snapshot& pile, double diameter) {
  const std::vector<std::size_t> flying = grains_in_flight(pile, diameter);
  if (flying.empty()) return "";
  const dem::Grain first = pile.grains[flying.front()];
  for (std::size_t k = flying.size(); k-- > 0;) {
    pile.grains.erase(pile.grains.begin() + static_cast<std::ptrdiff_t>(flying[k]));
  }
  return fmt::format(
      "{} grain{} in flight, no part of the heap: id {} at x = {:.4g} m, {:.4g} m "
      "above the floor{}",
      flying.size(), flying.size() == 1 ? "" : "s", first.id, first.position.x(),
      first.position.y(), flying.size() == 1 ? "" : ", and others");
}

double fraction_in(const dem::Snapshot& pile, const dem::Outline& window) {
  return window.empty() ? kNan : volume_fraction(pile, window);
}

}  // namespace

double PileFrame::weight_over_wedge() const {
  const auto foot = [&](double slope_deg) { return height / std::tan(slope_deg * kDegree); };
  return weight / (0.5 * pressure() * (foot(repose_left_deg) + foot(repose_right_deg)));
}

std::string PileFrame::why_not_a_heap(std::size_t number) const {
  const auto because = [&](const std::string& why) {
    return fmt::format("realization {}: {}", number, why);
  };
  if (largest_piece < kOnePiece) {
    return because(
        fmt::format("it lies in pieces, the largest with {:.0f} % of it", 100 * largest_piece));
  }
  if (std::isnan(repose_left_deg + repose_right_deg)) {
    return because("a flank on which no line fits (too flat, or too few grains)");
  }
  if (repose_left_deg + repose_right_deg < 2 * kLeastSlope) {
    return because(fmt::format("flanks of {:.1f} and {:.1f} degrees, a layer", repose_left_deg,
                               repose_right_deg));
  }
  return "";
}

Eigen::MatrixXd PileFrame::to_packing(const Eigen::MatrixXd& scaled) const {
  Eigen::MatrixXd out = height * scaled;
  out.col(0).array() += apex_x;
  out.col(1).array() += floor + height;
  return out;
}

double PileFrame::in_half_bases(double x) const {
  return (x - apex_x) / (x < apex_x ? half_left : half_right);
}

PileFrame pile_frame(const dem::Snapshot& heap_as_it_is) {
  if (heap_as_it_is.dim != 2) {
    throw std::invalid_argument("the snapshot is 3D; a 2D one is needed");
  }
  const double floor = floor_of(heap_as_it_is);
  dem::Snapshot pile = on_floor_zero(heap_as_it_is, floor);
  PileFrame frame;
  frame.in_flight = without_grains_in_flight(pile, mean_diameter(pile));
  pile.contacts.clear();  // their indices are those of all grains
  frame.floor = floor;
  frame.diameter = mean_diameter(pile);
  frame.gravity = pile.gravity.norm();
  double mass = 0, area = 0;
  for (const dem::Grain& grain : pile.grains) {
    if (grain.fixed) continue;
    mass += grain.mass;
    area += grain.volume;
  }
  frame.grain_density = mass / area;
  frame.weight = mass * frame.gravity;
  const Surface surface = free_surface(pile, frame.diameter);
  const HeapShape heap = measure_heap(surface);
  frame.height = heap.height;
  frame.repose_left_deg = heap.repose_left_deg;
  frame.repose_right_deg = heap.repose_right_deg;
  frame.apex_x = heap.apex_x;
  frame.half_left = heap.half_base_left();
  frame.half_right = heap.half_base_right();
  if (!(frame.half_left > 0 && frame.half_right > 0)) measure_small_heap(surface, frame);
  frame.middle_reach = reach_of_mass(pile, frame.apex_x, kMiddle);
  frame.largest_piece = largest_piece(surface);
  const HeapWindows windows = windows_of(heap, frame.diameter);
  frame.volume_fraction = fraction_in(pile, windows.whole);
  if (std::isnan(frame.volume_fraction)) {
    double below = 0;
    for (const double top : surface.top) below += top * surface.column;
    frame.volume_fraction = area / below;
  }
  frame.centre_fraction = fraction_in(pile, windows.centre);
  frame.surface_fraction =
      (fraction_in(pile, windows.surface_left) + fraction_in(pile, windows.surface_right)) / 2;
  return frame;
}

}  // namespace grainfield::coupling
