// Models of the registry in fits of heaps: which of their numbers may be free, and that they come
// back.
#include "coupling/fit/open_models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/fit/layer_models.h"
#include "coupling/observe/observations.h"
#include "coupling/result/tables.h"
#include "tests/coupling/fit_scene.h"
#include "tests/coupling/open_models_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

FitModel heap_model(const std::string& text) {
  const HeapFacts facts{kSlope, kRhoG, kHeight};
  const RegistryEntry entry = chosen_entries(
                                  {text}, heap_entries(facts),
                                  [&](const std::string& name) { return facts_of(facts, name); }, 1)
                                  .front();
  return model_of_entry(entry, facts_of(facts, entry.registry));
}

TEST(OpenModels, OfHeapsComeBackWithErrors) {
  for (const auto& [text, truth] : std::vector<std::pair<std::string, Eigen::VectorXd>>{
           {"held=osl:eta=0.74,mu=free", vector({-0.31})},
           {"angles=osl:K=free,tau_deg=80", vector({0.6})},
           {"axis=osl:K=2.2,tau_deg=free", vector({91})},  // about mu = 0
           {"both=osl:K=free,tau_deg=free", vector({1.8, 89})},
           {"osl:eta=free,mu=free", vector({0.7, -0.2})}}) {
    const FitModel model = heap_model(text);
    ASSERT_TRUE(model.absent.empty()) << model.absent;
    dem::Random random(3);
    FitData data = places(9);
    fill(data, predict(data, model, truth), 6, 0.01, 0.03, random);
    FitOptions options;
    options.bootstrap = 0;
    expect_back(fit(data, weights_of(data), model, options), truth);
  }
}

// Beyond its window there is no core that yields on a ray: the end of the window is a bound.
TEST(OpenModels, TheEndOfAModelIsABound) {
  const FitModel model =
      heap_model("cantelaube_asymmetric:yield_ray_deg=free,branch=minus,left_deg=30,right_deg=30");
  ASSERT_TRUE(model.absent.empty()) << model.absent;
  dem::Random random(3);
  FitData data = places(9);
  fill(data, predict(data, heap_model("cantelaube:beta_hat_deg=45"), Eigen::VectorXd(0)), 6, 0.01,
       0.03, random);
  FitOptions options;
  options.bootstrap = 0;
  const Fit found = fit(data, weights_of(data), model, options);
  const double ray = found.parameters.front().value;
  const auto exists = [&](double at) {
    int outside = 0;
    predict(data, model, vector({at}), &outside);
    return outside < data.values();
  };
  ASSERT_TRUE(exists(ray));
  const double step = 1e-6 * std::max(1.0, std::fabs(ray));
  ASSERT_FALSE(exists(ray + step) && exists(ray - step)) << ray;
  EXPECT_TRUE(found.parameters.front().at_bound);
  EXPECT_TRUE(std::isnan(found.parameters.front().error));
}

// A ratio's interval is even in its logarithm, whoever declares it.
TEST(OpenModels, RatiosKeepTheirFloor) {
  const auto facts = [](const std::string&) { return facts_of_layer(); };
  const RegistryEntry entry =
      chosen_entries({"orthotropic_layer:r=free,t=free,base=smooth"}, layer_entries(), facts, 1)
          .front();
  for (const FitParameter& p : entry.parameters) {
    EXPECT_EQ(p.floor == 0, p.name == "t") << p.name;
  }
  EXPECT_EQ(model_of_entry(entry, facts_of_layer()).kind, "orthotropic_layer smooth");
}

TEST(OpenModels, LabelsDoNotChangeThePlaces) {
  EXPECT_FALSE(takes_flanks_apart({"osl", "cantelaube_asymmetric_like=osl:eta=free,mu=free"}));
  EXPECT_TRUE(takes_flanks_apart({"x=cantelaube_asymmetric:phi_deg=free"}));
  EXPECT_TRUE(takes_flanks_apart({"cantelaube_asymmetric_flanks"}));
}

TEST(OpenModels, WithoutAFieldSayWhy) {
  EXPECT_THAT(heap_model("osl:K=free").absent, HasSubstr("allowed: eta, mu, eta with mu, or K"));
  EXPECT_THAT(heap_model("cantelaube:beta_hat_deg=80").absent, HasSubstr("is not inside the heap"));
}

TEST(OpenModels, HaveLabelsOfTheirOwn) {
  const auto entries = chosen_entries(
      {"osl", "osl:mu=free", "osl:eta=free", "x=ife", "bcc"}, heap_entries({}),
      [](const std::string& name) { return facts_of(HeapFacts{}, name); }, 1);
  std::vector<std::string> names;
  for (const RegistryEntry& entry : entries) names.push_back(entry.name);
  EXPECT_EQ(names, (std::vector<std::string>{"osl", "osl_2", "osl_3", "x", "bcc"}));
  EXPECT_EQ(entries[1].label, "osl_2=osl (mu=free)");
}

