// One shape with every law and integrator that go with it.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <stdexcept>

#include "dem/engine/engine_loop.h"
#include "dem/engine/engine_of.h"
#include "dem/shapes/shape.h"

namespace grainfield::dem {

/// The shape offers what the law reads.
template <class Law, class Store>
concept GoesWith = Shape<Store> && ContactLaw<Law, Store::dim> && Store::offers(Law::measures);

template <class Store>
std::unique_ptr<Engine> engine_of(const EngineSettings& settings) {
  static_assert(Shape<Store>);
  const auto refuse = [](const char* key, const char* found,
                         const std::vector<std::string>& allowed) {
    throw std::invalid_argument(
        fmt::format("{}: found \"{}\", allowed for grains of this shape: {}", key, found,
                    fmt::join(allowed, ", ")));
  };
  if (!Store::central && settings.resist_rolling()) {
    if (Store::outlines) refuse_rolling_polygons();
    refuse_rolling_superellipsoids();
  }
  const AnyLaw& any =
      settings.material_pairs.empty() ? settings.law : settings.material_pairs.front().law;
  std::unique_ptr<Engine> engine;
  std::visit(
      [&]<LawEntry Law>(const Law&) {
        if constexpr (GoesWith<Law, Store>) {
          settings.integrator.visit([&]<IntegratorEntry Kind>(Kind) {
            if constexpr (Moves<Kind, Store>) {
              using Mover = typename Kind::template In<Store::dim>;
              engine = std::make_unique<EngineLoop<Store, Law, Mover>>(
                  settings, Rules<Law>(settings), Kind::name);
            } else {
              refuse_integrator(settings);
            }
          });
        } else {
          refuse("material.law", Law::name,
                 words_where<AnyLaw>([]<class L>() { return GoesWith<L, Store>; }));
        }
      },
      any);
  return engine;
}

}  // namespace grainfield::dem
