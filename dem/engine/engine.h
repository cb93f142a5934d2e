// The discrete-element engine: grains, walls, contacts and time.
//
// One step, on any number of threads with the same bits:
//   1. every grain: integrator begins (moves), displacement since the last neighbour search
//   2. every candidate pair and wall: overlap, law, force written beside the pair
//   3. every grain: gathers its contacts' forces in a fixed order; integrator ends
// Parts 3 and 1 of successive steps are one sweep. Shape, law and integrator are fixed at compile
// time inside (engine_loop.h); this interface hides them.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dem/engine/contact_losses.h"
#include "dem/laws/materials.h"
#include "dem/motion/applied_force.h"
#include "dem/motion/registry.h"
#include "dem/shapes/registry.h"
#include "dem/shared/computation_failed.h"
#include "dem/sleep/sleep_settings.h"
#include "dem/snapshot/cell_stress.h"
#include "dem/snapshot/snapshot.h"
#include "dem/walls/wall_motion.h"

namespace grainfield::dem {

/// Laws and friction (Materials), motion, and what the engine is made for.
struct EngineSettings : Materials {
  IntegratorKind integrator;
  double time_step = 1e-5;  ///< s
  std::string step_bound;   ///< what sets it, for people: "the dashpots"; empty: not known
  double gravity_x = 0, gravity_y = -9.81, gravity_z = 0;  ///< m/s2
  double skin = 0;  ///< m; gap kept in the neighbour list; 0 = chosen from the radii
  int threads = 1;
  ShapeKind shape;  ///< polygons are disks too, but slower
  SleepSettings sleep;
  /// Axes that repeat, and the flow of their space (moving_cell.h). Walls must lie along the
  /// periodic edges. In a cell that flows no grain is fixed or sleeps.
  Cell<3> cell;
  /// Every contact accounts for what it loses (Diagnostics::dissipated_energy); steps take longer.
  /// With an integrator that leaps (dem/motion/integrator.h).
  bool energy_balance = false;
  /// Cundall's alpha in [0, 1): dem/motion/local_damping.h. Likewise.
  double local_damping = 0;
};

/// A grain to be added.
struct NewGrain {
  double x = 0, y = 0, vx = 0, vy = 0, angle = 0, spin = 0;
  double radius = 0;
  double density = 0;  ///< kg/m2
  bool fixed = false;
  bool rotates = true;   ///< false: a block that slides but never spins
  Outline outline;       ///< body frame (polygon.h: centred); empty: a disk of `radius`
  std::string material;  ///< one of EngineSettings::materials
  /// In 3D; `spin` is about z, `angle` is not used, `density` is in kg/m3.
  double z = 0, vz = 0, spin_x = 0, spin_y = 0;
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< unit quaternion w, x, y, z
  std::array<int, 3> image{0, 0, 0};              ///< as Grain::image, to count on from
  std::array<double, 3> axes{};                   ///< of a superellipsoid: r1, r2, r3, m
  std::array<double, 2> exponents{1, 1};  ///< likewise: e1, e2 (dem/shapes/superellipsoid.h)
  double mass = 0;                        ///< kg; 0: density times what the shape fills
  std::array<double, 3> moments{};        ///< principal, in 2D the third, kg m2; 0: of the shape
};

/// State of rest and energy, from the forces of the last step.
struct Diagnostics {
  double kinetic_energy = 0;          ///< J; in a cell that flows, of the motion against the flow
  double elastic_energy = 0;          ///< J
  double mean_contact_force = 0;      ///< N
  double mean_unbalanced_force = 0;   ///< N, mean resultant on the free grains
  double max_unbalanced_force = 0;    ///< N
  double unbalanced_force_ratio = 0;  ///< mean resultant / mean contact force
  /// Mean over the free grains that turn of |moment| / radius, over the mean contact force.
  double unbalanced_moment_ratio = 0;
  double max_overlap_ratio = 0;  ///< largest depth / smaller radius
  double height = 0;             ///< top of the highest free grain, m
  int contacts = 0;              ///< that carry force, with walls
  int sliding = 0;
  int awake = 0;                ///< free grains that do not sleep
  double potential_energy = 0;  ///< J, of free grains in gravity; 0 at the origin
  double wall_work = 0;         ///< J, done on the grains by walls that move, since the start
  /// Done by the cell's flow since the start, J: the integral of V sigma : L, sigma as in
  /// cell_stress.h, each step's power held for that step. With walls, gravity or an applied force
  /// also what these take from motion with the flow.
  double cell_work = 0;
  bool energy_followed = false;  ///< EngineSettings::energy_balance; since the start then:
  ContactLosses contact_losses;  ///< by mechanism, with the work of the law
  double damped_energy = 0;      ///< J, by background and local damping
  double stopped_energy = 0;     ///< J, kinetic, of grains when they fell asleep
  double applied_work = 0;       ///< J, of the applied force
  double brought_energy = 0;     ///< J, kinetic and elastic, with grains that were added
  double gravity_work = 0;       ///< J, on the grains since they were added

