// What runs leave, compared bit by bit and through stops.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "dem/random/random.h"
#include "dem/run/run.h"
#include "tests/coupling/pile_scene.h"

namespace grainfield::dem {

/// The result of a run that goes on to its end.
inline RunResult finished(const std::unique_ptr<Run>& run) {
  finish(*run);
  return run->result();
}

/// A name in the folder of temporary files; the file is gone with it.
class FileOfRun {
 public:
  explicit FileOfRun(const std::string& name)
      : path_((std::filesystem::temp_directory_path() /
               ("grainfield_" + name + "_" + std::to_string(getpid()) + ".h5"))
                  .string()) {}
  ~FileOfRun() { std::filesystem::remove(path_); }
  FileOfRun(const FileOfRun&) = delete;
  FileOfRun& operator=(const FileOfRun&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Same figures, where nan equals nan.
inline bool same_figures(const RunResult& a, const RunResult& b) {
  if (a.figures.size() != b.figures.size()) return false;
  for (const auto& [key, value] : a.figures) {
    const auto other = b.figures.find(key);
    if (other == b.figures.end()) return false;
    if (value != other->second && !(std::isnan(value) && std::isnan(other->second))) return false;
  }
  return true;
}

/// The same bits in all states and figures.
inline void expect_same(const RunResult& got, const RunResult& expected, const std::string& what) {
  ASSERT_EQ(got.snapshots.size(), expected.snapshots.size()) << what;
  for (std::size_t k = 0; k < got.snapshots.size(); ++k) {
    EXPECT_TRUE(same(got.snapshots[k].second, expected.snapshots[k].second))
        << what << ", " << got.snapshots[k].first;
  }
  EXPECT_TRUE(same_figures(got, expected)) << what;
}

/// Runs make(threads) that stop at random in `total` steps and are continued on another number of
/// threads leave what is expected. The last checkpoint stays in the file.
template <class Make>
void expect_same_after_stops(Make make, const RunResult& expected, double total, int stops,
                             const FileOfRun& file, Random& random) {
  for (int k = 0; k < stops; ++k) {
    const long stop = static_cast<long>(random.uniform() * total);
    {
      const auto first = make(1 + k % 2);
      first->advance(stop);
      first->save(file.path());
    }
    const auto second = make(2 - k % 2);
    second->restore(file.path());
    expect_same(finished(second), expected, "stopped at " + std::to_string(stop));
  }
}

/// How far two states b and c are apart into which grains came from a: root of the squared
/// distances over the squared displacements from a to b.
inline double difference_of_moves(const Snapshot& a, const Snapshot& b, const Snapshot& c) {
  double moved = 0, difference = 0;
  for (std::size_t k = 0; k < a.grains.size(); ++k) {
    moved += (b.grains[k].position - a.grains[k].position).squaredNorm();
    difference += (b.grains[k].position - c.grains[k].position).squaredNorm();
  }
  EXPECT_GT(moved, 0);
  return std::sqrt(difference / moved);
}

/// Why a run fails; "finished" where it does not.
inline std::string failure_of(const std::unique_ptr<Run>& run) {
  try {
    finish(*run);
  } catch (const ComputationFailed& failure) {
    return failure.what();
  }
  return "finished";
}

}  // namespace grainfield::dem
