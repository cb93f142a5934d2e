// Order of the measures on curved fields, what has no strain, and error texts.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/strain/strain.h"
#include "tests/coupling/strain_scene.h"

namespace grainfield::coupling {
namespace {

using test::moved;
using test::random_packing;

std::string text_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

// Square lattice of 41 x 41 equal grains of spacing h about the origin, contacts half way.
dem::Snapshot lattice(double h) {
  dem::Snapshot s = random_packing(1, 41, 41, 2, 0, h);
  for (dem::Grain& g : s.grains) {
    g.position -= dem::Vec3(20.5 * h, 20.5 * h, 0);
    g.mass = 1;
  }
  for (dem::Contact& c : s.contacts)
    c.point = (s.grains[static_cast<std::size_t>(c.i)].position +
               s.grains[static_cast<std::size_t>(c.j)].position) /
              2;
  return s;
}

// Error of du_x/dx at the origin when lattice, width and step shrink together (a smaller element
// of as many grains) on u_x = sin(x + 0.4).
double error(StrainOptions o, double h) {
  const dem::Snapshot before = lattice(h);
  const dem::Snapshot after = moved(
      before, [](const dem::Vec3& x) { return dem::Vec3(1e-3 * std::sin(x.x() + 0.4), 0, 0); });
  o.width = (o.measure == "kernel" ? 3.3 : 6.6) * h;
  o.step = 6 * h;
  const Field f = strain(before, after, Eigen::MatrixXd::Zero(1, 2), o).field;
  return std::abs(f.find("du_x_dx")->value[0] / 1e-3 - std::cos(0.4));
}

TEST(StrainOrder, CentralMeasuresAreSecondOrderForwardDifferencesFirst) {
  for (const std::string& measure : strain_measures())
    for (const bool forward : {false, true}) {
      if (forward && measure != "derivative") continue;
      StrainOptions o;
      o.measure = measure;
      o.support = measure == "kernel" ? "lucy" : "circle";
      o.forward = forward;
      const double expected = forward ? 1 : 2;
      double last = error(o, 0.02);
      for (const double h : {0.01, 0.005, 0.0025}) {
        const double now = error(o, h);
        EXPECT_NEAR(std::log2(last / now), expected, 0.2) << measure << " " << h;
        last = now;
      }
    }
}

// On a quadratic field u_x = x^2 / 2 + x y the gradient at the point is (x + y, x); symmetric
// elements give it exactly, Roul's forward difference is off by half the step.
TEST(StrainOrder, QuadraticField) {
  const double h = 0.01;
  const dem::Snapshot before = lattice(h);
  const dem::Snapshot after = moved(before, [](const dem::Vec3& x) {
    return dem::Vec3(x.x() * x.x() / 2 + x.x() * x.y(), 0, 0);
  });
  Eigen::MatrixXd points(1, 2);
  points << 2 * h, 3 * h;
  for (const std::string& measure : strain_measures()) {
    StrainOptions o;
    o.measure = measure;
    o.support = measure == "kernel" ? "lucy" : "circle";
    o.width = (measure == "kernel" ? 3.3 : 6.6) * h;
    o.step = 6 * h;
    Field f = strain(before, after, points, o).field;
    EXPECT_NEAR(f.find("du_x_dx")->value[0], 5 * h, 1e-12) << measure;
    EXPECT_NEAR(f.find("du_x_dy")->value[0], 2 * h, 1e-12) << measure;
    if (measure != "derivative") continue;
    o.forward = true;
    f = strain(before, after, points, o).field;
    EXPECT_NEAR(f.find("du_x_dx")->value[0], 5 * h + o.step / 2, 1e-12);
    EXPECT_NEAR(f.find("du_x_dy")->value[0], 2 * h, 1e-12);
  }
}

// On disordered grains a quadratic field errs in first order of the element: the error relative to
// curvature times width stays what it is, whatever the size.
TEST(StrainOrder, DisorderMakesItFirstOrder) {
  for (const std::string& measure : strain_measures()) {
    std::vector<double> relative;
    for (const double size : {0.01, 0.005, 0.0025}) {
      const dem::Snapshot before = random_packing(4, 20, 20, 2, 0.2, size);
      const dem::Vec3 centre(10 * size, 10 * size, 0);
      const dem::Snapshot after = moved(before, [&](const dem::Vec3& x) {
        return dem::Vec3(std::pow((x - centre).x(), 2), 0, 0);
      });
      StrainOptions o;
      o.measure = measure;
      o.support = measure == "kernel" ? "gaussian" : "circle";
      o.width = (measure == "kernel" ? 2 : 5) * size;
      const Field f = strain(before, after, Eigen::MatrixXd(centre.head<2>().transpose()), o).field;
      relative.push_back(f.find("du_x_dx")->value[0] / o.width);
    }
    EXPECT_GT(std::abs(relative[0]), 1e-4) << measure;
    EXPECT_LT(std::abs(relative[0]), 1) << measure;
    EXPECT_NEAR(relative[1], relative[0], 1e-9) << measure;
    EXPECT_NEAR(relative[2], relative[0], 1e-9) << measure;
  }
}

TEST(StrainLimits, TooFewGrainsAndDegenerateArrangementsAreNanAndReported) {
  dem::Snapshot before = random_packing(2, 8, 8);
  const auto stretch = [](const dem::Vec3& x) { return dem::Vec3(1e-3 * x.x(), 0, 0); };
  Eigen::MatrixXd points(3, 2);
  points << 0.04, 0.04, 1, 1, 0.04, -0.5;
  StrainOptions o;
  o.width = 0.02;
  // A row of grains below, exactly on a line.
  for (int k = 0; k < 8; ++k) {
    dem::Grain g = before.grains[0];
    g.id = 100000000 + k;
    g.position = {0.01 * k, -0.5, 0};
    before.grains.push_back(g);
    if (k == 0) continue;
    dem::Contact c;
    c.i = static_cast<std::int64_t>(before.grains.size()) - 2;
    c.j = c.i + 1;
    c.point = {0.01 * k - 0.005, -0.5, 0};
    before.contacts.push_back(c);
  }
  o.least_grains = 3;
  for (const std::string& measure : strain_measures()) {
    o.measure = measure;
    o.support = measure == "kernel" ? "lucy" : "circle";
    const StrainResult r = strain(before, moved(before, stretch), points, o);
    const auto at = [&](const char* name, Eigen::Index p) { return r.field.find(name)->value[p]; };
    EXPECT_FALSE(std::isnan(at("strain_xx", 0)));
    for (const Eigen::Index p : {1, 2})
      for (const char* name :
           {"u_x", "du_x_dx", "du_x_dy", "du_y_dx", "du_y_dy", "strain_xy", "rotation"})
        EXPECT_TRUE(std::isnan(at(name, p))) << measure << " " << name << " " << p;
    EXPECT_EQ(at("grains", 1), 0);
    if (measure == "derivative") {  // no element above or below the row
      EXPECT_EQ(r.too_few, (std::vector<Eigen::Index>{1, 2}));
      EXPECT_EQ(r.report(),
                "2 of 3 points have no strain: 2 with too few grains or contacts (first at (1, 1) "
                "m: 0 grains, 0 contacts)");
    } else {
      EXPECT_EQ(r.too_few, std::vector<Eigen::Index>{1});
      EXPECT_EQ(r.degenerate, std::vector<Eigen::Index>{2});
      EXPECT_EQ(r.report(),
                "2 of 3 points have no strain: 1 with too few grains or contacts (first at (1, 1) "
                "m: 0 grains, 0 contacts), 1 with a degenerate arrangement (first at (0.04, -0.5) "
                "m: condition inf)")
          << measure;
    }
  }
  o.measure = "cambou";
  o.support = "circle";
  EXPECT_EQ(strain(before, moved(before, stretch), points.topRows(1), o).report(), "");
  o.least_grains = 1000;
  EXPECT_EQ(strain(before, moved(before, stretch), points, o).too_few.size(), 3u);
}

TEST(StrainLimits, DerivativeTakesOneSideAtAnEdge) {
  const dem::Snapshot before = random_packing(6, 16, 16);
  const dem::Snapshot after =
      moved(before, [](const dem::Vec3& x) { return dem::Vec3(1e-3 * x.y(), 0, 0); });
  Eigen::MatrixXd points(2, 2);
  points << 0.08, 0.02, 0.08, 0.158;
  StrainOptions o;
  o.measure = "derivative";
  o.width = 0.025;
  o.step = 0.05;
  const StrainResult r = strain(before, after, points, o);
  EXPECT_EQ(r.report(), "");
  EXPECT_NEAR(r.field.find("du_x_dy")->value[0], 1e-3, 1e-13);
  EXPECT_NEAR(r.field.find("du_x_dy")->value[1], 1e-3, 1e-13);
  o.forward = true;  // nothing ahead of the upper point
  EXPECT_EQ(strain(before, after, points, o).too_few, std::vector<Eigen::Index>{1});
}

// A floor of fixed grains that does not move with the others must not enter.
TEST(StrainLimits, FixedGrainsAndWallsGiveNothing) {
  dem::Snapshot before = random_packing(8, 10, 10);
  dem::Wall floor;
  before.walls.push_back(floor);
  for (std::size_t g = 0; g < 20; ++g) before.grains[g].fixed = true;
  dem::Contact c;
  c.i = 50;
  c.j = -1;
  c.point = before.grains[50].position;
  before.contacts.push_back(c);
  dem::Snapshot after =
      moved(before, [](const dem::Vec3& x) { return dem::Vec3(0, 1e-3 * x.y(), 0); });
  for (std::size_t g = 0; g < 20; ++g) after.grains[g].position = before.grains[g].position;
  Eigen::MatrixXd points(1, 2);
  points << 0.05, 0.03;
  for (const std::string& measure : strain_measures()) {
    StrainOptions o;
    o.measure = measure;
    o.support = measure == "kernel" ? "lucy" : "circle";
    o.width = 0.025;
    EXPECT_NEAR(strain(before, after, points, o).field.find("strain_yy")->value[0], 1e-3, 1e-13)
        << measure;
  }
}

// Misfit: pure noise leaves everything but the few degrees of freedom of the fit.
TEST(StrainLimits, MisfitOfNoiseIsNearOne) {
  const dem::Snapshot before = random_packing(9, 20, 20);
  dem::Random random(2);
  const dem::Snapshot after = moved(before, [&](const dem::Vec3&) {
    return dem::Vec3(1e-6 * random.uniform(-1, 1), 1e-6 * random.uniform(-1, 1), 0);
  });
  for (const char* measure : {"cambou", "cundall", "liao", "kernel"}) {
    StrainOptions o;
    o.measure = measure;
    o.support = o.measure == "kernel" ? "lucy" : "circle";
    o.width = 0.06;
    const Field f = strain(before, after, Eigen::MatrixXd::Constant(1, 2, 0.1), o).field;
    EXPECT_GT(f.find("misfit")->value[0], 0.9) << measure;
    EXPECT_LE(f.find("misfit")->value[0], 1) << measure;
  }
}

TEST(StrainErrors, SnapshotsThatDoNotBelongTogether) {
  const dem::Snapshot before = random_packing(1, 5, 5);
  const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(1, 2, 0.02);
  StrainOptions o;
  o.width = 0.03;
  const auto refusal = [&](const std::function<void(dem::Snapshot&)>& change) {
    dem::Snapshot after = before;
    change(after);
    return text_of([&] { strain(before, after, points, o); });
  };
  EXPECT_EQ(refusal([](dem::Snapshot&) {}), "");
  EXPECT_EQ(refusal([](dem::Snapshot& s) { s.grains[3].id = 77; }),
            "snapshots do not belong together: grain 3 is id 3 unloaded, id 77 loaded");
  EXPECT_EQ(refusal([](dem::Snapshot& s) { s.grains[2].radius = 1; }).substr(0, 52),
            "snapshots do not belong together: grain id 2 has rad");
  EXPECT_EQ(
      refusal([](dem::Snapshot& s) {
        s.grains[2].outline = {{0, 0}, {1, 0}, {0, 1}};
      }),
      "snapshots do not belong together: grain id 2 has another outline loaded than unloaded");
  EXPECT_EQ(refusal([](dem::Snapshot& s) { s.grains[2].fixed = true; }),
            "snapshots do not belong together: grain id 2 is fixed in one of them only");
  EXPECT_EQ(refusal([](dem::Snapshot& s) { s.dim = 3; }),
            "snapshots do not belong together: one is 2D, the other 3D");
}

TEST(StrainErrors, Options) {
  const dem::Snapshot s = random_packing(1, 5, 5);
  const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(1, 2, 0.02);
  StrainOptions good;
  good.width = 0.03;
  const auto refusal = [&](const std::function<void(StrainOptions&)>& change) {
    StrainOptions o = good;
    change(o);
    return text_of([&] { strain(s, s, points, o); });
  };
  EXPECT_EQ(refusal([](StrainOptions& o) { o.measure = "cambu"; }),
            "unknown strain measure \"cambu\"; known: cambou, cundall, liao, derivative, kernel; "
            "did you mean \"cambou\"?");
  EXPECT_EQ(refusal([](StrainOptions& o) { o.support = "lucy"; }),
            "unknown support of strain measure cambou \"lucy\"; known: circle, square; did you "
            "mean \"circle\"?");
  EXPECT_EQ(refusal([](StrainOptions& o) {
              o.measure = "kernel";
              o.support = "heaviside";
            }).substr(0, 79),
            "unknown support of strain measure kernel \"heaviside\"; known: lucy, gaussian; di");
  EXPECT_EQ(refusal([](StrainOptions& o) { o.width = 0; }),
            "strain width is 0 m; it must be positive (some grain diameters)");
  EXPECT_EQ(refusal([](StrainOptions& o) { o.step = -1; }),
            "strain step is -1 m; it must be positive, or 0 for the width");
  EXPECT_EQ(refusal([](StrainOptions& o) { o.least_grains = 0; }),
            "strain from at least 0 grains; it must be 1 or more");
  EXPECT_EQ(refusal([](StrainOptions& o) { o.largest_condition = 1; }),
            "largest condition of the strain's matrix is 1; it must be above 1");
  EXPECT_EQ(refusal([](StrainOptions& o) { o.threads = 0; }),
            "strain on 0 threads; at least 1 is needed");
  EXPECT_EQ(text_of([&] { strain(s, s, Eigen::MatrixXd::Zero(1, 3), good); }),
            "points have 3 coordinates; the 2D snapshots need 2");
  EXPECT_EQ(text_of([&] { strain(s, s, Eigen::MatrixXd::Constant(1, 2, NAN), good); }),
            "points hold a value that is not finite");
  const dem::Snapshot ball = random_packing(1, 4, 4, 3);
  good.measure = "liao";
  EXPECT_EQ(text_of([&] { strain(ball, ball, Eigen::MatrixXd::Zero(1, 3), good); }),
            "strain measure liao needs the grains' rotations, and neither snapshot tells an "
            "orientation; use "
            "cambou");
}

// Nothing to average over is not an error of the user's numbers.
TEST(StrainLimits, EmptySnapshotsAndNoPoints) {
  const dem::Snapshot none;
  StrainOptions o;
  o.width = 1;
  for (const std::string& measure : strain_measures()) {
    o.measure = measure;
    o.support = measure == "kernel" ? "lucy" : "circle";
    EXPECT_EQ(strain(none, none, Eigen::MatrixXd::Zero(2, 2), o).too_few.size(), 2u);
    EXPECT_EQ(strain(none, none, Eigen::MatrixXd::Zero(0, 2), o).report(), "");
  }
}

}  // namespace
}  // namespace grainfield::coupling
