// Settings as text, to tell checkpoints of different setups apart.
//
// A setup lists its members once, in members(); that none is left out is checked when this is
// compiled.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace grainfield::dem {

/// A struct of settings that lists its members: members() returns a std::tuple of references.
template <class S>
concept Listed = std::is_aggregate_v<S> && requires(const S& setup) {
  std::tuple_size<decltype(setup.members())>::value;
};

namespace detail {

/// Whatever a member is made of.
struct Anything {
  template <class T>
  operator T() const;  // never defined: only whether S{Anything, ...} would compile is asked
};
template <class S, std::size_t... k>
constexpr bool takes(std::index_sequence<k...>) {
  return requires { S{(static_cast<void>(k), Anything{})...}; };
}
/// Members that an aggregate has.
template <class S, std::size_t n = 0>
constexpr std::size_t count_members() {
  if constexpr (takes<S>(std::make_index_sequence<n + 1>())) {
    return count_members<S, n + 1>();
  } else {
    return n;
  }
}

}  // namespace detail

/// Every number of a setup in full (its shortest text that reads back to the same bits), in the
/// order of members().
template <class T>
std::string fingerprint_of(const T& value) {
  if constexpr (Listed<T>) {
    static_assert(detail::count_members<T>() == std::tuple_size_v<decltype(value.members())>,
                  "members() leaves a member out");
    std::string text = "{";
    std::apply([&](const auto&... member) { ((text += fingerprint_of(member) + ";"), ...); },
               value.members());
    return text + "}";
  } else {
    return fmt::format("{}", value);
  }
}

}  // namespace grainfield::dem
