// The registered models of oriented stress linearity: finite elements, marching and the closed
// forms side by side, in the project's axes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "continuum/model.h"
#include "tests/continuum/osl_exact.h"

using namespace grainfield::continuum;
using testing::HasSubstr;

namespace {

Points grid(double half_width, double depth, int n) {
  Points points(n * n, 2);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      points.row(i * n + j) << half_width * (-1 + (2 * i + 1.) / n), -depth * (j + 1) / n;
  return points;
}

/// Largest difference where both have values, and the same places without.
double difference(const Stresses& a, const Stresses& b) {
  double largest = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    EXPECT_EQ(a.row(i).hasNaN(), b.row(i).hasNaN()) << i;
    if (!a.row(i).hasNaN() && !b.row(i).hasNaN())
      largest = std::max(largest, (a.row(i) - b.row(i)).cwiseAbs().maxCoeff());
  }
  return largest;
}

std::string refusal(const std::string& model, const Settings& settings) {
  try {
    make_model(model, settings)->stress((Points(1, 2) << 0, -0.5).finished());
  } catch (const BadParameter& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}

/// physics.md section 4 with rho g = 1 in the project's axes; eta such that the slope yields.
Stresses heap(const Points& points, double phi_deg, double mu) {
  const double t = std::tan(phi_deg * std::numbers::pi / 180), c = 1 / t;
  const osl::exact::Constants k{(1 - mu * t) / (1 + 2 * t * t), mu};
  Stresses out = Stresses::Constant(points.rows(), 3, NAN);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const double x = points(i, 0), y = -points(i, 1);
    if (!(std::abs(x) < c * y)) continue;
    const osl::State u = osl::exact::closed_form(k, c, x, y);
    out.row(i) << -k.eta * u[0] - mu * (x < 0 ? -1 : 1) * u[1], -u[0], u[1];
  }
  return out;
}

/// A load spread as 1 + cos over the width runs down both characteristics.
Stresses pulses(const Points& points, double load, double eta, double mu, double width) {
  const osl::exact::Constants k{eta, mu};
  const auto pressure = [=](double x) {
    return std::abs(x) < width / 2 ? load / width * (1 + std::cos(2 * std::numbers::pi * x / width))
                                   : 0;
  };
  Stresses out(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const double x = points(i, 0), y = -points(i, 1), c1 = k.c1(), c2 = k.c2();
    const double f1 = -c2 / (c1 - c2) * pressure(x - c1 * y);
    const double f2 = c1 / (c1 - c2) * pressure(x - c2 * y);
    out.row(i) << -c1 * c1 * f1 - c2 * c2 * f2, -f1 - f2, c1 * f1 + c2 * f2;
  }
  return out;
}

class Maps : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& text) const {
    const auto file = folder_ / "map.csv";
    std::ofstream(file) << text;
    return file.string();
  }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("grainfield_osl_map_" + std::to_string(::getpid()));
};

}  // namespace

TEST(FeOslWedge, ElementsAndMarchMeetTheClosedForm) {
  for (const char* phi : {"15", "28", "40"}) {
    for (const char* mu : {"-0.31", "0", "0.1"}) {
      Settings field = {{"phi_deg", phi}, {"mu", mu}, {"rho_g", "2"}, {"h", "3"}};
      const double half_width = 3 / std::tan(std::stod(phi) * std::numbers::pi / 180);
      const Points points = grid(1.05 * half_width, 3, 12);
      const Stresses closed = 2 * heap(points, std::stod(phi), std::stod(mu));
      const auto elements = make_model("fe_osl_wedge", field);
      EXPECT_LT(difference(elements->stress(points), closed), 1e-11) << phi << " " << mu;
      EXPECT_NEAR(elements->figures().at("base_force"), 2 * 3 * half_width, 1e-11);
      EXPECT_LT(elements->figures().at("force_balance"), 1e-13);
      field["solver"] = "march";
      EXPECT_LT(difference(make_model("fe_osl_wedge", field)->stress(points), closed), 1e-4);
    }
  }
}

