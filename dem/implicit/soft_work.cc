#include "dem/implicit/soft_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "dem/implicit/soft_checks.h"
#include "dem/shared/computation_failed.h"

namespace grainfield::dem {
namespace {

using soft_contact::Derived3;

// A step with relaxation 1 that has not lowered the residual's 2-norm to kProgress of it in so many
// iterations stalls; with less relaxation as many more are allowed.
constexpr double kPatience = 12, kProgress = 0.7;
// An iteration that lowers the largest residual to this share of it keeps its factors for the next.
constexpr double kKeep = 0.01;
// First guess for a disk that touches another: so much of the way that its velocity would take it.
// In the trapezoidal rule the velocities of stiff contacts swing from step to step.
constexpr double kSwing = 0.25;
// Round-off of a force K s, in units of K times the widest diameter times epsilon.
constexpr double kRoundOff = 16;
// The pairs' margin: so much more than what a step is expected to move, and at least this share of
// the widest radius, so that lists last.
constexpr double kMargin = 2, kLeastMargin = 0.05;

bool before(const SoftCandidate& a, const SoftCandidate& b) {
  return a.i != b.i ? a.i < b.i : a.j < b.j;
}

}  // namespace

SoftDisks::Work::Work(const SoftScene& scene, const std::vector<Body<2>>& disks,
                      const ImplicitSettings& settings)
    : scene_(scene),
      settings_(settings),
      bodies_(disks),
      angles_(disks.size(), 0.0),
      acting_(disks.size(), 1) {
  check_soft(scene, disks, settings);
  if (takes_end()) last_.resize(disks.size());
  for (const Body<2>& b : bodies_) widest_ = std::max(widest_, b.radius);
  stiffest_ = scene.grains.stiffness;
  for (const SoftWall& w : scene.walls) stiffest_ = std::max(stiffest_, w.law.stiffness);
}

void SoftDisks::Work::step(long steps) {
  for (long k = 0; k < steps; ++k) {
    while (!try_part()) {
    }
  }
}

bool SoftDisks::Work::try_part() {
  if (pending_.empty()) pending_ = {0};
  const int halvings = pending_.back();
  const double dt = std::ldexp(settings_.time_step, -halvings);
  if (try_step(dt)) {
    pending_.pop_back();
  } else if (halvings >= settings_.most_halvings) {
    throw ComputationFailed(
        fmt::format("implicit motion: no step at t = {:.6g} s, not even of {:.3g} s, {} halvings "
                    "of time_step = {:g} s: {}; take a smaller time_step or more max_iterations",
                    time_, dt, halvings, settings_.time_step, why_));
  } else {
    ++tally_.halved;
    pending_.back() = halvings + 1;
    pending_.push_back(halvings + 1);
  }
  if (!pending_.empty()) return false;
  ++tally_.steps;
  time_ = static_cast<double>(tally_.steps) * settings_.time_step;
  return true;
}

void SoftDisks::Work::set_acting(const std::vector<char>& acting) {
  if (acting.size() != bodies_.size()) throw std::invalid_argument("one value a disk");
  acting_ = acting;
  for (SoftCandidate& c : candidates_) {
    if (acts(c)) continue;
    c.memory = {};
    c.touched = false;
  }
}

void SoftDisks::Work::set_velocities(const std::vector<Body<2>>& bodies) {
  if (bodies.size() != bodies_.size()) throw std::invalid_argument("one body a disk");
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    bodies_[k].velocity = bodies[k].velocity;
    bodies_[k].spin = bodies[k].spin;
  }
  last_dt_ = 0;
}

