// The step loop's state and the names of its parts, compiled once per shape, law and integrator
// (see engine.h for the algorithm).
#pragma once
#include <array>
#include <atomic>
#include <numbers>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/engine/image.h"
#include "dem/engine/thread_team.h"
#include "dem/neighbours/hierarchical_grid.h"
#include "dem/shapes/bounding_rectangle.h"
#include "dem/shapes/disk_store.h"
#include "dem/shapes/polygon_store.h"

namespace grainfield::dem {

// Skin of the neighbour list as a share of the mean radius, when none is given. A large one means
// few searches and many idle pairs: it grows when motion asks for a search within kOften steps of
// the last time, and shrinks when it has not for kSeldom steps. At rest 0.03 was the fastest of
// 0.01, 0.03 and 0.1 on the settled packings of tests/benchmarks. Step counts alone decide, so the
// bits stay.
inline constexpr double kFirstSkin = 0.1, kLeastSkin = 0.03, kMostSkin = 0.4;
inline constexpr long kOften = 60, kSeldom = 1000;
// A grain may move half the skin, and at its present speed for this many steps, before the next
// search; so a few falling grains do not make all others search.
inline constexpr double kStepsAhead = 100;
// ... but not further than this many radii.
inline constexpr double kMostAhead = 3;
// Sleeping and waking are decided every so many steps.
inline constexpr long kReviewEvery = 50;
// How many pairs ahead the sweep asks for the grains it will need; the pair list ends with as many
// idle entries. Measured: 8 % on packings beyond the second-level cache, none below.
inline constexpr int kAhead = 16;
// A grain that moves further than this share of its radius in one step has diverged: a contact
// would be crossed before it is seen.
inline constexpr double kMaxMoveShare = 0.5;

enum class SweepKind {
  start,    ///< only the acceleration of new grains
  move_on,  ///< end the step and begin the next
  last      ///< end the step and keep the forces for measure() and snapshot()
};

template <class Shape, class Law, class Integrator>
class EngineLoop final : public Engine {
 public:
  using Memory = typename Integrator::Memory;

  EngineLoop(const EngineSettings& settings, const Law& law)
      : settings_(settings), law_(law), integrator_(settings.time_step), team_(settings.threads) {}

  std::int64_t add(const NewGrain& g) override {
    Body b;
    b.x = g.x;
    b.y = g.y;
    b.vx = g.fixed ? 0 : g.vx;
    b.vy = g.fixed ? 0 : g.vy;
    b.spin = g.fixed || !g.rotates ? 0 : g.spin;
    b.radius = g.outline.empty() ? g.radius : circumradius_of(g.outline);
    const double area =
        g.outline.empty() ? std::numbers::pi * g.radius * g.radius : area_of(g.outline);
    const double polar =
        g.outline.empty() ? 0.5 * area * g.radius * g.radius : polar_moment_of(g.outline);
    shapes_.add(g.outline);
    if (!g.fixed) {
      b.inverse_mass = 1 / (g.density * area);
      if (g.rotates) b.inverse_inertia = 1 / (g.density * polar);
      ++free_;
    }
    Memory m;
    m.angle = g.angle;
    bodies_.push_back(b);
    memory_.push_back(m);
    inertias_.push_back({g.density * area, g.density * polar, area});
    ids_.push_back(static_cast<std::int64_t>(ids_.size()));
    quiet_.push_back({g.x, g.y, g.angle, steps_});
    rests_.push_back({});
    touches_.push_back({});
    asleep_.push_back(g.fixed && settings_.sleep.on ? 1 : 0);
    if (asleep_.back() != 0) sleepers_changed_ = true;
    shapes_.place(static_cast<int>(bodies_.size()) - 1, b, g.angle);
    search_needed_ = true;
    return ids_.back();
  }

  void add_wall(const Wall& wall) override {
    walls_.push_back(wall);
    search_needed_ = true;
  }

  void apply(const AppliedForce& force) override {
    applied_ = force;
    wake_all();
    locate_applied();
  }

  void set_background_damping(double rate) override { background_ = rate; }

  void set_gravity(double gx, double gy) override {
    settings_.gravity_x = gx;
    settings_.gravity_y = gy;
    wake_all();
  }
  void set_sleep(bool on) override {
    settings_.sleep.on = on;
    wake_all();
  }

  void step(long n) override;

  double time() const override { return static_cast<double>(steps_) * settings_.time_step; }
  long steps() const override { return steps_; }
  int grains() const override { return free_; }
  double time_step() const override { return settings_.time_step; }
  Diagnostics measure() const override;
  Motion motion() const override;
  Snapshot snapshot() const override;
  void remember(const std::vector<Contact>& contacts) override;
  std::string image() const override;
  void restore(const std::string& image) override;

