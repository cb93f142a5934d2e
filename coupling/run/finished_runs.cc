#include "coupling/run/finished_runs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "dem/cannot_read_now.h"
#include "dem/hdf5/trial_read.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

// Numbers of grains.files, in all, that a check reads, bytes in memory; and s that a process spends
// on looking into such files before it computes.
constexpr double kReadBytes = 16e6, kLookSeconds = 4;

using Clock = std::chrono::steady_clock;

// Tells when a check has looked long enough. Of all members of a sweep together.
class Patience {
 public:
  bool over() const { return spent() > kLookSeconds; }
  void begin() { since_ = Clock::now(); }
  void end() { before_ += Clock::now() - since_; }

 private:
  double spent() const {
    return std::chrono::duration<double>(before_ + (Clock::now() - since_)).count();
  }
  Clock::time_point since_;
  Clock::duration before_{};
};

Patience& patience() {
  static Patience one;
  return one;
}

// The snapshots of a file, listed once as long as it stays the same.
struct Listed {
  std::uintmax_t bytes = 0;
  std::filesystem::file_time_type time;
  std::vector<std::string> groups;
  std::map<std::string, std::string> checksums;  // of the places, by group
};

const Listed& listed(const std::string& file) {
  static std::map<std::string, Listed> all;
  std::error_code error;
  Listed now{std::filesystem::file_size(file, error), {}, {}, {}};
  if (!error) now.time = std::filesystem::last_write_time(file, error);
  const auto at = all.find(file);
  if (!error && at != all.end() && at->second.bytes == now.bytes && at->second.time == now.time) {
    return at->second;
  }
  try {
    now.groups = dem::list_snapshots(file);
    const std::vector<std::string> checksums = dem::places_checksums(file, now.groups);
    for (std::size_t k = 0; k < checksums.size(); ++k) now.checksums[now.groups[k]] = checksums[k];
  } catch (const dem::CannotReadNow& e) {
    throw dem::CannotReadNow(std::string("grains.files: ") + e.what());
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(std::string("grains.files: ") + e.what());
  }
  return all[file] = std::move(now);
}

// All that the files hold, at least as many as the case takes. `go_on` is asked before every file:
// where it says no, nothing is returned.
std::optional<std::vector<FinishedRun>> find_runs(const Case& value,
                                                  const std::vector<std::string>& snapshots,
                                                  const std::string& study,
                                                  const std::function<bool()>& go_on) {
  std::vector<FinishedRun> there;
  std::map<std::string, std::string> seen;  // by checksum: which realization
  for (const std::string& file : value.get<GrainFiles>().files) {
    if (!go_on()) return std::nullopt;
    const std::size_t before = there.size();
    const Listed& found = listed(file);
    const std::vector<std::string>& groups = found.groups;
    const std::set<std::string> names(groups.begin(), groups.end());
    const std::string first = "/" + snapshots.front();
    for (const std::string& group : groups) {
      if (!group.ends_with(first)) continue;
      const std::string above = group.substr(0, group.size() - first.size());
      const bool all = std::all_of(snapshots.begin(), snapshots.end(), [&](const auto& name) {
        return names.contains(above + "/" + name);
      });
      if (!all) continue;
      there.push_back({file, above});
      const std::string& places = found.checksums.at(group);
      const auto [first_one, own] = seen.emplace(places, fmt::format("{}:{}", file, group));
      if (!own && !places.empty()) {
        throw std::invalid_argument(fmt::format(
            "grains.files: {}:{} is a copy of {}, allowed: every packing once (a copy is no "
            "realization of its own)",
            file, group, first_one->second));
      }
    }
    if (there.size() == before) {
      throw std::invalid_argument(fmt::format(
          "grains.files: {} holds no snapshot named {}, expected snapshots.h5 of a run of study {}",
          file, fmt::join(snapshots, " and "), study));
    }
  }
  const auto count = static_cast<std::int64_t>(there.size());
  if (value.ensemble.realizations > count) {
    throw std::invalid_argument(fmt::format(
        "ensemble.realizations: found {}, allowed: up to {}, the realizations in grains.files",
        value.ensemble.realizations, count));
  }
  return there;
}

class DoneRun final : public dem::Run {
 public:
  explicit DoneRun(dem::RunResult result) : result_(std::move(result)) {}
  void advance(long) override {}
  bool done() const override { return true; }
  dem::Progress progress() const override {
    dem::Progress out;
    out.phase = "from a file";
    out.fraction = 1;
    return out;
  }
  // The file is there.
  void save(const std::string&) const override {}
  void restore(const std::string&) override {}
  dem::RunResult result() const override { return result_; }

 private:
  dem::RunResult result_;
};

}  // namespace

std::unique_ptr<dem::Run> run_of(dem::RunResult result) {
  return std::make_unique<DoneRun>(std::move(result));
}

FinishedRun finished_run(const Case& value, std::int64_t number,
                         const std::vector<std::string>& snapshots, const std::string& study) {
  const auto runs = find_runs(value, snapshots, study, [] { return true; });
  return (*runs)[static_cast<std::size_t>(number)];
}

std::string unused_runs(const Case& value, const std::vector<std::string>& snapshots,
                        const std::string& study) {
  if (value.get<GrainFiles>().files.empty()) return {};
  const dem::hdf5::StructureOnly alone;
  patience().begin();
  const auto runs = find_runs(value, snapshots, study, [] { return !patience().over(); });
  patience().end();
  if (!runs || static_cast<std::int64_t>(runs->size()) == value.ensemble.realizations) return {};
  return fmt::format(
      "grains.files: {} realizations, of which ensemble.realizations = {} takes the first",
      runs->size(), value.ensemble.realizations);
}

void try_finished_runs(const Case& value, const std::vector<std::string>& snapshots,
                       const std::string& study,
                       const std::function<void(const FinishedRun&)>& make) {
  patience().begin();
  try {
    const auto go_on = [] { return !patience().over(); };
    // First what the files hold, then how much that is, and only then any of it.
    std::optional<std::vector<FinishedRun>> runs;
    double bytes = 0;
    {
      const dem::hdf5::StructureOnly alone;
      runs = find_runs(value, snapshots, study, go_on);
      for (const std::string& file : value.get<GrainFiles>().files) {
        if (!runs || !go_on() || bytes > kReadBytes) break;
        bytes += dem::hdf5::content_bytes(file);
      }
    }
    if (runs && bytes <= kReadBytes) {
      runs->resize(static_cast<std::size_t>(value.ensemble.realizations));
      for (const FinishedRun& run : *runs) {
        if (!go_on()) break;
        make(run);
      }
    }
  } catch (const dem::hdf5::TooMuchToLookAt&) {
    // The run itself will see.
  } catch (...) {
    patience().end();
    throw;
  }
  patience().end();
}

}  // namespace grainfield::coupling
