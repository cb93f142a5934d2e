// What a model says that refuses its settings.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "continuum/model.h"

namespace grainfield::continuum {

/// The message, one line; "accepted" when the model is made.
inline std::string refusal(const std::string& model, const Settings& settings) {
  try {
    make_model(model, settings);
  } catch (const BadParameter& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}

}  // namespace grainfield::continuum
