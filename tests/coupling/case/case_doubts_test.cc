// Values that are allowed and hardly meant: named with their unit, before what follows from them.
#include "tests/coupling/check_scene.h"

namespace grainfield::coupling {
namespace {

using testing::accepted;
using testing::complaint;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const std::string kPile = "study = \"pile\"\n[source]\ngrains = 200\n";

TEST(CaseDoubts, MillimetresWrittenAsMetres) {
  const std::string text = kPile + "[shape]\nradius = 4\n";
  EXPECT_THAT(complaint(text),
              StartsWith("x.toml:5: shape.radius: found 4 m, a boulder's size; the unit is m; 4 mm "
                         "is written \"4 mm\"; with it "));
  EXPECT_THAT(complaint(text), HasSubstr("rest.background_damping: found 100, allowed: at most"));
  // Where nothing follows, it is a warning.
  EXPECT_THAT(accepted(text, {"rest.background_damping=1", "floor.length=1000", "source.interval=3",
                              "source.height=200"})
                  .without_effect,
              ElementsAre(HasSubstr("x.toml:5: shape.radius: found 4 m")));
  EXPECT_THAT(accepted(kPile + "[shape]\nradius = \"4 mm\"\n").without_effect, IsEmpty());
}

TEST(CaseDoubts, DensitiesThatNoGrainHas) {
  EXPECT_THAT(accepted(kPile, {"material.density=2.65"}).without_effect,
              ElementsAre(HasSubstr("--set: material.density: found 2.65 kg/m2, which no grain has "
                                    "(sand: 2650)")));
  EXPECT_THAT(accepted(kPile, {"material.density=2650"}).without_effect, IsEmpty());
}

TEST(CaseDoubts, FallsOfManyDiameters) {
  EXPECT_THAT(accepted(kPile, {"source.height=150"}).without_effect,
              ElementsAre(HasSubstr("--set: source.height: found 150 m, a fall of 27273 grain "
                                    "diameters; the unit is m; 150 mm is written \"150 mm\"")));
  EXPECT_THAT(accepted(kPile, {"source.height=2"}).without_effect, IsEmpty());
  // Grains that start above the top do not fall from there.
  EXPECT_THAT(accepted(kPile, {"source.height=150", "source.above=2"}).without_effect,
              ElementsAre(HasSubstr("has no effect")));
}

}  // namespace
}  // namespace grainfield::coupling
