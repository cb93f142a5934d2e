// The inside of SoftDisks: the state, the list of pairs, and a step.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "dem/implicit/block_lu.h"
#include "dem/implicit/soft_disks.h"
#include "dem/neighbours/hierarchical_grid.h"
#include "dem/newton/newton.h"

namespace grainfield::dem {

/// A pair, or a disk and a wall, that may touch in this step.
struct SoftCandidate {
  int i = 0, j = 0;  ///< j = -1 - w: wall w
  SoftMemory memory;
  bool touched = false;         ///< at the end of the last step
  std::array<int, 4> places{};  ///< of (i, i), (i, j), (j, i), (j, j) in the matrix
};

class SoftDisks::Work {
 public:
  Work(const SoftScene& scene, const std::vector<Body<2>>& disks, const ImplicitSettings& settings);

  void step(long steps);
  bool try_part();
  void set_acting(const std::vector<char>& acting);
  void add(const Body<2>& disk);
  void set_velocities(const std::vector<Body<2>>& bodies);

  double time() const { return time_; }
  const std::vector<Body<2>>& bodies() const { return bodies_; }
  const std::vector<double>& angles() const { return angles_; }
  const SoftLosses& losses() const { return losses_; }
  const ImplicitTally& tally() const { return tally_; }
  SoftEnergy energy() const;
  std::vector<SoftTouch> touches() const;
  SoftRest rest() const;
  std::string checkpoint() const;
  void restore(const std::string& checkpoint);

 private:
  using Vector = Eigen::VectorXd;
  using Vec = Eigen::Vector2d;

  /// A disk's way and turn in the last step, velocity and spin before it.
  struct Last {
    Vec way{0, 0}, velocity{0, 0};
    double turn = 0, spin = 0;
  };

  static Vec plain(const VectorOf<2>& v) { return {v.x(), v.y()}; }
  int count() const { return static_cast<int>(bodies_.size()); }
  const SoftLaw& law_of(const SoftCandidate& c) const {
    return c.j < 0 ? scene_.walls[static_cast<std::size_t>(-1 - c.j)].law : scene_.grains;
  }
  bool acts(const SoftCandidate& c) const {
    return acting_[c.i] != 0 && (c.j < 0 || acting_[c.j] != 0);
  }
  /// Share of the distance of the centres that belongs to each disk.
  double share_i(const SoftCandidate& c) const {
    return c.j < 0 ? 1 : bodies_[c.i].radius / (bodies_[c.i].radius + bodies_[c.j].radius);
  }

  bool takes_end() const { return settings_.scheme == ImplicitScheme::bdf2; }
  /// With gamma_ and beta_ of steps r times as long as the last one, BDF2 is
  ///   x_1 - x_0 = gamma (x_0 - x_-1) + beta dt v_1,   gamma = r^2/(1 + 2 r), beta = (1 + r)/(1 + 2
  ///   r)
  /// and the same of velocities.
  SoftStep step_of(const SoftCandidate& c) const {
    SoftStep out;
    out.dt = dt_;
    out.end = takes_end();
    if (!out.end) return out;
    const double share = share_i(c);
    out.rate = 1 / (beta_ * dt_);
    out.drift = gamma_ * last_[c.i].way;
    out.turn_drift = share * gamma_ * last_[c.i].turn;
    if (c.j >= 0) {
      out.drift -= gamma_ * last_[c.j].way;
      out.turn_drift += (1 - share) * gamma_ * last_[c.j].turn;
    }
    return out;
  }
  /// At the end of a step of BDF2 in which a disk moves by u and turns by a.
  Vec velocity_after(int k, const Vec& u) const {
    return (u - gamma_ * last_[k].way) / (beta_ * dt_);
  }
  double spin_after(int k, double a) const { return (a - gamma_ * last_[k].turn) / (beta_ * dt_); }
  /// What it would be without forces.
  Vec velocity_along(int k) const {
    const Vec now = plain(bodies_[k].velocity);
    return now + gamma_ * (now - last_[k].velocity);
  }
  double spin_along(int k) const {
    return bodies_[k].spin + gamma_ * (bodies_[k].spin - last_[k].spin);
  }

