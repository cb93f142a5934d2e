#include "coupling/studies/point_load/layer_probe.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "dem/quasistatic/quasistatic.h"
#include "dem/shared/computation_failed.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/images.h"

namespace grainfield::dem {
namespace {

constexpr std::array kLayerDirections{"xx", "yy", "zz", "yz", "xz", "xy"};
constexpr std::array kPlaneDirections{"xx", "yy", "xy"};
// Balance to be reached, over contact forces: a strain of 1e-6 changes them by about 3e-4.
constexpr double kProbeBalance = 1e-9;

// Share of the way from height a to height b that is between low and high.
double share_within(double a, double b, double low, double high) {
  if (a > b) std::swap(a, b);
  if (a == b) return a >= low && a < high ? 1 : 0;
  return std::max(0.0, std::min(b, high) - std::max(a, low)) / (b - a);
}

// From where to where on the way from a to b, 0 to 1, it is between low and high.
struct Way {
  double begin = 0, end = 0;
};
Way way_within(double a, double b, double low, double high) {
  if (a == b) return {0.0, a >= low && a < high ? 1.0 : 0.0};
  double first = (low - a) / (b - a), last = (high - a) / (b - a);
  if (first > last) std::swap(first, last);
  return {std::max(first, 0.0), std::min(last, 1.0)};
}

// The gradient that moves the layer's ends and its cell. Shear along z is simple shear: the cell
// stays upright.
Eigen::Matrix3d imposed_gradient(const std::string& direction, double strain) {
  const int a = direction[0] - 'x', b = direction[1] - 'x';
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  if (a != b && b == 2) {
    out(a, b) = 2 * strain;
  } else {
    out(a, b) = out(b, a) = strain;
  }
  return out;
}

// A contact that no probe sees may reach into the slab with such a share of its branch.
constexpr double kMostLost = 0.2;
[[noreturn]] void refuse_thin_layer(double height) {
  throw ComputationFailed(fmt::format(
      "load.probe_strain: the layer is {:.3g} m deep, too thin to be strained: contacts of the "
      "held grains at its floor and surface reach into its middle half; set "
      "load.probe_strain = 0, or packing.depth to five grains or more",
      height));
}

double mean_free_diameter(const Snapshot& layer) {
  double diameter = 0;
  int free = 0;
  for (const Grain& g : layer.grains) {
    if (g.fixed) continue;
    diameter += 2 * g.radius;
    ++free;
  }
  return diameter / std::max(free, 1);
}

}  // namespace

std::vector<Slab> slabs_of(const Snapshot& layer, double height, int count) {
  const double diameter = mean_free_diameter(layer);
  // Held are centres within a diameter, whose contacts reach half a branch further.
  const double low = 1.5 * diameter, thick = (height - 2 * low) / count;
  if (!(thick >= diameter)) {
    throw ComputationFailed(fmt::format(
        "slabs: {} in a layer of {:.3g} m would be {:.3g} m thick, allowed: a diameter, {:.3g} m, "
        "or more; ask for fewer, or make the layer deeper",
        count, height, thick, diameter));
  }
  std::vector<Slab> out;
  for (int k = 0; k < count; ++k) out.push_back({low + k * thick, low + (k + 1) * thick});
  return out;
}

LayerProber::LayerProber(const Snapshot& layer, const Materials& settings, double height,
                         double strain, std::vector<Slab> slabs, int strips)
    : settings_(settings), strain_(strain), up_(layer.dim - 1), held_(layer) {
  const double diameter = mean_free_diameter(layer);
  if (layer.dim == 2) {
    left_ = std::numeric_limits<double>::infinity();
    right_ = -left_;
    for (const Grain& g : layer.grains) {
      if (g.fixed) continue;
      left_ = std::min(left_, g.position.x() - g.radius + diameter);
      right_ = std::max(right_, g.position.x() + g.radius - diameter);
    }
  }
  for (Grain& g : held_.grains) {
    const double at = g.position[up_], x = g.position.x();
    const bool aside = layer.dim == 2 && (x < left_ || x > right_);
    g.fixed = g.fixed || aside || at < diameter || at > height - diameter;
  }
  if (layer.dim == 2) {
    for (const Contact& c : held_.contacts) {
      if (c.j < 0) held_.grains[static_cast<std::size_t>(c.i)].fixed = true;
    }
    // Contacts of held grains reach half a branch further; and the strain is held at the sides.
    left_ += 0.5 * diameter;
    right_ -= 0.5 * diameter;
  }
  if (slabs.empty()) slabs = {{kSlabLow * height, kSlabHigh * height}};
  cut(slabs, strips);
  // Between two that are held nothing is left to find out.
  std::erase_if(held_.contacts, [this, height](const Contact& c) {
    const auto held = [this](std::int64_t k) {
      return held_.grains[static_cast<std::size_t>(k)].fixed;
    };
    if (!held(c.i) || (c.j >= 0 && !held(c.j))) return false;
    if (c.j < 0) return true;  // with a wall
    for (const Part& part : parts_) {
      if (share_in(part, c) > kMostLost) refuse_thin_layer(height);
    }
    return true;
  });
}

/// The parts, and their areas.
void LayerProber::cut(const std::vector<Slab>& slabs, int strips) {
  const bool plane = up_ == 1;
  const double from = plane ? left_ : held_.cell.low.x();
  const double width = plane ? right_ - left_ : held_.cell.edges(0, 0);
  const double area = plane ? width : held_.cell.edges.topLeftCorner<2, 2>().determinant();
  for (const Slab& slab : slabs) {
    parts_.push_back({slab, area, !plane, from, from + width});
    for (int k = 0; strips > 1 && k < strips; ++k) {
      parts_.push_back(
          {slab, area / strips, false, from + k * width / strips, from + (k + 1) * width / strips});
    }
  }
}

double LayerProber::place_in_cell(double x) const {
  if (!held_.cell.periodic[0]) return x;
  const double width = held_.cell.edges(0, 0), low = held_.cell.low.x();
  return x - width * std::floor((x - low) / width);
}

/// Share of the contact's branch, before any strain, that counts for the part.
double LayerProber::share_in(const Part& part, const Contact& c) const {
  const Vec3& first = held_.grains[static_cast<std::size_t>(c.i)].position;
  const Vec3 second = second_place(held_, c);
  if (part.all_along_x) return share_within(first[up_], second[up_], part.slab.low, part.slab.high);
  const Way along = way_within(first[up_], second[up_], part.slab.low, part.slab.high);
  const double x = place_in_cell(first.x()), to = x + (second.x() - first.x());
  const double width = held_.cell.periodic[0] ? held_.cell.edges(0, 0) : 0;
  double out = 0;
  for (int image = width > 0 ? -1 : 0; image <= (width > 0 ? 1 : 0); ++image) {
    const Way across = way_within(x + image * width, to + image * width, part.left, part.right);
    out += std::max(0.0, std::min(along.end, across.end) - std::max(along.begin, across.begin));
  }
  return out;
}

void LayerProber::fail(const std::string& what, const std::exception& failure) const {
  throw ComputationFailed(
      fmt::format("load.probe_strain = {:g}, {}: {}; or set "
                  "load.probe_strain = 0{}",
                  strain_, what, failure.what(), before_.empty() ? "" : ", or a smaller one"));
}

bool LayerProber::settle(const std::function<bool(double)>& go_on) {
  QuasistaticSettings how;
  how.unbalanced_force_ratio = kProbeBalance;
  how.go_on = go_on;
  try {
    held_ = relax(held_, settings_, held_.gravity, {}, how).state;
    how.go_on = nullptr;
    strains_ = std::make_unique<Strains>(held_, settings_, how);
  } catch (const RelaxationStopped&) {
    return false;
  } catch (const std::exception& failure) {
    fail("before any strain", failure);
  }
  for (const Part& part : parts_)
    before_.push_back(stress_of(part, held_, Eigen::Matrix3d::Zero()));
  return true;
}

int LayerProber::count(int dim) {
  return 2 * static_cast<int>(dim == 2 ? kPlaneDirections.size() : kLayerDirections.size());
}

std::string LayerProber::direction(int number, int dim) {
  const auto k = static_cast<std::size_t>(number / 2);
  return dim == 2 ? kPlaneDirections[k] : kLayerDirections[k];
}

const Eigen::Matrix3d& LayerProber::stress_before(std::size_t part) const {
  if (before_.empty()) throw std::logic_error("LayerProber: not settled");
  return before_[part];
}

std::optional<ProbeOutcome> LayerProber::probe(int number,
                                               const std::function<bool(double)>& go_on) {
  const auto all = probe_parts(number, go_on);
  if (!all) return std::nullopt;
  return all->front();
}

std::optional<std::vector<ProbeOutcome>> LayerProber::probe_parts(
    int number, const std::function<bool(double)>& go_on) {
  stress_before();
  const std::string way = direction(number, held_.dim);
  const Eigen::Matrix3d imposed = imposed_gradient(way, number % 2 == 0 ? strain_ : -strain_);
  try {
    const Snapshot state = strains_->strain(imposed, go_on).state;
    const ContactChanges changes = compare_contacts(held_, state);
    const double share = 1 / static_cast<double>(std::max<std::size_t>(held_.contacts.size(), 1));
    std::vector<ProbeOutcome> all;
    for (const Part& part : parts_) {
      ProbeOutcome& out = all.emplace_back();
      out.gradient = gradient_of(part, state, imposed);
      out.stress = stress_of(part, state, out.gradient);
      out.gained = share * changes.gained;
      out.lost = share * changes.lost;
      out.sliding = share * changes.newly_sliding;
    }
    return all;
  } catch (const RelaxationStopped&) {
    return std::nullopt;
  } catch (const std::exception& failure) {
    fail("along " + way, failure);
  }
}

Eigen::Matrix3d LayerProber::stress_of(const Part& part, const Snapshot& state,
                                       const Eigen::Matrix3d& gradient) const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Contact& c : state.contacts) {
    if (c.j < 0) continue;
    const auto i = static_cast<std::size_t>(c.i);
    const double share = share_in(part, c);
    if (share == 0) continue;
    sum += share * c.force * (second_place(state, c) - state.grains[i].position).transpose();
  }
  return sum / (part.area * (part.slab.high - part.slab.low) * (1 + gradient.trace()));
}

