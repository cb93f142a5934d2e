// Models of the registry in fits of layers under a point load.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "continuum/closed/orthotropic_layer.h"
#include "continuum/settings.h"
#include "coupling/fit/ensemble_fit.h"
#include "coupling/fit/open_models.h"
#include "tests/coupling/layer_fit_scene.h"
#include "tests/coupling/open_models_scene.h"

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;

constexpr double kDepth = 0.2;  // m

const LayerScene& scene() {
  static const LayerScene one = layer_scene();
  return one;
}

FitModel layer_model(const std::string& text) {
  return models_of_layers({text}, scene().sight, kDepth).front();
}

TEST(OpenModels, OfLayersComeBackWithErrors) {
  dem::Random random(5);
  for (const auto& [text, listed, all, truth] :
       std::vector<std::tuple<std::string, std::string, Eigen::VectorXd, Eigen::VectorXd>>{
           {"osl_layer:eta=free,mu=0.1,width=0.12", "osl_layer_absorbing", vector({0.5, 0.1, 0.6}),
            vector({0.5})},
           {"layer:base=rough,nu=free", "layer_rough", vector({0.3}), vector({0.3})},
           {"orthotropic_half_plane:r=free,t=0.6", "orthotropic_half_plane", vector({-0.3, 0.6}),
            vector({-0.3 * std::sqrt(0.6)})}}) {
    const FitData data = with_noise(scene(), listed, all, 6, 0.003, random);
    FitOptions options;
    options.bootstrap = 0;
    expect_back(fit(data, weights_of(data), layer_model(text), options), truth);
  }
}

TEST(OpenModels, LengthsAreOverTheDepth) {
  const FitModel model = layer_model("osl_layer:eta=0.5,mu=0.1,width=free");
  EXPECT_EQ(model.parameters.front().unit, "h");
  EXPECT_EQ(model.equations, "hyperbolic");
  const ModelChoice choice = registry_choice(model, vector({0.6}), kDepth);
  EXPECT_NEAR(std::stod(choice.settings.at("width")), 0.6 * kDepth, 1e-12);
  const Eigen::MatrixXd points = scene().sight->places().points();
  EXPECT_TRUE(model.stress(points, vector({0.6}))
                  .isApprox(find_fit_model(scene().models, "osl_layer_absorbing")
                                .stress(points, vector({0.5, 0.1, 0.6}))));
}

// Constants within the bounds of layer_rough, of the orthotropic layers.
Eigen::VectorXd drawn(const FitModel& model, dem::Random& random) {
  const Eigen::VectorXd p =
      vector({0.3 + random.uniform(), 0.5 + 2 * random.uniform(), 0.4 * random.uniform()});
  if (model.parameters.size() == 1) return vector({0.4 * p[0]});
  return p.head(static_cast<Eigen::Index>(model.parameters.size()));
}

constexpr const char* kSummed[] = {"layer_smooth", "layer_rough", "orthotropic_layer_smooth",
                                   "orthotropic_layer_rough"};

// Seen through the kernel: LayerFit.ModelsAreTheRegistrysSeenThroughTheKernel.
TEST(OpenModels, WavesAreTheRegistrysLayers) {
  Eigen::MatrixXd points(5, 2);
  points << -0.8, -0.5, 0, -0.5, 0.3, -0.6, 1.2, -0.45, 0.2, -1;
  dem::Random random(7);
  for (const char* name : kSummed) {
    const FitModel& model = find_fit_model(scene().models, name);
    for (int k = 0; k < 5; ++k) {
      const Eigen::VectorXd p = drawn(model, random);
      const ModelChoice choice = registry_choice(model, p, 1);
      const continuum::Settings filled = filled_settings(choice, facts_of_layer());
      const continuum::Settings all =
          continuum::complete(continuum::find_model(choice.name), filled);
      const continuum::Orthotropy medium = choice.name == "layer"
                                               ? continuum::Orthotropy{1, 1}
                                               : continuum::orthotropy(choice.name, all);
      const Eigen::MatrixXd exact = continuum::make_model(choice.name, filled)->stress(points);
      const Eigen::MatrixXd summed =
          continuum::orthotropic_layer_stress(*waves_of(choice.name, all), medium, 1, 1, points);
      EXPECT_LT((summed - exact).cwiseAbs().maxCoeff(), 1e-8 * exact.cwiseAbs().maxCoeff())
          << name << " " << p.transpose();
    }
  }
}

TEST(OpenModels, OfLayersAreRefused) {
  EXPECT_THAT(check_layer_model("boussinesq:nu=free").why, HasSubstr("it is a model of space"));
  EXPECT_THAT(check_layer_model("layer:dim=3").why, HasSubstr("dim = 3: the fit takes it"));
  EXPECT_THAT(check_layer_model("layer:h=free").why, HasSubstr("the fit takes it from the data"));
  EXPECT_THAT(check_layer_model("osl:mu=free").why, HasSubstr("no model of a body under a load"));
  EXPECT_EQ(check_layer_model("layer:base=rough,nu=free").is, ModelText::Is::model);
}

}  // namespace
}  // namespace grainfield::coupling