// At the ends of what height and weight may be.
TEST(FeOslWedge, ScalesWithHeightAndWeight) {
  const Points points = grid(1.8, 1, 10);
  for (const char* solver : {"dg", "march"}) {
    const Stresses one = make_model("fe_osl_wedge", {{"solver", solver}})->stress(points);
    for (const char* h : {"1e-50", "1e50"}) {
      for (const char* rho_g : {"1e-50", "1e50"}) {
        const auto model =
            make_model("fe_osl_wedge", {{"solver", solver}, {"h", h}, {"rho_g", rho_g}});
        const Stresses scaled = model->stress(std::stod(h) * points);
        EXPECT_LT(difference(scaled / std::stod(h) / std::stod(rho_g), one), 1e-5)
            << solver << " " << h << " " << rho_g;
        EXPECT_LT(model->figures().at("force_balance"), 1e-12);
      }
    }
  }
}

TEST(FeOslWedge, LeavesOpenWhatTheClosedFormLeavesOpen) {
  const Points points = grid(1.8, 1, 10);
  for (const Settings& s : {Settings{}, Settings{{"eta", "0.6"}}, Settings{{"mu", "0.1"}},
                            Settings{{"eta", "0.6"}, {"mu", "0.1"}}, Settings{{"phi_deg", "35"}}})
    EXPECT_LT(difference(make_model("fe_osl_wedge", s)->stress(points),
                         make_model("osl", s)->stress(points)),
              1e-11);
}

TEST(FeOslWedge, OtherMeshesComeNear) {
  const Points points = grid(1.8, 1, 10);
  const Stresses closed = heap(points, 28, -std::tan(28 * std::numbers::pi / 180));
  for (const char* mesh : {"rays", "box"}) {
    for (const char* solver : {"dg", "march"}) {
      Settings s{{"mesh", mesh}, {"solver", solver}, {"columns", "32"}};
      if (s.at("solver") == "dg") s.insert({{"order", "1"}, {"rows", "32"}});
      const auto model = make_model("fe_osl_wedge", s);
      EXPECT_LT(difference(model->stress(points), closed), 0.05) << mesh << " " << solver;
    }
  }
}

TEST(FeOslLayer, ElementsAndMarchMeetTheClosedForm) {
  for (const char* mu : {"0", "0.3"}) {
    Settings field = {{"F", "3"}, {"h", "2"}, {"eta", "0.5"}, {"mu", mu}, {"width", "0.5"}};
    const Points points = grid(2.5, 2, 31);
    const Stresses closed = pulses(points, 3, 0.5, std::stod(mu), 0.5);
    field["half_width"] = "1.25";
    field["columns"] = "20";
    field["rows"] = "20";
    const auto elements = make_model("fe_osl_layer", field);
    const double peak = closed.cwiseAbs().maxCoeff();
    EXPECT_LT(difference(elements->stress(points), closed), 0.02 * peak);
    EXPECT_NEAR(elements->figures().at("load"), 3, 1e-12);
    // What is wrong with the pulses has run ahead to the sides.
    EXPECT_NEAR(elements->figures().at("base_force"), 3, 1e-6);
    EXPECT_LT(elements->figures().at("force_balance"), 1e-13);
    field["solver"] = "march";
    field["columns"] = "100";
    field.erase("rows");
    const auto march = make_model("fe_osl_layer", field);
    EXPECT_LT(difference(march->stress(points), closed), 0.02 * peak);
    EXPECT_NEAR(march->figures().at("load"), 3, 1e-12);
    EXPECT_NEAR(march->figures().at("base_force"), 3, 1e-6);
    EXPECT_LT(march->figures().at("force_balance"), 1e-12);
  }
}

TEST(FeOslLayer, TwoPeaksAtTheFeetOfTheCharacteristics) {
  const auto model = make_model("fe_osl_layer", {{"eta", "0.5"}, {"mu", "0.3"}});
  Points base(601, 2);
  for (int i = 0; i <= 600; ++i) base.row(i) << -1.5 + i * 0.005, -1;
  const auto reach = model->figures();
  base.col(0) *= reach.at("half_width") / 1.5;
  const Eigen::VectorXd pressure = -model->stress(base).col(1);
  for (const char* foot : {"c1", "c2"}) {
    Eigen::Index at = 0;
    double best = 0;
    for (Eigen::Index i = 0; i <= 600; ++i)
      if (base(i, 0) * reach.at(foot) > 0 && pressure[i] > best) best = pressure[at = i];
    EXPECT_NEAR(base(at, 0), reach.at(foot), 0.01);
  }
  EXPECT_LT(std::abs(pressure[300]), 1e-2 * pressure.maxCoeff());
}

