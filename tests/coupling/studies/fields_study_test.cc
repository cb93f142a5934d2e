// Study pile-fields on heaps whose forces, strain and fabric are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "continuum/elastic_field.h"
#include "coupling/case/study.h"
#include "coupling/run/study_result.h"
#include "coupling/run/summary_keys.h"
#include "coupling/studies/pile/simulation.h"
#include "coupling/studies/pile_fields/robust.h"
#include "coupling/studies/pile_fields/setup.h"
#include "coupling/studies/pile_fields/topic.h"
#include "tests/coupling/heap_scene.h"
#include "tests/coupling/program.h"
#include "tests/refusal.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;

Case fields_case() {
  Case value;
  value.name = "heaps";
  value.study = "pile-fields";
  value.get<dem::PileSetup>().material.friction = 1;
  value.get<dem::PileSetup>().change.gravity = {8.829};
  value.get<FieldsSetup>().rve_diameters = 3;
  value.get<FieldsSetup>().sizes = {1, 2, 3, 4};
  value.get<FieldsSetup>().columns = 25;
  value.get<FieldsSetup>().rows = 15;
  value.get<FieldsSetup>().heights = {0.3, 0.4};
  value.get<FieldsSetup>().resamples = 20;
  return value;
}

// The heap under 0.9 g, all its centres displaced by `scale` times the same gradient.
dem::Snapshot lowered(int rows, double scale) {
  dem::Snapshot s = test::lattice_heap(rows, 0.005, 0.9 * 9.81);
  for (dem::Grain& g : s.grains) {
    const double x = g.position.x(), y = g.position.y();
    g.position.x() += scale * (3e-6 * x + 1e-6 * y);
    g.position.y() += scale * (1e-6 * x + 1e-5 * y);
  }
  return s;
}

std::string heap_file(const Folder& folder, const std::string& name, const dem::Snapshot& pile,
                      const dem::Snapshot& changed) {
  write_realization(folder / name, {{{"pile", pile}, {"gravity_8.829", changed}}, {}});
  return folder / name;
}

std::vector<std::string> heaps(const Folder& folder, const std::vector<double>& scales,
                               int rows = 32) {
  std::vector<std::string> out;
  for (const double scale : scales) {
    out.push_back(heap_file(folder, "heap_" + std::to_string(out.size()) + ".h5",
                            test::lattice_heap(rows), lowered(rows, scale)));
  }
  return out;
}

StudyResult look(const Case& value, const std::vector<std::string>& files, int threads = 1) {
  return find_study("pile-fields")->analyse(value, files, threads);
}

double number(const StudyResult& result, const std::string& key) {
  const auto found = result.summary.find(key);
  EXPECT_NE(found, result.summary.end()) << key;
  if (found == result.summary.end()) return NAN;
  if (const auto* integer = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*integer);
  }
  return std::get<double>(found->second);
}

std::string refusal(const Case& value, const std::vector<std::string>& files) {
  return refusal_of([&] { look(value, files); });
}

