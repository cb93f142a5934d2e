// Shapes, laws and integrators: a word that no registry knows goes nowhere, and a new one of each
// is made here as docs/extending.md says, against nothing but its concept.
#include "dem/laws/registry.h"

#include <gmock/gmock.h>

#include <cmath>

#include "dem/engine/combine.h"
#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/motion/registry.h"
#include "dem/run/common.h"
#include "dem/shapes/disk_store.h"

namespace grainfield::dem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Registry, WordsAreThoseOfTheKinds) {
  EXPECT_THAT(words_of<AnyIntegrator>(), ElementsAre("verlet", "gear", "runge_kutta"));
  EXPECT_THAT(words_of<AnyLaw>(), testing::IsSupersetOf({"overlap_area", "energy", "linear"}));
  EXPECT_THAT(laws_that_feel_edges(), ElementsAre("overlap_area", "energy"));
  EXPECT_EQ(IntegratorKind::named("gear"), IntegratorKind::gear);
  EXPECT_STREQ(IntegratorKind().name(), "verlet");
  MaterialSetup m;
  m.law = "linear";
  m.normal_stiffness = 7e6;
  EXPECT_EQ(std::get<LinearLaw>(law_of(m)).normal_stiffness, 7e6);
}

TEST(Registry, UnknownWordsReachNoEngine) {
  const auto refusal = [](const MaterialSetup& material, const MotionSetup& motion) {
    try {
      engine_settings(material, motion, {1, 0}, 1);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  MaterialSetup material;
  MotionSetup motion;
  EXPECT_EQ(refusal(material, motion), "accepted");
  motion.integrator = "gaer";
  EXPECT_EQ(refusal(material, motion),
            "motion.integrator: found \"gaer\", allowed: verlet, gear, runge_kutta; did you mean "
            "\"gear\"?");
  motion.integrator = "verlet";
  material.law = "lineer";
  EXPECT_THAT(
      refusal(material, motion),
      AllOf(HasSubstr("material.law: found \"lineer\", allowed: overlap_area, energy, linear"),
            HasSubstr("did you mean \"linear\"?")));
}

// A law: F = k depth^2, without friction.
struct SquareLaw {
  static constexpr const char* name = "square";
  static constexpr Measures measures = Measures::depth;
  static constexpr EdgeMeasure edges = EdgeMeasure::none;
  template <int D>
  using Memory = SpringMemory<D>;
  double k = 1e9;

  static SquareLaw of(const MaterialSetup&) { return {}; }
  double stiffness(double) const { return k; }
  double tangential_stiffness(double) const { return 0; }
  double viscous_rate(double, double) const { return 0; }
  double edge_stiffness(double) const { return k; }
  double edge_rate(double, double) const { return 0; }
  template <int D>
  LawForce<D> operator()(const OverlapIn<D>& o, const ContactMotion<D>&, double, double,
                         SpringMemory<D>&) const {
    return {repulsion(o), zero<TangentialOf<D>>()};
  }
  double repulsion(const auto& o) const { return k * o.depth * o.depth; }
  template <int D>
  ContactEnergy energy(const OverlapIn<D>& o, const SpringMemory<D>&) const {
    return {k * o.depth * o.depth * o.depth / 3, 0};
  }
};

// An integrator: symplectic Euler, of first order.
template <int D>
class EulerIntegrator {
 public:
  static constexpr bool end_moves = false;
  struct Memory {
    RotationOf<D> rotation = no_rotation<RotationOf<D>>();
  };
  explicit EulerIntegrator(double dt) : dt_(dt) {}
  void start(const Body<D>&, Memory&, const Inertia<D>&, const Load<D>&) const {}
  void begin(Body<D>& b, Memory& m, const Inertia<D>&) const {
    b.position += dt_ * b.velocity;
    m.rotation += dt_ * b.spin;
  }
  void end(Body<D>& b, Memory&, const Inertia<D>&, const Load<D>& load) const {
    b.velocity += dt_ * acceleration_of(b, load);
    b.spin += dt_ * spin_rate_of(b, load);
  }

 private:
  double dt_;
};
struct Euler {
  static constexpr const char* name = "euler";
  static constexpr double viscous_limit = 1, edge_limit = 1;
  static constexpr bool bears_irregular_edges = false;
  static constexpr bool leaps = false, moves_round = true;
  template <int D>
  using In = EulerIntegrator<D>;
};

// A shape: disks with a hard core of half their radius that alone is felt.
class CoreStore : public DiskStore {
 public:
  template <Measures measures>
  bool overlap(int i, const Body<2>& a, int j, const Body<2>& b, Feature& feature,
               Overlap& o) const {
    return DiskStore::overlap<measures>(i, core(a), j, core(b), feature, o);
  }
  template <Measures measures>
  bool overlap_plane(int i, const Body<2>& a, const Plane<2>& plane, Overlap& o) const {
    return DiskStore::overlap_plane<measures>(i, core(a), plane, o);
  }

 private:
  static Body<2> core(Body<2> b) {
    b.radius *= 0.5;
    return b;
  }
};

static_assert(LawEntry<SquareLaw> && ContactLaw<SquareLaw, 2>);
static_assert(IntegratorEntry<Euler> && IntegratesIn<Euler, 2>);
static_assert(Shape<CoreStore> && GoesWith<SquareLaw, CoreStore>);
// What the concepts are for: half a law, an integrator for another space.
struct NoLaw {
  static constexpr const char* name = "none";
};
static_assert(!LawEntry<NoLaw> && !ContactLaw<NoLaw, 2>);
static_assert(!Shape<int> && !IntegratorEntry<int>);

TEST(Registry, NewShapeLawAndIntegratorMakeAnEngine) {
  EngineSettings s;
  s.time_step = 1e-6;
  s.gravity_y = 0;
  const SquareLaw law;
  Rules<SquareLaw> rules(law, 0.0);
  EngineLoop<CoreStore, SquareLaw, EulerIntegrator<2>> engine(s, rules, Euler::name);
  NewGrain g;
  g.radius = 0.01;
  g.density = 1000;
  g.vx = 0.5;
  engine.add(g);
  g.x = 0.0101;  // the cores are 1e-4 apart
  g.vx = -0.5;
  engine.add(g);
  const double before = engine.measure().kinetic_energy;
  double deepest = 0;
  for (int k = 0; k < 4000; ++k) {
    engine.step(1);
    const Diagnostics d = engine.measure();
    deepest = std::max(deepest, d.elastic_energy);
    // First order: at most a step's force times velocity is amiss.
    EXPECT_NEAR(d.kinetic_energy + d.elastic_energy, before, 0.02 * before);
  }
  EXPECT_NEAR(deepest, before, 0.02 * before);  // all of it, head-on
  EXPECT_NEAR(engine.measure().kinetic_energy, before, 0.02 * before);
  EXPECT_EQ(engine.snapshot().attributes.at("law"), "square");
  EXPECT_EQ(engine.snapshot().attributes.at("integrator"), "euler");
}

}  // namespace
}  // namespace grainfield::dem
