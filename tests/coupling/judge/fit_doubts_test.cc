// Heaps whose forces cannot be right, heights too near to the floor, and the same model in `fit`
// and in `compare`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "continuum/closed/osl.h"
#include "coupling/fit/heap_models.h"
#include "coupling/import/packing_warnings.h"
#include "coupling/result/tables.h"
#include "tests/coupling/import_scene.h"
#include "tests/coupling/program.h"
#include "tests/coupling/stressed_heap.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Output;
using testing::program;

constexpr double kSlope = 28;
const std::string kModels = " --model osl --model hydrostatic --set fit.bootstrap=5 -o ";

dem::Snapshot heap(std::uint64_t seed = 1, double noise = 0.05) {
  const auto field =
      continuum::osl_field(kSlope * std::numbers::pi / 180, {0.74, -0.31}, test::lattice_rho_g());
  return test::stressed_heap({kSlope, kSlope, 0.01, 35, 0.3, 1.7, noise, seed},
                             [&](double x, double y) { return field.stress(x, y); });
}

std::string csv_files(const Folder& folder, const dem::Snapshot& s) {
  return folder.write("grains.csv", test::csv_grains(s)) + " " +
         folder.write("contacts.csv", test::csv_contacts(s)) + " " +
         folder.write("walls.csv", test::csv_walls(s));
}

void turn(dem::Snapshot& s, bool pairs, bool walls) {
  for (dem::Contact& c : s.contacts) {
    if (c.j < 0 ? walls : pairs) c.force = -c.force;
  }
}

void expect_refusal(const Output& output, const std::string& words) {
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_THAT(output.err, HasSubstr(words));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
}

TEST(FitDoubts, ForcesOfTheWrongSignAreRefused) {
  const Folder folder;
  dem::Snapshot turned = heap();
  turn(turned, true, true);
  const std::string files = csv_files(folder, turned), pulls = folder / "pulls.h5";
  const Output import = program("import --from csv " + files + " --group pile -o " + pulls);
  EXPECT_EQ(import.code, 0);
  EXPECT_THAT(import.err, HasSubstr("warning: /pile: the contacts pull: stress along gravity is "
                                    "tension"));
  EXPECT_THAT(import.err, HasSubstr("--flip-forces"));
  expect_refusal(program("fit " + pulls + kModels + (folder / "out")),
                 "pulls.h5:/pile: the contacts pull");
  EXPECT_FALSE(testing::fs::exists(folder / "out"));

  // Their average shows it, too.
  ASSERT_EQ(program("average " + pulls + " --frame heap --grid 41x21 -o " + (folder / "f.h5")).code,
            0);
  for (const std::string command : {"fit ", "compare "}) {
    expect_refusal(
        program(command + (folder / "f.h5") + " --model hydrostatic -o " + (folder / "out")),
        "f.h5:average: sigma_yy is tension");
  }

  // The remedy of the message.
  const std::string pushes = folder / "pushes.h5";
  const Output again =
      program("import --from csv " + files + " --flip-forces --group pile -o " + pushes);
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(again.err, "");
  const dem::Snapshot read = dem::read_snapshot(pushes, "/pile"), original = heap();
  ASSERT_EQ(read.contacts.size(), original.contacts.size());
  double largest = 0;
  std::map<std::pair<std::int64_t, std::int64_t>, dem::Vec3> force;
  for (const dem::Contact& c : original.contacts) force[{c.i, c.j}] = c.force;
  for (const dem::Contact& c : read.contacts) {
    largest = std::max(largest, (c.force - force.at({c.i, c.j})).norm());
  }
  EXPECT_LT(largest, 1e-12);
  EXPECT_EQ(program("fit " + pushes + kModels + (folder / "fit")).code, 0);
}

TEST(FitDoubts, OneTableOfTheWrongSignIsNamed) {
  dem::Snapshot s = heap();
  EXPECT_EQ(tension_in(check_packing(s)), "");
  EXPECT_TRUE(warnings_of(check_packing(s)).empty());
  turn(s, true, false);
  EXPECT_THAT(tension_in(check_packing(s)), HasSubstr("contacts between grains pull"));
  EXPECT_THAT(tension_in(check_packing(s)), HasSubstr("(import --flip-forces=pairs)"));
  // Without gravity, too.
  s.gravity.setZero();
  EXPECT_THAT(tension_in(check_packing(s)), HasSubstr("(import --flip-forces=pairs)"));
  turn(s, false, true);
  EXPECT_THAT(tension_in(check_packing(s)), HasSubstr("the mean stress is tension"));
  s.contacts.clear();
  EXPECT_TRUE(warnings_of(check_packing(s)).empty());
}

