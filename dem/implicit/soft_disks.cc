#include "dem/implicit/soft_disks.h"

#include <fmt/format.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/computation_failed.h"
#include "dem/image/image.h"
#include "dem/implicit/soft_checks.h"
#include "dem/neighbours/hierarchical_grid.h"
#include "dem/newton/newton.h"
#include "dem/quasistatic/block_matrix.h"

namespace grainfield::dem {
namespace {

using Vector = Eigen::VectorXd;
using Vec = Eigen::Vector2d;
using soft_contact::Derived3;

// A step with relaxation 1 that has not lowered the residual's 2-norm to kProgress of it in so many
// iterations stalls; with less relaxation as many more are allowed.
constexpr double kPatience = 12, kProgress = 0.7;
// Round-off of a force K s, in units of K times the widest diameter times epsilon.
constexpr double kRoundOff = 16;
// The pairs' margin: so much more than what a step is expected to move, and at least this share of
// the widest radius, so that lists last.
constexpr double kMargin = 2, kLeastMargin = 0.05;
// The diagonal pivot is taken unless it is this much smaller: the tangent is nearly symmetric.
constexpr double kPivotThreshold = 0.01;

Vec plain(const VectorOf<2>& v) { return {v.x(), v.y()}; }

struct Candidate {
  int i = 0, j = 0;  // j = -1 - w: wall w
  SoftMemory memory;
  bool touched = false;         // at the end of the last step
  std::array<int, 4> places{};  // of the blocks (i, i), (i, j), (j, i), (j, j) in the matrix
};

bool before(const Candidate& a, const Candidate& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; }

}  // namespace

class SoftDisks::Work {
 public:
  Work(const SoftScene& scene, const std::vector<Body<2>>& disks, const ImplicitSettings& settings)
      : scene_(scene), settings_(settings), bodies_(disks), angles_(disks.size(), 0.0) {
    check_soft(scene, disks, settings);
    for (const Body<2>& b : bodies_) widest_ = std::max(widest_, b.radius);
    stiffest_ = scene.grains.stiffness;
    for (const SoftWall& w : scene.walls) stiffest_ = std::max(stiffest_, w.law.stiffness);
    solver_.setPivotThreshold(kPivotThreshold);
  }

  void step(long steps) {
    for (long k = 0; k < steps; ++k) {
      time_ = static_cast<double>(tally_.steps) * settings_.time_step;
      advance(settings_.time_step, 0);
      ++tally_.steps;
      time_ = static_cast<double>(tally_.steps) * settings_.time_step;
    }
  }

  double time() const { return time_; }
  const std::vector<Body<2>>& bodies() const { return bodies_; }
  const std::vector<double>& angles() const { return angles_; }
  const SoftLosses& losses() const { return losses_; }
  const ImplicitTally& tally() const { return tally_; }
  SoftEnergy energy() const;
  std::vector<SoftTouch> touches() const;
  SoftRest rest() const;
  std::string image() const;
  void restore(const std::string& image);

 private:
  int count() const { return static_cast<int>(bodies_.size()); }
  const SoftLaw& law_of(const Candidate& c) const {
    return c.j < 0 ? scene_.walls[static_cast<std::size_t>(-1 - c.j)].law : scene_.grains;
  }
  /// Share of the distance of the centres that belongs to each disk.
  double share_i(const Candidate& c) const {
    return c.j < 0 ? 1 : bodies_[c.i].radius / (bodies_[c.i].radius + bodies_[c.j].radius);
  }

  /// Height above a wall and place along it.
  double height(const Candidate& c) const {
    const SoftWall& w = scene_.walls[static_cast<std::size_t>(-1 - c.j)];
    return plain(w.normal).dot(plain(bodies_[c.i].position - w.point));
  }
  double place(const Candidate& c) const {
    const SoftWall& w = scene_.walls[static_cast<std::size_t>(-1 - c.j)];
    const Vec x = plain(bodies_[c.i].position - w.point);
    return w.normal.y() * x.x() - w.normal.x() * x.y();
  }
  double overlap(const Candidate& c) const {
    if (c.j < 0) return bodies_[c.i].radius - height(c);
    return bodies_[c.i].radius + bodies_[c.j].radius -
           plain(bodies_[c.j].position - bodies_[c.i].position).norm();
  }
  /// Pull of a wall's well now, N.
  double well_now(const Candidate& c) const {
    const SoftLaw& law = law_of(c);
    const double s = overlap(c);
    if (c.j >= 0 || !c.memory.whole || !(law.static_friction > 0) || !(s > 0)) return 0;
    const double most = law.static_friction * law.stiffness * s;
    return -std::clamp(most / law.well * (place(c) - c.memory.rest), -most, most);
  }

