#include "dem/quasistatic/superellipsoid_law.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <stdexcept>

#include "dem/space/space3.h"

namespace grainfield::dem {
namespace {

template <class Law>
constexpr bool kElliptic = std::is_same_v<Law, HertzEllipticLaw>;
template <class Law>
constexpr bool kServes = kElliptic<Law> ||
                         (ContactLaw<Law, 3> && Law::measures == Measures::depth &&
                          requires(const Law& law, const Overlap3& o) {
                            { law.spring_stiffness(o) } -> std::same_as<double>;
                          });

}  // namespace

SuperellipsoidLaw::SuperellipsoidLaw(const AnyLaw& law) : law_(law) {
  std::visit(
      [this]<class Law>(const Law& l) {
        if constexpr (!kServes<Law>) {
          throw std::invalid_argument(fmt::format(
              "material.law: found {}, allowed for quasi-static relaxation of superellipsoids: {}",
              Law::name,
              fmt::join(words_where<AnyLaw>([]<LawEntry L>() { return kServes<L>; }), ", ")));
        }
        curvatures_ = Law::measures == Measures::curvatures;
        if constexpr (kElliptic<Law>) follows_size_ = l.displacement;
      },
      law_);
}

double SuperellipsoidLaw::repulsion(const Overlap3& o) const {
  return std::visit(
      [&]<class Law>(const Law& law) -> double {
        if constexpr (kServes<Law>) return law.repulsion(o);
        return 0;
      },
      law_);
}

SuperellipsoidLaw::Spring SuperellipsoidLaw::spring(const Overlap3& o) const {
  return std::visit(
      [&]<class Law>(const Law& law) -> Spring {
        if constexpr (kElliptic<Law>) {
          const EllipticContact ellipse = law.ellipse(o);
          const double a = ellipse.axis * std::sqrt(o.depth);
          const auto c = law.compliances(ellipse.shape.integrals, a);
          return {1 / c.major, 1 / c.minor, a};
        } else if constexpr (kServes<Law>) {
          return {law.spring_stiffness(o), law.spring_stiffness(o), 0};
        }
        return {};
      },
      law_);
}

}  // namespace grainfield::dem
