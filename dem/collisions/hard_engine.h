// Hard disks and spheres from collision to collision.
//
// Between events every grain flies freely, on a clock of its own: it is moved when something
// happens to it, and not before (Lubachevsky 1991). Each keeps its earliest meeting with another
// and its earliest event alone (a wall, the side of its cell, the end of sliding). A grain whose
// motion has changed gets a new number of motion, so that meetings which others planned with it are
// void: when such a one comes up, its owner looks for its next meeting anew. A meeting therefore
// has to be known to one of the two, the one that moved or changed its cell last. O(log N) an
// event. Of events at one time the grain of lower number comes first, so that the bits depend on
// nothing but the start.
//
// Round-off: flight.h. The clock starts anew every kEventsPerClock events a grain, so that times
// keep their digits in long runs.
//
// Inelastic collapse.  Grains that lose energy collide ever more often in finite time. With a
// contact time t_c > 0:
//   - A collision is elastic and smooth where one of the two has collided less than t_c before
//     (Luding and McNamara 1998).
//   - A grain that bounces from a floor comes to rest on it when its next flight would be shorter
//     than t_c: what is left of the geometric series of its flights, 2 w/(g (1 - e)), passes on
//     the floor, and then it is still. A floor is a wall at rest across gravity with e < 1. Until
//     something hits it the grain lies there: it rolls freely, after friction mu g has stopped its
//     slip.
//   - What the difference a of accelerations presses together, a grain and one that lies or a wall
//     that is no floor, parts at a t_c/2 at least, so that contacts take no less than t_c.
// Grains do not come to rest on grains: about g t_c they go on bouncing without loss. There hard
// grains end and soft ones begin (eq. 22).
#pragma once
#include <memory>
#include <vector>

#include "dem/collisions/event_queue.h"
#include "dem/collisions/flight.h"
#include "dem/collisions/scene.h"

namespace grainfield::dem {

/// What has happened since the start.
struct HardTally {
  long events = 0;     ///< of all kinds, void ones too
  long pairs = 0;      ///< collisions of two grains
  long walls = 0;      ///< with walls
  long elastic = 0;    ///< of both, those that were elastic by the contact time
  long crossings = 0;  ///< from cell to cell
  long repeated = 0;   ///< meetings that were void
  double virial = 0;   ///< sum over pairs of r . P, J s: distance of centres times repulsion
  double deepest = 0;  ///< overlap at a collision, over the distance of the centres
};

template <int D>
class HardEngine {
 public:
  using Vector = VectorOf<D>;

  /// Throws what check_scene does. Grains of inverse mass 0 keep their velocity.
  HardEngine(const HardScene<D>& scene, const std::vector<Body<D>>& grains);

  /// Goes on for at most so many events and not beyond that time (s). Returns how many there were:
  /// fewer where the time was reached, or nothing will ever happen any more. Throws
  /// ComputationFailed where collisions pile up at one instant.
  long advance(long events, double until = kNever);

  /// That of the last event or, where advance() came so far, its `until`; s.
  double time() const { return clock_ + now_; }
  std::size_t grains() const { return hot_.size(); }
  /// A grain at time(). In periodic boxes its place is that in the box.
  Body<D> body(std::size_t grain) const;
  /// At rest on a floor, and when the series of its flights has ended, s; kNever: it flies.
  double settled(std::size_t grain) const;
  /// Kinetic energy of the grains, J; without gravity's.
  double kinetic_energy() const;
  /// Kinetic energy lost since the start in collisions and by sliding, less what grains got that
  /// were pressed together, J. With moving walls: in the walls' frames.
  double lost() const;
  const HardTally& tally() const { return tally_; }
  /// Sum of the impulses of all collisions on that wall, N s; what lies on it adds none.
  const Vector& wall_impulse(std::size_t wall) const { return wall_impulses_[wall]; }

  /// Shows `each` what changes while it goes on; after values have been read settle() says whether
  /// they are a state.
  template <class Each>
  void visit(Each& each) {
    each(hot_);
    each(cold_);
    each(plans_);
    each(wall_impulses_);
    each(tally_);
    each(lost_);
    each(clock_);
    each(now_);
    each(until_restart_);
  }
  bool settle();

 private:
  enum class Motion : std::int32_t { free, lies, fixed };
  struct Hot {
    Vector position = zero<Vector>(), velocity = zero<Vector>();  // at its own time
    double time = 0, radius = 0;
    std::int32_t cell = 0;
    std::uint32_t number = 0;  // of its motion: goes up with every change
    Motion motion = Motion::free;
  };
  struct Cold {
    SpinOf<D> spin = zero<SpinOf<D>>();
    double inverse_mass = 0, inverse_inertia = 0;
    double last = -kNever;        // its last collision
    std::int32_t at_once = 0;     // collisions at that instant
    std::int32_t last_wall = -1;  // with which; -1: a grain
    std::int32_t floor = -1;      // on which it lies
    double settles = kNever;      // when it does
    double slides_until = -kNever;
    Vector acceleration = zero<Vector>();   // where it does not fly
    SpinOf<D> turning = zero<SpinOf<D>>();  // rad/s2
  };
  struct Plan {
    double meets = kNever;  // the earliest meeting
    double alone = kNever;  // the earliest of the other events
    std::int32_t partner = -1;
    std::uint32_t number = 0;  // of the partner's motion, for which it holds
    std::int32_t what = 0;     // wall, or face, or end of sliding or of settling
  };

  Vector acceleration(std::int32_t g) const {
    return hot_[g].motion == Motion::free ? scene_.gravity : cold_[g].acceleration;
  }
  void fly(std::int32_t g);
  void change(std::int32_t g);
  /// Energy that one that lies loses within such a time after its own, J.
  double slid(std::int32_t g, double time) const;
  Body<D> as_body(std::int32_t g) const;
  void take(std::int32_t g, const Body<D>& body);
  void note_collision(std::int32_t g, std::int32_t wall);
  bool is_recent(std::int32_t g) const;

  void happen(std::int32_t g);
  void collide_with_partner(std::int32_t g);
  void hit(std::int32_t g, std::int32_t wall);
  void lie_down(std::int32_t g, std::int32_t wall, double up);
  void stop_sliding(std::int32_t g);
  void cross(std::int32_t g, std::int32_t face);

  void look_around(std::int32_t g);
  void look_at(std::int32_t g, std::int32_t other, const Vector& shift, Plan& plan) const;
  void look_ahead(std::int32_t g);
  void plan(std::int32_t g);
  void restart_clock();
  void fill();

  HardScene<D> scene_;
  std::vector<char> is_floor_;
  bool weighs_ = false;
  std::vector<Hot> hot_;
  std::vector<Cold> cold_;
  std::vector<Plan> plans_;
  std::vector<Vector> wall_impulses_;
  HardTally tally_;
  double lost_ = 0;             // but for those that slide: up to their own times
  double clock_ = 0, now_ = 0;  // where the clock started, and what it says
  long until_restart_ = 0;
  Cells<D> cells_;
  EventQueue queue_;
};

extern template class HardEngine<2>;
extern template class HardEngine<3>;

}  // namespace grainfield::dem
