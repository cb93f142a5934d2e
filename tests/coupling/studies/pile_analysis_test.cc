// The analysis of piles on heaps whose stress is known.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <variant>

#include "coupling/averaging/base.h"
#include "coupling/judge/words.h"
#include "coupling/observe/setup.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/realization_file.h"
#include "coupling/run/summary_keys.h"
#include "coupling/specimen/dip.h"
#include "coupling/specimen/pile_frame.h"
#include "coupling/specimen/setup.h"
#include "coupling/statistics/spread.h"
#include "coupling/studies/pile/pile_ensemble.h"
#include "coupling/studies/pile/study.h"
#include "coupling/tasks/fit_task.h"
#include "tests/coupling/heap_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;

// Files of realizations that hold these heaps.
std::vector<std::string> files_of(const Folder& folder, std::vector<dem::Snapshot> heaps) {
  std::vector<std::string> out;
  for (std::size_t r = 0; r < heaps.size(); ++r) {
    // Forces may have been changed since.
    for (dem::Contact& c : heaps[r].contacts) c.normal_force = -c.force.dot(c.normal);
    out.push_back(folder / ("r" + std::to_string(r) + ".h5"));
    dem::RunResult result;
    result.snapshots = {{"pile", heaps[r]}};
    result.figures = {{"dem.grains", static_cast<double>(heaps[r].grains.size())}};
    write_realization(out.back(), result);
  }
  return out;
}

Case pile_case() {
  Case value;
  value.name = "heap";
  value.study = "pile";
  value.get<AverageSetup>().points = 81;
  value.get<AverageSetup>().map_columns = 21;
  value.get<AverageSetup>().map_rows = 11;
  value.get<AverageSetup>().width_diameters = 1.5;
  value.ensemble.realizations = 1;
  return value;
}

double number(const StudyResult& result, const std::string& key) {
  const auto at = result.summary.find(key);
  EXPECT_NE(at, result.summary.end()) << key;
  return at == result.summary.end() ? std::nan("") : std::get<double>(at->second);
}

const Profile& profile(const StudyResult& result, const std::string& key) {
  for (const Profile& p : result.comparison.profiles) {
    if (p.key == key) return p;
  }
  throw std::logic_error("no profile " + key);
}

TEST(HeapScene, IsInEquilibrium) {
  const dem::Snapshot s = test::lattice_heap(12);
  std::vector<dem::Vec3> sum(s.grains.size(), dem::Vec3::Zero());
  for (const dem::Contact& c : s.contacts) {
    sum[static_cast<std::size_t>(c.i)] += c.force;
    if (c.j >= 0) sum[static_cast<std::size_t>(c.j)] -= c.force;
  }
  const double weight = s.grains.front().mass * 9.81;
  for (std::size_t g = 0; g < sum.size(); ++g) {
    EXPECT_LT((sum[g] + s.grains[g].mass * s.gravity).norm(), 1e-10 * weight);
  }
}

TEST(PileFrame, MeasuresALatticeHeap) {
  const int rows = 40;
  const double d = 0.005, shift = 0.123;
  const PileFrame f = pile_frame(test::lattice_heap(rows, d, 9.81, shift));
  EXPECT_NEAR(f.apex_x, shift, 0.6 * d);
  EXPECT_NEAR(f.height, d + (rows - 1) * d * std::sqrt(3) / 2, 0.06 * d);
  EXPECT_NEAR(f.repose_left_deg, 60, 1.5);
  EXPECT_NEAR(f.repose_right_deg, 60, 1.5);
  EXPECT_NEAR(f.half_left, rows * d / 2, 1.5 * d);
  EXPECT_NEAR(f.grain_density, 5000, 1e-9);
  // Heptagons in a circle of diameter d on cells of d^2 sqrt(3)/2.
  const double lattice = 7 * std::sin(2 * M_PI / 7) / 8 / (std::sqrt(3) / 2);
  EXPECT_NEAR(f.volume_fraction, lattice, 0.01 * lattice);
  EXPECT_NEAR(f.pressure(), 5000 * f.volume_fraction * 9.81 * f.height, 1e-9 * f.pressure());
  // The frame there and back.
  const Eigen::MatrixXd ends = f.to_packing((Eigen::MatrixXd(2, 2) << 0, 0, 0, -1).finished());
  EXPECT_NEAR(ends(0, 0), f.apex_x, 1e-15);
  EXPECT_NEAR(ends(0, 1), f.height, 1e-15);
  EXPECT_NEAR(ends(1, 1), 0, 1e-15);
  EXPECT_DOUBLE_EQ(f.in_half_bases(f.apex_x - f.half_left), -1);
  EXPECT_DOUBLE_EQ(f.in_half_bases(f.apex_x + f.half_right / 2), 0.5);
}

