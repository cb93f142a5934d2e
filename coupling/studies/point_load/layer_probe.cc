#include "coupling/studies/point_load/layer_probe.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "dem/quasistatic/quasistatic.h"
#include "dem/shared/computation_failed.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/images.h"

namespace grainfield::dem {
namespace {

constexpr std::array kLayerDirections{"xx", "yy", "zz", "yz", "xz", "xy"};
// Balance to be reached, over contact forces: a strain of 1e-6 changes them by about 3e-4.
constexpr double kProbeBalance = 1e-9;

// Share of the way from height a to height b that is between low and high.
double share_within(double a, double b, double low, double high) {
  if (a > b) std::swap(a, b);
  if (a == b) return a >= low && a < high ? 1 : 0;
  return std::max(0.0, std::min(b, high) - std::max(a, low)) / (b - a);
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

}  // namespace

LayerProber::LayerProber(const Snapshot& layer, const EngineSettings& settings, double height,
                         double strain)
    : settings_(settings),
      strain_(strain),
      low_(kSlabLow * height),
      high_(kSlabHigh * height),
      area_(layer.cell.edges.topLeftCorner<2, 2>().determinant()),
      held_(layer) {
  double diameter = 0;
  int free = 0;
  for (const Grain& g : layer.grains) {
    if (g.fixed) continue;
    diameter += 2 * g.radius;
    ++free;
  }
  diameter /= std::max(free, 1);
  for (Grain& g : held_.grains) {
    g.fixed = g.fixed || g.position.z() < diameter || g.position.z() > height - diameter;
  }
  // Between two that are held nothing is left to find out.
  std::erase_if(held_.contacts, [this, height](const Contact& c) {
    const auto held = [this](std::int64_t k) {
      return held_.grains[static_cast<std::size_t>(k)].fixed;
    };
    if (!held(c.i) || (c.j >= 0 && !held(c.j))) return false;
    if (c.j < 0) return true;  // with a wall
    const double z = held_.grains[static_cast<std::size_t>(c.i)].position.z();
    if (share_within(z, second_place(held_, c).z(), low_, high_) > kMostLost)
      refuse_thin_layer(height);
    return true;
  });
}

void LayerProber::fail(const std::string& what, const std::exception& failure) const {
  throw ComputationFailed(
      fmt::format("load.probe_strain = {:g}, {}: {}; or set "
                  "load.probe_strain = 0{}",
                  strain_, what, failure.what(), before_ ? ", or a smaller one" : ""));
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
  before_ = stress_of(held_, Eigen::Matrix3d::Zero());
  return true;
}

int LayerProber::count() { return 2 * static_cast<int>(kLayerDirections.size()); }

std::string LayerProber::direction(int number) {
  return kLayerDirections[static_cast<std::size_t>(number / 2)];
}

const Eigen::Matrix3d& LayerProber::stress_before() const {
  if (!before_) throw std::logic_error("LayerProber: not settled");
  return *before_;
}

std::optional<ProbeOutcome> LayerProber::probe(int number,
                                               const std::function<bool(double)>& go_on) {
  stress_before();
  const Eigen::Matrix3d imposed =
      imposed_gradient(direction(number), number % 2 == 0 ? strain_ : -strain_);
  try {
    const Snapshot state = strains_->strain(imposed, go_on).state;
    ProbeOutcome out;
    out.gradient = gradient_of(state, imposed);
    out.stress = stress_of(state, out.gradient);
    const ContactChanges changes = compare_contacts(held_, state);
    const double share = 1 / static_cast<double>(std::max<std::size_t>(held_.contacts.size(), 1));
    out.gained = share * changes.gained;
    out.lost = share * changes.lost;
    out.sliding = share * changes.newly_sliding;
    return out;
  } catch (const RelaxationStopped&) {
    return std::nullopt;
  } catch (const std::exception& failure) {
    fail("along " + direction(number), failure);
  }
}

Eigen::Matrix3d LayerProber::stress_of(const Snapshot& state,
                                       const Eigen::Matrix3d& gradient) const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Contact& c : state.contacts) {
    if (c.j < 0) continue;
    const auto i = static_cast<std::size_t>(c.i);
    const double share =
        share_within(held_.grains[i].position.z(), second_place(held_, c).z(), low_, high_);
    if (share == 0) continue;
    sum += share * c.force * (second_place(state, c) - state.grains[i].position).transpose();
  }
  return sum / (area_ * (high_ - low_) * (1 + gradient.trace()));
}

Eigen::Matrix3d LayerProber::gradient_of(const Snapshot& state,
                                         const Eigen::Matrix3d& imposed) const {
  Eigen::Matrix3d across = imposed;  // what the cell strains
  across.col(2).setZero();
  double volume = 0, height = 0, square = 0;
  Vec3 moved = Vec3::Zero(), slope = Vec3::Zero();
  const auto each = [&](const auto& add) {
    for (std::size_t k = 0; k < held_.grains.size(); ++k) {
      const Grain& g = held_.grains[k];
      const double z = g.position.z();
      if (g.fixed || z < low_ || z >= high_) continue;
      add(g.volume, z, Vec3(state.grains[k].position - g.position - across * g.position));
    }
  };
  each([&](double weight, double z, const Vec3& u) {
    volume += weight;
    height += weight * z;
    moved += weight * u;
  });
  height /= volume;
  moved /= volume;
  each([&](double weight, double z, const Vec3& u) {
    square += weight * (z - height) * (z - height);
    slope += weight * (z - height) * (u - moved);
  });
  Eigen::Matrix3d out = across;
  out.col(2) = slope / square;
  return out;
}

}  // namespace grainfield::dem
