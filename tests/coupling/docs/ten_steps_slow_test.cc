// Ten steps of what `check` lets pass: every key of the grains at both ends of its range and with
// each of its words, in every study that has it. Made from the declarations: a new key is covered.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <ctime>

#include "dem/shared/computation_failed.h"
#include "tests/coupling/check_scene.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;

// Grains and bytes up to which a case is run; of larger ones reading is tested alone.
constexpr double kGrains = 4000, kBytes = 1e9;
constexpr double kSeconds = 10;
constexpr double kEnough = 1;  // s after which a run need not go on

std::vector<std::string> values_of(const Key& key) {
  const std::string type = type_name(key);
  std::vector<std::string> out;
  if (key.name == "outline") return {"[-1, -1, 1, -1, 0, 1]"};
  if (key.name == "waypoints") return {"[0, 0, 0, 1, 0.001, 0]"};
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

// Settings that give the key its effect in a case of this study that begins so.
// A setting takes the place of an earlier one of the same key.
void put(Overrides& set, const std::string& setting) {
  const std::string start = setting.substr(0, setting.find('=') + 1);
  set.erase(std::remove_if(set.begin(), set.end(),
                           [&](const std::string& one) { return one.rfind(start, 0) == 0; }),
            set.end());
  set.push_back(setting);
}

Overrides settings_for(const Key& key, const Study& study, const Overrides& beginning) {
  Overrides out;
  std::vector<const Key*> todo{&key};
  if (key.space && find_key(study.dimension_key) != nullptr && study.dimension_key != "study") {
    const Key& dimension = *find_key(study.dimension_key);
    out.push_back(dimension.path() + "=" + (dimension.choices.empty() ? "3" : in_space(dimension)));
  }
  if (key.name == "unload_stress") out.emplace_back("sample.deformation=uniaxial");  // not in shear
  for (std::size_t k = 0; k < todo.size() && k < 20; ++k) {
    for (const Need& need : todo[k]->needs) {
      const Key& other = *find_key(need.key);
      if (!key_applies(other, study.name)) continue;
      const std::string start = other.path() + "=";
      const bool set = std::any_of(
          out.begin(), out.end(), [&](const std::string& text) { return text.starts_with(start); });
      const bool there =
          std::any_of(need.values.begin(), need.values.end(), [&](const auto& value) {
            return std::count(beginning.begin(), beginning.end(), start + value) > 0;
          });
      if (set || there) continue;
      const std::string& value = need.values.at(0);
      out.push_back(start + (type_name(other).starts_with("list") ? "[\"" + value + "\"]" : value));
      todo.push_back(&other);
    }
  }
  return out;
}

// Beside what the case has: ends of a range often fit no other key.
std::vector<std::string> near_values(const Key& key, const std::string& file,
                                     const Overrides& set) {
  try {
    Case value = read_case(file, false, set);
    return std::visit(
        [&](auto get) -> std::vector<std::string> {
          const auto& now = get(value);
          using T = std::decay_t<decltype(now)>;
          if constexpr (std::is_same_v<T, double>) {
            return {fmt::format("{}", 1.1 * now), fmt::format("{}", 0.9 * now)};
          } else if constexpr (std::is_same_v<T, int> || std::is_same_v<T, std::int64_t>) {
            return {fmt::format("{}", now + 1)};
          } else {
            return {value_text(key, value)};
          }
        },
        key.where);
  } catch (const std::invalid_argument&) {
    return {};
  }
}

// Other beginnings besides small_case(): the same study with other grains.
std::vector<Overrides> beginnings(const std::string& study) {
  const std::string spheres = "material.law=hertz", bodies = "material.law=penalty";
  if (study == "point-load" || study == "boussinesq-limit") {
    Overrides space{"packing.dim=3", "packing.width=0.05", "packing.depth=0.03"};
    if (study == "point-load") space.push_back("compare.models=[\"boussinesq\"]");
    const auto with = [&](Overrides more) {
      more.insert(more.end(), space.begin(), space.end());
      return more;
    };
    return {
        {},
        {"packing.sizes=mono", "packing.kind=triangular", "packing.columns=20", "packing.rows=6"},
        with({"packing.kind=random", spheres}),
        with({"packing.kind=close_packed", "packing.sizes=mono", "packing.columns=6",
              "packing.rows=4", spheres}),
        with({"packing.kind=random", "packing.shape=superellipsoid", bodies,
              "packing.radius_min=0.003", "packing.radius_max=0.0035"})};
  }
  if (study.starts_with("pile")) return {{}, {"shape.kind=disk", "material.law=linear"}};
  if (study == "sample") {
    const std::string small = "sample.grains=60";
    return {{},
            {"sample.dim=3", "sample.shape=sphere", spheres, small},
            {"sample.boundary=walls", small},
            {"sample.shape=rand1", "material.law=overlap_area", small},
            {"sample.deformation=uniaxial", "sample.compression=uniaxial", small},
            {"sample.dim=3", "sample.shape=superellipsoid", bodies, "sample.grains=150",
             "sample.start_fraction=0.05"},
            {"sample.dim=3", "sample.shape=sphere", spheres, small, "sample.boundary=walls",
             "sample.filling=dropped"}};
  }
  if (study == "cone") {
    return {{"cone.grains=100", spheres}, {"cone.grains=100", "cone.shape=superellipsoid", bodies}};
  }
  if (study == "pair") return {{}, {"pair.shape=sphere", spheres}};
  if (study == "hard-disks") return {{"gas.grains=100"}};
  return {{}};
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
    run->set_watch([&](const dem::Progress&) { return seconds() < kEnough; });
    for (int step = 0; step < 10 && !run->done() && seconds() < kEnough; ++step) {
      run->advance(1);
      EXPECT_TRUE(finite(run->progress()));
    }
    ++counts.run;
  } catch (const ComputationFailed& e) {
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
          Overrides start = beginning;
          for (std::string& setting : settings_for(key, study, beginning)) put(start, setting);
          std::vector<std::string> values = values_of(key);
          for (std::string& value : near_values(key, file, start))
            values.push_back(std::move(value));
          for (const std::string& text : values) {
            Overrides set = start;
            put(set, key.path() + "=" + text);
            ASSERT_NO_FATAL_FAILURE(try_ten_steps(study, file, set, counts));
          }
        }
        if (counts.run + counts.failed == before) never.push_back(key.path());
      }
    }
    fmt::print("{}: {} run, {} ended as failed, {} refused, {} too large to run here; never: {}\n",
               study.name, counts.run, counts.failed, counts.refused, counts.large,
               fmt::join(never, " "));
    // Laws of the plane have keys that a cone's section shares.
    if (study.name != "cone") {
      EXPECT_TRUE(never.empty()) << study.name << ": " << fmt::format("{}", fmt::join(never, " "));
    }
    EXPECT_LE(never.size(), 3U) << study.name;
    all.run += counts.run;
  }
  EXPECT_GT(all.run, 300);
}

}  // namespace
}  // namespace grainfield::coupling
