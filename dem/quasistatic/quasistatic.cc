// Load stepping. A load step is first tried by Newton's method alone. When that fails, the step is
// halved; when it is small already, contacts are rearranging, and the packing is let flow to its
// next equilibrium (equilibrium.h).
#include "dem/quasistatic/quasistatic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/quasistatic/contact_network.h"
#include "dem/quasistatic/equilibrium.h"
#include "dem/quasistatic/quasistatic_checks.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/wall_forces.h"

namespace grainfield::dem {
namespace {

// Load steps longer than this share of the change are shortened to it before the flow is tried.
constexpr double kFlowBelow = 0.25;
// After the last load step: solves again with the scale of the new state.
constexpr int kMostFinish = 6;

std::int64_t index_of(const Snapshot& start, std::int64_t id) {
  for (std::size_t k = 0; k < start.grains.size(); ++k) {
    if (start.grains[k].id == id) return static_cast<std::int64_t>(k);
  }
  return -1;
}

/// Indices of the grains that carry the force; the first one's in front.
std::vector<std::int64_t> loaded_in(const Snapshot& start, std::int64_t first,
                                    const std::vector<std::int64_t>& beside) {
  std::vector<std::int64_t> out;
  const auto add = [&](std::int64_t id) {
    const std::int64_t k = id < 0 ? -1 : index_of(start, id);
    if (k >= 0) out.push_back(k);
  };
  add(first);
  for (const std::int64_t id : beside) add(id);
  return out;
}

class Relaxation {
 public:
  Relaxation(const Snapshot& start, const Materials& materials, const Vec3& gravity,
             const AppliedForce& force, const std::vector<std::int64_t>& beside,
             const QuasistaticSettings& settings,
             const Eigen::Matrix3d& gradient = Eigen::Matrix3d::Zero())
      : start_(start),
        settings_(settings),
        network_(make_contact_network(start, materials)),
        equilibrium_(*network_, settings,
                     [this] {
                       if (settings_.go_on && !settings_.go_on(share_)) throw RelaxationStopped();
                     }),
        gravity_(gravity),
        gradient_(gradient),
        before_{loaded_in(start, start.loaded_grain, start.also_loaded), start.applied_force},
        after_{loaded_in(start, force.id, beside), Vec3(force.fx, force.fy, force.fz)},
        beside_(beside) {}

  QuasistaticResult run() {
    double& share = share_;
    double step = 1.0 / settings_.first_steps;
    while (share < 1) {
      step = std::min(step, 1 - share);
      const double next = step > 1 - share - 1e-12 ? 1 : share + step;
      network_->keep();
      if (!gradient_.isZero(0)) network_->strain((next - share) * gradient_);
      set_load(next);
      if (equilibrium_.settle(step > kFlowBelow)) {
        share = next;
        step *= 2;
        continue;
      }
      const double reached = network_->balance().ratio;
      network_->take_back();
      step = step > kFlowBelow ? kFlowBelow : 0.5 * step;
      if (step < settings_.least_step) fail(share, reached);
    }
    return finish();
  }

 private:
  void set_load(double share) {
    network_->set_load(
        start_.gravity + share * (gravity_ - start_.gravity),
        {{before_.grains, (1 - share) * before_.force}, {after_.grains, share * after_.force}});
    equilibrium_.rescale();
  }

  bool balanced(const ContactNetwork::Balance& b) const {
    return std::max(b.ratio, b.moment_ratio) <= settings_.unbalanced_force_ratio;
  }