  /// Height above a wall and place along it.
  double height(const SoftCandidate& c) const {
    const SoftWall& w = scene_.walls[static_cast<std::size_t>(-1 - c.j)];
    return plain(w.normal).dot(plain(bodies_[c.i].position - w.point));
  }
  double place(const SoftCandidate& c) const {
    const SoftWall& w = scene_.walls[static_cast<std::size_t>(-1 - c.j)];
    const Vec x = plain(bodies_[c.i].position - w.point);
    return w.normal.y() * x.x() - w.normal.x() * x.y();
  }
  double overlap(const SoftCandidate& c) const {
    if (c.j < 0) return bodies_[c.i].radius - height(c);
    return bodies_[c.i].radius + bodies_[c.j].radius -
           plain(bodies_[c.j].position - bodies_[c.i].position).norm();
  }
  /// Pull of a wall's well now, N.
  double well_now(const SoftCandidate& c) const {
    const SoftLaw& law = law_of(c);
    const double s = overlap(c);
    if (c.j >= 0 || !c.memory.whole || !(law.static_friction > 0) || !(s > 0)) return 0;
    const double most = law.static_friction * law.stiffness * s;
    return -std::clamp(most / law.well * (place(c) - c.memory.rest), -most, most);
  }

  template <class T>
  bool force_of(const SoftCandidate& c, const SoftMotion<T>& m, SoftForce<T>& out) const {
    if (!acts(c)) return false;
    const SoftLaw& law = law_of(c);
    const SoftStep step = step_of(c);
    if (c.j < 0) {
      const SoftWall& w = scene_.walls[static_cast<std::size_t>(-1 - c.j)];
      return soft_wall(law, step, Vec(-plain(w.normal)), height(c), place(c), bodies_[c.i].radius,
                       c.memory, m, out);
    }
    const Vec way = plain(bodies_[c.j].position - bodies_[c.i].position);
    return soft_pair(law, step, way, bodies_[c.i].radius + bodies_[c.j].radius, c.memory, m, out);
  }
  /// From the unknowns (u/R, a) of all disks.
  SoftMotion<double> motion_of(const SoftCandidate& c, const Vector& z) const {
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

  bool try_step(double dt);
  void predict(Vector& z) const;
  void predict_at_end(Vector& z, const std::vector<bool>& held) const;
  void list(double margin);
  void lay_out();
  bool listed_for(const Vector& z) const;
  double largest_force(const Vector& z) const;
  double move_by(double force) const;
  NewtonReport solve(Vector& z);
  bool residual(const Vector& z, Vector& r) const;
  bool factorize(const Vector& z);
  void commit(const Vector& z);

  SoftScene scene_;
  ImplicitSettings settings_;
  std::vector<Body<2>> bodies_;
  std::vector<double> angles_;
  std::vector<char> acting_;          // of each disk
  double widest_ = 0, stiffest_ = 0;  // m, N/m
  double time_ = 0, dt_ = 0, scale_ = 1;
  std::vector<Last> last_;                     // of BDF2, empty otherwise
  double last_dt_ = 0, gamma_ = 0, beta_ = 1;  // s; 0: there was no step
  ImplicitTally tally_;
  SoftLosses losses_;
  std::string why_;  // the last step failed
  std::vector<int>
      pending_;  // parts left of the step under way, the next one last: halvings of each

  HierarchicalGrid<2> grid_;
  std::vector<SoftCandidate> candidates_;
  std::vector<VectorOf<2>> listed_;  // places when the list was made
  double margin_ = -1;               // m

  BlockLu matrix_;
  std::vector<std::pair<int, int>> blocks_;  // of it, sorted: all candidates' and some before them
};

}  // namespace grainfield::dem