TEST(FitDoubts, OtherUnitsAndTurnedGravityAreNotMissingContacts) {
  const auto doubt = [](const dem::Snapshot& s) {
    std::string all;
    for (const std::string& text : warnings_of(check_packing(s))) all += text + "\n";
    return all;
  };
  dem::Snapshot millimetres = heap();  // masses of grains a thousand times as large
  for (dem::Grain& g : millimetres.grains) g.mass *= 1e6;
  EXPECT_THAT(
      doubt(millimetres),
      HasSubstr("of the weight: contacts with the floor are missing, or forces, lengths and masses "
                "are not all in SI units (N, m, kg)"));
  dem::Snapshot up = heap();
  up.gravity = -up.gravity;
  EXPECT_THAT(doubt(up), HasSubstr("gravity points the other way (--gravity)"));
}

// Without the grains above this height, and without their contacts.
dem::Snapshot cut_off(const dem::Snapshot& whole, double height) {
  dem::Snapshot out = whole;
  out.grains.clear();
  out.contacts.clear();
  std::vector<int> kept(whole.grains.size(), -1);
  for (std::size_t k = 0; k < whole.grains.size(); ++k) {
    if (whole.grains[k].position.y() > height) continue;
    kept[k] = static_cast<int>(out.grains.size());
    out.grains.push_back(whole.grains[k]);
  }
  for (dem::Contact c : whole.contacts) {
    c.i = kept[static_cast<std::size_t>(c.i)];
    if (c.j >= 0 && (c.j = kept[static_cast<std::size_t>(c.j)]) < 0) continue;
    if (c.i >= 0) out.contacts.push_back(c);
  }
  return out;
}

TEST(FitDoubts, HeapsThatAreNoWedgesAreSaidWithTheVerdict) {
  const Folder folder;
  const dem::Snapshot pointed = heap();
  const double floor = pointed.walls.front().point.y();
  double top = floor;
  for (const dem::Grain& g : pointed.grains) top = std::max(top, g.position.y());
  const auto said = [&](const std::string& name, const dem::Snapshot& s) {
    const std::string file = folder / (name + ".h5");
    dem::write_snapshot(file, "/pile", s);
    const Output fit = program("fit " + file + " --heights 0.2,0.3" + kModels + (folder / name));
    EXPECT_EQ(fit.code, 0) << fit.err;
    const double ratio = std::get<double>(
        read_summary(folder / (name + "/summary.json")).at("fit.weight_over_wedge"));
    return std::pair(fit.out, ratio);
  };
  const auto [of_pointed, near_one] = said("pointed", pointed);
  EXPECT_NEAR(near_one, 1, 0.1);
  EXPECT_THAT(of_pointed, Not(HasSubstr("times the wedge")));
  // A wedge without its upper 0.4: (1 - 0.4^2)/0.6^2 times the wedge of what is left.
  const auto [of_flat, flat] = said("flat", cut_off(pointed, floor + 0.6 * (top - floor)));
  EXPECT_NEAR(flat, 2.33, 0.3);
  EXPECT_THAT(of_flat,
              HasSubstr(" times the wedge of their height and slopes: their tops are round"));
}

TEST(FitDoubts, HeapsOfUnlikeHeightAreNamed) {
  const Folder folder;
  const std::string file = folder / "heap.h5";
  dem::Snapshot small = heap(2);
  for (dem::Grain& g : small.grains) {
    g.position /= 2;
    g.radius /= 2;
    g.volume /= 4;
  }
  for (dem::Contact& c : small.contacts) c.point /= 2;
  dem::write_snapshot(file, "/a/pile", heap(1));
  dem::write_snapshot(file, "/b/pile", small);
  const Output fit = program("fit " + file + " --heights 0.2,0.3" + kModels + (folder / "fit"));
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("m high in one ensemble: are they realizations of one?"));
  EXPECT_THAT(fit.out, HasSubstr("heap.h5:/b/pile (number 2, "));
  const Output kept = program("fit " + file + " --heights 0.2,0.3 --set fit.leave_out=[2]" +
                              kModels + (folder / "kept"));
  ASSERT_EQ(kept.code, 0) << kept.err;
  EXPECT_THAT(kept.out, Not(HasSubstr("in one ensemble")));
  EXPECT_THAT(kept.out, HasSubstr(" of 1 pile"));
  expect_refusal(program("fit " + file + " --set fit.leave_out=[3]" + kModels + (folder / "none")),
                 "fit.leave_out: found 3, allowed: whole numbers 1 to 2");
  const Output average =
      program("average " + file + " --frame heap --grid 9x5 -o " + (folder / "field.h5"));
  ASSERT_EQ(average.code, 0) << average.err;
  EXPECT_THAT(average.err, HasSubstr("m high in one average"));
}

