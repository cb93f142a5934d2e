// The turning point of a sheared sample's volume by the mean over samples.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/studies/sample/rve.h"

namespace grainfield::coupling {
namespace {

using Eigen::Matrix3d;

// A sample whose one RVE has these traces over three, at shear strains of 0, 0.01, 0.02, ...
void add_sample(RveTable& table, const std::vector<double>& volume) {
  RveStates states;
  std::vector<Matrix3d> gradients;
  for (std::size_t s = 0; s < volume.size(); ++s) {
    RveValue value;
    value.fit = value.boundary = value.inside = value.grains = Matrix3d::Zero();
    value.hull = volume[s] * Matrix3d::Identity();
    states.push_back({value});
    Matrix3d shear = Matrix3d::Zero();
    shear(0, 2) = 0.02 * static_cast<double>(s);
    gradients.push_back(shear);
  }
  table.values.resize(1);
  table.values[0].push_back(states);
  table.gradients.push_back(gradients);
  table.radii = {5};
  table.loading = static_cast<int>(volume.size()) - 1;
}

// Every sample's trace/3: where the mean is least, and what it grows by until the end.
std::vector<double> least(const Contraction& found) {
  std::vector<double> out;
  for (const auto& volume : found.volumes) out.push_back(volume.there);
  return out;
}
std::vector<double> growth(const Contraction& found) {
  std::vector<double> out;
  for (const auto& volume : found.volumes) out.push_back(volume.at_end - volume.there);
  return out;
}

TEST(RveContraction, IsThatOfTheMeanNotTheMeanOfEachSamplesLeast) {
  // The samples scatter by 2 up and down; their mean never falls.
  RveTable table;
  add_sample(table, {0, 2, -2, 3});
  add_sample(table, {0, -2, 3, 1});
  const Contraction found = rve_contraction(table);
  EXPECT_EQ(least(found), (std::vector<double>{2, -2}));
  EXPECT_EQ(growth(found), (std::vector<double>{1, 3}));
  EXPECT_DOUBLE_EQ(found.strain, 0.01);
}

TEST(RveContraction, FindsADipAllSamplesHaveWithItsStrain) {
  RveTable table;
  for (const double more : {0.0, 0.25, 0.5}) add_sample(table, {0, -1 - more, -3 - more, -1, 1});
  const Contraction found = rve_contraction(table);
  EXPECT_EQ(least(found), (std::vector<double>{-3, -3.25, -3.5}));
  EXPECT_EQ(growth(found), (std::vector<double>{4, 4.25, 4.5}));
  EXPECT_DOUBLE_EQ(found.strain, 0.02);
  EXPECT_NEAR(found.strain_error, 0, 1e-15);
}

TEST(RveContraction, TheStrainsErrorIsThatOfDrawingSamplesAnew) {
  RveTable table;
  add_sample(table, {0, -1, 0, 0, 0});
  add_sample(table, {0, 0, 0, -2, 0});
  const Contraction found = rve_contraction(table);
  EXPECT_DOUBLE_EQ(found.strain, 0.03);
  // The first sample twice, a quarter of the draws, has it at 0.01: 0.02 sqrt(3)/4.
  EXPECT_NEAR(found.strain_error, 0.02 * std::sqrt(3.0) / 4, 5e-4);
}

TEST(RveContraction, OneSampleHasNoErrorAndNoRadiusNoFigure) {
  RveTable table;
  EXPECT_TRUE(rve_contraction(table).volumes.empty());
  add_sample(table, {0, 1, 2});
  const Contraction found = rve_contraction(table);
  EXPECT_EQ(least(found), (std::vector<double>{1}));
  EXPECT_TRUE(std::isnan(found.strain_error));
}

}  // namespace
}  // namespace grainfield::coupling