TEST(PileFrame, PiecesAndLayersAreNoHeaps) {
  const dem::Snapshot heap = test::lattice_heap(20);
  EXPECT_EQ(pile_frame(heap).why_not_a_heap(0), "");
  EXPECT_DOUBLE_EQ(pile_frame(heap).largest_piece, 1);
  // In a wedge of half base b the mass beyond x is that of (1 - x/b)^2.
  const PileFrame f = pile_frame(heap);
  EXPECT_NEAR(f.middle_reach, (1 - std::sqrt(0.05)) * f.half_left, 0.05 * f.half_left);
  dem::Snapshot two = heap;
  for (dem::Grain& grain : two.grains) {
    if (grain.position.x() > f.apex_x) grain.position.x() += 0.3;
  }
  two.contacts.clear();
  const PileFrame parted = pile_frame(two);
  EXPECT_LT(parted.largest_piece, 0.6);
  EXPECT_THAT(parted.why_not_a_heap(2),
              HasSubstr("realization 2: it lies in pieces, the largest with 5"));
  PileFrame layer = f;
  layer.repose_left_deg = 1;
  layer.repose_right_deg = 2;
  EXPECT_EQ(layer.why_not_a_heap(1), "realization 1: flanks of 1.0 and 2.0 degrees, a layer");
}

// One pile of several that fell apart does not widen the pictures of all.
TEST(PileAnalysis, PicturesEndWithTheHeap) {
  const Folder folder;
  const dem::Snapshot heap = test::lattice_heap(20);
  dem::Snapshot pieces = heap;
  pieces.contacts.clear();
  for (dem::Grain& grain : pieces.grains) grain.position.x() *= 5;
  ASSERT_NE(pile_frame(pieces).why_not_a_heap(1), "");
  const Case value = pile_case();
  const auto reach = [&](const std::vector<dem::Snapshot>& heaps) {
    return PileEnsemble(value, files_of(folder, heaps), 1).x.maxCoeff();
  };
  EXPECT_EQ(reach({heap, pieces}), reach({heap}));
  const PileFrame frame = pile_frame(heap);
  EXPECT_NEAR(reach({heap}), 1.08 * frame.half_left / frame.height, 0.05);
  EXPECT_GT(reach({pieces}), 3 * reach({heap}));
}

// Grains in flight, single ones and a pair that touches, are no part of the heap; a rattler is.
TEST(PileFrame, GrainsInFlightAreNoHeap) {
  dem::Snapshot heap = test::lattice_heap(30);
  const PileFrame before = pile_frame(heap);
  EXPECT_EQ(before.in_flight, "");
  const auto add = [&](double x, double y) {
    dem::Grain g = heap.grains.front();
    g.id = 7000 + static_cast<std::int64_t>(heap.grains.size());
    g.position = {x, y, 0};
    heap.grains.push_back(g);
    return static_cast<std::int64_t>(heap.grains.size()) - 1;
  };
  const std::int64_t first = add(0.02, 2 * before.height);
  add(-3 * before.half_left, 0.4 * before.height);
  const std::int64_t a = add(0, 3 * before.height), b = add(0.004, 3 * before.height);
  dem::Contact touch = heap.contacts.back();
  touch.i = a;
  touch.j = b;
  heap.contacts.push_back(touch);
  add(0, before.height / 2);
  const PileFrame after = pile_frame(heap);
  EXPECT_NEAR(after.height, before.height, 1e-12);
  // The columns are a mean diameter wide, whose last digit the sum over other grains moves.
  EXPECT_NEAR(after.apex_x, before.apex_x, 1e-3);
  EXPECT_NEAR(after.half_left, before.half_left, 1e-3);
  EXPECT_NEAR(after.repose_right_deg, before.repose_right_deg, 0.3);
  EXPECT_NEAR(after.volume_fraction, before.volume_fraction, 0.01);
  EXPECT_THAT(after.in_flight,
              HasSubstr("4 grains in flight, no part of the heap: id " +
                        std::to_string(heap.grains[static_cast<std::size_t>(first)].id) +
                        " at x = 0.02 m, "));
  // Where the contacts with the floor are not known, the largest group is the heap.
  std::erase_if(heap.contacts, [](const dem::Contact& c) { return c.j < 0; });
  EXPECT_THAT(pile_frame(heap).in_flight, HasSubstr("4 grains in flight"));
  heap.contacts.clear();
  EXPECT_EQ(pile_frame(heap).in_flight, "");
}

