// Images in which some bytes are others.
#pragma once
#include <cstring>
#include <stdexcept>
#include <string>

#include "dem/engine/engine.h"

namespace grainfield::dem {

inline constexpr const char* kBrokenCheckpoint = "the checkpoint is broken or of another setup";

/// As a checkpoint has them.
template <class T>
std::string bytes_of(const T& value) {
  std::string out(sizeof value, '\0');
  std::memcpy(out.data(), &value, sizeof value);
  return out;
}

/// What restore() says when these bytes stand at a place of a checkpoint; "accepted" when nothing.
template <class T>
std::string refusal_with(Engine& engine, std::string checkpoint, std::size_t at, const T& value) {
  checkpoint.replace(at, sizeof value, bytes_of(value));
  try {
    engine.restore(checkpoint);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace grainfield::dem