  template <class T>
  bool force_of(const Candidate& c, const SoftMotion<T>& m, SoftForce<T>& out) const {
    const SoftLaw& law = law_of(c);
    if (c.j < 0) {
      const SoftWall& w = scene_.walls[static_cast<std::size_t>(-1 - c.j)];
      return soft_wall(law, dt_, Vec(-plain(w.normal)), height(c), place(c), bodies_[c.i].radius,
                       c.memory, m, out);
    }
    const Vec way = plain(bodies_[c.j].position - bodies_[c.i].position);
    return soft_pair(law, dt_, way, bodies_[c.i].radius + bodies_[c.j].radius, c.memory, m, out);
  }
  /// From the unknowns (u/R, a) of all disks.
  SoftMotion<double> motion_of(const Candidate& c, const Vector& z) const {
    const double share = share_i(c);
    SoftMotion<double> m;
    m.shift = bodies_[c.i].radius * z.segment<2>(3 * c.i);
    m.turn = share * z[3 * c.i + 2];
    if (c.j >= 0) {
      m.shift -= bodies_[c.j].radius * z.segment<2>(3 * c.j);
      m.turn += (1 - share) * z[3 * c.j + 2];
    }
    return m;
  }

  void advance(double dt, int halvings);
  bool try_step(double dt);
  void predict(Vector& z) const;
  void list(double margin);
  void lay_out();
  bool listed_for(const Vector& z) const;
  double largest_force(const Vector& z) const;
  NewtonReport solve(Vector& z);
  bool residual(const Vector& z, Vector& r) const;
  bool factorize(const Vector& z);
  void commit(const Vector& z);

  SoftScene scene_;
  ImplicitSettings settings_;
  std::vector<Body<2>> bodies_;
  std::vector<double> angles_;
  double widest_ = 0, stiffest_ = 0;  // m, N/m
  double time_ = 0, dt_ = 0, scale_ = 1;
  ImplicitTally tally_;
  SoftLosses losses_;
  std::string why_;  // the last step failed

  HierarchicalGrid<2> grid_;
  std::vector<Candidate> candidates_;
  std::vector<VectorOf<2>> listed_;  // places when the list was made
  double margin_ = -1;               // m

