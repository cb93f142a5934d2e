// A run of disks in the plane under implicit motion, until they rest or their time is over.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "dem/run/archive.h"
#include "dem/run/fingerprint.h"
#include "dem/run/soft_snapshot.h"

namespace grainfield::dem {

/// `Setup` knows time_step(), time_unit(), longest_time() and records, rest and gravity; `columns`:
/// of a record, time first.
template <class Setup, class Disks, std::size_t columns>
class SoftRun : public ArchivedRun {
 public:
  void advance(long steps) final {
    try {
      for (; steps > 0 && !done_; --steps) {
        if (!step()) continue;
        const long now = tally().steps;
        if (now % every_ == 0) record();
        const bool rests =
            now % kJudgeEvery == 0 && may_rest() && disks_.rest().ratio < setup_.rest;
        if (!rests && now < last_step_) continue;
        if (now % every_ != 0) record();
        at_rest_ = rests;
        done_ = true;
      }
    } catch (const ComputationFailed& e) {
      throw ComputationFailed(fmt::format("{} ({})", e.what(), keys_));
    }
  }
  bool done() const final { return done_; }
  Progress progress() const final {
    Progress p;
    p.phase = done_ ? "done" : phase();
    const double end = static_cast<double>(last_step_) * setup_.time_step();
    p.fraction = done_ ? 1 : work(disks_.time()) / work(end);
    p.simulated_time = disks_.time();
    p.steps = tally().steps;
    p.grains = p.awake = static_cast<int>(disks_.bodies().size());
    p.kinetic_energy = disks_.energy().kinetic;
    p.unbalanced_force_ratio = disks_.rest().ratio;
    return p;
  }

 protected:
  /// `keys`: what to change where a step fails. Whoever derives from it makes the first record.
  SoftRun(const Setup& setup, std::uint64_t seed, Disks disks, std::string keys)
      : setup_(setup), seed_(seed), disks_(std::move(disks)), keys_(std::move(keys)) {
    last_step_ = std::max(1L, std::lround(setup.longest_time() / setup.time_step()));
    every_ = std::max(1L, last_step_ / setup.records);
  }

  /// Whether a whole step has ended with this.
  virtual bool step() = 0;
  virtual void record() = 0;
  virtual const ImplicitTally& tally() const = 0;
  virtual std::string phase() const = 0;
  virtual bool may_rest() const { return true; }
  /// Computing time up to a simulated one, in any unit: for the progress.
  virtual double work(double time) const { return time; }

  /// Without walls and contacts.
  Snapshot bare_snapshot(const std::string& state, const std::string& packing) const {
    Snapshot out;
    out.time = disks_.time();
    out.gravity = {0, -setup_.gravity, 0};
    out.grains = grains_of(disks_.bodies(), disks_.angles());
    out.attributes = {{"state", state}, {"seed", fmt::format("{}", seed_)}, {"packing", packing}};
    return out;
  }
  /// dem.* and, in the section, what is asked of all such runs; `balance`: the column of the
  /// energies' sum.
  void add_soft_figures(const std::string& section, const Snapshot& end, std::size_t balance,
                        std::map<std::string, double>& f) const {
    const ImplicitTally& t = tally();
    f["dem.grains"] = static_cast<double>(disks_.bodies().size());
    f["dem.contacts"] = static_cast<double>(end.contacts.size());
    f["dem.steps"] = static_cast<double>(t.steps);
    f["dem.time_step"] = setup_.time_step();
    f["dem.unbalanced_force_ratio"] = disks_.rest().ratio;
    f[section + ".at_rest"] = at_rest_ ? 1 : 0;
    f[section + ".time"] = disks_.time() / setup_.time_unit();
    f[section + ".iterations"] = static_cast<double>(t.iterations) / static_cast<double>(t.solves);
    f[section + ".halved"] = static_cast<double>(t.halved);
    double most = 0;
    for (const auto& r : records_) most = std::max(most, std::fabs(r[balance]));
    f[section + ".balance_error"] = most;
  }
  /// Disks and records.
  void visit_disks(Archive& archive) {
    std::string image = archive.is_reading() ? std::string() : disks_.checkpoint();
    archive(image);
    archive(records_);
    archive.require(!records_.empty());
    if (archive.is_reading()) disks_.restore(image);
  }
  void visit_end(Archive& archive) {
    archive(at_rest_);
    archive(done_);
  }

  Setup setup_;
  std::uint64_t seed_;
  Disks disks_;
  std::vector<std::array<double, columns>> records_;
  bool at_rest_ = false;

 private:
  // Rest is judged every so many steps.
  static constexpr long kJudgeEvery = 20;

  std::string keys_;
  long last_step_ = 1, every_ = 1;
  bool done_ = false;
};

}  // namespace grainfield::dem
