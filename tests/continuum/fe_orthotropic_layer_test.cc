// The orthotropic layer against a Fourier transform of its own, the closed isotropic layer and,
// deep layers, the closed half plane; maps of constants.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>

#include "continuum/closed/orthotropic.h"
#include "continuum/model.h"

using namespace grainfield::continuum;
using testing::HasSubstr;

namespace {

Points along(double depth, double least, double most, int n) {
  Points points(n, 2);
  for (int i = 0; i < n; ++i) points.row(i) << least + (most - least) * i / (n - 1), -depth;
  return points;
}

std::string text_of(double value) {
  std::ostringstream out;
  out.precision(17);
  out << value;
  return out.str();
}

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

class Map {
 public:
  Map(const std::string& header, const std::function<std::string(double, double)>& values)
      : file_(std::filesystem::temp_directory_path() /
              ("grainfield_orthotropic_" + std::to_string(::getpid()) + ".csv")) {
    std::ofstream out(file_);
    out << "# a map\nx,y," << header << "\n";
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 8; ++i) {
        const double x = -4 + i, y = -1 + 0.25 * j;
        out << x << "," << y << "," << values(x, y) << "\n";
      }
  }
  ~Map() { std::filesystem::remove(file_); }
  std::string file() const { return file_.string(); }

 private:
  std::filesystem::path file_;
};

std::string refusal(const Settings& settings) {
  try {
    make_model("fe_orthotropic_layer", settings);
  } catch (const BadParameter& error) {
    return error.what();
  }
  return "accepted";
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

TEST(FeOrthotropicLayer, RefusesWhatCannotBe) {
  EXPECT_THAT(refusal({{"r", "-1"}}), HasSubstr("r = -1 is not elastic; allowed: above -sqrt(t)"));
  EXPECT_THAT(refusal({{"base", "rough"}}), HasSubstr("nu_xy is not set; a rough base needs it, "
                                                      "allowed: between -1 and 1"));
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
