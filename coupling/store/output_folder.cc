#include "coupling/store/output_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "coupling/store/atomic_file.h"
#include "dem/hdf5/replace_file.h"
#include "dem/storage_failed.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSummary = "summary.json";
constexpr const char* kList = ".results";
constexpr std::size_t kNamed = 8;  // files, in a line for people

// What versions without a list of results left at the top of the folder and were not to keep.
bool left_by_older_version(const std::string& name) {
  constexpr std::array<std::string_view, 7> whole{"report.html", "snapshots.h5",    "fields.h5",
                                                  "fields.xdmf", "elastic_map.csv", "heaps.csv",
                                                  kSummary};
  return std::find(whole.begin(), whole.end(), name) != whole.end() ||
         name.starts_with("profiles.") || name.starts_with("fits.") || name.ends_with(".vtu");
}

// "table.csv": a file is expected, and a folder would be made.
bool is_file_name(const fs::path& name) {
  constexpr std::array<std::string_view, 11> endings{
      ".csv", ".txt", ".h5", ".hdf5", ".json", ".html", ".svg", ".png", ".pdf", ".vtk", ".vtu"};
  return std::find(endings.begin(), endings.end(), name.extension().string()) != endings.end();
}

// A list may have been edited: nothing outside the folder is ever meant.
bool inside(const fs::path& name) {
  return !name.empty() && name.is_relative() &&
         std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

[[noreturn]] void fail(const fs::path& file, const std::error_code& error) {
  const std::string what =
      fmt::format("{}: cannot write there: {}", dem::final_name(file.string()), error.message());
  if (dem::means_storage_failed(error)) throw dem::StorageFailed(what);
  throw std::invalid_argument(what);
}

}  // namespace

OutputFolder::OutputFolder(const std::string& folder, const std::string& command)
    : folder_(folder), partial_(folder_ / ".partial") {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format("{}: cannot write there: {}", folder_.string(), why));
  };
  undo_ = std::make_unique<OnSignal>([this] { abandon(); });
  std::error_code error;
  const fs::file_status there = fs::status(folder_, error);
  if (fs::exists(there) && !fs::is_directory(there)) {
    refuse(fmt::format("it is {}", kind_of(there.type())));
  }
  if (!fs::exists(there) && is_file_name(folder_)) {
    refuse(fmt::format(
        "what is written is a folder, and the name ends as a file's, allowed: such as {}",
        (folder_.parent_path() / folder_.stem()).string()));
  }
  if (!fs::exists(there) && fs::is_symlink(fs::symlink_status(folder_, error))) {
    refuse(fmt::format("it is a link to {}, which leads nowhere",
                       fs::read_symlink(folder_, error).string()));
  }
  error.clear();
  unless_stopping([&] {
    // The topmost folder that we make goes again if nothing comes of it.
    for (fs::path p = fs::absolute(folder_, error);
         !error && !fs::exists(p, error) && !error && p.has_relative_path(); p = p.parent_path()) {
      made_ = p;
    }
    fs::create_directories(folder_, error);
  });
  const bool is_folder = fs::is_directory(folder_);
  if (error && !is_folder) fail(folder_, error);
  if (!is_folder) refuse("it is a file");
  if (access(folder_.c_str(), W_OK | X_OK) != 0) refuse("no write permission");
  const auto begin = [&] {
    lock_ = std::make_unique<FileLock>((folder_ / ".lock").string(), folder_.string(),
                                       "wait for it, or name another folder with -o", command);
    remove_orphans(folder_.string());
    fs::remove_all(partial_, error);
    if (!error) fs::create_directories(partial_, error);
  };
  try {
    unless_stopping(begin);
    if (error) fail(folder_, error);
  } catch (...) {
    abandon();
    throw;
  }
}

OutputFolder::~OutputFolder() {
  undo_.reset();
  abandon();
}

void OutputFolder::require_other_than(const std::vector<std::string>& inputs) const {
  std::error_code unknown;  // what is not there is no input
  for (const fs::path& result : earlier_results()) {
    for (const std::string& input : inputs) {
      if (fs::equivalent(folder_ / result, input, unknown)) {
        throw std::invalid_argument(
            fmt::format("{}: its result {} is an input and would be replaced; name another folder "
                        "with -o",
                        folder_.string(), result.string()));
      }
    }
  }
}

std::string OutputFolder::staging(const std::string& inner) const {
  const fs::path file = partial_ / inner;
  std::error_code error;
  unless_stopping(
      [&] { fs::create_directories(inner.empty() ? partial_ : file.parent_path(), error); });
  if (error) fail(file.parent_path(), error);
  return inner.empty() ? partial_.string() : file.string();
}

bool OutputFolder::is_ours(const fs::path& name, const std::vector<fs::path>& earlier) const {
  std::error_code error;
  if (std::find(earlier.begin(), earlier.end(), name) != earlier.end()) return true;
  if (fs::exists(folder_ / kList, error)) return false;
  // A version without a list: whatever has the name of a result beside its summary is one, and so
  // are the three tables of `structure`, which had none.
  const fs::path beside = (folder_ / name).parent_path();
  return fs::exists(beside / kSummary, error) || (fs::exists(beside / "grains.csv", error) &&
                                                  fs::exists(beside / "coordination.csv", error));
}

