// A study of another program, made as docs/extending.md says: its keys, its grains, its figures and
// its page stand here, one line adds it, and no file of the toolkit knows of it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "coupling/case/declare.h"
#include "coupling/case/study.h"
#include "coupling/report/judgement.h"
#include "coupling/result/tables.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/grain_keys.h"
#include "coupling/run/ranks.h"
#include "coupling/run/run_case.h"
#include "coupling/run/study_result.h"
#include "coupling/run/summary_keys.h"
#include "dem/heap/grain_family.h"
#include "dem/packing/lattice_pile.h"
#include "dem/run/phased_run.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;

// Close-packed disks: what does the base carry?
struct StackSetup {
  dem::LatticeSetup lattice{.base_grains = 4};
  dem::MaterialSetup material;
  dem::MotionSetup motion;
  dem::RestSetup rest{.unbalanced_force_ratio = 1e-8};
  double tolerance = 1e-3;

  auto members() const { return std::tie(lattice, material, motion, rest, tolerance); }
};

struct StackGroundwork {
  using Setup = StackSetup;
  static constexpr const char* kName = "stack";
  static void check(const Setup& s) { dem::check_lattice(s.lattice); }
  static dem::ShapedGrain draw(const Setup& s, dem::Random&, dem::Allowance&) {
    return dem::disk_grain(s.lattice.radius);
  }
  static dem::EngineSettings settings(const Setup& s, const dem::ShapedGrain& disk,
                                      double reserve) {
    const dem::GrainExtremes extremes = dem::extremes_of({disk}, s.material.density);
    return dem::engine_settings(s.material, s.motion, extremes, 1, false, reserve);
  }
  static dem::Outlook outlook(const Setup& s, const dem::EngineSettings& settings) {
    dem::Outlook out;
    out.take_step(settings);
    for (const int row : dem::lattice_rows(s.lattice)) out.grains += row;
    return out;
  }
};

enum class StackPhase : int { rest, done };

class StackRun final : public dem::PhasedRun<StackGroundwork, StackPhase> {
 public:
  StackRun(const StackSetup& setup, std::uint64_t seed, int threads)
      : PhasedRun(setup, seed, {{"rest", true, 0, 1}, {"done", true, 1, 1}}) {
    take_settings(dem::disk_grain(setup_.lattice.radius), threads);
    engine_ = empty_engine();
    add(dem::lattice_pile_grains(setup_.lattice, setup_.material.density));
    enter(StackPhase::rest);
  }
  dem::RunResult result() const override {
    dem::RunResult out;
    if (stack_) out.snapshots = {{"pile", *stack_}};
    return out;
  }

 private:
  std::unique_ptr<dem::Engine> empty_engine() const override {
    auto engine = dem::make_engine(settings_);
    engine->add_wall(
        {"floor", dem::Vec3(0, 0, 0), dem::Vec3(0, 1, 0), setup_.material.floor_friction});
    return engine;
  }
  void decide() override {
    if (!has_come_to_rest(engine_->measure(), "stack", "")) return;
    stack_ = dem::named_snapshot(*engine_, "pile", seed_, {});
    phases_.enter(StackPhase::done);
  }
  double share(const dem::Diagnostics& state) const override {
    return dem::rest_progress(state, setup_.rest);
  }
  void visit(dem::Archive& archive) override {
    phases_.visit(archive);
    visit_engine(archive);
    archive.snapshot(stack_, "pile");
    archive.require(done() == stack_.has_value());
  }

  std::optional<dem::Snapshot> stack_;
};

void declare_stack_keys(SectionKeys s) {
  s.number(
      "width", "-", +[](Case& c) -> int& { return c.get<StackSetup>().lattice.base_grains; },
      {3, 100}, "disks in the lowest row");
  s.number(
      "tolerance", "-", +[](Case& c) -> double& { return c.get<StackSetup>().tolerance; },
      {1e-9, 1}, "carried means: the base force is the weight within this share");
}

std::vector<SummaryKey> stack_figures() {
  return {{"stack.base_force_over_weight", "-", "vertical force on the base over the weight",
           "base force / weight"},
          {"stack.carried", "text", "yes | no"}};
}

double base_force_over_weight(const dem::Snapshot& pile) {
  double weight = 0;
  for (const dem::Grain& g : pile.grains) weight += g.fixed ? 0 : g.mass * pile.gravity.norm();
  return dem::base_force(pile).y() / weight;
}

StudyResult analyse_stack(const Case& value, const std::vector<std::string>& files, int) {
  StudyResult out = begin_result(value, files);
  std::map<std::string, std::vector<double>> figures;
  for (const std::string& file : files) {
    figures["stack.base_force_over_weight"].push_back(
        base_force_over_weight(read_realization(file)["pile"]));
  }
  add_figures(out.summary, figures);
  const double ratio = figures["stack.base_force_over_weight"].front();
  const bool carried = std::abs(ratio - 1) < value.get<StackSetup>().tolerance;
  out.summary["stack.carried"] = carried ? "yes" : "no";
  out.comparison.judgement.findings = {
      fmt::format("The base carries {:.6g} of the weight.", ratio)};
  out.page = [](const StudyResult& result, const Realization* first) {
    Report page;
    page.title = "A stack of " + std::to_string((*first)["pile"].grains.size()) + " disks";
    add_verdict(page, result.comparison.judgement);
    Table table{"Figures", "", {}, {}};
    for (const auto& [name, text] : figure_rows(result)) table.rows.push_back({name, text});
    page.sections.emplace_back(std::move(table));
    return page;
  };
  return out;
}

