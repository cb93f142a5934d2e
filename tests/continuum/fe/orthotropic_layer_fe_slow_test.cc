// The closed orthotropic layer beside its finite elements: two ways to the same field.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "continuum/model.h"

using namespace grainfield::continuum;

TEST(OrthotropicLayer, FiniteElementsAgree) {
  Points points(9, 2);
  points << 0, -0.4, 0.2, -0.4, -0.7, -0.4, 0, -0.75, 0.5, -0.75, 1.2, -0.75, 0, -1, 0.4, -1, 1, -1;
  struct {
    double r, t, nu;
  } const media[] = {{1, 1, 0.3}, {0.4, 2, 0.3}, {-0.4, 1, 0.6}};
  for (const auto& m : media) {
    for (const char* base : {"smooth", "rough"}) {
      const Settings settings{{"r", fmt::format("{}", m.r)},
                              {"t", fmt::format("{}", m.t)},
                              {"nu_xy", fmt::format("{}", m.nu)},
                              {"base", base}};
      const Stresses closed = make_model("orthotropic_layer", settings)->stress(points);
      const Stresses elements = make_model("fe_orthotropic_layer", settings)->stress(points);
      // The elements' own tolerance is 2e-4 of F/h, their half width 8 h.
      EXPECT_LT((closed - elements).cwiseAbs().maxCoeff(), 2e-3) << m.r << " " << base << "\n"
                                                                 << closed << "\n\n"
                                                                 << elements;
    }
  }
}