TEST(FeOslLayer, WeightAndWallsConserveTheForce) {
  for (const char* sides : {"far", "walls"}) {
    for (const char* solver : {"dg", "march"}) {
      Settings s{{"sides", sides},       {"rho_g", "2"},    {"F", "3"},
                 {"half_width", "0.5"},  {"columns", "20"}, {"solver", solver},
                 {"closure", "mirrored"}};
      if (s.at("sides") == "walls") s["wall_friction"] = "0.4";
      if (s.at("solver") == "dg") s["rows"] = "10";
      const auto model = make_model("fe_osl_layer", s);
      model->stress((Points(1, 2) << 0, -1).finished());
      const auto f = model->figures();
      EXPECT_NEAR(f.at("weight"), 2, 1e-10) << sides << solver;
      EXPECT_NEAR(f.at("load"), 3, 1e-12);
      EXPECT_NEAR(f.at("base_force") + f.at("side_force"), 5, 1e-10);
      EXPECT_LT(f.at("force_balance"), 1e-12);
      EXPECT_GT(f.at("side_force"), 0.5);
    }
  }
}

TEST_F(Maps, AMapOfConstantsIsTheConstants) {
  const std::string file = write(
      "# of a "
      "heap\nx,y,rho_g,mu,eta\n-2,-1,3,-0.2,0.7\n2,-1,3,-0.2,0.7\n-2,0,3,-0.2,0.7\n2,0,3,-0.2,0."
      "7\n");
  const Points points = grid(1.8, 1, 10);
  for (const char* solver : {"dg", "march"}) {
    const auto mapped = make_model("fe_osl_wedge", {{"map", file}, {"solver", solver}});
    const auto plain = make_model(
        "fe_osl_wedge", {{"rho_g", "3"}, {"mu", "-0.2"}, {"eta", "0.7"}, {"solver", solver}});
    // Marching chooses its steps by errors that differ by round-off.
    EXPECT_LT(difference(mapped->stress(points), plain->stress(points)), 1e-9);
  }
}

// Also where one of eta and mu is left open: what the slope asks for, as without a map.
TEST_F(Maps, AMapLeavesOpenWhatTheConstantsLeaveOpen) {
  const Points points = grid(1.8, 1, 10);
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{"eta", "0.7"}, {"mu", "-0.2"}}) {
    const std::string v = "," + value + "\n";
    const std::string file =
        write("x,y," + name + "\n-2,-1" + v + "2,-1" + v + "-2,0" + v + "2,0" + v);
    for (const char* solver : {"dg", "march"}) {
      const auto mapped = make_model("fe_osl_wedge", {{"map", file}, {"solver", solver}});
      const auto plain = make_model("fe_osl_wedge", {{name, value}, {"solver", solver}});
      EXPECT_LT(difference(mapped->stress(points), plain->stress(points)), 1e-9) << name << solver;
      EXPECT_NEAR(mapped->figures().at("c1"), plain->figures().at("c1"), 1e-12) << name;
    }
  }
}

TEST_F(Maps, RefuseParametersThatTheyReplace) {
  const std::string file =
      write("# of a heap\nx, y ,eta,rho_g\n-2,-1,0.7,1\n2,-1,0.7,1\n-2,0,0.7,1\n2,0,0.7,1\n");
  for (const char* model : {"fe_osl_wedge", "fe_osl_layer"}) {
    for (const char* name : {"eta", "rho_g"})
      EXPECT_EQ(refusal(model, {{"map", file}, {name, "0.9"}}),
                "model " + std::string(model) + ": " + name + " = 0.9 has no effect beside map = " +
                    file + ", which replaces it; leave one of the two out");
    EXPECT_EQ(refusal(model, {{"map", file}, {"mu", "0.1"}}), "accepted");
    EXPECT_EQ(refusal(model, {{"map", ""}, {"eta", "0.6"}}), "accepted");
    // What is wrong with the map is said first.
    EXPECT_THAT(refusal(model, {{"map", "/nowhere/map.csv"}, {"eta", "0.6"}}),
                HasSubstr("/nowhere/map.csv: cannot be opened"));
  }
}

