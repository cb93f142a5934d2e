// The phase machine and the archive by themselves.
#include "dem/run/phases.h"

#include <gmock/gmock.h>

namespace grainfield::dem {
namespace {

enum class Phase : int { fall, rest, done };

Phases<Phase> three() {
  return Phases<Phase>({{"fall", false, 0, 0.4}, {"rest", true, 0.4, 1}, {"done", true, 1, 1}});
}

TEST(Phases, TellWhereTheRunIs) {
  Phases<Phase> p = three();
  EXPECT_EQ(p.now(), Phase::fall);
  EXPECT_STREQ(p.info().name, "fall");
  EXPECT_FALSE(p.info().damped);
  EXPECT_DOUBLE_EQ(p.fraction(0.5), 0.2);
  EXPECT_DOUBLE_EQ(p.fraction(7), 0.4);
  p.advance(130);
  EXPECT_EQ(p.until_due(100), 70);
  EXPECT_FALSE(p.is_due(100));
  p.enter(Phase::rest);
  EXPECT_EQ(p.steps(), 0);
  EXPECT_DOUBLE_EQ(p.fraction(0), 0.4);
  EXPECT_FALSE(p.done());
  p.enter(Phase::done);
  EXPECT_TRUE(p.done());
  EXPECT_DOUBLE_EQ(p.fraction(0), 1);
}

TEST(Phases, StepUpToTheNextDecision) {
  const auto engine = make_engine(EngineSettings{});
  Phases<Phase> p = three();
  EXPECT_EQ(p.step(*engine, 30, 100), 30);
  EXPECT_EQ(p.step(*engine, 300, 100), 70);
  EXPECT_TRUE(p.is_due(100));
  EXPECT_EQ(engine->steps(), 100);
}

// All that a run may show, in one list.
struct Shown {
  Phases<Phase> phases = three();
  double number = 0;
  std::vector<int> list;
  std::unique_ptr<Engine> engine, none;
  std::optional<Snapshot> missing;

  void visit(Archive& archive) {
    phases.visit(archive);
    archive(number);
    archive(list);
    archive.engine(engine, [] { return make_engine(EngineSettings{}); });
    archive.engine(none, [] { return make_engine(EngineSettings{}); });
    archive.snapshot(missing, "missing");
  }
};

TEST(Archive, GivesBackWhatItWasShown) {
  Shown a, b;
  a.phases.enter(Phase::rest);
  a.phases.advance(12);
  a.number = 0.1;
  a.list = {3, 1, 2};
  a.engine = make_engine(EngineSettings{});
  a.engine->step(5);
  b.none = make_engine(EngineSettings{});
  b.missing.emplace();
  Archive writing;
  a.visit(writing);
  EXPECT_FALSE(writing.is_reading());
  EXPECT_TRUE(writing.snapshots().empty());
  Archive reading(writing.written().bytes(), "none.h5");
  b.visit(reading);
  reading.finish();
  EXPECT_EQ(b.phases.now(), Phase::rest);
  EXPECT_EQ(b.phases.steps(), 12);
  EXPECT_EQ(b.number, 0.1);
  EXPECT_EQ(b.list, a.list);
  ASSERT_TRUE(b.engine);
  EXPECT_EQ(b.engine->steps(), 5);
  EXPECT_FALSE(b.none);
  EXPECT_FALSE(b.missing);
}

TEST(Archive, RefusesWhatDoesNotFit) {
  Shown a;
  Archive writing;
  a.visit(writing);
  const std::string bytes = writing.written().bytes();
  const auto read = [](std::string text) {
    Shown b;
    Archive reading(std::move(text), "none.h5");
    b.visit(reading);
    reading.finish();
  };
  EXPECT_NO_THROW(read(bytes));
  EXPECT_THROW(read(bytes.substr(0, bytes.size() - 1)), std::invalid_argument);
  EXPECT_THROW(read(bytes + "x"), std::invalid_argument);
  std::string no_phase = bytes;
  no_phase[0] = 9;
  EXPECT_THROW(read(no_phase), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::dem