TEST(OpenModels, EveryRangeOfASearchIsAllowed) {
  for (const continuum::ModelInfo& info : continuum::registry()) {
    for (const continuum::Parameter& p : info.parameters) {
      if (!p.free) continue;
      EXPECT_LT(p.free->least, p.free->most) << info.name << " " << p.name;
      EXPECT_LE(p.free->most, p.most) << info.name << " " << p.name;
      EXPECT_GE(p.free->least, p.least) << info.name << " " << p.name;
      EXPECT_TRUE(p.choices.empty()) << info.name << " " << p.name;
      for (const char* known : {"F", "h", "rho_g"}) EXPECT_NE(p.name, known) << info.name;
    }
  }
}

TEST(OpenModels, OfHeapsAreRefused) {
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"osl:phi_deg=free", "model osl: phi_deg cannot be free; allowed: eta, mu, K, tau_deg"},
           {"osl:muu=free", "muu cannot be free; allowed: eta, mu, K, tau_deg; did you mean mu"},
           {"osl:mu=steep", "mu = 'steep' is not a number"},
           {"hydrostatic:level=free", "level cannot be free; allowed: none"},
           {"osl:rho_g=2", "rho_g = 2: the fit takes it from the data; leave it out"},
           {"osl:mu=free,mu=2", "mu is given twice"},
           {"cantelaube:branch=zero,beta_hat_deg=free", "branch = zero has no effect"},
           {"fe_osl_wedge:mu=free", "one solve takes as long as a whole search"},
           {"cone_osl:eta=free", "it is a model of space"},
           {"layer:nu=free",
            "no model of a heap of weight rho_g; allowed: hydrostatic, cantelaube"},
           {"liffman:bend=free", "no model of a heap of weight rho_g"},
           {"x y=osl:mu=free", "found the label 'x y'"},
           {"a=oslo:mu=free", "no model 'oslo'; did you mean 'osl'?"}}) {
    const ModelText found = check_heap_model(text);
    ASSERT_EQ(found.is, ModelText::Is::refused) << text;
    EXPECT_THAT(found.why, HasSubstr(words)) << text;
  }
  EXPECT_EQ(check_heap_model("ols").is, ModelText::Is::no_model);
  for (const char* good : {"osl", "ife", "osl:mu=free", "x=osl:K=free,tau_deg=70"}) {
    EXPECT_EQ(check_heap_model(good).is, ModelText::Is::model) << good;
  }
}

TEST(OpenModels, AreFittedByTheCommand) {
  const std::string heaps = std::string(GRAINFIELD_SOURCES) + "/cases/samples/heaps.h5";
  const Folder folder;
  const Output done = program("fit " + heaps +
                              " --model hydrostatic --model held=osl:eta=0.7,mu=free --set "
                              "fit.bootstrap=0 -o " +
                              (folder / "out"));
  ASSERT_EQ(done.code, 0) << done.err;
  const Summary summary = read_summary(folder / "out/summary.json");
  EXPECT_EQ(summary.count("fit.held.mu"), 1U);
  EXPECT_EQ(summary.count("fit.held.mu.error"), 1U);
  EXPECT_EQ(summary.count("fit.held.K"), 0U);
  const Output again = program("fit " + heaps + " --case " + (folder / "out/fit.toml") + " -o " +
                               (folder / "again"));
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST(OpenModels, AreRefusedByTheCommands) {
  const std::string heaps = std::string(GRAINFIELD_SOURCES) + "/cases/samples/heaps.h5";
  const Folder folder;
  const Output fit = program("fit " + heaps + " --model osl:phi_deg=free -o " + (folder / "out"));
  EXPECT_EQ(fit.code, 2);
  EXPECT_THAT(fit.err, HasSubstr("fit.models: model osl: phi_deg cannot be free"));
  ASSERT_EQ(program("average " + heaps + " --frame heap -o " + (folder / "f.h5")).code, 0);
  const Output compared =
      program("compare " + (folder / "f.h5") + " --model osl:mu=free -o " + (folder / "c"));
  EXPECT_EQ(compared.code, 2);
  EXPECT_THAT(compared.err, HasSubstr("mu = free is for `grainfield fit`"));
  EXPECT_EQ(std::count(compared.err.begin(), compared.err.end(), '\n'), 1) << compared.err;
}

}  // namespace
}  // namespace grainfield::coupling
