#include "dem/walls/wall_motion.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "dem/shared/refuse.h"

namespace grainfield::dem {
namespace {

std::string named(const Wall& wall) { return "wall " + wall.name; }

void check_servo(const WallServo& s, const Wall& wall, int dim) {
  require(s.force >= 0 && s.stress >= 0 && (s.force > 0) != (s.stress > 0), named(wall),
          fmt::format("servo: found force {:g} N and stress {:g}, allowed: one target above 0",
                      s.force, s.stress));
  require(std::isfinite(s.force) && std::isfinite(s.stress), named(wall),
          "servo: found a target that is not finite");
  const bool between = !s.between.empty();
  if (s.stress > 0) {
    require((s.area > 0 && std::isfinite(s.area)) != between, named(wall),
            fmt::format("servo: area: found {:g} and {} pairs of walls, allowed: an area above 0, "
                        "or pairs, for a target stress",
                        s.area, s.between.size()));
    require(!between || static_cast<int>(s.between.size()) == dim - 1, named(wall),
            fmt::format("servo: between: found {} pairs of walls, allowed: {}", s.between.size(),
                        dim - 1));
  } else {
    require(!between, named(wall),
            fmt::format("servo: between: found {} pairs of walls, allowed: none for a target force",
                        s.between.size()));
  }
  for (const auto& pair : s.between) {
    require(
        pair[0] != pair[1], named(wall),
        fmt::format("servo: between: found \"{}\" twice in a pair, allowed: two walls", pair[0]));
  }
  require(s.max_speed > 0 && std::isfinite(s.max_speed), named(wall),
          fmt::format("servo: max_speed: found {:g}, allowed: above 0 m/s", s.max_speed));
  require(s.gain > 0 && s.gain <= 1, named(wall),
          fmt::format("servo: gain: found {:g}, allowed: above 0, at most 1", s.gain));
  require(s.direction.allFinite(), named(wall), "servo: found a direction that is not finite");
  require(wall.shape == "plane" || s.direction.norm() > 0, named(wall),
          "servo: direction: found none, allowed: a direction, as the wall is no plane");
}

}  // namespace

void check_motion(const WallMotion& m, const Wall& wall, int dim) {
  require(m.velocity.allFinite() && m.angular_velocity.allFinite() &&
              (!m.centre || m.centre->allFinite()),
          named(wall), "found a velocity or centre that is not finite");
  require(m.ramp >= 0 && std::isfinite(m.ramp), named(wall),
          fmt::format("ramp: found {:g}, allowed: 0 s or more", m.ramp));
  if (dim == 2) {
    require(m.velocity.z() == 0 && m.angular_velocity.x() == 0 && m.angular_velocity.y() == 0,
            named(wall),
            "found a motion out of the plane, allowed in 2D: velocity x, y, turning z");
  }
  if (m.servo) check_servo(*m.servo, wall, dim);
}

}  // namespace grainfield::dem
