#include "dem/quasistatic/strains.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "dem/quasistatic/equilibrium.h"
#include "dem/quasistatic/quasistatic_checks.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/wall_forces.h"

namespace grainfield::dem {
namespace {

// A chord leaves at most this share of the residual's 2-norm, or a contact has changed: without a
// change it leaves about the linear solver's tolerance.
constexpr double kMostLeft = 0.1;
constexpr int kMostChords = 12;
// Shares of the ratio asked for, which the mean resultant and mean moment must be below; and how
// many times the ratio a single grain's may be (as Equilibrium::enough of a large packing).
constexpr double kEnoughForce = 0.05, kEnoughMoment = 0.1, kMostOver = 100;

/// The gradient or its opposite, the one whose first entry that is not 0 is positive.
Eigen::Matrix3d forth(const Eigen::Matrix3d& gradient) {
  const auto entries = gradient.reshaped();
  const auto first = std::find_if(entries.begin(), entries.end(), [](double e) { return e != 0; });
  return first != entries.end() && *first < 0 ? Eigen::Matrix3d(-gradient) : gradient;
}

}  // namespace

Strains::Strains(const Snapshot& start, const Materials& materials,
                 const QuasistaticSettings& settings)
    : start_(start), materials_(materials), settings_(settings) {
  check_settings(settings);
  check_strained(start);
  network_ = make_contact_network(start, materials);
  std::vector<ContactNetwork::Load> loads(1);
  for (std::size_t k = 0; k < start.grains.size(); ++k) {
    const std::int64_t id = start.grains[k].id;
    const bool loaded = id == start.loaded_grain || std::ranges::count(start.also_loaded, id) > 0;
    if (loaded) loads[0].grains.push_back(static_cast<std::int64_t>(k));
  }
  loads[0].force = start.applied_force;
  network_->set_load(start.gravity, loads);
  network_->set_scale(1);
  const ContactNetwork::Balance b = network_->balance();
  if (!(b.mean_contact_force > 0)) return;
  network_->set_scale(b.mean_contact_force);
  Vector r;
  const Vector none = Vector::Zero(network_->size());
  if (!network_->residual(none, r)) return;
  network_->tangent(none, r, none, tangent_);
  solver_ = solver_of(*network_);
  if (!solver_->prepare(tangent_)) solver_.reset();
}

bool Strains::enough(const Vector& r) const {
  const double ratio = settings_.unbalanced_force_ratio;
  return network_->mean_resultant(r) <= kEnoughForce * ratio &&
         network_->mean_moment(r) <= kEnoughMoment * ratio &&
         r.cwiseAbs().maxCoeff() <= kMostOver * ratio;
}

/// The chord's step from where the residual is r; false: none was found.
bool Strains::better(const Vector& r, Vector& dz) {
  solver_->solve(-r, dz);
  return dz.allFinite() && dz.cwiseAbs().maxCoeff() <= ContactNetwork::kMostMove;
}

/// The first chord's step of a strain, linear in it.
std::optional<Strains::Vector> Strains::response(const Eigen::Matrix3d& gradient) {
  const Eigen::Matrix3d one = forth(gradient);
  if (!last_ || last_->gradient != one) {
    last_.reset();
    Vector r, dz;
    network_->keep();
    network_->strain(one);
    const bool found = network_->residual(Vector::Zero(network_->size()), r) && better(r, dz);
    network_->take_back();
    if (!found) return std::nullopt;
    last_.emplace(one, std::move(dz));
  }
  return one == gradient ? last_->z : Vector(-last_->z);
}

/// None: a contact changes.
std::optional<QuasistaticResult> Strains::by_chords(const Eigen::Matrix3d& gradient,
                                                    const std::function<bool(double)>& go_on) {
  const auto ask = [&] {
    if (go_on && !go_on(0)) throw RelaxationStopped();
  };
  ask();
  std::optional<Vector> z = response(gradient);
  if (!z) return std::nullopt;
  network_->keep();
  network_->strain(gradient);
  const auto give_up = [&] {
    network_->take_back();
    return std::nullopt;
  };
  QuasistaticResult out;
  out.iterations = 1;
  Vector r, dz;
  for (double before = 0;; ++out.iterations) {
    if (!network_->residual(*z, r)) return give_up();
    if (enough(r)) break;
    const double now = r.norm();
    if (out.iterations > kMostChords || (before > 0 && now > kMostLeft * before)) return give_up();
    before = now;
    try {
      ask();
    } catch (...) {
      network_->take_back();
      throw;
    }
    if (!better(r, dz)) return give_up();
    *z += dz;
  }
  network_->commit(*z);
  const ContactNetwork::Balance b = network_->balance();
  if (std::max(b.ratio, b.moment_ratio) > settings_.unbalanced_force_ratio) return give_up();
  out.state = network_->snapshot(start_);
  network_->take_back();
  set_wall_forces(out.state);
  out.unbalanced_force_ratio = b.ratio;
  out.unbalanced_moment_ratio = b.moment_ratio;
  const ContactChanges changes = compare_contacts(start_, out.state);
  out.contacts_gained = changes.gained;
  out.contacts_lost = changes.lost;
  out.newly_sliding = changes.newly_sliding;
  return out;
}

QuasistaticResult Strains::strain(const Eigen::Matrix3d& gradient,
                                  const std::function<bool(double)>& go_on) {
  check_gradient(gradient);
  if (solver_) {
    if (std::optional<QuasistaticResult> done = by_chords(gradient, go_on)) return *done;
  }
  QuasistaticSettings how = settings_;
  how.go_on = go_on;
  return dem::strain(start_, materials_, gradient, how);
}

}  // namespace grainfield::dem
