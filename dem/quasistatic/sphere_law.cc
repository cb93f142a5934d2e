#include "dem/quasistatic/sphere_law.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "dem/space/space3.h"

namespace grainfield::dem {
namespace {

// Step of the central differences, as a share of the depth: of powers of the depth they leave 1e-9.
constexpr double kShare = 1e-4;

template <class Law>
constexpr bool kHasSpring = ContactLaw<Law, 3>&& requires(const Law& law, const Overlap3& o) {
  { law.spring_stiffness(o) } -> std::same_as<double>;
};

Overlap3 overlap_of(double depth, double radius) {
  Overlap3 o;
  o.depth = depth;
  o.radius = radius;
  return o;
}

template <class Value>
SphereLaw::Slope slope_of(double depth, Value value) {
  const double step = kShare * depth;
  return {value(depth), (value(depth + step) - value(depth - step)) / (2 * step)};
}

}  // namespace

SphereLaw::SphereLaw(const AnyLaw& law) : law_(law) {
  std::visit(
      [this]<class Law>(const Law& l) {
        if constexpr (!kHasSpring<Law>) {
          throw std::invalid_argument(fmt::format(
              "material.law: found {}, allowed for quasi-static relaxation of spheres: {}",
              Law::name,
              fmt::join(words_where<AnyLaw>([]<LawEntry L>() { return kHasSpring<L>; }), ", ")));
        }
        if constexpr (std::is_same_v<Law, HertzLaw>) {
          memory_ = l.displacement ? Memory::displacement : Memory::force;
        }
      },
      law_);
}

SphereLaw::Slope SphereLaw::repulsion(double depth, double radius) const {
  return std::visit(
      [&]<class Law>(const Law& law) -> Slope {
        if constexpr (kHasSpring<Law>) {
          return slope_of(depth, [&](double d) { return law.repulsion(overlap_of(d, radius)); });
        }
        return {};
      },
      law_);
}

SphereLaw::Slope SphereLaw::spring(double depth, double radius) const {
  return std::visit(
      [&]<class Law>(const Law& law) -> Slope {
        if constexpr (kHasSpring<Law>) {
          return slope_of(depth,
                          [&](double d) { return law.spring_stiffness(overlap_of(d, radius)); });
        }
        return {};
      },
      law_);
}

SphereLaw::Slope SphereLaw::kept(double before, double depth, double radius) const {
  if (memory_ == Memory::constant || !(before > 0)) return {1, 0};
  if (memory_ == Memory::force && depth >= before) return {1, 0};
  const double old = spring(before, radius).value;
  const Slope now = spring(depth, radius);
  return {now.value / old, now.slope / old};
}

double SphereLaw::depth_of_stiffness(double before, double depth) const {
  return memory_ == Memory::force && depth > before ? 0.5 * (before + depth) : depth;
}

}  // namespace grainfield::dem
