// Maps of E and nu: exactness, edges, interpolation, file.
#include "coupling/elastic_constants/elastic_map.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "elastic_scene.h"

namespace grainfield::coupling {
namespace {

using test::make_increments;
using test::Recipe;
using test::refusal_text;

class ElasticMapTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("grainfield_elastic_map_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string put(const std::string& text) const {
    std::ofstream(file("map.csv")) << text;
    return file("map.csv");
  }
  std::filesystem::path folder_;
};

ElasticMapOptions options() {
  ElasticMapOptions o;
  o.x0 = -0.5;
  o.x1 = 1.5;
  o.nx = 9;
  o.y0 = 0;
  o.y1 = 1;
  o.ny = 5;
  o.width = 0.15;
  o.fit.bootstrap.resamples = 20;
  return o;
}

Increments linear_material(int realizations = 1, double noise = 0) {
  Recipe recipe;
  recipe.points = grid_points(0, 1, 21, 0, 1, 21);
  recipe.c = [](const Eigen::Vector2d& x) {
    return test::isotropic(1e6 * (2 + x.x()), 1e6 * (1 + 0.2 * x.y()));
  };
  recipe.realizations = realizations;
  recipe.stress_noise = noise;
  return make_increments(1, recipe);
}

double young_at(double x, double y) {
  const double k = 1e6 * (2 + x), g = 1e6 * (1 + 0.2 * y);
  return 3 * g - g * g / k;
}
double poisson_at(double x, double y) { return (1 - (1 + 0.2 * y) / (2 + x)) / 2; }

TEST_F(ElasticMapTest, LinearMaterialIsExactAtNodesAndNanOutside) {
  const ElasticMap map = elastic_map(linear_material(), options());
  int inside = 0;
  for (int iy = 0; iy < map.ny; ++iy)
    for (int ix = 0; ix < map.nx; ++ix) {
      const double x = map.x0 + ix * map.dx, y = map.y0 + iy * map.dy;
      const ElasticMap::Values v = map.at(x, y);
      if (x < -0.29 || x > 1.29) {
        EXPECT_TRUE(std::isnan(v.young) && std::isnan(v.poisson)) << x << " " << y;
        continue;
      }
      if (x < 0 || x > 1) continue;  // the linear fit goes on beyond the points, as far as they see
      ++inside;
      EXPECT_NEAR(v.young / young_at(x, y), 1, 1e-8);
      EXPECT_NEAR(v.poisson, poisson_at(x, y), 1e-8);
    }
  EXPECT_EQ(inside, 25);
  // Between the nodes the bilinear error is of second order: below 0.1 %.
  for (double x = 0.01; x < 1; x += 0.07)
    EXPECT_NEAR(map.at(x, 0.33).young / young_at(x, 0.33), 1, 3e-3);
  for (const auto& [x, y] :
       {std::pair{-0.6, 0.5}, {1.6, 0.5}, {0.5, -0.01}, {0.5, 1.01}, {NAN, 0.5}})
    EXPECT_TRUE(std::isnan(map.at(x, y).young));
  EXPECT_TRUE(std::isnan(map.young_error[12]));
}

TEST_F(ElasticMapTest, BilinearByHand) {
  ElasticMap map;
  map.x0 = 1;
  map.y0 = 2;
  map.dx = 0.5;
  map.dy = 2;
  map.nx = 3;
  map.ny = 2;
  map.young = Eigen::VectorXd(6);
  map.young << 10, 20, NAN, 30, 60, 50;
  map.poisson = Eigen::VectorXd::Constant(6, 0.3);
  map.young_error = map.poisson_error = Eigen::VectorXd::Constant(6, 1);
  EXPECT_DOUBLE_EQ(map.at(1.25, 3).young, 30);
  EXPECT_DOUBLE_EQ(map.at(1.25, 2).young, 15);
  EXPECT_DOUBLE_EQ(map.at(1.5, 2).young, 20);  // beside a node without value
  EXPECT_DOUBLE_EQ(map.at(2, 4).young, 50);
  EXPECT_TRUE(std::isnan(map.at(1.75, 2).young));
  const ElasticMap full = map.filled();
  EXPECT_DOUBLE_EQ(full.young[2], 20);
  EXPECT_TRUE(std::isnan(full.young_error[2]));
  EXPECT_DOUBLE_EQ(full.young[5], 50);
  map.young.setConstant(NAN);
  EXPECT_EQ(refusal_text([&] { map.filled(); }),
            "an elastic map without any value cannot be filled");
}

TEST_F(ElasticMapTest, ErrorsAndThreads) {
  ElasticMapOptions o = options();
  const Increments data = linear_material(5, 20);
  const ElasticMap one = elastic_map(data, o);
  o.fit.bootstrap.threads = 3;
  const ElasticMap three = elastic_map(data, o);
  EXPECT_EQ(std::memcmp(one.young.data(), three.young.data(), 45 * sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(one.poisson_error.data(), three.poisson_error.data(), 45 * sizeof(double)),
            0);
  // Node (0.5, 0.5) is number 22.
  EXPECT_GT(one.young_error[22], 0);
  EXPECT_NEAR(one.young[22], young_at(0.5, 0.5), 8 * one.young_error[22]);
  // A material that softens under load has no E that a solve could take.
  Increments unstable = data;
  for (Eigen::MatrixX3d& s : unstable.stress) s = -s;
  EXPECT_TRUE(elastic_map(unstable, o).young.array().isNaN().all());
}

TEST_F(ElasticMapTest, FileRoundTrip) {
  const ElasticMap map = elastic_map(linear_material(3, 20), options());
  write_elastic_map(file("m.csv"), map);
  const ElasticMap back = read_elastic_map(file("m.csv"));
  EXPECT_EQ(back.nx, map.nx);
  EXPECT_EQ(back.ny, map.ny);
  EXPECT_DOUBLE_EQ(back.x0, map.x0);
  EXPECT_DOUBLE_EQ(back.y0, map.y0);
  EXPECT_DOUBLE_EQ(back.dx, map.dx);
  EXPECT_DOUBLE_EQ(back.dy, map.dy);
  int known = 0;
  const auto same = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    ASSERT_EQ(a.size(), b.size());
    for (Eigen::Index k = 0; k < a.size(); ++k) {
      EXPECT_TRUE(a[k] == b[k] || (std::isnan(a[k]) && std::isnan(b[k]))) << k;
      known += !std::isnan(a[k]);
    }
  };
  same(map.young, back.young);
  same(map.poisson, back.poisson);
  same(map.young_error, back.young_error);
  same(map.poisson_error, back.poisson_error);
  EXPECT_GE(known, 100);
}

TEST_F(ElasticMapTest, BrokenFiles) {
  const std::string head = "# a map\nx,y,young,poisson,young_error,poisson_error\n";
  const std::string good = "0,0,1,0.2,nan,nan\n1,0,1,0.2,nan,nan\n0,1,1,0.2,nan,nan\n";
  const auto refusal = [&](const std::string& text) {
    const std::string name = put(text);
    const std::string text_found = refusal_text([&] { read_elastic_map(name); });
    return text_found.substr(std::min(name.size(), text_found.size()));
  };
  EXPECT_EQ(refusal(head + good + "1,1,nan,nan,nan,nan\r\n\n"), "");
  EXPECT_EQ(refusal(head + good + "1,1,1,0.2,nan\n"),
            ":6: \"1,1,1,0.2,nan\" is not six numbers separated by commas");
  EXPECT_EQ(refusal(head + good + "1,1,1,0.2,nan,nan,3\n"),
            ":6: \"1,1,1,0.2,nan,nan,3\" is not six numbers separated by commas");
  EXPECT_EQ(refusal(head + good + "1,1,x,0.2,nan,nan\n"),
            ":6: \"1,1,x,0.2,nan,nan\" is not six numbers separated by commas");
  EXPECT_EQ(refusal(head + good + "1,1,-2,0.2,nan,nan\n"),
            ":6: young is -2; it must be positive (or nan)");
  EXPECT_EQ(refusal(head + good + "1,1,2,0.5,nan,nan\n"),
            ":6: poisson is 0.5; it must be between -1 and 0.5 (or nan)");
  EXPECT_EQ(refusal(head + good + "nan,1,2,0.4,nan,nan\n"), ":6: a node's place is not finite");
  EXPECT_EQ(refusal(head + good + "1.1,1,2,0.4,nan,nan\n"),
            ":6: node (1.1, 1) is not on the regular grid, which has (1, 1) here");
  EXPECT_EQ(refusal(head + good),
            ": 3 nodes with 2 in the first row form no grid of at least 2 x 2");
  EXPECT_EQ(refusal(head), ": 0 nodes with 0 in the first row form no grid of at least 2 x 2");
  EXPECT_EQ(refusal("# a map\n"), ":1: no header \"x,y,young,poisson,young_error,poisson_error\"");
  EXPECT_EQ(refusal("x,y,E\n"),
            ":1: the header is \"x,y,E\"; it must be "
            "\"x,y,young,poisson,young_error,poisson_error\"");
  EXPECT_EQ(refusal(head + "1,0,1,0.2,1,1\n0,0,1,0.2,1,1\n1,1,1,0.2,1,1\n0,1,1,0.2,1,1\n"),
            ": x and y of the nodes must ascend, x fastest");
  EXPECT_EQ(refusal_text([&] { read_elastic_map("/nowhere/map.csv"); }),
            "/nowhere/map.csv: no such file");
}

TEST_F(ElasticMapTest, Refusals) {
  const Increments data = linear_material();
  const auto refusal = [&](const std::function<void(ElasticMapOptions&)>& change) {
    ElasticMapOptions o = options();
    change(o);
    return refusal_text([&] { elastic_map(data, o); });
  };
  EXPECT_EQ(refusal([](auto& o) { o.nx = 1; }),
            "an elastic map of 1 x 5 nodes; at least 2 x 2 are needed");
  EXPECT_EQ(
      refusal([](auto& o) { o.x1 = -1; }),
      "an elastic map over x -0.5 to -1 m, y 0 to 1 m; the ends must be finite and ascending");
  EXPECT_EQ(refusal([](auto& o) { o.width = 0; }),
            "width of the elastic map's kernel is 0 m; it must be positive");
  EXPECT_EQ(refusal([](auto& o) { o.least_points = 0; }),
            "elastic map from at least 0 points; it must be 1 or more");
  EXPECT_EQ(refusal([](auto& o) { o.fit.degree = 3; }),
            "degree of the elastic fit is 3; it must be 0 or 1");
  EXPECT_EQ(refusal_text([] { elastic_map({}, options()); }),
            "elastic constants need at least one realization");
}

}  // namespace
}  // namespace grainfield::coupling