TEST(PileFrame, AHeapOfAFewGrainsStillHasOne) {
  const PileFrame f = pile_frame(test::lattice_heap(3, 0.01));
  EXPECT_NEAR(f.apex_x, 0, 0.011);
  EXPECT_GT(f.half_left, 0);
  EXPECT_GT(f.half_right, 0);
  EXPECT_GT(f.pressure(), 0);
  EXPECT_TRUE(std::isnan(f.centre_fraction));
}

TEST(PileAnalysis, PressureOfALatticeHeapIsHalfOfRhoGDepth) {
  const Folder folder;
  Case value = pile_case();
  value.get<HeapSetup>().heights = {0.25, 0.5};
  const auto files = files_of(folder, {test::lattice_heap(45)});
  const StudyResult result = analyse_pile(value, files, 1);
  EXPECT_NO_THROW(require_documented(result.summary));
  EXPECT_EQ(result.comparison.scale.stress, "rho g h");
  const double unit = number(result, "heap.rho_g_h");
  EXPECT_NEAR(result.comparison.scale.unit, unit, 1e-9 * unit);
  for (const auto& [key, share] :
       {std::pair{"base", 1.0}, {"height_0.25", 0.75}, {"height_0.5", 0.5}}) {
    const Profile& p = profile(result, key);
    EXPECT_NEAR(p.depth, share * result.comparison.scale.h, 1e-12);
    int inside = 0;
    for (Eigen::Index k = 0; k < p.x.size(); ++k) {
      // Well inside the flanks of 60 degrees.
      if (std::fabs(p.x[k]) > 0.8 * share * result.comparison.scale.h / std::sqrt(3)) continue;
      ++inside;
      EXPECT_NEAR(p.mean[k] / unit, share / 2, 0.03) << key << " at " << p.x[k];
    }
    EXPECT_GT(inside, 15) << key;
  }
  // The averages beside the base forces see the same.
  int beside = 0;
  for (const Profile& p : result.comparison.beside) {
    if (p.key != "base_coarse_graining") continue;
    ++beside;
    EXPECT_NEAR(p.mean[p.mean.size() / 2] / unit, 0.5, 0.03);
  }
  EXPECT_EQ(beside, 1);
  EXPECT_NEAR(number(result, "base.weight_ratio"), 1, 1e-9);
  EXPECT_NEAR(number(result, "dip.window_ratio"), 1, 0.1);
  EXPECT_LT(number(result, "average.coarse_graining.balance_rms"), 1e-3);
  EXPECT_EQ(std::get<std::string>(result.summary.at("dip.verdict")), "undecided");
}

TEST(PileAnalysis, TheBaseProfileIntegratesToTheWeight) {
  const Folder folder;
  for (const double width : {0.8, 2.0}) {
    Case value = pile_case();
    value.get<AverageSetup>().width_diameters = width;
    value.get<AverageSetup>().points = 2001;
    dem::Snapshot heap = test::lattice_heap(30);
    test::plant_dip(heap, 0.4, 0.02, 0.3, 5);
    const StudyResult result = analyse_pile(value, files_of(folder, {heap}), 1);
    const Profile& p = profile(result, "base");
    double sum = 0;
    for (Eigen::Index k = 1; k < p.x.size(); ++k) {
      sum += (p.mean[k] + p.mean[k - 1]) / 2 * (p.x[k] - p.x[k - 1]);
    }
    // The smeared ends reach a little beyond the profile's.
    EXPECT_NEAR(sum / test::heap_weight(heap), 1, 0.02) << width;
  }
}

