// How a wall moves: at rest, as given, or led by a servo to a force.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Moves a wall along one direction until the grains push it back with a force or a mean stress.
///
///   u = v + G e, M dv/dt = e, e = target - push; |u| and |v| <= max_speed
/// This is a lid of mass M under the target as a dead load, that also gives way like a dashpot 1/G:
/// it takes energy from the grains whatever they are (its admittance G + 1/(M s) has a real part
/// above 0), so it cannot make them swing. M is the mass of the grains at the wall: the lid bears
/// the time step that they bear. G = gain / (K dt): K is the stiffness of their contacts with the
/// wall, with 2 c/dt for each dashpot. In steps, the force answers G e dt at once, which leaves
/// (1 - gain) of an error; with a = K dt^2/M it is stable while 2 gain + a < 4.
struct WallServo {
  double force = 0;   ///< of the grains on the wall, against `direction`, N; or
  double stress = 0;  ///< this times the wall's area: Pa (N/m in 2D)
  double area = 0;    ///< m2 (2D: m); or the distances of pairs of walls as they are at each step,
  std::vector<std::array<std::string, 2>> between{};  ///< one pair of planes in 2D, two in 3D
  Vec3 direction{0, 0, 0};  ///< unit, into the grains; 0: the wall's normal
  double max_speed = 0;     ///< m/s; also without grains at the wall
  double gain = 0.3;        ///< 0 to 1; lower: slower and smoother
};

/// From the time when it is set, anew: what came before is forgotten.
struct WallMotion {
  Vec3 velocity{0, 0, 0};          ///< of the centre, m/s
  Vec3 angular_velocity{0, 0, 0};  ///< about the centre, rad/s
  std::optional<Vec3> centre{};    ///< moves with the velocity, m; none: the wall's point
  double ramp = 0;                 ///< s in which both rise smoothly (3 s^2 - 2 s^3); 0: at once
  std::optional<WallServo> servo{};
};

/// Throws std::invalid_argument naming the wall: a servo without a target or with two, without an
/// area or a largest speed, a gain out of range, numbers that are not finite, a plane's motion that
/// leaves two dimensions.
void check_motion(const WallMotion& motion, const Wall& wall, int dim);

}  // namespace grainfield::dem