TEST(Fields, KnownHeapsComeBackAndOneRearrangedPileSpoilsNothing) {
  const Folder folder;
  const StudyResult one = look(fields_case(), heaps(folder, {1, 1, 10, 1}));
  EXPECT_NO_THROW(require_documented(one.summary));
  // An affine displacement is the same to every measure.
  for (const char* measure : {"cundall", "liao", "derivative", "kernel"}) {
    EXPECT_LT(number(one, std::string("strain.") + measure + ".difference"), 1e-7) << measure;
    EXPECT_NEAR(number(one, std::string("strain.") + measure + ".ratio"), 1, 1e-7) << measure;
  }
  EXPECT_NEAR(number(one, "strain.dip_ratio"), 1, 1e-7);
  // Equal grains.
  EXPECT_NEAR(number(one, "fabric.g2"), 1, 1e-12);
  EXPECT_NEAR(number(one, "fabric.g2_theory"), 1, 1e-12);
  EXPECT_NEAR(number(one, "fabric.trace_over_nu_c"), 1, 1e-9);
  EXPECT_NEAR(number(one, "fabric.nu_c_slope"), 1, 1e-6);
  // Every contact is there under both gravities.
  EXPECT_NEAR(number(one, "change.gravity_8.829.coordination_ratio"), 1, 1e-12);
  // The lattice's contacts at 60 and 120 degrees: xx 1/4, yy 3/4 of the trace.
  EXPECT_NEAR(number(one, "fabric.anisotropy"), 0.5, 0.02);
  // Pile 2 has ten times the strain at the same stress.
  EXPECT_EQ(std::get<std::string>(one.summary.at("elastic.rearranged_piles")), "2");
  EXPECT_EQ(number(one, "elastic.rearranged"), 1);
  const Folder other;
  const StudyResult sound = look(fields_case(), heaps(other, {1, 1, 1, 1}));
  EXPECT_EQ(std::get<std::string>(sound.summary.at("elastic.rearranged_piles")), "none");
  for (const char* key : {"elastic.bulk", "elastic.shear", "elastic.young", "elastic.poisson",
                          "elastic.young_over_grain", "elastic.young_pooled_kept"}) {
    EXPECT_NEAR(number(one, key) / number(sound, key), 1, 1e-9) << key;
  }
  EXPECT_LT(number(one, "elastic.young_pooled"), 0.5 * number(sound, "elastic.young"));
  EXPECT_NEAR(number(one, "elastic.young.least") / number(sound, "elastic.young"), 0.1, 1e-3);
}

TEST(Fields, ModuliFollowFromTheStressThatTheLatticeHas) {
  // Half of rho g depth is the vertical stress, a third of it the horizontal one (forces along the
  // contacts): -10 % of both against strains of 3e-6, 1e-5 and 1e-6.
  const Folder folder;
  const StudyResult result = look(fields_case(), heaps(folder, {1}));
  double bulk = 0, trace = 0, squares = 0;
  const Field* stress = nullptr;
  for (const auto& [name, field] : result.fields) {
    if (name == "yield") stress = &field;
  }
  ASSERT_NE(stress, nullptr);
  const double radius = number(result, "fields.rve_radius");
  const double h = number(result, "pile.height");
  for (Eigen::Index p = 0; p < stress->points.rows(); ++p) {
    const double x = std::fabs(stress->points(p, 0)), depth = -stress->points(p, 1);
    const double flank = depth / 2 - x * std::sqrt(3) / 2;  // to the flank of 60 degrees
    if (flank < 1.05 * radius || h - depth < radius) continue;
    trace -= 0.1 * (stress->find("sigma_xx")->value[p] + stress->find("sigma_yy")->value[p]);
    squares += 1;
  }
  bulk = trace / squares / 2 / 1.3e-5;
  EXPECT_NEAR(number(result, "elastic.bulk") / bulk, 1, 0.1);
  // One pile: no errors, no statement about isotropy, and it says so.
  EXPECT_EQ(result.summary.count("elastic.bulk.standard_error"), 0u);
  EXPECT_EQ(std::get<std::string>(result.summary.at("elastic.isotropy")), "undecided");
  ASSERT_EQ(result.texts.size(), 1u);
  EXPECT_EQ(result.texts[0].first, "elastic_map.csv");
  const std::string file = folder.write("map.csv", result.texts[0].second);
  EXPECT_GT(continuum::read_elastic_field(file).at(0, -h / 2)(0, 0), 0);
  const std::string& map = result.texts[0].second;
  EXPECT_EQ(std::count(map.begin(), map.end(), '\n'), 2 + 25 * 15);
}

