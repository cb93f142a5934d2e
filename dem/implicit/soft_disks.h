// Soft disks in the plane, moved implicitly so that energy is kept (Liffman et al. 1992, eqs 22-36;
// Greenspan 1984).
//
// With u the way of a disk in a step, a its turn, and forces F, moments M over the step
// (soft_contact.h), each step solves
//
//   u = dt (v_0 + v_1)/2          m (v_1 - v_0)/dt = m g + F - m b u/dt
//   a = dt (w_0 + w_1)/2          I (w_1 - w_0)/dt = M - I b a/dt
//
// for all u, a at once by Newton's method (KINSOL) on the sparse contact network. Without dashpots
// and friction kinetic, potential and elastic energy together stay the same to the solver's
// tolerance at any time step, and so do linear and angular momentum of grains alone. Contacts that
// last are followed to second order in time.
//
// The step is halved where Newton's method does not converge, and where a disk would move further
// than `most_move` of its radius: two that fly freely do not pass through each other unseen.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dem/implicit/soft_contact.h"
#include "dem/space/body.h"

namespace grainfield::dem {

/// A half plane that disks do not enter; it stands still.
struct SoftWall {
  VectorOf<2> point = VectorOf<2>::Zero();  ///< on it, m
  VectorOf<2> normal{0, 1};                 ///< unit, towards the disks
  SoftLaw law;
};

struct SoftScene {
  SoftLaw grains;  ///< of a pair of disks; without a well
  std::vector<SoftWall> walls;
  VectorOf<2> gravity = VectorOf<2>::Zero();  ///< m/s2
  double background_damping = 0;              ///< b, 1/s: acceleration -= b v
};

enum class ImplicitScheme {
  conserving,  ///< the equations above
  bdf2,        ///< the two last steps and forces at the end of this one: what swings faster than a
               ///< step can follow dies out; of second order, begun by the implicit Euler step
};

struct ImplicitSettings {
  ImplicitScheme scheme = ImplicitScheme::conserving;
  double time_step = 1e-3;  ///< s
  /// Share of Newton's step that is tried first. Liffman: 0.5 to 0.9; below 1 convergence is linear
  /// with 1 - relaxation.
  double relaxation = 1;
  double tolerance = 1e-12;  ///< residual over the step's largest force, no less than round-off
  int max_iterations = 50;
  double most_move = 0.5;  ///< of a disk in a step, over its radius
  int most_halvings = 10;
};

struct ImplicitTally {
  long steps = 0;           ///< of time_step
  long solves = 0;          ///< of Newton's method that converged, parts of halved steps among them
  long iterations = 0;      ///< in those
  int most_iterations = 0;  ///< of one solve
  long halved = 0;          ///< steps or parts of them that were halved
  double least_step = 0;    ///< the shortest part taken, s
};

/// J, gone since the start.
struct SoftLosses {
  double normal = 0;      ///< dashpots along the normal
  double tangential = 0;  ///< friction
  double well = 0;        ///< what walls' wells took, less what they gave back: they hold by N, so
                          ///< that they have no potential
  double background = 0;
  double scheme = 0;  ///< BDF2's own: what is missing besides the others
  double total() const { return normal + tangential + well + background + scheme; }
};

struct SoftEnergy {
  double kinetic = 0, potential = 0, elastic = 0, springs = 0;  ///< J; springs: of coulomb
  double total() const { return kinetic + potential + elastic + springs; }
};

/// Disks that touch now.
struct SoftTouch {
  int i = 0, j = 0;          ///< j = -1 - w: wall w
  VectorOf<2> normal{0, 0};  ///< from i to j, unit
  double overlap = 0;        ///< m
  double repulsion = 0;      ///< K s, N
  double tangential = 0;  ///< on i along (-n_y, n_x): spring of coulomb and pull of the well now, N
};

struct SoftRest {
  double mean_contact_force = 0, mean_unbalanced_force = 0;  ///< N, of forces without dashpots
  double ratio = 0;                                          ///< of the two; inf without contacts
};

class SoftDisks {
 public:
  /// A disk of inverse mass 0 goes on at its velocity, one of inverse inertia 0 at its spin. Throws
  /// std::invalid_argument: a key out of range (name, value, what is allowed); a start that
  /// Newton's method cannot begin from: places, velocities or spins that are not finite, disks
  /// without radius, centres of a pair nearer than half the sum of their radii, a centre nearer to
  /// a wall than half its radius.
  SoftDisks(const SoftScene& scene, const std::vector<Body<2>>& disks,
            const ImplicitSettings& settings);
  ~SoftDisks();
  SoftDisks(SoftDisks&&) noexcept;
  SoftDisks& operator=(SoftDisks&&) noexcept;

  /// The same bits whenever it is repeated. Throws ComputationFailed where a step halved
  /// `most_halvings` times does not converge: when, why and what to change.
  void step(long steps);
  /// Solves the next part of a step: the whole of it, unless that did not converge before. Returns
  /// whether a step has ended with it; a part that does not converge is halved for the next call.
  /// Throws as step(), which is as many calls as end its steps.
  bool try_part();

  /// Contacts act between disks of value 1, and between these and walls; all of them at the start.
  /// Takes one value a disk; a contact that stops acting is forgotten.
  void set_acting(const std::vector<char>& acting);
  /// A disk more, the last one, between whole steps; it acts. Throws std::invalid_argument as the
  /// constructor, for this disk.
  void add(const Body<2>& disk);
  /// Velocities and spins become those of these bodies.
  void set_velocities(const std::vector<Body<2>>& bodies);

  double time() const;
  const std::vector<Body<2>>& bodies() const;
  const std::vector<double>& angles() const;  ///< since the start, rad
  SoftEnergy energy() const;
  const SoftLosses& losses() const;
  const ImplicitTally& tally() const;
  /// Sorted by i, then j; walls first.
  std::vector<SoftTouch> touches() const;
  /// Rest of the disks of finite mass.
  SoftRest rest() const;

  /// The whole state, in bits, and back into one made of the same scene, settings and number of
  /// disks: it goes on to the same bits. Throws std::invalid_argument when the checkpoint does not
  /// fit.
  std::string checkpoint() const;
  void restore(const std::string& checkpoint);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace grainfield::dem