  double dissipated_energy() const { return contact_losses.lost(); }
  /// Done by all that is no grain: walls, cell, force, gravity, and with grains that were added.
  double work() const {
    return wall_work + cell_work + applied_work + gravity_work + brought_energy;
  }
  /// The same without regard to signs: what an error of the balance is measured by.
  double size_of_work() const {
    return std::fabs(wall_work) + std::fabs(cell_work) + std::fabs(applied_work) +
           std::fabs(gravity_work) + brought_energy;
  }
  /// 0 to second order in the time step (dem/engine/energy_balance.h), to first order in a cell
  /// that flows, J.
  double energy_balance() const {
    return kinetic_energy + elastic_energy + dissipated_energy() + damped_energy + stopped_energy -
           work() - contact_losses.law;
  }
};

/// What measure() says of the motion alone: read without looking at a contact.
struct Motion {
  double kinetic_energy = 0;  ///< J; in a cell that flows, of the motion against the flow
  int awake = 0;              ///< free grains that do not sleep
};

/// Where the engine keeps its grains, fixed ones too: number k of a column is `stride` bytes behind
/// number k - 1, a vector's components are side by side. The order is the engine's: ids[k] tells
/// who is where. Steps change the values and the order, but not the places; add() and restore()
/// may move all.
struct GrainArrays {
  int count = 0, dim = 2;
  long stride = 0;                   ///< bytes, of all but ids
  const double* position = nullptr;  ///< dim each, m
  const double* velocity = nullptr;  ///< dim each, m/s
  const double* spin = nullptr;      ///< 1 each, in space 3; rad/s
  const double* radius = nullptr;    ///< m
  const std::int64_t* ids = nullptr;
};

class Engine {
 public:
  virtual ~Engine() = default;

  /// Adds a grain and returns its id (0, 1, 2, ...). Radius and density (or mass) must be positive.
  /// In a cell its place may be any image; velocities are of the laboratory's frame. Throws
  /// std::invalid_argument when it is fixed in a cell that flows or too large for the cell.
  virtual std::int64_t add(const NewGrain& grain) = 0;
  /// `material`: "": the wall has the friction of `wall` and the law of each grain with its like;
  /// else one of EngineSettings::materials, and all is the pair's. Throws std::invalid_argument
  /// when nothing is known of a pair that can meet.
  virtual void add_wall(const Wall& wall, const std::string& material) = 0;
  void add_wall(const Wall& wall) { add_wall(wall, wall.material); }
  /// From now on, instead of any earlier motion; every grain wakes. `wall`: in the order of adding.
  /// add_wall sets a wall with a velocity or angular velocity in motion, about its point. Throws
  /// std::invalid_argument naming the wall: a servo without a target and the like (wall_motion.h);
  /// step() throws it for a given speed of more than half the smallest radius a step.
  virtual void set_wall_motion(int wall, const WallMotion& motion) = 0;
  /// Moves the wall with this name. Throws std::invalid_argument when there is none.
  void set_wall_motion(const std::string& name, const WallMotion& motion);
  /// Where they are, how they move, and the force of all grains on each in the last step.
  virtual std::vector<Wall> walls() const = 0;
  /// Applies this force from now on instead of any earlier one; the grains `beside` carry the same
  /// each.
  virtual void apply(const AppliedForce& force, const std::vector<std::int64_t>& beside) = 0;
  void apply(const AppliedForce& force) { apply(force, {}); }
  /// Mass-proportional damping: acceleration -= rate * velocity, 1/s.
  virtual void set_background_damping(double rate) = 0;
  /// From now on; every grain wakes.
  virtual void set_gravity(double gx, double gy, double gz) = 0;
  void set_gravity(double gx, double gy) { set_gravity(gx, gy, 0); }
  /// The flow of the cell from now on, 1/s: its edges follow edges' = L edges, exactly for simple
  /// shear and any L with L^2 = 0, to second order in the time step otherwise (moving_cell.h). Of
  /// every grain the velocity against the flow stays; so no wave starts from the faces. In the
  /// plane the third row and column are 0. Throws std::invalid_argument when the cell cannot flow
  /// so, or some grain is fixed or may sleep.
  virtual void set_velocity_gradient(const Eigen::Matrix3d& gradient) = 0;
  /// The cell now; without periodic axes an empty one.
  virtual Cell<3> cell() const = 0;
  /// Switches sleeping on or off; off wakes every grain.
  virtual void set_sleep(bool on) = 0;
  /// Without any threads' influence on the bits. Throws ComputationFailed when it diverges: a grain
  /// moves by more than half its radius in a step (against the cell's flow), its place, speed or
  /// spin is not finite, or the cell has become too small for its grains.
  virtual void step(long n) = 0;