TEST(PileAnalysis, PilesOfOtherHeightsFallOnOneScaledProfile) {
  const Folder folder;
  std::vector<dem::Snapshot> heaps;
  for (const int rows : {32, 40, 48, 56})
    heaps.push_back(test::lattice_heap(rows, 0.004 + 0.0001 * rows));
  Case value = pile_case();
  value.get<AverageSetup>().width_diameters = 2;
  const StudyResult result = analyse_pile(value, files_of(folder, heaps), 1);
  const Profile& p = profile(result, "base");
  const double unit = result.comparison.scale.unit;
  for (Eigen::Index k = 0; k < p.x.size(); ++k) {
    if (std::fabs(p.x[k]) > 0.4 * result.comparison.scale.h) continue;
    EXPECT_NEAR(p.mean[k] / unit, 0.5, 0.02);
    // Without scaling the heights alone would spread by 0.27.
    EXPECT_LT(p.error[k] / unit, 0.01);
  }
  EXPECT_EQ(result.comparison.realizations, 4);
  EXPECT_THAT(result.comparison.scale.note, HasSubstr("realizations: 4"));
}

// Piles with a planted dip of this depth: the verdict's figures.
StudyResult planted(double depth, int realizations, std::uint64_t seed) {
  const Folder folder;
  std::vector<dem::Snapshot> heaps;
  for (int r = 0; r < realizations; ++r) {
    heaps.push_back(test::lattice_heap(36 + r % 3));
    test::plant_dip(heaps.back(), depth, 0.015, 0.25, seed + static_cast<std::uint64_t>(r));
  }
  Case value = pile_case();
  value.get<AverageSetup>().methods = {"coarse_graining"};
  return analyse_pile(value, files_of(folder, heaps), 1);
}

TEST(PileAnalysis, FindsAPlantedDipAndAPlantedPeak) {
  const StudyResult dip = planted(0.4, 8, 100);
  EXPECT_EQ(std::get<std::string>(dip.summary.at("dip.verdict")), "dip");
  EXPECT_LT(number(dip, "dip.p_value"), 0.01);
  EXPECT_GT(number(dip, "dip.difference"), 3 * number(dip, "dip.standard_error"));
  EXPECT_LT(number(dip, "dip.ratio"), 0.85);
  EXPECT_LT(number(dip, "dip.window_ratio"), 0.85);
  EXPECT_THAT(sentence(dip.comparison.judgement),
              HasSubstr("The heaps have a pressure dip (8 realizations, 95 %)."));

  const StudyResult peak = planted(-0.4, 8, 100);
  EXPECT_EQ(std::get<std::string>(peak.summary.at("dip.verdict")), "peak");
  EXPECT_GT(number(peak, "dip.p_value"), 0.95);
  EXPECT_LT(number(peak, "dip.difference"), 0);
  EXPECT_GT(number(peak, "dip.window_ratio"), 1.1);
  EXPECT_THAT(sentence(peak.comparison.judgement),
              HasSubstr("The heaps have a pressure peak and no dip (8 "));
}

TEST(PileAnalysis, FewRealizationsGiveNoVerdict) {
  const StudyResult two = planted(0.4, 2, 7);
  EXPECT_EQ(std::get<std::string>(two.summary.at("dip.verdict")), "undecided");
  EXPECT_TRUE(std::isnan(number(two, "dip.p_value")));
  EXPECT_THAT(sentence(two.comparison.judgement),
              AllOf(HasSubstr("needs at least 3 realizations that differ; there are 2."),
                    Not(HasSubstr("grainfield fit"))));
  // 1/sqrt(2 (n - 1)) = 0.5 of three, 0.41 of four; with eight nothing is said.
  EXPECT_THAT(sentence(planted(0.4, 3, 7).comparison.judgement),
              HasSubstr(", an error that is itself uncertain by 50 %"));
  EXPECT_THAT(sentence(planted(0.4, 4, 7).comparison.judgement),
              AllOf(HasSubstr("uncertain by 41 %"), HasSubstr("grainfield fit snapshots.h5")));
  EXPECT_THAT(sentence(planted(0.4, 8, 100).comparison.judgement),
              ::testing::Not(HasSubstr("uncertain")));
}

