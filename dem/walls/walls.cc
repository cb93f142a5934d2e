#include "dem/walls/walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "dem/space/rotation.h"
#include "dem/space/space3.h"

namespace grainfield::dem {
namespace {

Eigen::Matrix<double, 2, 2, Eigen::DontAlign> turned_by(double angle) {
  const Rotation r = rotation_of(angle);
  Eigen::Matrix<double, 2, 2, Eigen::DontAlign> m;
  m << r.cosine, -r.sine, r.sine, r.cosine;
  return m;
}
Eigen::Matrix<double, 3, 3, Eigen::DontAlign> turned_by(const Eigen::Vector3d& turn) {
  return quaternion_of(turn).toRotationMatrix();
}

/// Rounding does not make it skew.
void make_orthonormal(Eigen::Matrix<double, 2, 2, Eigen::DontAlign>& m) {
  m.col(0).normalize();
  m.col(1) << -m(1, 0), m(0, 0);
}
void make_orthonormal(Eigen::Matrix<double, 3, 3, Eigen::DontAlign>& m) {
  Eigen::Vector3d x = m.col(0), y = m.col(1);
  x.normalize();
  y = (y - y.dot(x) * x).normalized();
  m << x, y, x.cross(y);
}

}  // namespace

template <int D>
void Walls<D>::add(const Wall& wall, std::unique_ptr<WallSurface<D>> surface) {
  const int index = size(), slots = surface->slots();
  State state;
  state.place = state.centre = in_space<D>(wall.point);
  walls_.push_back(wall);
  // Those of a snapshot are told by its contacts, anew.
  walls_.back().force.setZero();
  walls_.back().torque.setZero();
  states_.push_back(state);
  first_.push_back(static_cast<int>(wall_of_.size()));
  wall_of_.insert(wall_of_.end(), slots, index);
  plain_.insert(plain_.end(), slots, 0);
  planes_.insert(planes_.end(), slots, Plane<D>{});
  surfaces_.push_back(std::move(surface));
  mark(index);
}

/// What follows from its state.
template <int D>
void Walls<D>::mark(int wall) {
  const bool plain = walls_[wall].shape == "plane" && !states_[wall].driven;
  plain_[first_[wall]] = plain ? 1 : 0;
  if (plain) planes_[first_[wall]] = placed_plane(wall);
  any_driven_ = any_servo_ = false;
  for (const State& s : states_) {
    any_driven_ |= s.driven != 0;
    any_servo_ |= s.servo.on != 0;
  }
}

template <int D>
Plane<D> Walls<D>::placed_plane(int wall) const {
  const State& s = states_[wall];
  const Vector normal = in_space<D>(walls_[wall].normal);
  return {s.place, s.turned ? Vector(s.turn * normal) : normal};
}

template <int D>
int Walls<D>::touching(int wall, const Vector& at, double reach, Patch<D>* found) const {
  const State& s = states_[wall];
  Vector local = at - s.place;
  if (s.turned) local = (s.turn.transpose() * local).eval();
  const int count = surfaces_[wall]->patches(local, reach, found);
  for (int k = 0; k < count; ++k) {
    Plane<D>& plane = found[k].plane;
    if (s.turned) {
      plane.point = (s.turn * plane.point).eval();
      plane.normal = (s.turn * plane.normal).eval();
    }
    plane.point += s.place;
  }
  return count;
}

template <int D>
Wall Walls<D>::placed(int wall) const {
  const State& s = states_[wall];
  Wall w = walls_[wall];
  w.velocity = to_three(velocity(wall, s.place));
  w.angular_velocity = turning_to_three(s.spin);
  w.point = to_three(s.place);
  if (s.turned) w.normal = to_three(Vector(s.turn * in_space<D>(w.normal)));
  for (auto& triangle : w.triangles) {
    for (Vec3& corner : triangle) {
      Vector at = in_space<D>(corner - walls_[wall].point);
      if (s.turned) at = (s.turn * at).eval();
      corner = to_three(Vector(s.place + at));
    }
  }
  return w;
}

template <int D>
int Walls<D>::index_of(const std::string& name, const Wall& asked_by) const {
  for (int w = 0; w < size(); ++w) {
    if (walls_[w].name == name && walls_[w].shape == "plane") return w;
  }
  throw std::invalid_argument(fmt::format(
      "wall {}: servo: between: found \"{}\", allowed: the name of a plane", asked_by.name, name));
}

template <int D>
void Walls<D>::set_motion(int wall, const WallMotion& motion, double time) {
  if (wall < 0 || wall >= size()) {
    throw std::invalid_argument(fmt::format("found wall {}, allowed: 0 to {}", wall, size() - 1));
  }
  const Wall& given = walls_[wall];
  check_motion(motion, given, D);
  State& s = states_[wall];
  typename State::Servo servo;
  if (motion.servo) {
    const WallServo& m = *motion.servo;
    servo.on = 1;
    servo.force = m.force;
    servo.stress = m.stress;
    servo.area = m.area;
    for (std::size_t k = 0; k < m.between.size(); ++k) {
      servo.first[k] = index_of(m.between[k][0], given);
      servo.second[k] = index_of(m.between[k][1], given);
    }
    const Vector direction = in_space<D>(m.direction);
    servo.direction =
        direction.norm() > 0 ? Vector(direction / direction.norm()) : placed_plane(wall).normal;
    servo.max_speed = m.max_speed;
    servo.gain = m.gain;
  }
  s.servo = servo;
  s.given_velocity = in_space<D>(motion.velocity);
  s.given_spin = turning_in_space<D>(motion.angular_velocity);
  s.start = time;
  s.ramp = motion.ramp;
  s.centre = motion.centre ? in_space<D>(*motion.centre) : s.place;
  const bool moves = motion.velocity.norm() > 0 || motion.angular_velocity.norm() > 0;
  s.driven = moves || servo.on != 0 ? 1 : 0;
  s.velocity = zero<Vector>();
  s.spin = zero<SpinOf<D>>();
  if (s.driven && s.ramp == 0) {
    s.velocity = s.given_velocity;
    s.spin = s.given_spin;
  }
  s.searched = s.centre;
  s.way = s.turning = 0;
  mark(wall);
}

/// What of a way brings the wall nearer to grains: a plane may slide along itself.
template <int D>
double Walls<D>::across(int wall, const Vector& way) const {
  const State& s = states_[wall];
  if (walls_[wall].shape != "plane" || size_of(s.given_spin) > 0) return way.norm();
  return std::fabs(way.dot(placed_plane(wall).normal));
}

template <int D>
double Walls<D>::top_speed(int wall, const Vector& at) const {
  const State& s = states_[wall];
  return across(wall, s.given_velocity) + (s.servo.on ? s.servo.max_speed : 0.0) +
         size_of(s.given_spin) * lever(wall, at, 0);
}

template <int D>
double Walls<D>::top_speed(int wall) const {
  const State& s = states_[wall];
  return across(wall, s.given_velocity) + (s.servo.on ? s.servo.max_speed : 0.0) +
         size_of(s.given_spin) * s.lever;
}

template <int D>
void Walls<D>::check_speeds(double most, double dt) const {
  for (int w = 0; w < size(); ++w) {
    const State& s = states_[w];
    if (!s.driven) continue;
    // A surface without an end is fast far away: what it meets there is seen in the step (sweep.h).
    const double arm = sweeping_arm(w);
    const double turning = std::isfinite(arm) ? size_of(s.given_spin) * arm : 0;
    const double speed = top_speed(w, s.centre) + turning;
    if (speed * dt <= most) continue;
    throw std::invalid_argument(fmt::format(
        "wall {}: speed: found {:.4g} m/s, allowed: up to {:.4g} m/s, at which it passes half a "
        "radius of the smallest grain in a step; lower it or motion.time_step (now {:.3g} s)",
        walls_[w].name, speed, most / dt, dt));
  }
}

template <int D>
double Walls<D>::target_of(const State& s) const {
  if (s.servo.stress == 0) return s.servo.force;
  double area = s.servo.area;
  if (s.servo.first[0] >= 0) {
    area = 1;
    for (int k = 0; k < D - 1; ++k) {
      const Plane<D> a = placed_plane(s.servo.first[k]), b = placed_plane(s.servo.second[k]);
      area *= std::fabs(a.height(b.point));
    }
  }
  return s.servo.stress * area;
}

/// Along the servo's direction, from the forces of the last step.
template <int D>
double Walls<D>::servo_speed(State& s, double dt) const {
  typename State::Servo& servo = s.servo;
  if (!(s.stiffness > 0)) {  // no grain: on to meet one
    servo.speed = servo.max_speed;
    return servo.speed;
  }
  const double error = target_of(s) + s.force.dot(servo.direction);
  const auto limited = [&](double v) { return std::clamp(v, -servo.max_speed, servo.max_speed); };
  servo.speed = limited(servo.speed + dt / s.touched * error);
  return limited(servo.speed + servo.gain / (s.stiffness * dt) * error);
}

template <int D>
void Walls<D>::advance(double time, double dt) {
  const double half = time + 0.5 * dt;
  for (State& s : states_) {
    if (!s.driven) continue;
    const double since = half - s.start;
    const double t = s.ramp > 0 ? std::clamp(since / s.ramp, 0.0, 1.0) : 1.0;
    const double share = t * t * (3 - 2 * t);
    s.velocity = share * s.given_velocity;
    s.spin = share * s.given_spin;
    if (s.servo.on) s.velocity += servo_speed(s, dt) * s.servo.direction;
  }
  for (State& s : states_) {
    if (!s.driven) continue;
    const Vector arm = s.place - s.centre;
    s.centre += dt * s.velocity;
    if (size_of(s.spin) > 0) {
      const auto turn = turned_by(SpinOf<D>(dt * s.spin));
      s.place = s.centre + turn * arm;
      s.turn = (turn * s.turn).eval();
      make_orthonormal(s.turn);
      s.turned = true;
      s.turning += dt * size_of(s.spin);
    } else {
      s.place += dt * s.velocity;
    }
  }
}

template <int D>
void Walls<D>::clear_forces() {
  for (State& s : states_) {
    s.force_before = s.force;
    s.torque_before = s.torque;
    s.force = zero<Vector>();
    s.torque = zero<SpinOf<D>>();
    s.stiffness = s.touched = 0;
  }
}

/// Work by the trapezoidal rule: with the velocity of the half step, which has moved the wall, it
/// closes the energy balance of velocity Verlet at second order.
template <int D>
void Walls<D>::finish_forces(double dt) {
  for (State& s : states_) {
    if (!s.driven) continue;
    const Vector force = s.force_before + s.force;
    const SpinOf<D> torque = s.torque_before + s.torque;
    s.work -= 0.5 * dt * (force.dot(s.velocity) + power_of(torque, s.spin));
  }
}

template <int D>
void Walls<D>::feel(int wall, const Vector& force, const SpinOf<D>& torque) {
  states_[wall].force = force;
  states_[wall].torque = torque;
  states_[wall].stiffness = states_[wall].touched = 0;
}

template <int D>
double Walls<D>::work() const {
  double sum = 0;
  for (const State& s : states_) sum += s.work;
  return sum;
}

/// Arm of its surface, as it is given to turn; 0 without a spin.
template <int D>
double Walls<D>::sweeping_arm(int wall) const {
  const State& s = states_[wall];
  if (size_of(s.given_spin) == 0) return 0;
  Vector centre = s.centre - s.place;
  Eigen::Vector3d spin = turning_to_three(s.given_spin);
  if (s.turned) {
    centre = (s.turn.transpose() * centre).eval();
    if constexpr (D == 3) spin = (s.turn.transpose() * spin).eval();
  }
  return surfaces_[wall]->sweeping_arm(centre, spin);
}

/// How far from the centre a grain at `at` may feel it turn, m; 0 where turning leaves it in place.
template <int D>
double Walls<D>::lever(int wall, const Vector& at, double reach) const {
  return sweeping_arm(wall) == 0 ? 0 : (at - states_[wall].centre).norm() + reach;
}

template <int D>
double Walls<D>::speed(int wall) const {
  const State& s = states_[wall];
  return across(wall, s.velocity) + size_of(s.spin) * s.lever;
}

template <int D>
void Walls<D>::set_margin(int wall, double lever, double way) {
  State& s = states_[wall];
  s.searched = s.centre;
  s.turning = 0;
  s.lever = lever;
  s.way = way;
}

/// Servos of a checkpoint that name walls which are there.
template <int D>
bool Walls<D>::fits() const {
  if (states_.size() != walls_.size()) return false;
  for (const State& s : states_) {
    const bool between = s.servo.first[0] >= 0;
    for (int k = 0; k < 2; ++k) {
      const int first = s.servo.first[k], second = s.servo.second[k];
      const bool named = between && k < D - 1;
      if (named ? first < 0 || second < 0 : first != -1 || second != -1) return false;
      if (first >= size() || second >= size()) return false;
    }
  }
  return true;
}

template <int D>
bool Walls<D>::leaves_margin(double dt) const {
  for (int w = 0; w < size(); ++w) {
    const State& s = states_[w];
    if (!s.driven) continue;
    const double gone = across(w, s.centre - s.searched) + s.turning * s.lever;
    if (!(gone + dt * top_speed(w) <= s.way)) return true;
  }
  return false;
}

template <int D>
void Walls<D>::restored() {
  for (int w = 0; w < size(); ++w) mark(w);
}

template class Walls<2>;
template class Walls<3>;

}  // namespace grainfield::dem
