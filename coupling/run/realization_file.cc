#include "coupling/run/realization_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "dem/hdf5/replace_file.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

constexpr std::string_view kFigure = "figure:";
constexpr const char* kOrder = "realization:order";

// Takes what write_realization added to the attributes out again; returns the order.
std::size_t strip(dem::Snapshot& snapshot, std::map<std::string, double>& figures,
                  const std::string& file) {
  const auto refuse = [&](const auto& at, const char* wanted) {
    throw std::invalid_argument(
        fmt::format("{}: {} is \"{}\"; it must be {}", file, at->first, at->second, wanted));
  };
  std::size_t order = 0;
  auto& attributes = snapshot.attributes;
  for (auto at = attributes.begin(); at != attributes.end();) {
    if (at->first == kOrder) {
      const auto number = parse_integer(at->second);
      if (!number || *number < 0) refuse(at, "a whole number from 0");
      order = static_cast<std::size_t>(*number);
    } else if (at->first.compare(0, kFigure.size(), kFigure) == 0) {
      const auto number = parse_number(at->second);
      if (!number) refuse(at, "a number");
      figures[at->first.substr(kFigure.size())] = *number;
    } else {
      ++at;
      continue;
    }
    at = attributes.erase(at);
  }
  return order;
}

}  // namespace

const dem::Snapshot* Realization::find(const std::string& name) const {
  for (const auto& [own, snapshot] : snapshots) {
    if (own == name) return &snapshot;
  }
  return nullptr;
}

const dem::Snapshot& Realization::operator[](const std::string& name) const {
  if (const dem::Snapshot* found = find(name)) return *found;
  std::string names;
  for (const auto& entry : snapshots) names += (names.empty() ? "" : ", ") + entry.first;
  throw std::invalid_argument(
      fmt::format("no snapshot \"{}\" in the realization; there are: {}", name, names));
}

void write_realization(const std::string& file, const dem::RunResult& result) {
  dem::write_in_place_of(file, [&](const std::string& beside) {
    std::size_t order = 0;
    for (const auto& [name, snapshot] : result.snapshots) {
      dem::Snapshot copy = snapshot;
      copy.attributes[kOrder] = std::to_string(order);
      if (order == 0) {
        for (const auto& [key, value] : result.figures) {
          copy.attributes[std::string(kFigure) + key] = fmt::format("{:.17g}", value);
        }
      }
      dem::write_snapshot(beside, "/" + name, copy);
      ++order;
    }
  });
}

Realization read_realization(const std::string& file) {
  std::vector<std::pair<std::size_t, std::string>> order;
  std::map<std::string, dem::Snapshot> found;
  Realization out;
  for (const auto& group : dem::list_snapshots(file)) {
    dem::Snapshot snapshot = dem::read_snapshot(file, group);
    const std::string name = group.substr(group.rfind('/') + 1);
    order.emplace_back(strip(snapshot, out.figures, file), name);
    found.emplace(name, std::move(snapshot));
  }
  if (order.empty()) throw std::invalid_argument(file + ": holds no snapshot");
  std::sort(order.begin(), order.end());
  for (const auto& [at, name] : order) out.snapshots.emplace_back(name, std::move(found.at(name)));
  return out;
}

MeanLayer mean_layer(const std::vector<std::string>& files) {
  MeanLayer out;
  for (const std::string& file : files) {
    const Realization r = read_realization(file);
    out.add(r["unloaded"], r["loaded"], files.size());
  }
  return out;
}

}  // namespace grainfield::coupling