bool SoftDisks::Work::try_step(double dt) {
  dt_ = dt;
  const double ratio = last_dt_ > 0 ? dt / last_dt_ : 0;
  gamma_ = ratio * ratio / (1 + 2 * ratio);
  beta_ = (1 + ratio) / (1 + 2 * ratio);
  Vector z(3 * count());
  predict(z);
  if (margin_ < 0 || !listed_for(z)) {
    // A guess may be further off than any step that is taken.
    const double most = z.size() > 0 ? z.cwiseAbs().maxCoeff() : 0;
    list(kMargin * widest_ * std::min(most, settings_.most_move));
  }
  const Vector guess = z;
  for (;;) {
    const NewtonReport report = solve(z);
    if (!report.converged) {
      why_ = "Newton's method did not converge: " + report.why;
      return false;
    }
    double furthest = 0;
    for (int k = 0; k < count(); ++k) furthest = std::max(furthest, z.segment<2>(3 * k).norm());
    if (furthest > settings_.most_move) {
      why_ = fmt::format("a disk would move by {:.3g} of its radius, above most_move = {:g}",
                         furthest, settings_.most_move);
      return false;
    }
    if (!listed_for(z)) {
      list(kMargin * widest_ * furthest);
      z = guess;
      continue;
    }
    ++tally_.solves;
    tally_.iterations += report.iterations;
    tally_.most_iterations = std::max(tally_.most_iterations, report.iterations);
    tally_.least_step = tally_.least_step > 0 ? std::min(tally_.least_step, dt) : dt;
    commit(z);
    return true;
  }
}

// A disk that touches nothing flies freely: the guess is the solution. One that touches is held.
void SoftDisks::Work::predict(Vector& z) const {
  std::vector<bool> held(bodies_.size(), false);
  for (const SoftCandidate& c : candidates_) {
    if (!c.touched) continue;
    held[c.i] = true;
    if (c.j >= 0) held[c.j] = true;
  }
  if (takes_end()) return predict_at_end(z, held);
  const double drag = scene_.background_damping;
  for (int k = 0; k < count(); ++k) {
    const Body<2>& b = bodies_[k];
    const bool free = b.inverse_mass > 0;
    const double share = free && held[k] ? kSwing : 1;
    Vec u = share * dt_ * plain(b.velocity);
    if (free && !held[k]) {
      u = (u + 0.5 * dt_ * dt_ * plain(scene_.gravity)) / (1 + 0.5 * drag * dt_);
    }
    z.segment<2>(3 * k) = u / b.radius;
    z[3 * k + 2] = share * dt_ * b.spin;
  }
}

void SoftDisks::Work::predict_at_end(Vector& z, const std::vector<bool>& held) const {
  const double step = beta_ * dt_, slow = 1 + step * scene_.background_damping;
  for (int k = 0; k < count(); ++k) {
    const Body<2>& b = bodies_[k];
    Vec u = dt_ * plain(b.velocity);
    if (b.inverse_mass > 0 && !held[k]) {
      u = gamma_ * last_[k].way + step * (velocity_along(k) + step * plain(scene_.gravity)) / slow;
    }
    z.segment<2>(3 * k) = u / b.radius;
    z[3 * k + 2] = b.inverse_inertia > 0 && !held[k]
                       ? gamma_ * last_[k].turn + step * spin_along(k) / slow
                       : dt_ * b.spin;
  }
}

bool SoftDisks::Work::listed_for(const Vector& z) const {
  for (int k = 0; k < count(); ++k) {
    const Vec now = plain(bodies_[k].position - listed_[k]);
    const Vec then = now + bodies_[k].radius * z.segment<2>(3 * k);
    if (!(std::max(now.norm(), then.norm()) <= margin_)) return false;
  }
  return true;
}

