// Walls as the engine meets them: where they are, how they move, what they feel.
//
// A wall has one or more slots, each with the memory of one contact of a grain; the slots of all
// walls are numbered through, and the lists of contacts name them. A plane at rest has one slot and
// is read directly (is_plain, plane); what moves or is no plane answers by touching().
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "dem/space/lever.h"
#include "dem/walls/surface.h"
#include "dem/walls/wall_motion.h"

namespace grainfield::dem {

/// What changes of a wall, in bits without gaps: it goes into checkpoints, and these are compared.
template <int D>
struct WallState {
  using Vector = VectorOf<D>;
  using Matrix = Eigen::Matrix<double, D, D, Eigen::DontAlign>;
  struct Servo {
    std::int64_t on = 0;
    Vector direction = zero<Vector>();
    double force = 0, stress = 0, area = 0;
    int first[2] = {-1, -1}, second[2] = {-1, -1};  ///< walls whose distances make the area
    double max_speed = 0, gain = 0;
    double speed = 0;  ///< of the lid's mass, m/s
  };

  Vector place = zero<Vector>();  ///< of the surface's origin, m
  Matrix turn = Matrix::Identity();
  Vector centre = zero<Vector>();  ///< about which it turns, m
  Vector velocity = zero<Vector>();
  SpinOf<D> spin = zero<SpinOf<D>>();

  std::int64_t driven = 0, turned = 0;  ///< 0 or 1
  Vector given_velocity = zero<Vector>();
  SpinOf<D> given_spin = zero<SpinOf<D>>();
  double start = 0, ramp = 0;  ///< s
  Servo servo;

  Vector force = zero<Vector>();         ///< of the grains in the last step, N
  SpinOf<D> torque = zero<SpinOf<D>>();  ///< about the centre, N m
  Vector force_before = zero<Vector>();  ///< in the step before it
  SpinOf<D> torque_before = zero<SpinOf<D>>();
  double stiffness = 0;  ///< of the contacts, N/m; while a servo leads
  double touched = 0;    ///< mass of the grains there, kg
  double work = 0;       ///< done on the grains, J

  Vector searched = zero<Vector>();  ///< the centre at the last search
  double turning = 0;                ///< rad since then
  double lever = 0;                  ///< m: how far from the centre grains may feel it turn
  double way = 0;                    ///< m: how far it may go until the next search
};

template <int D>
class Walls {
 public:
  using Vector = VectorOf<D>;
  using State = WallState<D>;

  void add(const Wall& wall, std::unique_ptr<WallSurface<D>> surface);
  int size() const { return static_cast<int>(walls_.size()); }
  int slots() const { return static_cast<int>(wall_of_.size()); }
  int wall_of(int slot) const { return wall_of_[slot]; }
  int first_slot(int wall) const { return first_[wall]; }
  int slots_of(int wall) const { return surfaces_[wall]->slots(); }
  /// As it was given; where it is now: placed().
  const Wall& given(int wall) const { return walls_[wall]; }
  const State& state(int wall) const { return states_[wall]; }

  /// A plane at rest.
  bool is_plain(int slot) const { return plain_[slot] != 0; }
  const Plane<D>& plane(int slot) const { return planes_[slot]; }

  /// Where the wall is nearer to a place than `reach`: WallSurface::patches in space.
  int touching(int wall, const Vector& at, double reach, Patch<D>* found) const;
  bool is_near(int wall, const Vector& at, double reach) const {
    if (is_plain(first_[wall])) return planes_[first_[wall]].height(at) < reach;
    Patch<D> found[kMostPatches];
    return touching(wall, at, reach, found) > 0;
  }
  /// Velocity of a point of the wall, m/s.
  Vector velocity(int wall, const Vector& at) const {
    const State& s = states_[wall];
    return s.velocity + velocity_at(s.spin, Vector(at - s.centre));
  }
  /// Where it is and how it moves, without forces.
  Wall placed(int wall) const;

  /// From `time` on. Throws std::invalid_argument (check_motion; walls that are not known).
  void set_motion(int wall, const WallMotion& motion, double time);
  bool any_driven() const { return any_driven_; }
  bool is_driven(int wall) const { return states_[wall].driven != 0; }
  bool any_servo() const { return any_servo_; }
  /// Largest speed at which it may come nearer to a grain at `at`, m/s.
  double top_speed(int wall, const Vector& at) const;
  /// Throws std::invalid_argument when a given speed, with the turning of a wall that ends
  /// somewhere, passes more than `most` metres a step.
  void check_speeds(double most, double dt) const;

  /// Moves all by a step, before which they were at `time`.
  void advance(double time, double dt);
  /// The forces of a step: clear, add for each contact (on the wall, about its centre), finish.
  void clear_forces();
  void add_force(int wall, const Vector& force, const SpinOf<D>& torque, double stiffness,
                 double mass) {
    State& s = states_[wall];
    s.force += force;
    s.torque += torque;
    s.stiffness += stiffness;
    s.touched += mass;
  }
  void finish_forces(double dt);
  /// What the grains do to a wall at this moment, before it begins to move.
  void feel(int wall, const Vector& force, const SpinOf<D>& torque);
  double work() const;  ///< of all walls on the grains, J

  /// After a search: its margin, where grains lie within `lever` of its centre.
  void set_margin(int wall, double lever, double way);
  double lever(int wall, const Vector& at, double reach) const;
  double way(int wall) const { return states_[wall].way; }
  double speed(int wall) const;      ///< at which it may come nearer to grains now, m/s
  double top_speed(int wall) const;  ///< the same at most
  /// Some wall may leave its margin in the next step.
  bool leaves_margin(double dt) const;

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.states_);
  }
  bool fits() const;
  void restored();  ///< after states have come from a checkpoint

 private:
  void mark(int wall);
  double across(int wall, const Vector& way) const;
  double sweeping_arm(int wall) const;
  double servo_speed(State& s, double dt) const;
  double target_of(const State& s) const;
  Plane<D> placed_plane(int wall) const;
  int index_of(const std::string& name, const Wall& asked_by) const;

  std::vector<Wall> walls_;
  std::vector<std::unique_ptr<WallSurface<D>>> surfaces_;
  std::vector<State> states_;
  std::vector<int> first_, wall_of_;
  std::vector<unsigned char> plain_;
  std::vector<Plane<D>> planes_;
  bool any_driven_ = false, any_servo_ = false;
};

}  // namespace grainfield::dem