  Eigen::SparseMatrix<double> matrix_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> solver_;
  bool analysed_ = false;
};

void SoftDisks::Work::advance(double dt, int halvings) {
  if (try_step(dt)) return;
  if (halvings >= settings_.most_halvings) {
    throw ComputationFailed(
        fmt::format("implicit motion: no step at t = {:.6g} s, not even of {:.3g} s, {} halvings "
                    "of time_step = {:g} s: {}; take a smaller time_step or more max_iterations",
                    time_, dt, halvings, settings_.time_step, why_));
  }
  ++tally_.halved;
  advance(0.5 * dt, halvings + 1);
  advance(0.5 * dt, halvings + 1);
}

bool SoftDisks::Work::try_step(double dt) {
  dt_ = dt;
  Vector z(3 * count());
  predict(z);
  if (margin_ < 0 || !listed_for(z)) {
    list(kMargin * widest_ * (z.size() > 0 ? z.cwiseAbs().maxCoeff() : 0));
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
  for (const Candidate& c : candidates_) {
    if (!c.touched) continue;
    held[c.i] = true;
    if (c.j >= 0) held[c.j] = true;
  }
  const double drag = scene_.background_damping;
  for (int k = 0; k < count(); ++k) {
    const Body<2>& b = bodies_[k];
    const bool free = b.inverse_mass > 0;
    Vec u = dt_ * plain(b.velocity);
    if (free && !held[k]) {
      u = (u + 0.5 * dt_ * dt_ * plain(scene_.gravity)) / (1 + 0.5 * drag * dt_);
    }
    z.segment<2>(3 * k) = u / b.radius;
    z[3 * k + 2] = dt_ * b.spin;
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
  std::vector<Candidate> found;
  for (int k = 0; k < count(); ++k) {
    for (int w = 0; w < static_cast<int>(scene_.walls.size()); ++w) {
      Candidate c;
      c.i = k;
      c.j = -1 - w;
      if (overlap(c) + margin_ > 0) found.push_back(c);
    }
  }
  for (const auto& [i, j] : pairs) {
    Candidate c;
    c.i = i;
    c.j = j;
    found.push_back(c);
  }
  std::sort(found.begin(), found.end(), before);
  for (Candidate& c : found) {
    const auto old = std::lower_bound(candidates_.begin(), candidates_.end(), c, before);
    if (old != candidates_.end() && old->i == c.i && old->j == c.j) {
      c.memory = old->memory;
      c.touched = old->touched;
    } else {
      c.touched = overlap(c) > 0;
    }
  }
  candidates_ = std::move(found);
  lay_out();
}

// The matrix of these candidates.
void SoftDisks::Work::lay_out() {
  std::vector<std::pair<int, int>> pairs;
  for (const Candidate& c : candidates_) {
    if (c.j >= 0) pairs.emplace_back(c.i, c.j);
  }
  lay_out_blocks(count(), 3, pairs, matrix_);
  analysed_ = false;
  for (Candidate& c : candidates_) {
    c.places[0] = place_of_block(matrix_, 3, c.i, c.i);
    if (c.j < 0) continue;
    c.places[1] = place_of_block(matrix_, 3, c.i, c.j);
    c.places[2] = place_of_block(matrix_, 3, c.j, c.i);
    c.places[3] = place_of_block(matrix_, 3, c.j, c.j);
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
  for (const Candidate& c : candidates_) {
    out = std::max(out, law_of(c).stiffness * overlap(c));
    if (force_of(c, motion_of(c, z), f)) out = std::max(out, f.normal);
  }
  return out;
}

NewtonReport SoftDisks::Work::solve(Vector& z) {
  scale_ = largest_force(z);
  NewtonProblem problem;
  problem.residual = [this](const Vector& at, Vector& r) { return residual(at, r); };
  problem.factorize = [this](const Vector& at, const Vector&) { return factorize(at); };
  problem.solve = [this](const Vector& rhs, Vector& x) {
    x = solver_.solve(rhs);
    x *= settings_.relaxation;
  };
  NewtonSettings how;
  const double epsilon = std::numeric_limits<double>::epsilon();
  how.tolerance =
      std::max(settings_.tolerance, kRoundOff * epsilon * stiffest_ * 2 * widest_ / scale_);
  how.max_iterations = settings_.max_iterations;
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
    const Vec u = b.radius * z.segment<2>(3 * k), v = u / dt_;
    const double w = z[3 * k + 2] / dt_;
    if (b.inverse_mass > 0) {
      const Vec rate = 2 / dt_ * (v - plain(b.velocity)) + drag * v - plain(scene_.gravity);
      r.segment<2>(3 * k) = rate / (b.inverse_mass * scale_);
    } else {
      r.segment<2>(3 * k) = z.segment<2>(3 * k) - dt_ / b.radius * plain(b.velocity);
    }
    if (b.inverse_inertia > 0) {
      r[3 * k + 2] = (2 / dt_ * (w - b.spin) + drag * w) / (b.inverse_inertia * b.radius * scale_);
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
  for (const Candidate& c : candidates_) {
    if (!force_of(c, motion_of(c, z), f)) continue;
    const double share = share_i(c);
    add(c.i, 1, share);
    if (c.j >= 0) add(c.j, -1, 1 - share);
  }
  return true;
}

bool SoftDisks::Work::factorize(const Vector& z) {
  double* const values = matrix_.valuePtr();
  std::fill_n(values, matrix_.nonZeros(), 0.0);
  const int* const outer = matrix_.outerIndexPtr();
  const double drag = scene_.background_damping, rate = (2 / dt_ + drag) / dt_;
  for (int k = 0; k < count(); ++k) {
    const Body<2>& b = bodies_[k];
    const double move = b.inverse_mass > 0 ? rate * b.radius / (b.inverse_mass * scale_) : 1;
    const double turn = b.inverse_inertia > 0 ? rate / (b.inverse_inertia * b.radius * scale_) : 1;
    matrix_.coeffRef(3 * k, 3 * k) = matrix_.coeffRef(3 * k + 1, 3 * k + 1) = move;
    matrix_.coeffRef(3 * k + 2, 3 * k + 2) = turn;
  }
  SoftForce<Derived3> f;
  for (const Candidate& c : candidates_) {
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
    const auto add = [&](int place, int column, const Eigen::Vector3d& rows,
                         const Eigen::Vector3d& columns) {
      const int length = outer[3 * column + 1] - outer[3 * column];
      for (int b = 0; b < 3; ++b) {
        for (int a = 0; a < 3; ++a) {
          values[place + b * length + a] -= rows[a] * slopes(a, b) * columns[b];
        }
      }
    };
    const Eigen::Vector3d rows_i = rows_of(c.i, 1, share), columns_i = columns_of(c.i, 1, share);
    add(c.places[0], c.i, rows_i, columns_i);
    if (c.j < 0) continue;
    const Eigen::Vector3d rows_j = rows_of(c.j, -1, 1 - share);
    const Eigen::Vector3d columns_j = columns_of(c.j, -1, 1 - share);
    add(c.places[1], c.j, rows_i, columns_j);
    add(c.places[2], c.i, rows_j, columns_i);
    add(c.places[3], c.j, rows_j, columns_j);
  }
  if (!analysed_) solver_.analyzePattern(matrix_);
  analysed_ = true;
  solver_.factorize(matrix_);
  return solver_.info() == Eigen::Success;
}

void SoftDisks::Work::commit(const Vector& z) {
  SoftForce<double> f;
  for (Candidate& c : candidates_) {
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
      // round.
      const double from = place(c), to = from + f.along;
      const SoftWall& w = scene_.walls[static_cast<std::size_t>(-1 - c.j)];
      const double v0 =
          w.normal.y() * bodies_[c.i].velocity.x() - w.normal.x() * bodies_[c.i].velocity.y();
      const double v1 = 2 * f.along / dt_ - v0;
      if (c.memory.whole) {
        c.memory.whole = std::fabs(to - c.memory.rest) <= law.well;
      } else if (v0 * v1 <= 0) {
        c.memory.whole = true;
        c.memory.rest = to;
      }
    }
  }
  for (int k = 0; k < count(); ++k) {
    Body<2>& b = bodies_[k];
    const Vec u = b.radius * z.segment<2>(3 * k), v = u / dt_;
    const double turn = z[3 * k + 2], w = turn / dt_;
    const double drag = scene_.background_damping * dt_;
    if (b.inverse_mass > 0) {
      losses_.background += drag * v.squaredNorm() / b.inverse_mass;
      b.velocity = 2 * v - plain(b.velocity);
    }
    if (b.inverse_inertia > 0) {
      losses_.background += drag * w * w / b.inverse_inertia;
      b.spin = 2 * w - b.spin;
    }
    b.position += u;
    angles_[k] += turn;
  }
  time_ += dt_;
}

SoftEnergy SoftDisks::Work::energy() const {
  SoftEnergy out;
  for (const Body<2>& b : bodies_) {
    if (b.inverse_mass > 0) {
      out.kinetic += 0.5 * plain(b.velocity).squaredNorm() / b.inverse_mass;
      out.potential -= plain(scene_.gravity).dot(plain(b.position)) / b.inverse_mass;
    }
    if (b.inverse_inertia > 0) out.kinetic += 0.5 * b.spin * b.spin / b.inverse_inertia;
  }
  for (const Candidate& c : candidates_) {
    const SoftLaw& law = law_of(c);
    const double s = std::max(overlap(c), 0.0);
    out.elastic += 0.5 * law.stiffness * s * s;
    if (law.tangential_stiffness > 0) {
      out.springs += 0.5 * c.memory.spring * c.memory.spring / law.tangential_stiffness;
    }
  }
  return out;
}

std::vector<SoftTouch> SoftDisks::Work::touches() const {
  std::vector<SoftTouch> out;
  for (const Candidate& c : candidates_) {
    SoftTouch t;
    t.i = c.i;
    t.j = c.j;
    t.overlap = overlap(c);
    if (!(t.overlap > 0)) continue;
    if (c.j < 0) {
      t.normal = -scene_.walls[static_cast<std::size_t>(-1 - c.j)].normal;
    } else {
      const Vec way = plain(bodies_[c.j].position - bodies_[c.i].position);
      t.normal = way / way.norm();
    }
    t.repulsion = law_of(c).stiffness * t.overlap;
    t.tangential = c.memory.spring + well_now(c);
    out.push_back(t);
  }
  return out;
}

SoftRest SoftDisks::Work::rest() const {
  std::vector<Vec> sums;
  for (const Body<2>& b : bodies_) {
    sums.push_back(b.inverse_mass > 0 ? Vec(plain(scene_.gravity) / b.inverse_mass) : Vec(0, 0));
  }
  SoftRest out;
  const std::vector<SoftTouch> all = touches();
  for (const SoftTouch& t : all) {
    const Vec force(-t.repulsion * t.normal.x() - t.tangential * t.normal.y(),
                    -t.repulsion * t.normal.y() + t.tangential * t.normal.x());
    out.mean_contact_force += force.norm() / static_cast<double>(all.size());
    sums[t.i] += force;
    if (t.j >= 0) sums[t.j] -= force;
  }
  int free = 0;
  for (int k = 0; k < count(); ++k) {
    if (!(bodies_[k].inverse_mass > 0)) continue;
    out.mean_unbalanced_force += sums[k].norm();
    ++free;
  }
  if (free > 0) out.mean_unbalanced_force /= free;
  out.ratio = all.empty() ? std::numeric_limits<double>::infinity()
                          : out.mean_unbalanced_force / out.mean_contact_force;
  return out;
}

std::string SoftDisks::Work::image() const {
  ImageWriter out;
  out.put(bodies_);
  out.put(angles_);
  out.put(listed_);
  for (const double value : {margin_, losses_.normal, losses_.tangential, losses_.well,
                             losses_.background, tally_.least_step}) {
    out.put(value);
  }
  for (const long value : {tally_.steps, tally_.solves, tally_.iterations, tally_.halved,
                           static_cast<long>(tally_.most_iterations)}) {
    out.put(static_cast<std::int64_t>(value));
  }
  out.put(static_cast<std::uint64_t>(candidates_.size()));
  for (const Candidate& c : candidates_) {
    out.put(c.i);
    out.put(c.j);
    out.put(c.memory.spring);
    out.put(c.memory.rest);
    out.put(c.memory.whole);
    out.put(c.touched);
  }
  return out.bytes();
}

void SoftDisks::Work::restore(const std::string& image) {
  ImageReader in(image);
  const std::size_t n = bodies_.size();
  in.get(bodies_);
  in.get(angles_);
  in.get(listed_);
  in.require(bodies_.size() == n && angles_.size() == n &&
             (listed_.empty() || listed_.size() == n));
  for (double* value : {&margin_, &losses_.normal, &losses_.tangential, &losses_.well,
                        &losses_.background, &tally_.least_step}) {
    in.get(*value);
  }
  std::int64_t counts[5];
  for (std::int64_t& value : counts) in.get(value);
  tally_.steps = counts[0];
  tally_.solves = counts[1];
  tally_.iterations = counts[2];
  tally_.halved = counts[3];
  tally_.most_iterations = static_cast<int>(counts[4]);
  std::uint64_t found = 0;
  in.get(found);
  in.require(found <= image.size());
  candidates_.assign(found, Candidate());
  for (Candidate& c : candidates_) {
    in.get(c.i);
    in.get(c.j);
    in.get(c.memory.spring);
    in.get(c.memory.rest);
    in.get(c.memory.whole);
    in.get(c.touched);
    in.require(c.i >= 0 && c.i < count() && c.j < count() &&
               c.j >= -static_cast<int>(scene_.walls.size()));
  }
  in.finish();
  time_ = static_cast<double>(tally_.steps) * settings_.time_step;
  lay_out();
}

SoftDisks::SoftDisks(const SoftScene& scene, const std::vector<Body<2>>& disks,
                     const ImplicitSettings& settings)
    : work_(std::make_unique<Work>(scene, disks, settings)) {}
SoftDisks::~SoftDisks() = default;
SoftDisks::SoftDisks(SoftDisks&&) noexcept = default;
SoftDisks& SoftDisks::operator=(SoftDisks&&) noexcept = default;

void SoftDisks::step(long steps) { work_->step(steps); }
double SoftDisks::time() const { return work_->time(); }
const std::vector<Body<2>>& SoftDisks::bodies() const { return work_->bodies(); }
const std::vector<double>& SoftDisks::angles() const { return work_->angles(); }
SoftEnergy SoftDisks::energy() const { return work_->energy(); }
const SoftLosses& SoftDisks::losses() const { return work_->losses(); }
const ImplicitTally& SoftDisks::tally() const { return work_->tally(); }
std::vector<SoftTouch> SoftDisks::touches() const { return work_->touches(); }
SoftRest SoftDisks::rest() const { return work_->rest(); }
std::string SoftDisks::image() const { return work_->image(); }
void SoftDisks::restore(const std::string& image) { work_->restore(image); }

}  // namespace grainfield::dem
