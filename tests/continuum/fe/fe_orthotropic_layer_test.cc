// The orthotropic layer against the closed isotropic layer and, deep layers, the closed half plane;
// maps of one material; refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "continuum/closed/orthotropic.h"
#include "continuum/model.h"
#include "tests/continuum/orthotropic_layer_oracle.h"
#include "tests/continuum/orthotropic_layer_scene.h"
#include "tests/continuum/refused_model.h"

using namespace grainfield::continuum;
using grainfield::continuum::testing::along;
using grainfield::continuum::testing::exact_base;
using grainfield::continuum::testing::Map;
using grainfield::continuum::testing::text_of;
using ::testing::HasSubstr;

namespace {

std::string refusal(const Settings& settings) {
  return grainfield::continuum::refusal("fe_orthotropic_layer", settings);
}

}  // namespace

TEST(FeOrthotropicLayer, IsotropicConstantsAreTheIsotropicLayer) {
  const double E = 1e7, nu = 0.3;
  const PlaneModuli m = plane_strain_moduli(E, nu);
  for (const char* base : {"smooth", "rough"}) {
    const auto elements = make_model("fe_orthotropic_layer", {{"F", "300"},
                                                              {"h", "0.15"},
                                                              {"base", base},
                                                              {"E_x", text_of(m.E_x)},
                                                              {"E_y", text_of(m.E_y)},
                                                              {"G", text_of(m.G)},
                                                              {"nu_xy", text_of(m.nu_xy)}});
    const Settings settings = {{"F", "300"}, {"h", "0.15"}, {"base", base}, {"nu", "0.3"}};
    const auto closed = make_model("layer", settings);
    const auto isotropic = make_model("fe_elastic_layer", settings);
    for (const double depth : {0.15, 0.1, 0.03}) {
      const Points points = along(depth, -0.6, 0.6, 49);
      const Stresses expected = closed->stress(points), found = elements->stress(points);
      const double peak = expected.col(1).cwiseAbs().maxCoeff();
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-3 * peak) << base << " " << depth;
      // The same elements on the same mesh, and the same split of the displacement.
      EXPECT_LT((found - isotropic->stress(points)).cwiseAbs().maxCoeff(), 1e-7 * peak);
    }
  }
}

// What the base at h adds is smooth, of order F/h and without traction on the surface: at depth d
// it is d/h of the half plane's stress, of the vertical stress (d/h)^3.
TEST(FeOrthotropicLayer, DeepLayerIsTheHalfPlane) {
  for (const auto& [r, t] : {std::pair{1.5, 2.}, {-0.5, 1.}}) {
    const Settings medium = {{"r", text_of(r)}, {"t", text_of(t)}, {"F", "2"}};
    const auto half_plane = make_model("orthotropic_half_plane", medium);
    const auto layer = make_model("fe_orthotropic_layer", medium);
    double before = 0;
    for (const double depth : {0.1, 0.05, 0.025, 0.0125}) {
      const Points points = along(depth, -2 * depth, 2 * depth, 17);
      const Stresses exact = half_plane->stress(points);
      const Stresses difference = layer->stress(points) - exact;
      const double size = exact.cwiseAbs().maxCoeff();
      const double error = difference.cwiseAbs().maxCoeff() / size;
      EXPECT_LT(error, 1.2 * depth) << r;
      EXPECT_LT(difference.col(1).cwiseAbs().maxCoeff(), (10 * std::pow(depth, 3) + 2e-5) * size)
          << r << " at " << depth;
      if (before > 0) {
        EXPECT_NEAR(error / before, 0.5, 0.08) << r << " at " << depth;
      }
      before = error;
    }
  }
}

TEST(FeOrthotropicLayer, MapOfOneMaterialIsThatMaterial) {
  const Points points = along(1, -2, 2, 9);
  const PlaneModuli m = plane_strain_moduli(3, 0.25);
  for (const char* base : {"smooth", "rough"}) {
    const Stresses isotropic =
        make_model("layer", {{"base", base}, {"nu", "0.25"}})->stress(points);
    // Nodes without a value take the nearest one's; errors are not used.
    const Map map("young,poisson,young_error,poisson_error", [](double x, double y) {
      return x < -2.5 && y < -0.5 ? "nan,nan,nan,nan" : "3,0.25,0.1,nan";
    });
    const Stresses mapped =
        make_model("fe_orthotropic_layer", {{"base", base}, {"map", map.file()}})->stress(points);
    EXPECT_LT((mapped - isotropic).cwiseAbs().maxCoeff(), 1e-3) << base;
    const Map four("E_x,E_y,nu_xy,G", [&](double, double) {
      return text_of(m.E_x) + "," + text_of(m.E_y) + "," + text_of(m.nu_xy) + "," + text_of(m.G);
    });
    const auto same = make_model("fe_orthotropic_layer", {{"base", base}, {"map", four.file()}});
    EXPECT_LT((same->stress(points) - mapped).cwiseAbs().maxCoeff(), 1e-8);
  }
}