// 400 disks, each on the floor: what the missing twentieth carries is beyond what unbalanced forces
// make by chance.
TEST(FitDoubts, AShareOfTheWeightIsJudgedByItsOwnError) {
  const auto warned = [](int missing, double noise) {
    dem::Snapshot s;
    s.gravity = {0, -10, 0};
    dem::Wall floor;
    floor.name = "floor";
    s.walls = {floor};
    for (int k = 0; k < 400; ++k) {
      dem::Grain grain;
      grain.id = k;
      grain.position = {2.5 * k, 1, 0};
      grain.radius = grain.mass = grain.volume = grain.inertia = 1;
      s.grains.push_back(grain);
      if (k % 400 < missing) continue;
      dem::Contact c;
      c.i = k;
      c.j = -1;
      c.point = {2.5 * k, 0, 0};
      c.normal = {0, -1, 0};
      c.normal_force = 10 * (1 + (k % 2 == 0 ? noise : -noise));
      c.force = {0, c.normal_force, 0};
      s.contacts.push_back(c);
    }
    std::string out;
    for (const std::string& text : warnings_of(check_packing(s))) {
      if (text.find("of the weight") != std::string::npos) out += text;
    }
    return out;
  };
  EXPECT_EQ(warned(0, 0), "");
  EXPECT_EQ(warned(0, 0.3), "");
  EXPECT_EQ(warned(6, 0), "");  // 1.5 %
  // sqrt(20) of 400 weights.
  EXPECT_THAT(warned(20, 0), HasSubstr("walls and fixed grains carry 0.95 ± 0.011 of the weight: "
                                       "contacts with the floor are missing"));
  // The same share within the error of forces that are as far out of balance.
  EXPECT_EQ(warned(20, 0.5), "");
  EXPECT_THAT(warned(60, 0), HasSubstr("carry 0.85 of the weight: "));
}

TEST(FitDoubts, OneComponentOfWrongSignIsSeen) {
  const Folder folder;
  const auto imported = [&](const std::function<void(dem::Contact&)>& change) {
    dem::Snapshot packing = heap(1);
    for (dem::Contact& c : packing.contacts) change(c);
    const Output out =
        program("import --from csv " + csv_files(folder, packing) + " -o " + (folder / "one.h5"));
    EXPECT_EQ(out.code, 0) << out.err;
    return out.err;
  };
  EXPECT_THAT(imported([](dem::Contact&) {}), Not(HasSubstr("pull")));
  EXPECT_THAT(
      imported([](dem::Contact& c) { c.force.x() *= -1; }),
      ::testing::ContainsRegex("[0-9]+ of [0-9]+ contacts \\([0-9]+ %\\) pull, their normal "
                               "force is tension: turn the sign of fx alone, which leaves "
                               "[0-9]+ that pull"));
  const Output fit = program("fit " + (folder / "one.h5") + kModels + (folder / "fit"));
  EXPECT_THAT(fit.out, HasSubstr("turn the sign of fx alone"));
  EXPECT_THAT(imported([](dem::Contact& c) { c.force.y() *= -1; }),
              HasSubstr("turn the sign of fy alone"));
  EXPECT_THAT(imported([](dem::Contact& c) { c.force *= -1; }), HasSubstr("--flip-forces"));
  // Some that pull, whatever component is turned: grains may stick together.
  int count = 0;
  EXPECT_THAT(imported([&](dem::Contact& c) {
                if (c.j >= 0 && ++count % 10 == 0) c.force *= -1;
              }),
              HasSubstr("unless the grains stick together (cohesion, liquid bridges)"));
}