  QuasistaticResult finish() {
    ContactNetwork::Balance b;
    for (int k = 0; k < kMostFinish; ++k) {
      b = network_->balance();
      if (balanced(b)) break;
      equilibrium_.rescale();
      if (!equilibrium_.settle(false)) break;
      b = network_->balance();
    }
    if (!balanced(b)) fail(1, std::max(b.ratio, b.moment_ratio));
    QuasistaticResult out;
    out.state = network_->snapshot(start_);
    set_wall_forces(out.state);
    out.state.gravity = gravity_;
    const bool loaded = !after_.grains.empty();
    out.state.loaded_grain = loaded ? start_.grains[after_.grains.front()].id : -1;
    out.state.applied_force = loaded ? after_.force : Vec3(0, 0, 0);
    out.state.also_loaded = beside_;
    out.unbalanced_force_ratio = b.ratio;
    out.unbalanced_moment_ratio = b.moment_ratio;
    out.steps = equilibrium_.steps();
    out.iterations = equilibrium_.iterations();
    out.times_apart = equilibrium_.times_apart();
    const ContactChanges changes = compare_contacts(start_, out.state);
    out.contacts_gained = changes.gained;
    out.contacts_lost = changes.lost;
    out.newly_sliding = changes.newly_sliding;
    return out;
  }

  [[noreturn]] void fail(double share, double ratio) const {
    throw ComputationFailed(fmt::format(
        "quasi-static relaxation came to {:.3g} of the change; the next step stopped at an "
        "unbalanced force ratio of {:.2g} (asked for: {:.2g}) after {} iterations in all: contacts "
        "rearrange; lower least_step (now {:g}), raise max_iterations (now {}), make the change "
        "smaller, or use damped dynamics",
        share, ratio, settings_.unbalanced_force_ratio, equilibrium_.iterations(),
        settings_.least_step, settings_.max_iterations));
  }

  const Snapshot& start_;
  const QuasistaticSettings& settings_;
  std::unique_ptr<ContactNetwork> network_;
  Equilibrium equilibrium_;
  Vec3 gravity_;
  Eigen::Matrix3d gradient_;  // of the strain
  ContactNetwork::Load before_, after_;
  std::vector<std::int64_t> beside_;
  double share_ = 0;  // of the change that is done
};

}  // namespace

QuasistaticResult relax(const Snapshot& start, const Materials& materials, const Vec3& gravity,
                        const AppliedForce& force, const QuasistaticSettings& settings,
                        const std::vector<std::int64_t>& beside) {
  check_settings(settings);
  check_start(start);
  if (!materials.materials.empty()) {
    throw std::invalid_argument(
        fmt::format("quasi-static relaxation: found {} materials, allowed: one for all grains",
                    materials.materials.size()));
  }
  if (start.dim == 2 && materials.resist_rolling()) {
    throw std::invalid_argument(
        "quasi-static relaxation in the plane: found resistance against rolling "
        "(material.rolling_friction or "
        "twisting_friction above 0), allowed: none; choose method = \"damped\"");
  }
  if (!gravity.allFinite()) {
    throw std::invalid_argument("quasi-static relaxation: found a gravity that is not finite");
  }
  std::vector<std::int64_t> loaded = beside;
  if (force.id >= 0) loaded.insert(loaded.begin(), force.id);
  for (const std::int64_t id : loaded) {
    const std::int64_t k = index_of(start, id);
    if (k < 0 || start.grains[k].fixed) {
      throw std::invalid_argument(
          fmt::format("quasi-static relaxation: found a force on grain {}, allowed: the id of a "
                      "free grain",
                      id));
    }
    if (!std::isfinite(force.fx) || !std::isfinite(force.fy) || !std::isfinite(force.fz)) {
      throw std::invalid_argument(fmt::format(
          "quasi-static relaxation: found a force on grain {} that is not finite", force.id));
    }
  }
  return Relaxation(start, materials, gravity, force, beside, settings).run();
}

QuasistaticResult strain(const Snapshot& start, const Materials& materials,
                         const Eigen::Matrix3d& gradient, const QuasistaticSettings& settings) {
  check_settings(settings);
  check_gradient(gradient);
  check_strained(start);
  AppliedForce force;
  force.id = start.loaded_grain;
  force.fx = start.applied_force.x();
  force.fy = start.applied_force.y();
  force.fz = start.applied_force.z();
  return Relaxation(start, materials, start.gravity, force, start.also_loaded, settings, gradient)
      .run();
}

}  // namespace grainfield::dem