// One peak on the base becomes two where the curvature of the pressure below the load changes sign:
// not at r = 0 as in the half plane, and not at the same r on both bases.
TEST(FeOrthotropicLayer, PassageFromOnePeakToTwoDependsOnTheBase) {
  const auto curvature = [](double r, bool rough) {
    return exact_base({r, 1}, 0.95, rough, 0).curvature;
  };
  for (const auto& [rough, one, two] : {std::tuple{false, 0.04, 0.02}, {true, 0.14, 0.12}}) {
    EXPECT_LT(curvature(one, rough), -0.01) << rough;
    EXPECT_GT(curvature(two, rough), 0.01) << rough;
  }
  EXPECT_LT(curvature(0.1, false), -0.2);
  EXPECT_GT(curvature(0.1, true), 0.09);
  // The curvature is that of the pressure.
  for (const bool rough : {false, true}) {
    const double step = 0.05;
    const auto pressure = [&](double x) { return exact_base({0.1, 1}, 0.95, rough, x).pressure; };
    EXPECT_NEAR(2 * (pressure(step) - pressure(0)) / (step * step), curvature(0.1, rough), 0.02);
  }
}

TEST(FeOrthotropicLayer, NuIsReportedOnlyWhereItIsKnown) {
  // A figure needs no solve: it is known from the settings.
  const auto figures = [](const Settings& settings) {
    return make_model("fe_orthotropic_layer", settings)->figures();
  };
  EXPECT_EQ(figures({{"r", "0.4"}}).count("nu_xy"), 0u);
  EXPECT_EQ(figures({{"r", "0.4"}, {"nu_xy", "0.3"}}).at("nu_xy"), 0.3);
  EXPECT_EQ(figures({{"sides", "smooth"}, {"nu_xy", "0.3"}}).at("nu_xy"), 0.3);
}

TEST(FeOrthotropicLayer, RefusesWhatCannotBe) {
  EXPECT_THAT(refusal({{"r", "-1"}}), HasSubstr("r = -1 is not elastic; allowed: above -sqrt(t)"));
  EXPECT_THAT(refusal({{"base", "rough"}}),
              HasSubstr("nu_xy is not set; base = rough needs it, allowed: between -1 and 1"));
  EXPECT_THAT(refusal({{"sides", "smooth"}, {"r", "-0.5"}}),
              HasSubstr("nu_xy is not set; sides = smooth needs it, allowed: between 0.5 and 1"));
  EXPECT_THAT(refusal({{"r", "-0.5"}, {"nu_xy", "0.3"}}),
              HasSubstr("nu_xy = 0.3 is not elastic with r = -0.5, t = 1; allowed: between "
                        "max(-r, -sqrt(t)) = 0.5 and sqrt(t) = 1"));
  EXPECT_THAT(refusal({{"E_x", "1"}, {"G", "1"}}),
              HasSubstr("found 2 of E_x, E_y, G, nu_xy; allowed: all four, or r and t"));
  EXPECT_THAT(refusal({{"E_x", "1"}, {"E_y", "4"}, {"G", "1"}, {"nu_xy", "0.6"}}),
              HasSubstr("nu_xy = 0.6 is not elastic; allowed: between -0.5 and 0.5"));
  EXPECT_THAT(refusal({{"map", "/nowhere.csv"}}), HasSubstr("/nowhere.csv: cannot be opened"));
  const auto refused = [](const std::string& header, const std::string& row) {
    const Map map(header, [&](double, double) { return row; });
    return refusal({{"map", map.file()}});
  };
  EXPECT_THAT(refused("young,poisson", "1,0.5"), HasSubstr("poisson = 0.5 at (-4, -1)"));
  EXPECT_THAT(refused("young,poisson", "nan,nan"), HasSubstr("no node has elastic constants"));
  EXPECT_THAT(refused("young,eta", "1,1"), HasSubstr("the header is \"x,y,young,eta\"; allowed:"));
  EXPECT_THAT(refused("young", "1"), HasSubstr("neither or both of young,poisson and E_x"));
  EXPECT_THAT(refused("E_x,E_y,nu_xy,G", "1,1,1,1"), HasSubstr("nu_xy = 1, G = 1 at (-4, -1)"));
}

// The share of the layer that a map has constants for is a figure, and below a quarter on either
// side of the load it is refused.
TEST(FeOrthotropicLayer, MapMustCoverTheLayer) {
  const auto share = [](const Map& map, const char* half_width) {
    return make_model("fe_orthotropic_layer", {{"map", map.file()}, {"half_width", half_width}})
        ->figures()
        .at("map_share");
  };
  {
    const Map all("young,poisson", [](double, double) { return "3,0.25"; });
    EXPECT_EQ(share(all, "4"), 1);
    EXPECT_NEAR(share(all, "8"), 0.5, 0.01);
    EXPECT_THAT(
        refusal({{"map", all.file()}, {"half_width", "20"}}),
        HasSubstr("model fe_orthotropic_layer: map = " + all.file() +
                  " has constants for 20 % of the layer's left half; allowed: 25 % or more; take "
                  "half_width (in depths) to fit the map, whose load is at (0, 0)"));
    // Below the load only.
    EXPECT_THAT(refusal({{"map", all.file()}, {"h", "0.001"}, {"half_width", "1000"}}), "accepted");
    EXPECT_THAT(refusal({{"map", all.file()}, {"h", "10"}, {"half_width", "1"}}),
                HasSubstr("of the layer's left half"));
  }
  {
    // Filled-in nodes do not count.
    const Map left("young,poisson",
                   [](double x, double) { return x > 0.5 ? "nan,nan" : "3,0.25"; });
    EXPECT_THAT(refusal({{"map", left.file()}, {"half_width", "4"}}),
                HasSubstr("has constants for 12.5 % of the layer's right half"));
  }
  {
    const Map half("young,poisson",
                   [](double, double y) { return y < -0.6 ? "nan,nan" : "3,0.25"; });
    EXPECT_NEAR(share(half, "4"), 0.625, 0.02);
  }
}