void OutputFolder::require_free(const std::vector<fs::path>& names) const {
  std::error_code error;
  const std::vector<fs::path> earlier = earlier_results();
  for (const fs::path& name : names) {
    const fs::path target = folder_ / name;
    if (!fs::exists(fs::symlink_status(target, error))) continue;
    if (!fs::is_regular_file(target, error)) {
      throw std::invalid_argument(
          fmt::format("{}: is in the way of a result of that name", target.string()));
    }
    if (is_ours(name, earlier)) continue;
    throw std::invalid_argument(
        fmt::format("{}: is no result of an earlier command and would be replaced by one of that "
                    "name; move it, or name another folder with -o",
                    target.string()));
  }
}

std::vector<fs::path> OutputFolder::earlier_results() const {
  std::vector<fs::path> out;
  std::error_code error;
  if (fs::exists(folder_ / kList, error)) {
    std::istringstream lines(read_text_file((folder_ / kList).string()));
    for (std::string line; std::getline(lines, line);) {
      if (inside(line)) out.emplace_back(line);
    }
    return out;
  }
  // Only where a run left its results: a folder of other things is none of ours.
  if (!fs::exists(folder_ / kSummary, error) || !fs::exists(folder_ / "case.toml", error))
    return out;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename().string();
    if (left_by_older_version(name)) out.emplace_back(name);
  }
  return out;
}

std::vector<fs::path> OutputFolder::staged() const {
  std::vector<fs::path> results;
  for (const auto& entry : fs::recursive_directory_iterator(partial_)) {
    if (entry.is_regular_file()) results.push_back(entry.path().lexically_relative(partial_));
  }
  std::sort(results.begin(), results.end());
  return results;
}

std::vector<fs::path> OutputFolder::publish() {
  const HeldSignals held(AfterHold::forget);
  std::vector<fs::path> results = staged();
  std::stable_partition(results.begin(), results.end(),
                        [](const fs::path& file) { return file.filename() != kSummary; });
  // What could go wrong goes wrong before anything is removed.
  std::error_code error;
  for (const fs::path& name : results) {
    const fs::path target = folder_ / name;
    fs::create_directories(target.parent_path(), error);
    if (error) fail(target.parent_path(), error);
  }
  require_free(results);
  // Where we are killed in between, the list names what is left of both.
  const std::vector<fs::path> earlier = earlier_results();
  const auto list = [&](const std::set<fs::path>& names) {
    std::string text;
    for (const fs::path& name : names) text += name.string() + "\n";
    write_text_file((folder_ / kList).string(), text);
  };
  std::set<fs::path> both(results.begin(), results.end());
  both.insert(earlier.begin(), earlier.end());
  list(both);

  // Also those of a sweep's members.
  fs::remove(folder_ / kSummary, error);
  for (const fs::path& name : results) {
    if (name.filename() == kSummary) fs::remove(folder_ / name, error);
  }
  const std::set<fs::path> fresh(results.begin(), results.end());
  const auto move = [&](bool summaries) {
    for (const fs::path& name : results) {
      if ((name.filename() == kSummary) != summaries) continue;
      dem::replace_file((partial_ / name).string(), (folder_ / name).string());
    }
  };
  move(false);
  std::vector<fs::path> gone;
  for (const fs::path& name : earlier) {
    if (fresh.contains(name)) continue;
    const fs::path file = folder_ / name;
    if (!fs::is_regular_file(fs::symlink_status(file, error))) continue;
    // A folder of results that has become a link is somebody else's.
    if (fs::canonical(file.parent_path(), error) !=
        (fs::canonical(folder_) / name).parent_path().lexically_normal()) {
      continue;
    }
    fs::remove(file, error);
    if (error) fail(file, error);
    gone.push_back(name);
    for (fs::path up = file.parent_path(); up != folder_ && fs::is_empty(up, error) && !error;
         up = up.parent_path()) {
      fs::remove(up, error);
    }
  }
  move(true);
  list(fresh);
  fs::remove_all(partial_, error);
  made_.clear();
  std::sort(gone.begin(), gone.end());
  return gone;
}

std::string gone_note(const std::string& folder, const std::vector<fs::path>& gone) {
  if (gone.empty()) return "";
  std::vector<std::string> names;
  for (std::size_t k = 0; k < gone.size() && k < kNamed; ++k) names.push_back(gone[k].string());
  if (gone.size() > kNamed) names.emplace_back("...");
  return fmt::format("{}: {} of an earlier command {} gone: {}", folder,
                     gone.size() == 1 ? "a result" : fmt::format("{} results", gone.size()),
                     gone.size() == 1 ? "is" : "are", fmt::join(names, ", "));
}

void OutputFolder::abandon() noexcept {
  std::error_code error;
  if (lock_) {  // else it is somebody else's
    // Under another name first: whoever still writes there meets a missing folder.
    const fs::path gone = folder_ / ".partial-gone";
    fs::remove_all(gone, error);  // a kill may have left one
    fs::rename(partial_, gone, error);
    fs::remove_all(gone, error);
  }
  lock_.reset();
  if (made_.empty()) return;
  for (fs::path p = fs::absolute(folder_, error);; p = p.parent_path()) {
    if (!fs::is_empty(p, error) || error) return;
    fs::remove(p, error);
    if (p == made_) return;
  }
}

}  // namespace grainfield::coupling
