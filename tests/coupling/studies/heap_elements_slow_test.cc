// Finite elements of heaps with fitted constants: the fields of the fits that they stand for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/fit/ensemble_fit.h"
#include "tests/coupling/fit_scene.h"

namespace grainfield::coupling {
namespace {

EnsembleFits heap_of(const std::string& truth, const Eigen::VectorXd& parameters) {
  EnsembleFits out;
  out.observed.facts.slope_deg = kSlope;
  out.observed.data = places(9);
  FitData& data = out.observed.data;
  data.points /= kHeight;
  const std::vector<FitModel> known = heap_models(out.observed.facts);
  dem::Random random(3);
  fill(data, predict(data, find_fit_model(known, truth), parameters), 6, 0.02 / (kRhoG * kHeight),
       0.2, random);
  out.weights = weights_of(data);
  FitOptions options;
  options.bootstrap = 0;
  for (const char* name : {"osl", "cantelaube_plus"}) {
    out.models.push_back(find_fit_model(known, name));
    out.fits.push_back(fit(data, out.weights, out.models.back(), options));
  }
  return out;
}

std::vector<FiniteElementFit> elements_of(const EnsembleFits& fits,
                                          const std::vector<std::string>& names) {
  const FitData& data = fits.observed.data;
  return solve_elements(names, fits.models, fits.fits, data, fits.weights,
                        [&](const StressFunction& stress, bool) { return stress(data.points); });
}

TEST(HeapElements, TakeTheFittedConstants) {
  const EnsembleFits fits = heap_of("osl", vector({0.6, -0.1}));
  const auto elements = elements_of(fits, {"fe_osl_wedge", "fe_mohr_coulomb_wedge"});
  ASSERT_EQ(elements.size(), 2U);
  EXPECT_EQ(elements[0].why, "");
  EXPECT_EQ(elements[0].of, "osl");
  EXPECT_THAT(elements[0].constants, testing::HasSubstr("phi_deg=28"));
  EXPECT_LT(elements[0].from_closed, 1e-3);
  EXPECT_NEAR(elements[0].chi2_per_dof, fits.fits[0].chi2_per_dof,
              0.05 * fits.fits[0].chi2_per_dof);
  EXPECT_EQ(elements[1].why, "");
  EXPECT_EQ(elements[1].of, "cantelaube_plus");
  EXPECT_LT(elements[1].from_closed, 0.4);
  EXPECT_GT(elements[1].from_closed, 1e-3);
}

TEST(HeapElements, SaysWhenThereIsNoFitForIt) {
  EnsembleFits fits = heap_of("osl", vector({0.6, -0.1}));
  fits.fits.resize(1);
  const auto elements = elements_of(fits, {"fe_mohr_coulomb_wedge"});
  EXPECT_EQ(elements[0].why, "no fitted model that it represents");
}

}  // namespace
}  // namespace grainfield::coupling
