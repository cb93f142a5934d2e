#include "coupling/run/realization_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

namespace grainfield::coupling {
namespace {

constexpr std::string_view kFigure = "figure:";

}  // namespace

void write_realization(const std::string& file, const dem::RunResult& result) {
  const std::string beside = file + ".part";
  std::filesystem::remove(beside);
  for (const auto& [name, snapshot] : result.snapshots) {
    dem::Snapshot copy = snapshot;
    if (name == "loaded") {
      for (const auto& [key, value] : result.figures) {
        copy.attributes[std::string(kFigure) + key] = fmt::format("{:.17g}", value);
      }
    }
    dem::write_snapshot(beside, "/" + name, copy);
  }
  std::filesystem::rename(beside, file);
}

Realization read_realization(const std::string& file) {
  Realization out;
  out.unloaded = dem::read_snapshot(file, "/unloaded");
  out.loaded = dem::read_snapshot(file, "/loaded");
  auto& attributes = out.loaded.attributes;
  for (auto at = attributes.begin(); at != attributes.end();) {
    if (at->first.compare(0, kFigure.size(), kFigure) == 0) {
      out.figures[at->first.substr(kFigure.size())] = std::stod(at->second);
      at = attributes.erase(at);
    } else {
      ++at;
    }
  }
  return out;
}

}  // namespace grainfield::coupling
