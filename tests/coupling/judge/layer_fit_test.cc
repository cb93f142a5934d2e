// Fits of layers under a point load: how models are seen, constants that come back, the verdict.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "continuum/model.h"
#include "coupling/compare/compare.h"
#include "coupling/compare/smooth.h"
#include "coupling/fit/posteriors.h"
#include "tests/coupling/layer_fit_scene.h"

namespace grainfield::coupling {
namespace {

using testing::HasSubstr;

const LayerScene& scene() {
  static const LayerScene one = layer_scene();
  return one;
}

// The registry's model with the same constants, smoothed node by node.
Eigen::MatrixXd seen_directly(const ModelChoice& choice, const Eigen::MatrixXd& points,
                              const Kernel& kernel) {
  continuum::Settings settings = choice.settings;
  settings["F"] = "1";
  if (family_of(choice.name) != "half plane") settings["h"] = "1";
  const auto model = continuum::make_model(choice.name, settings);
  const StressFunction stress = [&](const Eigen::MatrixXd& at) { return model->stress(at); };
  Eigen::MatrixXd out(points.rows(), 3);
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const Eigen::MatrixXd here = points.row(k);
    const double depth = family_of(choice.name) == "half plane" ? 0 : 1;
    out.row(k) =
        (here(0, 1) == -1 ? nodes_along_x(here, kernel) : nodes_in_plane(here, kernel, depth))
            .of(stress);
  }
  return out;
}

Fit with_parameters(const std::string& name, const Eigen::VectorXd& p) {
  Fit out;
  out.name = name;
  out.equations = find_fit_model(scene().models, name).equations;
  out.kind = find_fit_model(scene().models, name).kind;
  for (Eigen::Index k = 0; k < p.size(); ++k) {
    FittedParameter f;
    f.parameter = find_fit_model(scene().models, name).parameters[static_cast<std::size_t>(k)];
    f.value = p[k];
    out.parameters.push_back(f);
  }
  out.correlation = Eigen::MatrixXd::Identity(p.size(), p.size());
  return out;
}

TEST(LayerVerdict, ContainsByWhatModelsAreAndNotByTheirNames) {
  const auto one = [](const char* name, const char* kind, int free) {
    Fit out;
    out.name = name;
    out.kind = kind;
    out.equations = "elliptic";
    out.parameters.resize(static_cast<std::size_t>(free));
    return out;
  };
  const Fit smooth = one("a", "layer smooth", 0), general = one("b", "orthotropic_layer smooth", 2);
  EXPECT_TRUE(contains(general, smooth));
  EXPECT_FALSE(contains(smooth, general));
  EXPECT_TRUE(contains(one("c", "layer rough", 1), one("d", "layer rough", 0)));
  EXPECT_FALSE(contains(one("c", "layer rough", 0), one("d", "layer rough", 1)));
  EXPECT_FALSE(contains(general, one("e", "layer rough", 1)));
  EXPECT_FALSE(contains(one("f", "orthotropic_layer smooth", 1), smooth));
  EXPECT_FALSE(contains(one("g", "", 7), one("h", "", 1)));
}

TEST(LayerFit, ModelsAreTheRegistrysSeenThroughTheKernel) {
  const auto kernel = make_kernel("lucy", 0.1);
  Eigen::MatrixXd points(6, 2);
  points << scene().sight->places().points().row(6), scene().sight->places().points().row(8),
      scene().sight->places().points().row(20), scene().sight->places().points().row(34),
      scene().sight->places().points().row(45), scene().sight->places().points().row(47);
  for (const LayerTruth& truth : layer_truths()) {
    const ModelChoice choice =
        registry_choice(find_fit_model(scene().models, truth.model), truth.parameters, 1);
    const Eigen::MatrixXd direct = seen_directly(choice, points, *kernel);
    const Eigen::MatrixXd fast =
        find_fit_model(scene().models, truth.model).stress(points, truth.parameters);
    EXPECT_LT((direct - fast).cwiseAbs().maxCoeff(), 2e-3 * direct.cwiseAbs().maxCoeff())
        << truth.model << "\n"
        << direct << "\n\n"
        << fast;
  }
}

TEST(LayerFit, RefusesPointsItDoesNotKnow) {
  Eigen::MatrixXd point(1, 2);
  point << 0.1234, -0.5;
  EXPECT_THROW(scene().models.front().stress(point, Eigen::VectorXd(0)), std::logic_error);
}

TEST(LayerFit, WithoutNoiseTheConstantsComeBack) {
  dem::Random random(1);
  for (const LayerTruth& truth : layer_truths()) {
    const FitData data = with_noise(scene(), truth.model, truth.parameters, 1, 0, random);
    FitOptions options;
    options.bootstrap = 0;
    const Fit f = fit(data, weights_of(data), find_fit_model(scene().models, truth.model), options);
    EXPECT_LT(f.rel_l2, 1e-5) << truth.model;
    for (Eigen::Index k = 0; k < truth.parameters.size(); ++k) {
      EXPECT_NEAR(f.parameters[static_cast<std::size_t>(k)].value, truth.parameters[k], 2e-3)
          << truth.model << " " << f.parameters[static_cast<std::size_t>(k)].parameter.name;
    }
  }
}

TEST(LayerFit, FiniteElementsTakeTheBestFitsConstants) {
  std::vector<Fit> fits{with_parameters("layer_smooth", vector({})),
                        with_parameters("layer_rough", vector({0.27})),
                        with_parameters("orthotropic_layer_rough", vector({0.6, 0.6, 0.4})),
                        with_parameters("osl_layer_absorbing", vector({0.5, 0.1, 0.6}))};
  fits[1].expected = -10;
  std::vector<FitModel> models;
  for (const Fit& f : fits) models.push_back(find_fit_model(scene().models, f.name));
  std::string of;
  auto choice = finite_element_choice("fe_elastic_layer", models, fits, 0.2, of);
  ASSERT_TRUE(choice);
  EXPECT_EQ(of, "layer_rough");
  EXPECT_EQ(choice->settings.at("nu"), "0.27");
  EXPECT_EQ(choice->settings.at("base"), "rough");
  choice = finite_element_choice("fe_osl_layer", models, fits, 0.2, of);
  ASSERT_TRUE(choice);
  EXPECT_NEAR(std::stod(choice->settings.at("width")), 0.12, 1e-12);
  EXPECT_EQ(choice->settings.count("base"), 0U);
  choice = finite_element_choice("fe_orthotropic_layer", models, fits, 0.2, of);
  ASSERT_TRUE(choice);
  const double t = std::stod(choice->settings.at("t"));
  EXPECT_NEAR(t, 0.6, 1e-12);
  EXPECT_NEAR(std::stod(choice->settings.at("r")) / std::sqrt(t), 0.2, 1e-9);  // shear - nu_ratio
  EXPECT_NEAR(std::stod(choice->settings.at("nu_xy")) / std::sqrt(t), 0.4, 1e-9);
  EXPECT_FALSE(finite_element_choice("fe_elastic_half_space", models, fits, 0.2, of));
}

TEST(Posteriors, DrawEveryParameterWithAnError) {
  Fit f = with_parameters("layer_rough", vector({0.3}));
  EXPECT_TRUE(posterior_sections({&f}, 8).empty());
  f.parameters[0].error = f.parameters[0].covariance_error = 0.05;
  f.parameters[0].bootstrap_error = 0.06;
  const auto sections = posterior_sections({&f}, 8);
  ASSERT_EQ(sections.size(), 1U);
  EXPECT_THAT(std::get<Picture>(sections[0]).program, HasSubstr("nu of layer_rough"));
}

}  // namespace
}  // namespace grainfield::coupling