  virtual double time() const = 0;
  virtual long steps() const = 0;
  virtual int grains() const = 0;  ///< without fixed ones
  virtual double time_step() const = 0;
  /// Throws ComputationFailed when an energy is not finite.
  virtual Diagnostics measure() const = 0;
  virtual Motion motion() const = 0;
  virtual Snapshot snapshot() const = 0;
  /// Its grains in place, without a copy; empty without grains.
  virtual GrainArrays arrays() const = 0;
  /// That of cell_stress(snapshot()), as a sum in another order, and much sooner: for servos.
  /// Throws std::invalid_argument when the cell is not periodic along every axis.
  virtual CellStress cell_stress() const = 0;

  /// Gives the contacts that the next step finds between these grains (by id; j = -1 - w: wall w)
  /// these springs, where they have none yet.
  virtual void remember(const std::vector<Contact>& contacts) = 0;

  /// The whole state, in bits, and back. restore() expects an engine made with the same settings
  /// and without grains; throws std::invalid_argument when the checkpoint does not fit.
  virtual std::string checkpoint() const = 0;
  virtual void restore(const std::string& checkpoint) = 0;
};

/// The largest time step that make_engine's user should take, s: the smaller of
///  - (1/10) pi sqrt(m/k) (physics section 2): a tenth of the half period of a contact, and
///  - the integrator's limit for the dashpots (viscous_limit): their fastest mode in a packing
///    decays at the law's viscous_rate(m). For Roul's law this is what makes Gear need steps of
///    5e-6 s where Verlet takes 5e-5.
/// Resistance against rolling counts like another spring and dashpot (rolling.h). Of several laws
/// the one with the smallest step counts.
double stable_time_step(const EngineSettings& settings, double least_mass, double least_radius = 0);

/// What of a population of grains bounds the time step.
struct GrainExtremes {
  double least_mass = 0;     ///< kg
  double steepest_edge = 0;  ///< edge_steepness (polygon.h) of the polygon with the largest
                             ///< steepness / sqrt(mass); 0: disks only
  double steep_mass = 0;     ///< its mass, kg
  double widest_edge = 0;    ///< edge_width of the polygon with the largest width / sqrt(mass)
  double wide_mass = 0;      ///< its mass, kg
  double least_radius = 0;   ///< m; for laws whose stiffness goes by it (hertz)
};
/// The same with polygons: two parallel edges of length e at arms a give the contact the stiffness
/// E e/l <= E s, s = 2 e/a, and the dashpot gamma s sqrt(E m_eff). In a chain of grains like the
/// steepest one, hemmed in between others, the fastest mode feels four times both, and velocity
/// Verlet with forces at the half-step velocity is stable while c dt + k dt^2/2 < 2 (k, c per
/// mass); 0.7 of it is allowed. Irregular grains hardly ever lie like this: kMostOfLimit.
double stable_time_step(const EngineSettings& settings, const GrainExtremes& extremes);

/// What sets that limit.
enum class StepBound { spring, rolling, dashpots, edges };
StepBound step_bound(const EngineSettings& settings, const GrainExtremes& extremes);

/// Shares of that limit up to this are accepted for polygons: piles of 200 RAND1 polygons came to
/// rest at 2.8 times the limit and not at 3.5; at 2.5 impacts keep the same energy as at a tenth to
/// 0.5 % (tests/dem/engine/time_step_test.cc). A packing that is not stable does not come to rest,
/// which is reported.
inline constexpr double kMostOfLimit = 2.5;

/// Throws std::invalid_argument for settings out of range; resistance against rolling of polygons
/// (their corners resist) and superellipsoids; twisting in the plane.
std::unique_ptr<Engine> make_engine(const EngineSettings& settings);
/// What make_engine says of rolling resistance and local damping, before there is a shape. Throws
/// std::invalid_argument: twisting in the plane, local damping out of range or with gear.
void check_rolling(const EngineSettings& settings);
/// Throws std::invalid_argument: the two do not go together.
[[noreturn]] void refuse_rolling_polygons();
/// The same for superellipsoids, whose shapes resist.
[[noreturn]] void refuse_rolling_superellipsoids();
/// Throws std::invalid_argument naming motion.integrator: it does not move grains of this shape.
void check_integrator(const EngineSettings& settings);
[[noreturn]] void refuse_integrator(const EngineSettings& settings);
/// The same, to go on from a snapshot of the shape's dimension, whose grains are numbered 0, 1, 2,
/// ...: its walls and grains with their materials, mass, moments and velocities (one that never
/// turns goes on so), the contacts' springs, and the applied force as it is. A spring that another
/// program did not tell (nan) is taken for the tangential force, which it is at rest. Time begins
/// at 0; the settings' gravity and cell are replaced by the snapshot's. Walls go on at the velocity
/// and angular velocity of that moment, about their points: a servo, a ramp or another centre is
/// for set_wall_motion to give anew. What a snapshot does not hold is the settings': laws, time
/// step, sleep; and background damping is off. Throws std::invalid_argument when the snapshot is of
/// another dimension or numbered otherwise, or names a material that the settings do not have.
std::unique_ptr<Engine> make_engine(const EngineSettings& settings, const Snapshot& start);

}  // namespace grainfield::dem
