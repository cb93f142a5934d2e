// The orthotropic layer against a Fourier integral of its own; its load and peaks; maps of
// constants that vary.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "continuum/closed/orthotropic.h"
#include "continuum/model.h"
#include "orthotropic_layer_scene.h"

using namespace grainfield::continuum;
using grainfield::continuum::testing::along;
using grainfield::continuum::testing::Map;
using grainfield::continuum::testing::text_of;

namespace {

/// Pressure and shear on the base of a layer of depth 1 under F = 1. Airy's function is
/// (1/pi) Int g(k d) cos(k x) / k^2 dk with g'''' - 2 r g'' + t g = 0: g(0) = 1, g'(0) = 0; base:
/// g''' - (2 r + nu) g' = 0 (no vertical displacement) and g' = 0 (smooth) or g'' + nu g = 0.
Eigen::Vector2d exact_base(const Orthotropy& o, double nu, bool rough, double x) {
  using C = std::complex<double>;
  const C root = std::sqrt(C(o.r * o.r - o.t));
  const C exponents[] = {std::sqrt(C(o.r) + root), std::sqrt(C(o.r) - root)};
  const double decay = std::min(exponents[0].real(), exponents[1].real());
  const int n = 800;
  const double end = 30 / decay, step = end / n;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < n; ++i) {
    const double u = (i + 0.5) * step;
    Eigen::Matrix4cd m;
    Eigen::RowVector4cd g, g1;
    for (int k = 0; k < 4; ++k) {
      // exp(-l s) and exp(l (s - u)).
      const C l = k < 2 ? -exponents[k] : exponents[k - 2];
      const C top = k < 2 ? C(1) : std::exp(-l * u), base = k < 2 ? std::exp(l * u) : C(1);
      m(0, k) = top;
      m(1, k) = l * top;
      m(2, k) = (l * l * l - (2 * o.r + nu) * l) * base;
      m(3, k) = (rough ? l * l + nu : l) * base;
      g(k) = base;
      g1(k) = l * base;
    }
    const Eigen::Vector4cd a = m.fullPivLu().solve(Eigen::Vector4cd(1, 0, 0, 0));
    sum[0] += (g * a).value().real() * std::cos(u * x) * step;
    sum[1] += (g1 * a).value().real() * std::sin(u * x) * step;
  }
  return sum / M_PI;
}

}  // namespace

TEST(FeOrthotropicLayer, MeetsTheFourierTransformOnTheBase) {
  struct Medium {
    double r, t, nu;
  };
  for (const auto& [r, t, nu] : {Medium{-0.8, 1, 0.9}, {2.5, 0.4, 0.1}, {-0.2, 3, 1.1}}) {
    for (const bool rough : {false, true}) {
      const auto model = make_model("fe_orthotropic_layer", {{"r", text_of(r)},
                                                             {"t", text_of(t)},
                                                             {"nu_xy", text_of(nu)},
                                                             {"base", rough ? "rough" : "smooth"}});
      const Points points = along(1, 0, 3, 7);
      const Stresses found = model->stress(points);
      for (int i = 0; i < points.rows(); ++i) {
        const Eigen::Vector2d exact = exact_base({r, t}, nu, rough, points(i, 0));
        EXPECT_NEAR(-found(i, 1), exact[0], 5e-4) << r << " " << t << " " << rough;
        // y up: the shear of x and depth changes sign.
        EXPECT_NEAR(-found(i, 2), exact[1], 5e-4) << r << " " << t << " " << rough;
      }
      EXPECT_NEAR(model->figures().at("r"), r, 1e-12);
      EXPECT_NEAR(model->figures().at("t"), t, 1e-12);
    }
  }
}

TEST(FeOrthotropicLayer, BearsTheLoadAndShowsOnePeakOrTwo) {
  for (const auto& [r, t, base, peaks] : {std::tuple{1., 1., "smooth", 1},
                                          {0.2, 0.5, "rough", 1},
                                          {-0.7, 1., "smooth", 2},
                                          {-0.7, 1., "rough", 2}}) {
    const auto model = make_model(
        "fe_orthotropic_layer",
        {{"r", text_of(r)}, {"t", text_of(t)}, {"base", base}, {"nu_xy", r < 0 ? "0.8" : "0.3"}});
    const int n = 1601;
    const Points points = along(1, -8, 8, n);
    const Eigen::VectorXd pressure = -model->stress(points).col(1);
    EXPECT_NEAR(pressure.sum() * 16 / (n - 1), 1, 1e-3) << r;
    int found = 0;
    for (int i = 1; i < n - 1; ++i)
      found += pressure[i] > 0.1 && pressure[i] > pressure[i - 1] && pressure[i] >= pressure[i + 1];
    EXPECT_EQ(found, peaks) << r << " " << base;
  }
}

TEST(FeOrthotropicLayer, MapThatIsMirroredMirrorsTheStress) {
  const auto young = [](double x, double y) {
    return text_of(1 + 0.2 * x / 4 - 0.5 * y) + "," + text_of(0.3 + 0.02 * x);
  };
  const Points points = along(1, -2, 2, 9);
  const char* base = "rough";
  {
    Stresses there, back;
    {
      const Map map("young,poisson", young);
      there =
          make_model("fe_orthotropic_layer", {{"base", base}, {"map", map.file()}})->stress(points);
    }
    {
      const Map map("young,poisson", [&](double x, double y) { return young(-x, y); });
      back =
          make_model("fe_orthotropic_layer", {{"base", base}, {"map", map.file()}})->stress(points);
    }
    EXPECT_GT((there - there.colwise().reverse()).cwiseAbs().maxCoeff(), 5e-3);
    Stresses mirrored = back.colwise().reverse();
    mirrored.col(2) *= -1;
    EXPECT_LT((there - mirrored).cwiseAbs().maxCoeff(), 1e-5);
    // What a map changes, it only moves.
    const Points base_points = along(1, -8, 8, 801);
    const Map map("young,poisson", young);
    const Eigen::VectorXd pressure =
        -make_model("fe_orthotropic_layer", {{"base", base}, {"map", map.file()}})
             ->stress(base_points)
             .col(1);
    EXPECT_NEAR(pressure.sum() * 16 / 800, 1, 1e-3);
  }
}
