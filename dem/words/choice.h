// Kinds of a thing (laws, integrators, shapes) and their words. The list of kinds is a
// std::variant of types with a `name` each: the only place that a new kind has to enter.
#pragma once
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "dem/words/nearest.h"

namespace grainfield::dem {

/// The words of those kinds for which holds.template operator()<Kind>().
template <class Variant, class Holds>
std::vector<std::string> words_where(Holds holds) {
  return [&]<std::size_t... k>(std::index_sequence<k...>) {
    std::vector<std::string> words;
    const auto add = [&]<class Kind>() {
      if (holds.template operator()<Kind>()) words.emplace_back(Kind::name);
    };
    (add.template operator()<std::variant_alternative_t<k, Variant>>(), ...);
    return words;
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>());
}

/// The words of a list of kinds, in its order.
template <class Variant>
std::vector<std::string> words_of() {
  return words_where<Variant>([]<class>() { return true; });
}

/// The kind with this word, made by make.template operator()<Kind>(). Throws std::invalid_argument
/// (refuse_word) when there is none.
template <class Variant, class Make>
Variant kind_named(const std::string& key, const std::string& word, Make make) {
  return [&]<std::size_t... k>(std::index_sequence<k...>) {
    Variant out;
    const bool known =
        ((word == std::variant_alternative_t<k, Variant>::name &&
          (out = make.template operator()<std::variant_alternative_t<k, Variant>>(), true)) ||
         ...);
    if (!known) refuse_word(key, word, words_of<Variant>());
    return out;
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>());
}

/// One kind of a list of empty types.
template <class Variant>
class Choice {
 public:
  constexpr Choice() = default;  ///< the first
  constexpr explicit Choice(Variant kind) : kind_(kind) {}

  const char* name() const {
    return std::visit([](auto kind) { return decltype(kind)::name; }, kind_);
  }
  template <class Visit>
  decltype(auto) visit(Visit visitor) const {
    return std::visit(visitor, kind_);
  }
  friend bool operator==(const Choice& a, const Choice& b) {
    return a.kind_.index() == b.kind_.index();
  }

 private:
  Variant kind_;
};

}  // namespace grainfield::dem