Study stack_study() {
  Study out;
  out.name = "toy-stack";
  out.meaning = "close-packed disks and their weight";
  out.sections = {
      kMaterialKeys, kMotionKeys, kRestKeys, {"stack", KeyRole::grains, declare_stack_keys}};
  out.material = [](Case& c) -> dem::MaterialSetup& { return c.get<StackSetup>().material; };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<StackSetup>().motion; };
  out.rest = [](Case& c) -> dem::RestSetup& { return c.get<StackSetup>().rest; };
  out.figures = {stack_figures};
  out.models_optional = true;
  out.make_run = [](const Case& value, std::int64_t number,
                    int threads) -> std::unique_ptr<dem::Run> {
    return std::make_unique<StackRun>(value.get<StackSetup>(), realization_seed(value, number),
                                      threads);
  };
  out.foresee = [](const Case& value, std::int64_t draws) {
    return dem::foresee<StackGroundwork>(value.get<StackSetup>(), realization_seeds(value), draws);
  };
  out.analyse = analyse_stack;
  return out;
}

const bool kAdded = add_study(stack_study);

const char* const kCase = R"(study = "toy-stack"
[stack]
width = 5
[material]
floor_friction = 0.9
[ensemble]
realizations = 2
)";

void run(const std::string& file, const std::string& folder,
         const std::vector<std::string>& set = {}) {
  const Case value = read_case(file, false, set);
  RunOptions options;
  options.folder = folder;
  options.note = [](const std::string&) {};
  run_case(value, Ranks(), options);
}

TEST(ToyStudy, RunsAsTheOthersDo) {
  const Folder folder;
  run(folder.write("x.toml", kCase), folder / "out");
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NEAR(std::get<double>(s.at("stack.base_force_over_weight")), 1, 1e-6);
  EXPECT_EQ(std::get<std::string>(s.at("stack.carried")), "yes");
  EXPECT_EQ(std::get<std::string>(s.at("case.study")), "toy-stack");
  EXPECT_TRUE(s.contains("stack.base_force_over_weight.standard_error"));
  EXPECT_THAT(testing::read_text(folder / "out/report.html"), HasSubstr("A stack of 15 disks"));
  const std::string text = testing::read_text(folder / "out/case.toml");
  EXPECT_THAT(text, HasSubstr("[stack]"));
  EXPECT_THAT(text, HasSubstr("width = 5\n"));
  EXPECT_THAT(text, HasSubstr("floor_friction = 0.9\n"));
  EXPECT_THAT(text, HasSubstr("tolerance = 0.001\n"));
  EXPECT_EQ(text.find("[lattice]"), std::string::npos);
  // What is written reads back to the same.
  EXPECT_EQ(write_case(read_case(folder / "out/case.toml", false, {})), text);
}

TEST(ToyStudy, IsSweptOverItsOwnKeys) {
  const Folder folder;
  run(folder.write("x.toml", std::string(kCase) + "[sweep]\nkey = \"stack.width\"\nvalues = "
                                                  "[\"3\", \"4\"]\n"),
      folder / "out");
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NEAR(std::get<double>(s.at("stack.base_force_over_weight.width_4")), 1, 1e-6);
  EXPECT_THAT(testing::read_text(folder / "out/report.html"), HasSubstr("base force / weight"));
}

TEST(ToyStudy, ItsKeysAreCheckedAndDocumented) {
  const Folder folder;
  const std::string file = folder.write("x.toml", kCase);
  const auto refused = [&](const std::string& set) -> std::string {
    try {
      read_case(file, false, {set});
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refused("stack.width=2"), "--set: stack.width: found 2, allowed: 3 to 100");
  EXPECT_THAT(refused("stack.widht=4"), HasSubstr("unknown key; did you mean stack.width"));
  EXPECT_THAT(refused("lattice.gap=0"), HasSubstr("has no meaning for study = \"toy-stack\""));
  EXPECT_THAT(refused("study=\"toy-stak\""), HasSubstr("did you mean toy-stack"));
  EXPECT_THAT(keys_markdown(), HasSubstr("disks in the lowest row"));
  EXPECT_THAT(keys_text("stack"), HasSubstr("Studies: toy-stack."));
  EXPECT_THAT(summary_keys_markdown(), HasSubstr("| `stack.carried` | text | yes \\| no |"));
  EXPECT_EQ(find_summary_key("stack.nobody_knows"), nullptr);
}

TEST(ToyStudy, StandsBehindThoseThatShip) {
  EXPECT_TRUE(kAdded);
  EXPECT_EQ(studies().back().name, "toy-stack");
  EXPECT_EQ(studies().size(), shipped_studies().size() + 1);
  EXPECT_EQ(default_study(), shipped_studies().front().name);
  EXPECT_THROW(add_study(stack_study), std::logic_error) << "too late";
}

}  // namespace
}  // namespace grainfield::coupling
