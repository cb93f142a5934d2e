#include "coupling/case/cost.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "coupling/base/memory.h"
#include "coupling/case/material.h"
#include "coupling/case/study.h"

namespace grainfield::coupling {
namespace {

// Grain-steps per CPU second of settled polygons, all awake (docs/benchmarks.md): an estimate.
constexpr double kRate = 5e6;
// A year of one core is 1.5e14 grain steps.
constexpr double kMostGrainSteps = 1e16;
// Averaged values that an analysis holds at a time: points times realizations, each of a few
// hundred bytes in all its columns.
constexpr double kMostAveraged = 1e7;
// What is told: longer than this, s, more memory than this, bytes.
constexpr double kLong = 3600, kLarge = 1e9;

std::string duration(double seconds) {
  constexpr double kHour = 3600, kDay = 24 * kHour, kYear = 365 * kDay;
  if (seconds < 90) return fmt::format("{:.0f} s", std::max(1.0, seconds));
  if (seconds < 1.5 * kHour) return fmt::format("{:.0f} minutes", seconds / 60);
  if (seconds < 3 * kDay) return fmt::format("{:.1f} hours", seconds / kHour);
  if (seconds < 2 * kYear) return fmt::format("{:.0f} days", seconds / kDay);
  return fmt::format("{:.0f} years", seconds / kYear);
}

// Grain by grain: half of them on average.
double grain_steps(const dem::Outlook& o) { return 0.5 * o.grains * o.time / o.time_step; }

}  // namespace

void check_steps(const Draft& draft, const dem::Outlook& o) {
  if (o.time == 0 || o.time_step == 0) return;
  const double steps = o.time / o.time_step, work = grain_steps(o);
  if (steps <= dem::kMostSteps && work <= kMostGrainSteps) return;
  const Key& key = *find_key(o.time_key);
  const std::string most = steps > dem::kMostSteps
                               ? fmt::format("up to {:g} steps", dem::kMostSteps)
                               : fmt::format("up to {:g} steps of single grains", kMostGrainSteps);
  reject(
      written(draft, key.path()), key.path(),
      fmt::format("found {}: {:.3g} s take {:.3g} steps of {:.3g} s (motion.time_step), {} on one "
                  "core; allowed: {}",
                  value_text(key, draft.value), o.time, steps, o.time_step,
                  duration(std::max(work, steps) / kRate), most));
}

void check_memory(const Draft& draft, const dem::Outlook& o) {
  const double limit = memory_limit();
  if (o.bytes <= limit) return;
  const Key& key = *find_key(o.bytes_key);
  reject(
      written(draft, key.path()), key.path(),
      fmt::format("found {}: {:.3g} grains take about {:.2g} GB of memory in a realization, "
                  "allowed: up to {:.2g} GB, what a process may take here",
                  value_text(key, draft.value), o.grains + o.fixed, 1e-9 * o.bytes, 1e-9 * limit));
}

void check_points(const Draft& draft) {
  const Case& value = draft.value;
  Case usual;
  usual.study = value.study;
  const Study& study = study_of(value);
  if (study.averaged == nullptr) return;
  // A key with its number: here, and as it is where nobody gives it.
  struct Factor {
    std::string path;
    double now, before;
    double excess() const { return now / before; }
  };
  const auto check = [&](std::vector<Factor> factors, double times) {
    factors.push_back({"ensemble.realizations", static_cast<double>(value.ensemble.realizations),
                       static_cast<double>(usual.ensemble.realizations)});
    double values = times;
    for (const Factor& f : factors) values *= f.now;
    if (values <= kMostAveraged) return;
    // The one that is farthest from usual is to blame.
    std::sort(factors.begin(), factors.end(),
              [](const Factor& a, const Factor& b) { return a.excess() > b.excess(); });
    std::vector<std::string> others;
    for (std::size_t k = 1; k < factors.size(); ++k) {
      others.push_back(fmt::format("{} = {}", factors[k].path, factors[k].now));
    }
    reject(written(draft, factors.front().path), factors.front().path,
           fmt::format("found {:g}, with {}: {:.3g} averaged values, allowed: up to {:g}",
                       factors.front().now, fmt::join(others, " and "), values, kMostAveraged));
  };
  const std::vector<AveragedValues> now = study.averaged(value), before = study.averaged(usual);
  for (std::size_t k = 0; k < now.size(); ++k) {
    std::vector<Factor> factors;
    for (std::size_t f = 0; f < now[k].keys.size(); ++f) {
      const auto& [path, number] = now[k].keys[f];
      factors.push_back({path, number, before[k].keys[f].second});
    }
    check(std::move(factors), now[k].times);
  }
}

std::string outlook_text(const Case& value) {
  const Study& study = study_of(value);
  if (!study.has_grains()) return "";
  Case first = value;  // all have been looked at when the case was read
  first.ensemble.realizations = 1;
  const dem::Outlook o = study.foresee(first, kMostDraws);
  std::string out = fmt::format("  {} realization{}", value.ensemble.realizations,
                                value.ensemble.realizations == 1 ? "" : "s");
  if (!value.sweep.key.empty()) {
    out += fmt::format(" for each of {} values of {}", value.sweep.values.size(), value.sweep.key);
  }
  if (o.grains > 0) out += fmt::format(" of {:.0f} grains", o.grains);
  if (o.time_step > 0) out += fmt::format(", steps of {:.3g} s", o.time_step);
  if (!value.sweep.key.empty()) out += " (of the case as it is)";
  out += "\n";
  if (const std::string material = material_text(value); !material.empty()) {
    out += fmt::format("  contacts: {}\n", material);
  }
  if (!o.step_bound.empty()) out += fmt::format("  the step follows {}\n", o.step_bound);
  if (o.bytes > kLarge) {
    out += fmt::format("  about {:.2g} GB of memory for every realization at a time\n",
                       1e-9 * o.bytes);
  }
  std::vector<std::string> solved;
  for (const ModelChoice& model : value.models) {
    if (model.name.starts_with("fe_")) solved.push_back(model.label);
  }
  if (!solved.empty()) {
    out += fmt::format(
        "  besides, finite elements ({}), not counted here: seconds to minutes each, more with "
        "finer meshes\n",
        fmt::join(solved, ", "));
  }
  if (o.time == 0 || o.time_step == 0) return out;
  const double steps = o.time / o.time_step, seconds = grain_steps(o) / kRate;
  LongestPart part;
  if (study.longest_part != nullptr) part = study.longest_part(value, o);
  if (!part.name.empty()) {
    out += fmt::format(
        "  {} takes {:.1f} s, {:.1f} million steps: with every grain awake about {} a "
        "realization on one core{}\n",
        part.name, o.time, 1e-6 * steps, duration(seconds), part.remark);
  } else if (seconds > kLong) {
    out += fmt::format(
        "  {:.1f} s and more are simulated, {:.1f} million steps: about {} a "
        "realization on one core\n",
        o.time, 1e-6 * steps, duration(seconds));
  }
  return out;
}

}  // namespace grainfield::coupling