// "No dip" of a few noisy heaps is no measurement: the sentence says what they leave open.
TEST(PileAnalysis, NeitherSaysWhatTheHeapsLeaveOpen) {
  std::vector<BaseWindows> piles(4);
  const double differences[] = {-0.1, 0.3, 0.0, 0.2};
  for (std::size_t k = 0; k < 4; ++k) {
    piles[k].centre = 0.6;
    piles[k].shoulder = 0.6 + differences[k];
  }
  const Dip dip = judge_dip(piles);
  EXPECT_EQ(dip.verdict, "neither");
  const std::vector<std::string> lines = dip_lines(dip);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], "The heaps show no dip or peak beyond chance (4 realizations, 95 %).");
  // 0.1 -+ 3.1824 x 0.0913 (Student's t of three degrees of freedom).
  EXPECT_THAT(lines[1], HasSubstr("anything from -0.19 (peak) to 0.39 (dip) rho g h"));
}

TEST(PileAnalysis, WithoutADipFewEnsemblesShowOne) {
  // Windows of noise alone: one verdict in twenty is wrong, dips and peaks together.
  dem::Random random(17);
  int dips = 0, peaks = 0;
  const int ensembles = 2000;
  for (int e = 0; e < ensembles; ++e) {
    std::vector<BaseWindows> piles(6);
    for (BaseWindows& p : piles) {
      p.centre = 0.5 + 0.1 * (random.uniform() + random.uniform() - 1);
      p.shoulder = 0.5 + 0.1 * (random.uniform() + random.uniform() - 1);
    }
    const Dip dip = judge_dip(piles);
    dips += dip.verdict == "dip";
    peaks += dip.verdict == "peak";
  }
  EXPECT_NEAR(dips / double(ensembles), 0.025, 0.011);  // three standard deviations
  EXPECT_NEAR(peaks / double(ensembles), 0.025, 0.011);
}

TEST(PileAnalysis, TheMachineryOfModelsTakesHeaps) {
  const Folder folder;
  Case value = pile_case();
  value.models = {{"hydrostatic", "hydrostatic", {{"left_deg", "0"}, {"right_deg", "0"}}},
                  {"half", "hydrostatic", {{"rho_g", "1000"}}}};
  std::vector<dem::Snapshot> heaps;
  for (const int rows : {30, 33, 36}) heaps.push_back(test::lattice_heap(rows));
  const StudyResult result = analyse_pile(value, files_of(folder, heaps), 1);
  EXPECT_NO_THROW(require_documented(result.summary));
  ASSERT_EQ(result.comparison.results.size(), 2U);
  // rho g from the ensemble: rho g h on the base, where the grains carry half of it.
  const double at_base = result.comparison.models[0].values[0][40] / result.comparison.scale.unit;
  EXPECT_NEAR(at_base, 1, 1e-6);
  // Under the flanks the kernel blunts the ridge.
  const double ridge = result.comparison.models[1].values[0][40];
  EXPECT_LT(ridge, 1000 * result.comparison.scale.h);
  EXPECT_GT(ridge, 900 * result.comparison.scale.h);
  EXPECT_TRUE(result.summary.count("compare.hydrostatic.rel_l2"));
  EXPECT_FALSE(result.comparison.judgement.best.empty());
  EXPECT_FALSE(result.summary.count("response.peak"));
}

// Models with free constants: the numbers of `grainfield fit` of the same heaps, beside the pile's
// own figures and lines.
TEST(PileAnalysis, FitsAreThoseOfTheCommand) {
  const Folder folder;
  std::vector<dem::Snapshot> heaps;
  for (const int seed : {1, 2, 3}) {
    heaps.push_back(test::lattice_heap(30));
    dem::Random random(static_cast<std::uint64_t>(seed));
    for (dem::Contact& c : heaps.back().contacts) c.force *= 1 + 0.05 * random.uniform(-1, 1);
  }
  Case value = pile_case();
  value.ensemble.realizations = 3;
  FitSetup& fit = value.get<FitSetup>();
  fit.models = {"hydrostatic", "osl_yield"};
  fit.bootstrap = 0;
  const std::vector<std::string> files = files_of(folder, heaps);
  const StudyResult result = analyse_pile(value, files, 1);
  EXPECT_NO_THROW(require_documented(result.summary));

  FitRequest request;
  request.inputs = files;
  request.models = fit.models;
  request.overrides = {"fit.bootstrap=0"};
  const FitOutcome command = run_fit(request);
  const auto text = [](const auto& figure) {  // nan is the same as nan
    return std::visit([](const auto& held) { return fmt::format("{}", held); }, figure);
  };
  int same = 0;
  for (const auto& [key, figure] : command.summary) {
    if (!key.starts_with("fit.")) continue;
    ASSERT_TRUE(result.summary.contains(key)) << key;
    EXPECT_EQ(text(result.summary.at(key)), text(figure)) << key;
    ++same;
  }
  EXPECT_GT(same, 20);
  EXPECT_NEAR(number(result, "base.weight_ratio"), 1, 0.02);
  const Judgement &own = result.comparison.judgement, &theirs = command.comparison.judgement;
  ASSERT_EQ(own.models.size(), 2u);
  EXPECT_EQ(own.best, theirs.best);
  EXPECT_EQ(own.models.front().misfit, theirs.models.front().misfit);
  ASSERT_FALSE(own.findings.empty());
  EXPECT_THAT(own.findings.front(), HasSubstr("heaps have"));
  EXPECT_EQ(result.comparison.results.size(), 2u);
  EXPECT_NO_THROW(profile(result, "sigma_yy_0.1"));
  EXPECT_EQ(result.comparison.beside.front().key, "base");

  const Report page = result.page(result, nullptr);
  std::string titles;
  for (const Section& section : page.sections) {
    if (const auto* picture = std::get_if<Picture>(&section)) titles += picture->title + "\n";
    if (const auto* table = std::get_if<Table>(&section)) titles += table->title + "\n";
  }
  for (const char* title : {"Vertical pressure on the base", "Fitted constants", "Figures"}) {
    EXPECT_THAT(titles, HasSubstr(title));
  }
}

