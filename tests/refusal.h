// What a call says that refuses what it is given.
#pragma once
#include <stdexcept>
#include <string>

namespace grainfield {

/// The message; "accepted" when nothing is thrown.
template <class Call>
std::string refusal_of(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace grainfield