TEST(FitDoubts, TheImportsWarningsAreRepeated) {
  const Folder folder;
  const std::string words = "walls and fixed grains carry 0 of the weight: contacts with the floor";
  for (const std::string group : {"a", "b"}) {
    dem::Snapshot loose = heap(group == "a" ? 1 : 2);
    std::erase_if(loose.contacts, [](const dem::Contact& c) { return c.j < 0; });
    const Output import = program("import --from csv " + csv_files(folder, loose) +
                                  " --add --group " + group + " -o " + (folder / "loose.h5"));
    EXPECT_EQ(import.code, 0);
    EXPECT_THAT(import.err, HasSubstr("warning: /" + group + ": " + words));
  }
  const Output fit = program("fit " + (folder / "loose.h5") + kModels + (folder / "fit"));
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("loose.h5:/a: " + words));
  EXPECT_THAT(fit.out, HasSubstr("(likewise 1 other packing)"));
  const Summary s = read_summary(folder / "fit/summary.json");
  EXPECT_THAT(std::get<std::string>(s.at("fit.warnings")), HasSubstr(words));
  EXPECT_THAT(testing::read_text(folder / "fit/report.html"), HasSubstr(words));
  EXPECT_THAT(testing::read_text(folder / "fit/fits.md"), HasSubstr("\n- "));

  dem::Snapshot noisy = heap(1, 0.9);
  EXPECT_THAT(warnings_of(check_packing(noisy)),
              ::testing::Contains(HasSubstr("unbalanced force ratio ")));
}

// Three grains above the heap, as poured packings of other programs have them.
TEST(FitDoubts, GrainsInFlightAreNamedAndLeftOut) {
  const Folder folder;
  const std::string file = folder / "heap.h5", clean = folder / "clean.h5";
  for (const std::uint64_t seed : {1, 2, 3}) {
    dem::Snapshot s = heap(seed);
    dem::write_snapshot(clean, "/" + std::to_string(seed) + "/pile", s);
    for (int k = 0; k < 3 && seed == 2; ++k) {
      dem::Grain g = s.grains.back();
      g.id = 90000 + k;
      g.position = {0.05 * k, 1.0 + 0.1 * k, 0};
      s.grains.push_back(g);
    }
    dem::write_snapshot(file, "/" + std::to_string(seed) + "/pile", s);
  }
  ASSERT_EQ(program("fit " + clean + kModels + (folder / "clean")).code, 0);
  const Output fit = program("fit " + file + kModels + (folder / "fit"));
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("heap.h5:/2/pile: 3 grains in flight, no part of the heap: id "
                                 "90000 at x = 0 m, 0.7 m above the floor, and others"));
  const Summary one = read_summary(folder / "clean/summary.json"),
                two = read_summary(folder / "fit/summary.json");
  for (const char* key : {"fit.osl.mu", "fit.osl.eta", "fit.slope_deg"}) {
    EXPECT_NEAR(std::get<double>(one.at(key)), std::get<double>(two.at(key)), 1e-9) << key;
  }
  const Output average =
      program("average " + file + " --frame heap --grid 9x5 -o " + (folder / "field.h5"));
  ASSERT_EQ(average.code, 0) << average.err;
  EXPECT_THAT(average.err, HasSubstr("/2/pile: 3 grains in flight"));
}

TEST(FitDoubts, HeightsBelowTheAveragingWidthAreNamed) {
  const Folder folder;
  const std::string file = folder / "heap.h5";
  dem::write_snapshot(file, "/a/pile", heap(1));
  dem::write_snapshot(file, "/b/pile", heap(2));
  // h = 0.304 m, width 2 x 0.01 m: 0.066 h.
  const Output low =
      program("fit " + file + " --heights 0.03,0.05,0.3" + kModels + (folder / "low"));
  ASSERT_EQ(low.code, 0) << low.err;
  EXPECT_THAT(low.out, HasSubstr("- Heights 0.03, 0.05 h nearer to the floor than the "
                                 "averaging width 0.02 m (0.065"));
  EXPECT_THAT(low.out, HasSubstr("choose heights from 0.07"));
  EXPECT_THAT(std::get<std::string>(read_summary(folder / "low/summary.json").at("fit.warnings")),
              HasSubstr("heights 0.03, 0.05 h"));
  EXPECT_THAT(testing::read_text(folder / "low/report.html"), HasSubstr("Doubts"));
  const Output high = program("fit " + file + " --heights 0.07,0.3" + kModels + (folder / "high"));
  EXPECT_EQ(high.code, 0);
  EXPECT_EQ(high.err, "");
  EXPECT_EQ(std::get<std::string>(read_summary(folder / "high/summary.json").at("fit.warnings")),
            "");

  ASSERT_EQ(program("average " + file + " --frame heap --width 0.02 --grid 61x101 -o " +
                    (folder / "f.h5"))
                .code,
            0);
  const Output field =
      program("fit " + (folder / "f.h5") + " --heights 0.05,0.3" + kModels + (folder / "field"));
  EXPECT_THAT(field.out, HasSubstr("Height 0.05 h nearer to the floor"));

  // Slopes that the heaps do not have, from both sources.
  for (const std::string& source : {file, folder / "f.h5"}) {
    const auto slopes = [&](const std::string& set) {
      return program("fit " + source + " --heights 0.3" + set + kModels + (folder / "slopes"));
    };
    const Output off = slopes(" --set fit.left_deg=15 --set fit.right_deg=31");
    ASSERT_EQ(off.code, 0) << off.err;
    EXPECT_THAT(off.out, HasSubstr("- fit.left_deg: set to 15 degrees, measured "));
    EXPECT_THAT(off.out, Not(HasSubstr("fit.right_deg")));
  }
}

