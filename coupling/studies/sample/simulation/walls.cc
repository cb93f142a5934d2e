#include "coupling/studies/sample/simulation/walls.h"

#include "coupling/studies/sample/simulation/view.h"

namespace grainfield::dem {

const char* moved_wall(int axis, int dim) {
  return axis == dim - 1 ? "lid" : axis == 0 ? "right" : "back";
}

namespace {

WallServo servo_of(const SamplePlan& p, SamplePhase phase, int axis, const Vec3& now,
                   const std::array<double, 3>& box) {
  const int last = p.dim - 1;
  WallServo servo;
  servo.stress = p.pressure;
  servo.max_speed = p.compression_rate * box[axis];
  if (deforms(phase) && shears(p)) {  // between sides that tilt
    servo.area = p.dim == 2 ? now[0] : now[0] * now[1];
    return servo;
  }
  for (int a = 0; a < p.dim; ++a) {
    if (a == axis) continue;
    const char* fixed = a == last ? "floor" : a == 0 ? "left" : "front";
    servo.between.push_back({fixed, moved_wall(a, p.dim)});
  }
  return servo;
}

// Without a servo. `from`: the edges that the phase's strain is counted by.
WallMotion prescribed(const SamplePlan& p, SamplePhase phase, int axis, const Vec3& from) {
  const int last = p.dim - 1;
  WallMotion motion;
  Vec3 inwards = Vec3::Zero();
  inwards[axis] = -from[axis];
  if (phase == SamplePhase::compress) {
    if (compresses(p, axis)) motion.velocity = p.compression_rate * inwards;
  } else if (phase == SamplePhase::precompress) {
    if (axis == last) motion.velocity = p.strain_rate * inwards;
    motion.ramp = p.ramp_time;
  } else if (deforms(phase)) {
    const double rate = phase == SamplePhase::unload ? -p.strain_rate : p.strain_rate;
    const bool moves = p.deformation == "isotropic" || (!shears(p) && axis == last);
    if (moves) motion.velocity = rate * inwards;
    motion.ramp = p.ramp_time;
  }
  return motion;
}

}  // namespace

void lead_walls(Engine& engine, const SamplePlan& p, SamplePhase phase,
                const std::array<double, 3>& box, const Vec3& first) {
  const Vec3 size = sample_edges(p, engine);
  const Vec3& from = phase == SamplePhase::unload ? first : size;
  const int last = p.dim - 1;
  for (int a = 0; a < p.dim; ++a) {
    const bool led = is_led(p, phase, a);
    WallMotion motion;
    if (led) {
      motion.servo = servo_of(p, phase, a, size, box);
    } else {
      motion = prescribed(p, phase, a, from);
    }
    if (deforms(phase) && shears(p) && a == last) {
      const double rate = phase == SamplePhase::unload ? -p.strain_rate : p.strain_rate;
      motion.velocity.x() = rate * from[last];
      motion.ramp = p.ramp_time;
    }
    // A servo that goes on keeps what it has learnt.
    const bool goes_on = phase == SamplePhase::rest || (deforms(phase) && !shears(p));
    if (led && goes_on) continue;
    engine.set_wall_motion(moved_wall(a, p.dim), motion);
  }
}

void tilt_sides(Engine& engine, const SamplePlan& p, double then, long steps) {
  const int last = p.dim - 1;
  const double time = static_cast<double>(steps) * engine.time_step();
  for (const Wall& wall : engine.walls()) {
    if (wall.name != "left" && wall.name != "right") continue;
    // The angle between the tangents, by its series: it is small.
    const double now = -wall.normal[last] / wall.normal.x();
    const double t = (then - now) / (1 + now * then), q = t * t;
    const double angle = t * (1 - q * (1.0 / 3 - q * (1.0 / 5 - q / 7)));
    WallMotion motion;
    Vec3 foot = wall.point;
    foot.x() -= now * wall.point[last];  // the floor is at 0
    foot[last] = 0;
    motion.centre = foot;
    const double spin = angle / time;
    if (p.dim == 2) {
      motion.angular_velocity.z() = -spin;
    } else {
      motion.angular_velocity.y() = spin;
    }
    engine.set_wall_motion(wall.name, motion);
  }
}

}  // namespace grainfield::dem