void SoftDisks::Work::list(double margin) {
  margin_ = std::max(margin, kLeastMargin * widest_);
  std::vector<Reach<2>> reaches;
  listed_.clear();
  for (const Body<2>& b : bodies_) {
    reaches.push_back({b.position, b.radius + margin_, b.inverse_mass == 0});
    listed_.push_back(b.position);
  }
  std::vector<std::pair<int, int>> pairs;
  grid_.build(reaches);
  grid_.pairs(pairs);
  std::vector<SoftCandidate> found;
  for (int k = 0; k < count(); ++k) {
    for (int w = 0; w < static_cast<int>(scene_.walls.size()); ++w) {
      SoftCandidate c;
      c.i = k;
      c.j = -1 - w;
      if (overlap(c) + margin_ > 0) found.push_back(c);
    }
  }
  for (const auto& [i, j] : pairs) {
    SoftCandidate c;
    c.i = i;
    c.j = j;
    found.push_back(c);
  }
  std::sort(found.begin(), found.end(), before);
  for (SoftCandidate& c : found) {
    const auto old = std::lower_bound(candidates_.begin(), candidates_.end(), c, before);
    if (old != candidates_.end() && old->i == c.i && old->j == c.j) {
      c.memory = old->memory;
      c.touched = old->touched;
    } else {
      c.touched = acts(c) && overlap(c) > 0;
    }
  }
  candidates_ = std::move(found);
  lay_out();
}

// Places of these candidates in the matrix, which is laid out anew only for pairs that it lacks.
void SoftDisks::Work::lay_out() {
  std::vector<std::pair<int, int>> pairs;
  for (const SoftCandidate& c : candidates_) {
    if (c.j >= 0) pairs.emplace_back(c.i, c.j);
  }
  const bool has = std::includes(blocks_.begin(), blocks_.end(), pairs.begin(), pairs.end());
  if (!has) blocks_ = std::move(pairs);
  if (!has || matrix_.size() != count()) matrix_.lay_out(count(), blocks_);
  for (SoftCandidate& c : candidates_) {
    c.places[0] = matrix_.place(c.i, c.i);
    if (c.j < 0) continue;
    c.places[1] = matrix_.place(c.i, c.j);
    c.places[2] = matrix_.place(c.j, c.i);
    c.places[3] = matrix_.place(c.j, c.j);
  }
}

// What the residual is measured by: weights, changes of momentum and contact forces, by the first
// guess.
double SoftDisks::Work::largest_force(const Vector& z) const {
  double out = std::numeric_limits<double>::min();
  const double g = plain(scene_.gravity).norm();
  for (const Body<2>& b : bodies_) {
    if (!(b.inverse_mass > 0)) continue;
    out = std::max(out, (g + 2 * plain(b.velocity).norm() / dt_) / b.inverse_mass);
    if (b.inverse_inertia > 0) {
      out = std::max(out, 2 * std::fabs(b.spin) / (dt_ * b.inverse_inertia * b.radius));
    }
  }
  SoftForce<double> f;
  for (const SoftCandidate& c : candidates_) {
    if (!acts(c)) continue;
    out = std::max(out, law_of(c).stiffness * overlap(c));
    if (force_of(c, motion_of(c, z), f)) out = std::max(out, f.normal);
  }
  return out;
}

// How far a force moves the lightest disk in the step, over its radius.
double SoftDisks::Work::move_by(double force) const {
  double out = 0;
  for (const Body<2>& b : bodies_) {
    out = std::max(out, force * b.inverse_mass * dt_ * dt_ / b.radius);
  }
  return out > 0 ? out : 1;
}

NewtonReport SoftDisks::Work::solve(Vector& z) {
  scale_ = largest_force(z);
  NewtonProblem problem;
  problem.residual = [this](const Vector& at, Vector& r) { return residual(at, r); };
  double before = 0;
  problem.factorize = [this, &before](const Vector& at, const Vector& r) {
    const double now = r.cwiseAbs().maxCoeff();
    const bool keep = now < kKeep * before;
    before = now;
    return keep || factorize(at);
  };
  problem.solve = [this](const Vector& rhs, Vector& x) {
    matrix_.solve(rhs, x);
    x *= settings_.relaxation;
  };
  NewtonSettings how;
  const double epsilon = std::numeric_limits<double>::epsilon();
  how.tolerance =
      std::max(settings_.tolerance, kRoundOff * epsilon * stiffest_ * 2 * widest_ / scale_);
  how.max_iterations = settings_.max_iterations;
  how.scale = move_by(scale_);
  how.patience = static_cast<std::size_t>(kPatience / settings_.relaxation);
  how.progress = kProgress;
  return newton(problem, how, z);
}

