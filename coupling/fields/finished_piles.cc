#include "coupling/fields/finished_piles.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

std::vector<FinishedPile> finished_piles(const std::vector<std::string>& files) {
  constexpr std::string_view name = "/pile";
  std::vector<FinishedPile> out;
  for (const std::string& file : files) {
    const std::size_t before = out.size();
    std::vector<std::string> groups;
    try {
      groups = dem::list_snapshots(file);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(std::string("grains.files: ") + e.what());
    }
    for (const std::string& group : groups) {
      if (group.size() < name.size()) continue;
      const std::size_t at = group.size() - name.size();
      if (std::string_view(group).substr(at) == name) out.push_back({file, group.substr(0, at)});
    }
    if (out.size() == before) {
      throw std::invalid_argument(fmt::format(
          "grains.files: {} holds no snapshot named pile, expected snapshots.h5 of a run of study "
          "pile",
          file));
    }
  }
  return out;
}

FinishedPile finished_pile(const Case& value, std::int64_t number) {
  const std::vector<FinishedPile> piles = finished_piles(value.grains.files);
  const auto there = static_cast<std::int64_t>(piles.size());
  if (value.ensemble.realizations > there) {
    throw std::invalid_argument(
        fmt::format("ensemble.realizations: found {}, allowed: up to {}, the piles in grains.files",
                    value.ensemble.realizations, there));
  }
  return piles[static_cast<std::size_t>(number)];
}

}  // namespace grainfield::coupling
