// Images in which some bytes are others.
#pragma once
#include <cstring>
#include <stdexcept>
#include <string>

#include "dem/engine/engine.h"

namespace grainfield::dem {

inline constexpr const char* kBrokenImage = "the checkpoint is broken or of another setup";

/// As an image has them.
template <class T>
std::string bytes_of(const T& value) {
  std::string out(sizeof value, '\0');
  std::memcpy(out.data(), &value, sizeof value);
  return out;
}

/// What restore() says when these bytes stand at a place of an image; "accepted" when nothing.
template <class T>
std::string refusal_with(Engine& engine, std::string image, std::size_t at, const T& value) {
  image.replace(at, sizeof value, bytes_of(value));
  try {
    engine.restore(image);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace grainfield::dem