bool SoftDisks::Work::residual(const Vector& z, Vector& r) const {
  if (!z.allFinite() || z.cwiseAbs().maxCoeff() > 2 * settings_.most_move + 1) return false;
  r.resize(z.size());
  const double drag = scene_.background_damping;
  for (int k = 0; k < count(); ++k) {
    const Body<2>& b = bodies_[k];
    const Vec u = b.radius * z.segment<2>(3 * k);
    const double a = z[3 * k + 2];
    const bool end = takes_end();
    const Vec v = end ? velocity_after(k, u) : Vec(u / dt_);
    const double w = end ? spin_after(k, a) : a / dt_;
    if (b.inverse_mass > 0) {
      const Vec change = end ? Vec((v - velocity_along(k)) / (beta_ * dt_))
                             : Vec(2 / dt_ * (v - plain(b.velocity)));
      const Vec rate = change + drag * v - plain(scene_.gravity);
      r.segment<2>(3 * k) = rate / (b.inverse_mass * scale_);
    } else {
      r.segment<2>(3 * k) = z.segment<2>(3 * k) - dt_ / b.radius * plain(b.velocity);
    }
    if (b.inverse_inertia > 0) {
      const double change = end ? (w - spin_along(k)) / (beta_ * dt_) : 2 / dt_ * (w - b.spin);
      r[3 * k + 2] = (change + drag * w) / (b.inverse_inertia * b.radius * scale_);
    } else {
      r[3 * k + 2] = z[3 * k + 2] - dt_ * b.spin;
    }
  }
  SoftForce<double> f;
  const auto add = [&](int k, double sign, double share) {
    const Body<2>& b = bodies_[k];
    if (b.inverse_mass > 0) r.segment<2>(3 * k) -= sign / scale_ * f.force;
    if (b.inverse_inertia > 0) r[3 * k + 2] -= share * f.moment / (b.radius * scale_);
  };
  for (const SoftCandidate& c : candidates_) {
    if (!force_of(c, motion_of(c, z), f)) continue;
    const double share = share_i(c);
    add(c.i, 1, share);
    if (c.j >= 0) add(c.j, -1, 1 - share);
  }
  return true;
}

bool SoftDisks::Work::factorize(const Vector& z) {
  matrix_.clear();
  const double drag = scene_.background_damping, step = beta_ * dt_;
  const double rate = takes_end() ? (1 / step + drag) / step : (2 / dt_ + drag) / dt_;
  for (int k = 0; k < count(); ++k) {
    const Body<2>& b = bodies_[k];
    const double move = b.inverse_mass > 0 ? rate * b.radius / (b.inverse_mass * scale_) : 1;
    const double turn = b.inverse_inertia > 0 ? rate / (b.inverse_inertia * b.radius * scale_) : 1;
    matrix_.at(matrix_.place(k, k)).diagonal() = Eigen::Vector3d(move, move, turn);
  }
  SoftForce<Derived3> f;
  for (const SoftCandidate& c : candidates_) {
    const SoftMotion<double> at = motion_of(c, z);
    SoftMotion<Derived3> m;
    m.shift.x() = Derived3(at.shift.x(), 3, 0);
    m.shift.y() = Derived3(at.shift.y(), 3, 1);
    m.turn = Derived3(at.turn, 3, 2);
    if (!force_of(c, m, f)) continue;
    Eigen::Matrix3d slopes;
    slopes.row(0) = f.force.x().derivatives();
    slopes.row(1) = f.force.y().derivatives();
    slopes.row(2) = f.moment.derivatives();
    slopes /= scale_;
    const double share = share_i(c);
    const auto rows_of = [&](int k, double sign, double part) {
      const Body<2>& b = bodies_[k];
      const double push = b.inverse_mass > 0 ? sign : 0;
      return Eigen::Vector3d(push, push, b.inverse_inertia > 0 ? part / b.radius : 0);
    };
    const auto columns_of = [&](int k, double sign, double part) {
      const double r = bodies_[k].radius;
      return Eigen::Vector3d(sign * r, sign * r, part);
    };
    const auto add = [&](int place, const Eigen::Vector3d& rows, const Eigen::Vector3d& columns) {
      matrix_.at(place) -= rows.asDiagonal() * slopes * columns.asDiagonal();
    };
    const Eigen::Vector3d rows_i = rows_of(c.i, 1, share), columns_i = columns_of(c.i, 1, share);
    add(c.places[0], rows_i, columns_i);
    if (c.j < 0) continue;
    const Eigen::Vector3d rows_j = rows_of(c.j, -1, 1 - share);
    const Eigen::Vector3d columns_j = columns_of(c.j, -1, 1 - share);
    add(c.places[1], rows_i, columns_j);
    add(c.places[2], rows_j, columns_i);
    add(c.places[3], rows_j, columns_j);
  }
  return matrix_.factorize();
}