TEST(FeOslModels, MoreUnknownsThanMemoryAreRefused) {
  const auto made = [](const std::string& model, const Settings& settings) -> std::string {
    try {
      make_model(model, settings);
    } catch (const BadParameter& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(
      made("fe_osl_wedge", {{"columns", "100000"}, {"rows", "100000"}}),
      "model fe_osl_wedge: 200000 columns (columns = 100000), rows = 100000 and order = 2 ask "
      "for 3.6e+11 unknowns; allowed: up to 1e+07; lower columns, rows or order");
  EXPECT_EQ(
      made("fe_osl_wedge", {{"columns", "2000"}, {"rows", "2000"}, {"order", "1"}})
          .find("model fe_osl_wedge: 4000 columns (columns = 2000), rows = 2000 and order = 1"),
      0U);
  EXPECT_EQ(made("fe_osl_wedge", {{"columns", "700"}, {"rows", "390"}}), "accepted");
  EXPECT_EQ(made("fe_osl_wedge", {{"columns", "100000"}, {"solver", "march"}}), "accepted");
  EXPECT_THAT(made("fe_osl_layer", {{"columns", "10000"}, {"rows", "10000"}}),
              HasSubstr("(columns = 10000), rows = 10000 and order = 3 ask for"));
  EXPECT_THAT(made("fe_osl_layer", {{"half_width", "1000"}, {"rows", "1000"}}),
              HasSubstr("lower columns, rows or order, or half_width"));
  EXPECT_EQ(made("fe_osl_layer", {{"columns", "100"}, {"rows", "100"}}), "accepted");
}

TEST_F(Maps, BothSolversAgreeOnAMapThatVaries) {
  const std::string file = write(
      "x,y,rho_g,eta\n-2,-1,1.2,0.5\n0,-1,1.5,0.6\n2,-1,0.9,0.8\n-2,0,1,0.7\n0,0,1,0.7\n2,0,1,0."
      "7\n");
  const Points points = grid(1.8, 1, 10);
  const auto elements =
      make_model("fe_osl_wedge", {{"map", file}, {"columns", "32"}, {"rows", "32"}});
  const auto march =
      make_model("fe_osl_wedge", {{"map", file}, {"solver", "march"}, {"columns", "64"}});
  const Stresses a = elements->stress(points), b = march->stress(points);
  EXPECT_LT(difference(a, b), 0.02);
  EXPECT_NEAR(elements->figures().at("base_force"), march->figures().at("base_force"), 1e-8);
}

TEST_F(Maps, RefusalsNameFileLineAndWhatIsAllowed) {
  const auto with = [&](const std::string& text) {
    return refusal("fe_osl_wedge", {{"map", write(text)}});
  };
  EXPECT_THAT(refusal("fe_osl_wedge", {{"map", "/nowhere/map.csv"}}),
              HasSubstr("/nowhere/map.csv: cannot be opened"));
  EXPECT_THAT(with("x,y,etta\n"), HasSubstr("map.csv:1: the header is \"x,y,etta\"; allowed: x,y"));
  EXPECT_THAT(with("x,y,eta\n0,0,a\n"), HasSubstr("map.csv:2: \"a\" is not a finite number"));
  EXPECT_THAT(with("x,y,eta\n0,0\n"), HasSubstr("map.csv:2: 2 numbers, expected 3"));
  EXPECT_THAT(with("x,y,eta\n0,0,1\n1,0,1\n"), HasSubstr("form no grid"));
  EXPECT_THAT(with("x,y,eta\n0,0,1\n1,0,1\n0,1,1\n1.5,1,1\n"), HasSubstr("is not on the regular"));
  EXPECT_THAT(with("x,y,eta\n0,0,1\n1,0,1\n0,-1,1\n1,-1,1\n"), HasSubstr("must ascend"));
  EXPECT_THAT(with("x,y,eta\n-1,-1,1\n1,-1,1\n-1,0,1\n1,0,1\n"),
              HasSubstr("covers x from -1 to 1 and y from -1 to 0; allowed: a map that covers x"));
  // eta falls below 0 half way down.
  EXPECT_THAT(with("x,y,eta\n-2,-1,-1\n2,-1,-1\n-2,0,0.7\n2,0,0.7\n"),
              HasSubstr("both characteristics on one side"));
}

TEST(FeOslModels, RefusalsNameWhatIsAllowed) {
  EXPECT_THAT(refusal("fe_osl_wedge", {{"eta", "-0.5"}, {"mu", "0.1"}}),
              HasSubstr("outside the hyperbolic range; allowed: mu^2 + 4 eta above 0"));
  EXPECT_THAT(refusal("fe_osl_wedge", {{"eta", "-0.001"}, {"mu", "0.1"}}),
              HasSubstr("on one side of the vertical; allowed: eta above 0"));
  EXPECT_THAT(refusal("fe_osl_wedge", {{"eta", "4"}, {"mu", "0"}}),
              HasSubstr("outside the heap, dx/dy = 2; allowed: below cot(phi) = 1.88"));
  EXPECT_THAT(refusal("fe_osl_layer", {{"eta", "0"}, {"mu", "0"}}),
              testing::EndsWith("allowed: mu^2 + 4 eta above 0, here eta above 0"));
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{
           {"h", "1e200"}, {"h", "1e-200"}, {"rho_g", "1e200"}, {"rho_g", "1e-320"}})
    EXPECT_THAT(refusal("fe_osl_wedge", {{name, value}}),
                HasSubstr("model fe_osl_wedge: " + name + " = " + value +
                          " is out of range; allowed: 1e-50 to 1e+50"));
  for (const char* name : {"F", "h", "rho_g", "width"})
    EXPECT_THAT(refusal("fe_osl_layer", {{name, "1e51"}}), HasSubstr("= 1e51 is out of range"));
  EXPECT_THAT(refusal("fe_osl_layer", {{"width", "1e40"}}),
              HasSubstr("half the layer's width of 5e+39 m; allowed: up to 1e+06 columns, less "
                        "width, fewer columns or less half_width"));
  EXPECT_THAT(refusal("fe_osl_wedge", {{"order", "9"}}),
              HasSubstr("order = 9 is out of range; allowed: whole numbers 0 to 8"));
  EXPECT_THAT(
      refusal("fe_osl_wedge", {{"columns", "1"}}),
      HasSubstr("model fe_osl_wedge: columns = 1 does not fit the heap; allowed with mesh = "
                "aligned: at least 2"));
  EXPECT_THAT(refusal("fe_osl_layer", {{"eta", "-1"}}), HasSubstr("hyperbolic range"));
  EXPECT_THAT(refusal("fe_osl_layer", {{"half_width", "0.01"}}),
              HasSubstr("half_width = 0.01 depths does not fit the load; allowed: at least 0.05"));
  EXPECT_THAT(refusal("fe_osl_layer", {{"width", "1e-30"}}),
              HasSubstr("width = 1e-30 m asks for 1.61e+30 columns"));
  EXPECT_THAT(refusal("fe_osl_layer", {{"eta", "-0.01"}, {"mu", "1"}, {"sides", "walls"}}),
              HasSubstr("allowed between walls: above 0"));
  EXPECT_THROW(make_model("fe_osl_wedge", {{"solver", "march"}, {"steps", "2"}})
                   ->stress((Points(1, 2) << 0, -1).finished()),
               grainfield::ComputationFailed);
}

TEST(FeOslModels, OutsideIsNan) {
  for (const char* solver : {"dg", "march"}) {
    const auto heap = make_model("fe_osl_wedge", {{"solver", solver}});
    EXPECT_TRUE(heap->stress((Points(4, 2) << 0, 0.1, 1, -0.1, 0, -1.01, NAN, -0.5).finished())
                    .array()
                    .isNaN()
                    .all());
    EXPECT_TRUE(heap->stress((Points(2, 2) << 0, 0, 0, -1).finished()).array().isFinite().all());
    const auto layer = make_model("fe_osl_layer", {{"solver", solver}, {"half_width", "1"}});
    EXPECT_TRUE(layer->stress((Points(3, 2) << 0, 0.1, 1.1, -0.1, 0, -1.01).finished())
                    .array()
                    .isNaN()
                    .all());
    EXPECT_EQ(layer->stress(Points(0, 2)).rows(), 0);
  }
}