double value(const Summary& s, const std::string& key) { return std::get<double>(s.at(key)); }

// Far off the heaps' 28 degrees constants may end at a bound or be the same for all heaps.
TEST(FitDoubts, SlopesSetFarOffMakeNoErrorOfZero) {
  const Folder folder;
  const std::string file = folder / "heap.h5";
  for (const int k : {1, 2, 3}) {
    dem::write_snapshot(file, "/" + std::to_string(k) + "/pile",
                        heap(static_cast<std::uint64_t>(k)));
  }
  for (const std::string slope : {"8", "65"}) {
    const Output out = program("fit " + file + " --heights 0.2,0.3 --set fit.left_deg=" + slope +
                               " --set fit.right_deg=" + slope +
                               " --model cantelaube --model osl_yield --set fit.bootstrap=20 -o " +
                               (folder / slope));
    ASSERT_EQ(out.code, 0) << out.err;
    EXPECT_THAT(out.out, HasSubstr("fit.left_deg: set to "));
    int errors = 0;
    const Summary s = read_summary(folder / (slope + "/summary.json"));
    for (const auto& [key, figure] : s) {
      const double* error = std::get_if<double>(&figure);
      if (error == nullptr || !key.ends_with(".error")) continue;
      ++errors;
      EXPECT_FALSE(*error <= 1e-9) << slope << " " << key << " " << *error;
      // Without one, the note of the model says why.
      const std::string note = key.substr(0, key.find('.', 4)) + ".note";
      EXPECT_TRUE(std::isfinite(*error) || std::get<std::string>(s.at(note)) != "")
          << slope << " " << key;
    }
    EXPECT_GE(errors, 9) << slope;
  }
  ASSERT_EQ(
      program("fit " + file + " --heights 0.2,0.3 --set fit.left_deg=75 --set fit.right_deg=75" +
              " --model cantelaube -o " + (folder / "none"))
          .code,
      0);
  EXPECT_THAT(testing::read_text(folder / "none/fits.md"), HasSubstr("leave no room for a core"));
}