void SoftDisks::Work::commit(const Vector& z) {
  const double before = takes_end() ? energy().total() + losses_.total() : 0;
  SoftForce<double> f;
  for (SoftCandidate& c : candidates_) {
    const bool acts = force_of(c, motion_of(c, z), f);
    c.touched = acts && f.overlap_end > 0;
    if (!acts) {
      c.memory = {};
      continue;
    }
    losses_.normal += (f.normal - f.elastic) * f.closing;
    losses_.well -= f.well * f.along;
    const SoftLaw& law = law_of(c);
    double stored = 0;
    if (law.tangential_stiffness > 0) {
      stored = 0.5 * (f.spring * f.spring - c.memory.spring * c.memory.spring) /
               law.tangential_stiffness;
    }
    losses_.tangential -= f.tangential * f.slip + stored;
    c.memory.spring = f.spring;
    if (!c.touched) {
      c.memory = {};
    } else if (c.j < 0 && law.static_friction > 0) {
      // It breaks where the disk leaves it, and forms anew where the disk comes to rest or turns
      // round; at once if the law says so.
      const double from = place(c), to = from + f.along;
      const SoftWall& w = scene_.walls[static_cast<std::size_t>(-1 - c.j)];
      const double v0 =
          w.normal.y() * bodies_[c.i].velocity.x() - w.normal.x() * bodies_[c.i].velocity.y();
      const SoftStep step = step_of(c);
      const double v1 =
          step.end ? (f.along - (w.normal.y() * step.drift.x() - w.normal.x() * step.drift.y())) *
                         step.rate
                   : 2 * f.along / dt_ - v0;
      const bool stays = c.memory.whole && std::fabs(to - c.memory.rest) <= law.well;
      if (!stays) {
        c.memory.whole = law.renewed || (!c.memory.whole && v0 * v1 <= 0);
        if (c.memory.whole) c.memory.rest = to;
      }
    }
  }
  for (int k = 0; k < count(); ++k) {
    Body<2>& b = bodies_[k];
    const Vec u = b.radius * z.segment<2>(3 * k), v = u / dt_;
    const double turn = z[3 * k + 2], w = turn / dt_;
    const double drag = scene_.background_damping * dt_;
    const Vec first = plain(b.velocity);
    const double first_spin = b.spin;
    if (b.inverse_mass > 0) {
      losses_.background += drag * v.squaredNorm() / b.inverse_mass;
      b.velocity = takes_end() ? velocity_after(k, u) : Vec(2 * v - first);
    }
    if (b.inverse_inertia > 0) {
      losses_.background += drag * w * w / b.inverse_inertia;
      b.spin = takes_end() ? spin_after(k, turn) : 2 * w - first_spin;
    }
    if (takes_end()) last_[k] = {u, first, turn, first_spin};
    b.position += u;
    angles_[k] += turn;
  }
  last_dt_ = dt_;
  time_ += dt_;
  if (takes_end()) losses_.scheme += before - energy().total() - losses_.total();
}

}  // namespace grainfield::dem