 private:
  struct Pair {
    double spring = 0;    // N, on the first grain along (-n_y, n_x)
    int j = 0;            // second grain, or wall; the first is the row's
    PairFeature feature;  // where the narrow phase starts; no influence on the result
  };
  struct alignas(32) Sum {
    double fx = 0, fy = 0, torque = 0;
    double press = 0;  // sum of |fx| + |fy|; where sleeping is judged
  };
  struct Inertia {
    double mass = 0, polar = 0, area = 0;  // kg, kg m2, m2; of fixed grains too
  };
  /// Where a grain was at the last search, and how far any of its points may go.
  struct Reference {
    double x = 0, y = 0, angle = 0;
    double turning = 0;  // m/rad: how far turning carries a point; 0 where only the circle counts
    double way = 0;      // m
  };
  /// Since when, and from where, a grain has hardly moved.
  struct Quiet {
    double x = 0, y = 0, angle = 0;
    long since = 0;
  };
  /// A contact between sleepers (or of one with a wall): its memory and its force, on the grain
  /// with the lower id.
  struct Frozen {
    std::uint64_t key = 0;
    double spring = 0, fx = 0, fy = 0, torque_low = 0, torque_high = 0;
  };
  using Key = std::uint64_t;  // of a pair of ids, or of an id and a wall

  void wake_all();
  void search(bool by_motion);
  double way_of(int i) const;
  double turning_of(int i) const;
  void find_bounds(int first, int last);
  bool out_of_reach(int i, int j) const;
  void build_sleepers_grid();
  void part_sleepers();
  void swap_bodies(int i, int j);
  Pair recalled(int i, int j, bool wall, const std::vector<std::pair<Key, double>>& kept);
  static Key pair_key(std::int64_t a, std::int64_t b);
  static Key wall_key(std::int64_t id, int wall);
  void adapt_skin(bool by_motion);
  void gather_touches();
  void review();
  bool wake_sleepers();
  bool let_sleep();
  template <class Visit>
  void visit_static(const std::vector<unsigned char>& of, Visit visit);
  void index_contacts();
  void sort_bodies(const std::vector<int>& order);
  void locate_applied();
  void begin(int i, bool& moved);
  void begin_all(int rank);
  void incoming(int rank, double dt);
  template <SweepKind kind>
  void sweep(int rank, long step_index, double dt);
  bool pair_force(int i, int k, double dt, ContactForce& force);
  std::array<double, 2> applied_at(double t) const;
  std::array<double, 3> weight_of(int i) const;
  void start_new_grains();
  void check_motion();
  static bool is_finite(const Body& b);
  ContactForce evaluate(const Body& a, const Body& b, const Overlap& o, double mu, double dt,
                        double& spring) const;
  bool overlap_with_wall(int i, const Wall& w, Overlap& o) const;
  static std::array<double, 2> point_of(const Body& a, const Overlap& o);
  template <class Visit>
  void visit_contacts(Visit visit) const;
  template <class Loop, class Each>
  static void visit_state(Loop& loop, Each each);
  std::vector<Frozen> sorted_frozen() const;
  [[noreturn]] void report_divergence() const;

  EngineSettings settings_;
  Law law_;
  Integrator integrator_;
  ThreadTeam team_;
  double background_ = 0;
  AppliedForce applied_;
  int applied_index_ = -1;
  long steps_ = 0;
  int free_ = 0;
  std::int64_t first_new_ = 0;  // ids from here on have not been started yet
  double skin_ = 0, skin_share_ = kFirstSkin;
  long last_by_motion_ = 0;  // the last search that motion asked for
  bool search_needed_ = true;
  std::atomic<bool> moved_{false}, diverged_{false};

  std::vector<Body> bodies_;
  std::vector<Memory> memory_;
  std::vector<Inertia> inertias_;
  std::vector<std::int64_t> ids_;
  std::vector<Wall> walls_;
  std::vector<Reference> reference_;  // of the awake
  Shape shapes_;

  // Grains [0, awake_) move; the others sleep or are fixed. Without sleeping awake_ is their
  // number.
  int awake_ = 0;
  std::vector<unsigned char> asleep_;
  std::vector<Quiet> quiet_;
  std::vector<Sum> rests_;    // of sleepers: weight and forces of the frozen contacts
  std::vector<Sum> touches_;  // of sleepers: forces of awake neighbours, summed over the steps
  long touch_steps_ = 0;      // ... since the last review
  std::vector<Sum> felt_;     // the same by pair, since the last search
  std::unordered_map<Key, Frozen> frozen_;
  bool sleepers_changed_ = true;

  // Candidate pairs by first grain (rows pair_start_[i] .. pair_start_[i+1]), likewise with walls.
  std::vector<Pair> pairs_, wall_pairs_;
  std::vector<int> pair_start_, wall_start_;
  std::vector<ContactForce> pair_forces_, wall_forces_;  // of the last step of step(n)
  std::vector<Sum> sums_;    // what earlier grains have left for a later one; 0 between steps
  std::vector<int> blocks_;  // first grain of each thread's block, and the end
  std::vector<std::vector<std::pair<int, int>>> incoming_;  // per block: (i, pair)
  HierarchicalGrid grid_, sleepers_grid_;
  std::vector<Reach> reaches_;
  std::vector<BoundingRectangle> bounds_;  // while some grain is slender
};

}  // namespace grainfield::dem
