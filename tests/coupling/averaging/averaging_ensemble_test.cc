// Mean and standard error over realizations.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coupling/averaging/ensemble.h"

namespace grainfield::coupling {
namespace {

Field field(std::vector<double> values, const std::string& name = "sigma_yy") {
  Field f;
  f.points = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(values.size()), 2);
  f.add(name, "N/m").value =
      Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  return f;
}

TEST(Ensemble, MeanAndStandardError) {
  Ensemble e;
  e.add(field({1, 10}));
  e.add(field({2, 10}));
  e.add(field({6, 10}));
  const Field mean = e.mean();
  EXPECT_EQ(mean.realizations, 3);
  EXPECT_DOUBLE_EQ(mean.columns[0].value[0], 3);
  EXPECT_DOUBLE_EQ(mean.columns[0].error[0], std::sqrt((4. + 1 + 9) / 2 / 3));
  EXPECT_DOUBLE_EQ(mean.columns[0].error[1], 0);
  const Eigen::MatrixXd samples = e.samples("sigma_yy");
  EXPECT_EQ(samples.rows(), 2);
  EXPECT_EQ(samples(0, 2), 6);
}

TEST(Ensemble, OneRealizationHasNoError) {
  Ensemble e;
  e.add(field({1, 2}));
  EXPECT_TRUE(std::isnan(e.mean().columns[0].error[0]));
}

TEST(Ensemble, NanInOneIsNanInTheMean) {
  Ensemble e;
  e.add(field({1, 2}));
  e.add(field({std::numeric_limits<double>::quiet_NaN(), 2}));
  EXPECT_TRUE(std::isnan(e.mean().columns[0].value[0]));
  EXPECT_EQ(e.mean().columns[0].value[1], 2);
}

TEST(Ensemble, RefusesWhatDoesNotFit) {
  const auto text = [](auto act) -> std::string {
    try {
      act();
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  Ensemble e;
  EXPECT_EQ(text([&] { e.mean(); }), "an ensemble without realizations has no mean");
  e.add(field({1, 2}));
  EXPECT_EQ(text([&] { e.add(field({1})); }), "realization 1 has 1 points, the first one 2");
  EXPECT_EQ(text([&] {
              e.add(field({1, 2}, "sigma_xx"));
            }),
            "realization 1 has column \"sigma_xx\" where the first one has \"sigma_yy\"");
  EXPECT_EQ(text([&] { e.samples("p"); }), "the ensemble has no column \"p\"");
}

}  // namespace
}  // namespace grainfield::coupling
