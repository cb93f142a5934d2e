// Ten steps of what `check` lets pass: every key of the grains at both ends of its range and with
// each of its words, in every study that has it. Made from the declarations: a new key is covered.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <ctime>

#include "check_scene.h"
#include "dem/computation_failed.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;

// Grains and bytes up to which a case is run; of larger ones reading is tested alone.
constexpr double kGrains = 12000, kBytes = 1e9;
constexpr double kSeconds = 10;

std::vector<std::string> values_of(const Key& key) {
  const std::string type = type_name(key);
  std::vector<std::string> out;
  if (type == "boolean") return {"true", "false"};
  if (type.ends_with("word") || type.ends_with("words")) out = key.choices;
  if (type.find("number") != std::string::npos) {
    out = {fmt::format("{}", key.least), fmt::format("{}", key.most)};
    if (key.or_zero) out.emplace_back("0");
  } else if (type == "integer") {
    out = {fmt::format("{:.0f}", key.least), fmt::format("{:.0f}", key.most)};
    if (key.or_zero) out.emplace_back("0");
  } else {
    for (std::string& word : out) word = "\"" + word + "\"";
  }
  if (type.starts_with("list")) {
    for (std::string& value : out) value = "[" + value + "]";
  }
  return out;
}

// A shape of three dimensions.
std::string in_space(const Key& shapes) {
  for (const char* word : {"sphere", "superellipsoid"}) {
    if (std::count(shapes.choices.begin(), shapes.choices.end(), word) > 0) return word;
  }
  throw std::logic_error(shapes.path() + " has no shape in space");
}

// Settings that give the key its effect in a case of this study.
Overrides settings_for(const Key& key, const Study& study) {
  Overrides out;
  std::vector<const Key*> todo{&key};
  if (key.space && find_key(study.dimension_key) != nullptr && study.dimension_key != "study") {
    const Key& dimension = *find_key(study.dimension_key);
    out.push_back(dimension.path() + "=" + (dimension.choices.empty() ? "3" : in_space(dimension)));
  }
  for (std::size_t k = 0; k < todo.size() && k < 20; ++k) {
    for (const Need& need : todo[k]->needs) {
      const Key& other = *find_key(need.key);
      if (!key_applies(other, study.name)) continue;
      const std::string start = other.path() + "=";
      const bool set = std::any_of(
          out.begin(), out.end(), [&](const std::string& text) { return text.starts_with(start); });
      if (set) continue;
      const std::string& value = need.values.at(0);
      out.push_back(start + (type_name(other).starts_with("list") ? "[\"" + value + "\"]" : value));
      todo.push_back(&other);
    }
  }
  return out;
}

// Other beginnings besides small_case(): the same study with other grains.
std::vector<Overrides> beginnings(const std::string& study) {
  std::vector<Overrides> out{{}};
  if (study == "point-load") {
    out.push_back(
        {"packing.sizes=mono", "packing.kind=triangular", "packing.columns=20", "packing.rows=6"});
    out.push_back({"packing.dim=3", "packing.kind=random", "material.law=hertz",
                   "packing.width=0.05", "packing.depth=0.03"});
  } else if (study == "sample") {
    out.push_back(
        {"sample.dim=3", "sample.shape=sphere", "material.law=hertz", "sample.grains=60"});
    out.push_back({"sample.boundary=walls", "sample.grains=60"});
  } else if (study == "cone") {
    out = {{"cone.grains=100"}};
  } else if (study == "hard-disks") {
    out = {{"gas.grains=100"}};
  }
  return out;
}

struct Counts {
  int refused = 0, large = 0, run = 0, failed = 0;
};

bool finite(const dem::Progress& now) {
  return std::isfinite(now.simulated_time) && std::isfinite(now.fraction);
}

void try_ten_steps(const Study& study, const std::string& file, const Overrides& set,
                   Counts& counts) {
  SCOPED_TRACE(fmt::format("{}: {}", study.name, set.back()));
  if (std::getenv("GRAINFIELD_SHOW_CASES") != nullptr) {
    fmt::print(stderr, "{}: {}\n", study.name, fmt::join(set, " "));
  }
  Case value;
  try {
    value = read_case(file, false, set);
  } catch (const std::invalid_argument& e) {
    if (std::getenv("GRAINFIELD_SHOW_REFUSALS") != nullptr) {
      fmt::print("{} {}: {}\n", study.name, set.back(), e.what());
    }
    ++counts.refused;
    return;
  }
  const dem::Outlook outlook = study.foresee(value, 1000);
  if (outlook.grains + outlook.fixed > kGrains || outlook.bytes > kBytes) {
    ++counts.large;
    return;
  }
  const std::clock_t start = std::clock();  // of the processor: other work beside does not count
  const auto seconds = [&] { return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; };
  try {
    const auto run = study.make_run(value, 0, 1);
    // Some advance by more than they are asked; they ask whether to go on.
    run->set_watch([&](const dem::Progress&) { return seconds() < kSeconds / 2; });
    for (int step = 0; step < 10 && !run->done() && seconds() < kSeconds / 2; ++step) {
      run->advance(1);
      EXPECT_TRUE(finite(run->progress()));
    }
    ++counts.run;
  } catch (const dem::ComputationFailed& e) {
    EXPECT_STRNE(e.what(), "");
    ++counts.failed;
  }
  EXPECT_LT(seconds(), kSeconds);
}

TEST(TenSteps, OfEveryKeyAtItsEndsAndWithEachOfItsWords) {
  Counts all;
  for (const Study& study : studies()) {
    if (!study.has_grains()) continue;
    const Folder folder;
    const std::string file = folder.write("x.toml", testing::small_case(study.name));
    Counts counts;
    std::vector<std::string> never;  // keys of which no value ran
    for (const KeySection& section : study.sections) {
      if (section.role != KeyRole::grains) continue;
      for (const Key& key : keys()) {
        if (key.section != section.name || !key_applies(key, study.name)) continue;
        const int before = counts.run + counts.failed;
        for (const Overrides& beginning : beginnings(study.name)) {
          for (const std::string& text : values_of(key)) {
            Overrides set = beginning;
            for (std::string& setting : settings_for(key, study)) set.push_back(std::move(setting));
            set.push_back(key.path() + "=" + text);
            ASSERT_NO_FATAL_FAILURE(try_ten_steps(study, file, set, counts));
          }
        }
        if (counts.run + counts.failed == before) never.push_back(key.path());
      }
    }
    fmt::print("{}: {} run, {} ended as failed, {} refused, {} too large to run here; never: {}\n",
               study.name, counts.run, counts.failed, counts.refused, counts.large,
               fmt::join(never, " "));
    EXPECT_GT(counts.run + counts.failed, counts.refused / 4) << study.name;
    all.run += counts.run;
  }
  EXPECT_GT(all.run, 300);
}

}  // namespace
}  // namespace grainfield::coupling
