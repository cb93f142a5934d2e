#include "coupling/tasks/snapshot_names.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <stdexcept>
#include <utility>

#include "coupling/averaging/contact_geometry.h"

namespace grainfield::coupling {
namespace {

// The snapshots REALIZATION/NAME of a file that has no snapshot called NAME itself.
std::vector<std::string> states_called(const std::string& file, const std::string& name) {
  std::vector<std::string> out;
  if (!std::filesystem::exists(file) || name.find('/') != std::string::npos) return out;
  for (const std::string& group : dem::list_snapshots(file)) {
    if (group == name || group == "/" + name) return {};
    if (group.ends_with("/" + name)) out.push_back(group);
  }
  return out;
}

}  // namespace

std::shared_ptr<const dem::Snapshot> snapshot_of(const SnapshotName& name, std::size_t* idle) {
  if (idle != nullptr) *idle = 0;
  if (name.held && count_idle(*name.held) == 0) return name.held;
  auto made = std::make_shared<dem::Snapshot>(
      name.held ? *name.held : dem::read_snapshot(name.file, name.group));
  const std::size_t left_out = leave_out_idle(*made);
  if (idle != nullptr) *idle = left_out;
  return made;
}

std::vector<SnapshotName> parse_snapshot_names(const std::vector<std::string>& texts) {
  std::vector<SnapshotName> out;
  for (const auto& text : texts) {
    const std::size_t at = text.rfind(':');
    if (at != std::string::npos && !std::filesystem::exists(text)) {
      const std::string file = text.substr(0, at), group = text.substr(at + 1);
      const std::vector<std::string> states = states_called(file, group);
      if (states.empty()) out.push_back({file, group, {}});
      for (const std::string& state : states) out.push_back({file, state, {}});
      continue;
    }
    const auto groups = dem::list_snapshots(text);
    if (groups.empty())
      throw std::invalid_argument(
          text +
          ": holds no snapshot (grainfield info shows what it holds; averaged and measured "
          "fields are for fit and compare)");
    for (const auto& group : groups) out.push_back({text, group, {}});
  }
  require_each_once(out);
  return out;
}

void require_each_once(const std::vector<SnapshotName>& names) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const SnapshotName& name : names) {
    const std::string group = name.group.substr(name.group.starts_with('/') ? 1 : 0);
    std::error_code error;
    const std::string file = std::filesystem::weakly_canonical(name.file, error).string();
    if (!seen.insert({error ? name.file : file, group}).second) {
      throw std::invalid_argument(fmt::format(
          "{}:{}: named twice, allowed: every packing once (a copy is no realization of its own)",
          name.file, name.group));
    }
  }
}

}  // namespace grainfield::coupling