TEST(Fields, ThreadsChangeNoBit) {
  const Folder folder;
  const auto files = heaps(folder, {1, 1.5, 2}, 26);
  const StudyResult one = look(fields_case(), files, 1), three = look(fields_case(), files, 3);
  for (const auto& [key, value] : one.summary) {
    if (key.rfind("time.", 0) == 0) continue;
    const auto& other = three.summary.at(key);
    const auto* a = std::get_if<double>(&value);
    if (a != nullptr && std::isnan(*a)) {
      EXPECT_TRUE(std::isnan(std::get<double>(other))) << key;
    } else {
      EXPECT_EQ(value, other) << key;
    }
  }
}

TEST(Fields, EveryTopicStandsAlone) {
  const Folder folder;
  const auto files = heaps(folder, {1, 2}, 26);
  for (const Topic& topic : topics()) {
    Case value = fields_case();
    value.get<FieldsSetup>().topics = {topic.name};
    const StudyResult result = look(value, files);
    EXPECT_NO_THROW(require_documented(result.summary)) << topic.name;
    EXPECT_FALSE(result.fields.empty()) << topic.name;
    const Realization first = read_realization(files.front());
    const Report page = result.page(result, &first);
    EXPECT_GT(page.sections.size(), 5u) << topic.name;
  }
}

TEST(Fields, PointsWithoutEnoughGrainsAreNamed) {
  const Folder folder;
  Case value = fields_case();
  value.get<FieldsSetup>().rve_diameters = 1.3;
  value.get<FieldsSetup>().topics = {"fabric"};
  const StudyResult result = look(value, heaps(folder, {1}));
  std::string text;
  for (const Section& section : result.page(result, nullptr).sections) {
    if (const auto* t = std::get_if<Text>(&section)) text += t->body + "\n";
  }
  EXPECT_THAT(text, HasSubstr("fewer than 6 grains in the averaging volume and are nan: ("));
}

TEST(Fields, BadInputIsNamed) {
  const Folder folder;
  Case value = fields_case();
  value.get<FieldsSetup>().rve_diameters = 30;
  EXPECT_THAT(refusal(value, heaps(folder, {1})),
              HasSubstr("fields.rve_diameters: found 30 (an RVE of radius 0.15 m), which fits into "
                        "heaps 0.139 m high at 0 of the 375 points"));
  // Snapshots that do not belong together.
  dem::Snapshot other = lowered(26, 1);
  other.grains.front().radius *= 1.01;
  const std::string mixed = heap_file(folder, "mixed.h5", test::lattice_heap(26), other);
  EXPECT_THAT(refusal(fields_case(), {mixed}), HasSubstr("snapshots do not belong together"));
  // No change of gravity.
  write_realization(folder / "alone.h5", {{{"pile", test::lattice_heap(26)}}, {}});
  EXPECT_THAT(refusal(fields_case(), {folder / "alone.h5"}),
              HasSubstr("change.gravity: found no gravity besides that of the piles"));
}

TEST(Robust, MedianAndItsErrorIgnoreOneWildNumber) {
  EXPECT_TRUE(std::isnan(median_of({})));
  EXPECT_EQ(median_of({3, NAN, 1, 2}), 2);
  EXPECT_EQ(median_of({4, 1, 2, 3}), 2.5);
  EXPECT_TRUE(std::isnan(robust_deviation({1})));
  EXPECT_NEAR(robust_deviation({1, 2, 3, 4, 1e9}), 1.4826, 1e-12);
  const RobustMean sound = robust_mean({9, 10, 11, 10, 9.5, 10.5, 10}, 200);
  const RobustMean wild = robust_mean({9, 10, 11, 10, 9.5, 10.5, -1e6}, 200);
  EXPECT_EQ(sound.median, 10);
  EXPECT_EQ(wild.median, 10);
  EXPECT_LT(wild.error, 1);
  EXPECT_EQ(robust_mean({5, NAN}, 50).median, 5);
  EXPECT_TRUE(std::isnan(robust_mean({5}, 50).error));
}

}  // namespace
}  // namespace grainfield::coupling