// Flanks of cantelaube that are out of balance, a_yy = 1.6 where 1 + a_xy tan(slope) is 1.2: a
// description, beside which stands the fit that is bound to equilibrium and yield.
TEST(FitDoubts, ConstantsThatAreNoStressFieldAreADescription) {
  const Folder folder;
  const std::string file = folder / "heap.h5";
  const auto models = heap_models({kSlope, test::lattice_rho_g(), 1});
  const FitModel& cantelaube = find_fit_model(models, "cantelaube");
  const double tangent = std::tan(kSlope * std::numbers::pi / 180);
  const auto field = [&](double x, double y) {
    return Eigen::Vector3d(
        cantelaube
            .stress(Eigen::RowVector2d(x, y), numbers({0.34, 0.49, -0.2, 0.78, 1.6, 0.38, 35}))
            .row(0));
  };
  for (const int k : {1, 2, 3, 4}) {
    dem::write_snapshot(
        file, "/" + std::to_string(k) + "/pile",
        test::stressed_heap(
            {kSlope, kSlope, 0.01, 35, 0.3, 1.7, 0.05, static_cast<std::uint64_t>(k)}, field));
  }
  const Output out = program("fit " + file +
                             " --heights 0.2,0.3,0.4 --model cantelaube --set fit.bootstrap=0 -o " +
                             (folder / "fit"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Summary s = read_summary(folder / "fit/summary.json");
  EXPECT_NEAR(value(s, "fit.cantelaube.flank_balance_y"), 0.6 - 0.38 * tangent, 0.05);
  const auto named =
      ::testing::AllOf(HasSubstr("a description, no stress field: its flanks are out of balance, "),
                       HasSubstr("a_yy - 1 - a_xy tan(slope) = 0.4"),
                       HasSubstr("cantelaube_continuous is the fit within equilibrium and yield"));
  EXPECT_THAT(std::get<std::string>(s.at("fit.cantelaube.note")), named);
  EXPECT_THAT(std::get<std::string>(s.at("verdict.doubts")), named);
  EXPECT_TRUE(std::isfinite(value(s, "fit.cantelaube_continuous.beta_hat_deg")));
  EXPECT_EQ(std::get<std::string>(s.at("fit.cantelaube_continuous.note")), "");
}

// Column `name` of profiles.csv by component, depth and x as they are written there.
std::map<std::string, double> column(const std::string& file, const std::string& name) {
  std::istringstream text(testing::read_text(file));
  std::map<std::string, double> out;
  std::size_t at = 0;
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (cells.front() == "profile") {
      at = static_cast<std::size_t>(std::find(cells.begin(), cells.end(), name) - cells.begin());
    } else if (at < cells.size()) {
      const bool xx = cells[0].find("sigma_xx") != std::string::npos;
      out[(xx ? "xx," : "yy,") + cells[1] + "," + cells[2]] = std::stod(cells[at]);
    }
  }
  return out;
}

TEST(FitDoubts, FitAndCompareHaveOneHydrostaticModel) {
  const Folder folder;
  const std::string file = folder / "heap.h5", field = folder / "f.h5";
  for (int k = 1; k <= 4; ++k) {
    dem::write_snapshot(file, "/" + std::to_string(k) + "/pile",
                        heap(static_cast<std::uint64_t>(k)));
  }
  ASSERT_EQ(program("average " + file + " --frame heap --width 0.01 --grid 81x16 -o " + field).code,
            0);
  const std::string common = " --heights 0.2,0.4 --components sigma_yy,sigma_xx ";
  ASSERT_EQ(program("fit " + field + common + kModels + (folder / "fit")).code, 0);
  ASSERT_EQ(program("compare " + field + common +
                    "--model hydrostatic --model liffman --model lines=liffman:spacing=0.01 -o " +
                    (folder / "compare"))
                .code,
            0);
  const auto fitted = column(folder / "fit/profiles.csv", "hydrostatic_N/m");
  const auto compared = column(folder / "compare/profiles.csv", "hydrostatic_N/m");
  ASSERT_GT(fitted.size(), 20U);
  // `compare` looks through the averaging's kernel, which changes the pressure under the ridge
  // alone: by rho g tan(slope) times the kernel's mean |x|, 0.8 standard deviations, which are
  // sqrt(5/56) of its range of two widths.
  const double kink = test::lattice_rho_g() * std::tan(kSlope * std::numbers::pi / 180) * 0.8 *
                      0.02 * std::sqrt(5.0 / 56);
  std::size_t same = 0;
  for (const auto& [place, pressure] : fitted) {
    ASSERT_EQ(compared.count(place), 1U) << place;
    EXPECT_NEAR(pressure, compared.at(place), kink) << place;
    same += std::fabs(pressure - compared.at(place)) < 1e-3 * pressure ? 1 : 0;
  }
  EXPECT_GT(same, fitted.size() * 8 / 10);
  const Summary fit = read_summary(folder / "fit/summary.json");
  const Summary compare = read_summary(folder / "compare/summary.json");
  EXPECT_NEAR(value(fit, "fit.hydrostatic.rel_l2"), value(compare, "compare.hydrostatic.rel_l2"),
              0.03 * value(fit, "fit.hydrostatic.rel_l2"));

  // Liffman's lines carry the heap's weight whatever the spacing that stands for them.
  EXPECT_LT(value(compare, "compare.liffman.rel_l2"), 0.4);
  const auto lines = column(folder / "compare/profiles.csv", "liffman_N/m");
  double force = 0, weight = 0;
  for (const auto& [place, pressure] : compared) {
    if (place.compare(0, 2, "yy") != 0) continue;
    weight += std::isfinite(pressure) ? pressure : 0;
    force += std::isfinite(lines.at(place)) ? lines.at(place) : 0;
  }
  EXPECT_NEAR(force, weight, 0.02 * weight);
  EXPECT_NEAR(value(compare, "compare.liffman.rel_l2"), value(compare, "compare.lines.rel_l2"),
              1e-9);
}

}  // namespace
}  // namespace grainfield::coupling
