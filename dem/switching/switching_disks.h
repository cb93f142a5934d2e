// Disks in the plane that collide as hard ones and rest as soft ones, grain by grain (Liffman et
// al. 1992, eq. 22).
//
// A hard grain flies freely and collides by impulses (dem/collisions/impulse.h); contacts of two
// soft grains, and of soft ones with walls, act by forces over an implicit step (dem/implicit). In
// a step of dt:
//
//   1. Pairs that are not both soft: free flight v dt + a dt^2/2, with a of gravity and the forces
//      of now, tells whether they would overlap; those that would, and approach, collide now. So
//      impulses come early by up to dt, and no hard grain ever overlaps: a switch changes neither
//      place nor velocity, and there is no elastic energy and no memory to make or to lose.
//   2. With u >= 0 the speed at which such a pair parts and a > 0 the acceleration at which the
//      resultants bring it together again, it becomes soft where dt > u/a                     (22)
//   3. All move by the implicit step; contacts that are not soft on both sides do not act.
//   4. A soft grain that touches nothing becomes hard. Where a soft grain was pushed into a hard
//      one within the step, by less than what it moved, both are soft from now on; the elastic
//      energy of that overlap is counted as `switched`.
//
// So total energy + what was lost - switched stays the same to the solver's tolerance, and momentum
// is exchanged with walls and gravity alone.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "dem/collisions/impulse.h"
#include "dem/implicit/soft_disks.h"
#include "dem/neighbours/hierarchical_grid.h"

namespace grainfield::dem {

struct SwitchScene {
  SoftScene soft;                ///< forces of soft grains, walls, gravity
  ImpactLaw grains;              ///< of a pair that is not soft
  std::vector<ImpactLaw> walls;  ///< of each wall of `soft`
};

struct SwitchTally {
  long collisions = 0;
  long to_soft = 0, to_hard = 0;  ///< grains
  long pressed = 0;     ///< pairs that became soft because impulses found no end, or where
                        ///< one was pushed into the other
  double lost = 0;      ///< by impulses, J
  double switched = 0;  ///< elastic energy of overlaps that began with a switch, J
};

class SwitchingDisks {
 public:
  /// All are hard at the start, those that overlap soft. Throws what SoftDisks does, and
  /// std::invalid_argument for a restitution outside [0, 1], friction below 0 or another number of
  /// walls' laws than of walls.
  SwitchingDisks(const SwitchScene& scene, const std::vector<Body<2>>& disks,
                 const ImplicitSettings& settings);

  /// The same bits whenever it is repeated. Throws as SoftDisks::step.
  void step(long steps);
  /// A hard disk more, the last one, which overlaps none. Throws as SoftDisks::add.
  void add(const Body<2>& disk);

  double time() const { return disks_.time(); }
  const std::vector<Body<2>>& bodies() const { return disks_.bodies(); }
  const std::vector<double>& angles() const { return disks_.angles(); }
  const std::vector<char>& soft() const { return soft_; }  ///< 1: the grain is soft
  SoftEnergy energy() const { return disks_.energy(); }    ///< of contacts that act
  const SoftLosses& losses() const { return disks_.losses(); }
  const SwitchTally& tally() const { return tally_; }
  const ImplicitTally& implicit_tally() const { return disks_.tally(); }
  std::vector<SoftTouch> touches() const { return disks_.touches(); }
  SoftRest rest() const { return disks_.rest(); }
  /// Energy with all that was lost, less what was switched, J: stays the same but for what a disk
  /// brings that is added.
  double balance() const {
    return energy().total() + losses().total() + tally_.lost - tally_.switched;
  }

  /// Bytes and their reading as of SoftDisks; disks that were added are added again before.
  std::string checkpoint() const;
  void restore(const std::string& checkpoint);

 private:
  using Vec = VectorOf<2>;
  struct Pair {
    int i = 0, j = 0;  // j = -1 - w: wall w
  };
  struct Meeting {
    Vec normal{0, 0};         // from i to j
    double gap = 0, end = 0;  // now, and after free flight
    double parting = 0;       // speed
    double closing = 0;       // acceleration towards each other
  };

  bool is_soft(const Pair& p) const { return soft_[p.i] && (p.j < 0 || soft_[p.j]); }
  void make_soft(const Pair& p);
  void find_pairs();
  void find_accelerations();
  Meeting meeting_of(const Pair& p) const;
  void collide_pair(const Pair& p, const Vec& normal);
  void collide_all();
  void look_back();

  SwitchScene scene_;
  double time_step_ = 0;
  SoftDisks disks_;
  std::vector<Body<2>> moving_;  // with this step's impulses
  std::vector<char> soft_;
  std::vector<Vec> accelerations_;  // m/s2
  std::vector<Pair> pairs_;
  HierarchicalGrid<2> grid_;
  SwitchTally tally_;
};

}  // namespace grainfield::dem
