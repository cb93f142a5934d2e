// The ratio of stresses on a heap's axis, on heaps whose stress is known.
#include "coupling/specimen/axis_stress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "coupling/averaging/average.h"
#include "coupling/case/case.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/realization_file.h"
#include "coupling/run/summary_keys.h"
#include "coupling/studies/pile/study.h"
#include "tests/coupling/heap_scene.h"
#include "tests/coupling/program.h"
#include "tests/coupling/stressed_heap.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;

// Stresses are over rho g, lengths in m; tension positive.
double ratio_of(const dem::Snapshot& heap, const HeapSetup& setup = {}) {
  return axis_stress_ratio(heap, pile_frame(heap), setup);
}

// Every bond of this heap carries along itself: cot 60 times its lever d/2 across, over
// d sin 60 down (Liffman 1992). The ratio is 1/3 in every window.
TEST(AxisStress, IsAThirdInALatticeHeap) {
  for (const auto& [from, to] : {std::pair{0.1, 0.6}, {0.3, 0.35}, {0.5, 0.9}}) {
    HeapSetup setup;
    setup.axis_from = from;
    setup.axis_to = to;
    EXPECT_NEAR(ratio_of(test::lattice_heap(40, 0.005, 9.81, 0.2), setup), 1 / 3.0, 1e-12);
  }
}

TEST(AxisStress, IsNanInAWindowWithoutForces) {
  dem::Snapshot heap = test::lattice_heap(20);
  heap.contacts.clear();
  EXPECT_TRUE(std::isnan(ratio_of(heap)));
}

// sigma_yy = y and sigma_xx = k y + c y^2/h + e x: over the window the mean of x is that of its
// ends, which lie at shares of unlike half bases, and y^2 weighs its depths. The lattice's steps
// are felt with d over the window's width, so the error falls with the rows.
TEST(AxisStress, WeighsEveryPlaceInItsWindowAlike) {
  const double k = 0.6, c = 0.3, e = 0.5;
  double coarse = 0;
  for (const int rows : {40, 80, 160}) {
    test::StressedHeap made;
    made.rows = rows;
    made.left_deg = 22;
    made.right_deg = 34;
    made.apex_x = 0.3;
    made.floor = -0.1;
    const double h = made.diameter * (1 + (rows - 1) * std::sqrt(3) / 2);
    const dem::Snapshot heap = test::stressed_heap(made, [&](double x, double y) {
      return Eigen::Vector3d(k * y + c * y * y / h + e * x, y, 0);
    });
    double worst = 0;
    for (const auto& [from, to] : {std::pair{0.1, 0.6}, {0.2, 0.4}, {0.4, 0.7}}) {
      HeapSetup setup;
      setup.axis_from = from;
      setup.axis_to = to;
      const PileFrame frame = pile_frame(heap);
      // The steps of the flanks leave out the topmost grain: the frame's height is a row less.
      ASSERT_NEAR(frame.floor, made.floor, 1e-12);
      const double upper = to * frame.height - h, lower = from * frame.height - h;
      const double mean_y = (upper + lower) / 2;
      const double mean_y2 = (upper * upper + upper * lower + lower * lower) / 3;
      const double mean_x =
          frame.apex_x - made.apex_x + setup.centre * (frame.half_right - frame.half_left) / 2;
      const double expected = (k * mean_y + c * mean_y2 / h + e * mean_x) / mean_y;
      worst = std::max(worst, std::fabs(ratio_of(heap, setup) - expected));
    }
    if (rows == 40) coarse = worst;
    EXPECT_LT(worst, 1.0 / rows);
    if (rows == 160) {
      EXPECT_LT(worst, coarse / 3);
    }
  }
}

// The coarse-grained field, averaged over the same window, has the same ratio.
TEST(AxisStress, IsThatOfTheAveragedField) {
  test::StressedHeap made;
  made.rows = 80;
  made.noise = 0.2;
  const dem::Snapshot heap = test::stressed_heap(
      made, [](double x, double y) { return Eigen::Vector3d(0.7 * y + 0.2 * x, y, 0); });
  const PileFrame frame = pile_frame(heap);
  const HeapSetup setup;
  const double left = setup.centre * frame.half_left, right = setup.centre * frame.half_right;
  const Eigen::MatrixXd points = grid_points(frame.apex_x - left, frame.apex_x + right, 81,
                                             frame.floor + setup.axis_from * frame.height,
                                             frame.floor + setup.axis_to * frame.height, 81);
  AverageOptions options;
  options.width = made.diameter;
  options.quantities = {"sigma"};
  const Field field = average(heap, points, options);
  EXPECT_NEAR(ratio_of(heap),
              field.find("sigma_xx")->value.sum() / field.find("sigma_yy")->value.sum(), 0.01);
}

TEST(AxisStress, IsAFigureOfEveryPileWithItsError) {
  const Folder folder;
  std::vector<std::string> files;
  for (const double k : {0.4, 0.5, 0.9}) {
    files.push_back(folder / ("r" + std::to_string(files.size()) + ".h5"));
    dem::RunResult result;
    result.snapshots = {{"pile", test::stressed_heap({}, [k](double, double y) {
                           const double pressure = test::lattice_rho_g() * y;
                           return Eigen::Vector3d(k * pressure, pressure, 0);
                         })}};
    write_realization(files.back(), result);
  }
  Case value;
  value.study = "pile";
  value.get<AverageSetup>().map_columns = 21;
  value.get<AverageSetup>().map_rows = 11;
  const StudyResult result = analyse_pile(value, files, 1);
  EXPECT_NO_THROW(require_documented(result.summary));
  const auto number = [&](const std::string& key) {
    return std::get<double>(result.summary.at(key));
  };
  // All ratios of one lattice are k times the same number, 1 but for the lattice's steps.
  const double lattice = number("axis.stress_ratio") / 0.6;
  EXPECT_NEAR(lattice, 1, 0.03);
  EXPECT_NEAR(number("axis.stress_ratio.least"), 0.4 * lattice, 1e-9);
  EXPECT_NEAR(number("axis.stress_ratio.most"), 0.9 * lattice, 1e-9);
  EXPECT_NEAR(number("axis.stress_ratio.standard_error"), std::sqrt(0.07 / 3) * lattice, 1e-9);
  // The same vertical forces in all three.
  EXPECT_NEAR(number("dip.centre.standard_error"), 0, 1e-12);
  EXPECT_NEAR(number("dip.centre"), 1, 0.1);
  std::map<std::string, int> columns;
  for (const OverviewColumn& column : overview_of({result})) ++columns[column.key];
  EXPECT_EQ(columns["axis.stress_ratio"], 1);
  EXPECT_EQ(columns["dip.centre"], 1);
}

TEST(AxisStress, RefusesAWindowUpsideDown) {
  Case value;
  value.study = "pile";
  value.get<HeapSetup>().axis_from = 0.7;
  try {
    pile_study().check(value);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(),
                HasSubstr("heap.axis_from: found 0.7, allowed: below heap.axis_to = 0.6"));
  }
}

}  // namespace
}  // namespace grainfield::coupling