Eigen::Matrix3d LayerProber::gradient_of(const Part& part, const Snapshot& state,
                                         const Eigen::Matrix3d& imposed) const {
  const bool plane = up_ == 1;
  Eigen::Matrix3d across = imposed;  // what the cell strains
  across.col(2).setZero();
  if (plane) across.setZero();
  double volume = 0, height = 0, square = 0, x_mean = 0;
  Vec3 moved = Vec3::Zero(), slope = Vec3::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 3, 2> slopes = Eigen::Matrix<double, 3, 2>::Zero();
  const auto each = [&](const auto& add) {
    for (std::size_t k = 0; k < held_.grains.size(); ++k) {
      const Grain& g = held_.grains[k];
      const double z = g.position[up_];
      if (g.fixed || z < part.slab.low || z >= part.slab.high) continue;
      if (!part.all_along_x) {
        const double x = place_in_cell(g.position.x());
        if (x < part.left || x >= part.right) continue;
      }
      add(g.volume, g.position, Vec3(state.grains[k].position - g.position - across * g.position));
    }
  };
  each([&](double weight, const Vec3& at, const Vec3& u) {
    volume += weight;
    height += weight * at[up_];
    x_mean += weight * at.x();
    moved += weight * u;
  });
  height /= volume;
  x_mean /= volume;
  moved /= volume;
  each([&](double weight, const Vec3& at, const Vec3& u) {
    const double z = at[up_] - height;
    square += weight * z * z;
    slope += weight * z * (u - moved);
    if (!plane) return;
    const Eigen::Vector2d way(at.x() - x_mean, z);
    squares += weight * way * way.transpose();
    slopes += weight * (u - moved) * way.transpose();
  });
  Eigen::Matrix3d out = across;
  if (plane) {
    out.leftCols<2>() = slopes * squares.inverse();
  } else {
    out.col(2) = slope / square;
  }
  return out;
}

}  // namespace grainfield::dem