TEST(PileAnalysis, ChangedGravityGivesItsFigures) {
  const Folder folder;
  dem::RunResult run;
  run.snapshots = {{"pile", test::lattice_heap(20)}};
  dem::Snapshot heavy = test::lattice_heap(20, 0.005, 19.62);
  for (dem::Grain& g : heavy.grains) g.position.y() -= 0.001 * g.position.y();
  heavy.contacts.erase(heavy.contacts.begin());  // the leftmost grain's hold on the floor
  run.snapshots.emplace_back("gravity_19.62", heavy);
  const std::string file = folder / "r.h5";
  write_realization(file, run);
  const StudyResult result = analyse_pile(pile_case(), {file}, 1);
  EXPECT_NO_THROW(require_documented(result.summary));
  const double before = coordination(run.snapshots[0].second);
  EXPECT_NEAR(number(result, "change.gravity_19.62.coordination"), before - 1 / 210.0, 1e-12);
  EXPECT_NEAR(number(result, "change.gravity_19.62.coordination_ratio"), 1 - 1 / 210.0 / before,
              1e-12);
  EXPECT_NEAR(number(result, "change.gravity_19.62.dip_difference_change"), 0, 0.05);
}

TEST(PileAnalysis, RefusesARealizationWithoutItsPile) {
  const Folder folder;
  dem::RunResult run;
  run.snapshots = {{"loaded", test::lattice_heap(5)}};
  write_realization(folder / "r.h5", run);
  EXPECT_THROW(analyse_pile(pile_case(), {folder / "r.h5"}, 1), std::invalid_argument);
}

TEST(PileAnalysis, RefusesAKernelWithoutGrains) {
  const Folder folder;
  Case value = pile_case();
  value.get<AverageSetup>().width = 1e-6;
  const auto files = files_of(folder, {test::lattice_heap(12)});
  try {
    analyse_pile(value, files, 1);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(),
                HasSubstr("coarse_graining with a width of 1e-06 m, below 0.25 mean grain "
                          "diameters of 0.005 m"));
  }
}

TEST(Spread, IsStudentsT) {
  const Spread s = spread_of({1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.standard_error, std::sqrt(5.0 / 3 / 4));
  // t = 3.873 with 3 degrees of freedom (R: pt(3.872983, 3, lower = FALSE)).
  EXPECT_NEAR(s.p_value, 0.01523, 1e-4);
  EXPECT_NEAR(spread_of({-1, -2, -3, -4}).p_value, 1 - s.p_value, 1e-12);
  EXPECT_TRUE(std::isnan(spread_of({1, 2}).p_value));
  EXPECT_TRUE(std::isnan(spread_of({2, 2, 2}).p_value));
  EXPECT_TRUE(std::isnan(spread_of({1}).standard_error));
  EXPECT_TRUE(std::isnan(spread_of({}).mean));
  EXPECT_TRUE(std::isnan(spread_of({1, 2, std::nan("")}).mean));
}

}  // namespace
}  // namespace grainfield::coupling
