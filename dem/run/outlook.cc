#include "dem/run/outlook.h"

#include <fmt/format.h>

#include <stdexcept>

#include "dem/run/common.h"

namespace grainfield::dem {

void too_many(const std::string& key, double found, double most, const std::string& unit,
              const std::string& why) {
  throw std::invalid_argument(fmt::format("{}: found {:g}{}, allowed: up to {:g}{} {}", key, found,
                                          unit, round_down(most), unit, why));
}

std::string ten_million() { return fmt::format("{:g} million grains", kMostGrains * 1e-6); }

void Times::add(const std::string& key, double time) {
  sum_ += time;
  if (time <= most_) return;
  most_ = time;
  key_ = key;
}

void Times::put_into(Outlook& out) const {
  out.time = sum_;
  out.time_key = key_;
}

}  // namespace grainfield::dem
