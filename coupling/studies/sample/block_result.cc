// What is told of a block of finite elements beside the grains.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/case/declare.h"
#include "coupling/judge/words.h"
#include "coupling/result/csv.h"
#include "coupling/statistics/spread.h"
#include "coupling/studies/sample/block.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// A law has left the grains where its driving stress is off by this share of their largest.
constexpr double kHasLeft = 0.1;
// Share of the grains' largest stress below which they carry next to nothing.
constexpr double kUnloaded = 0.01;
// A block whose volume the path prescribes shows no difference of it beyond rounding.
constexpr double kNoDifference = 1e-9;

// The spread of the realizations that have a value.
Spread spread_in(const Eigen::MatrixXd& values, Index state) {
  std::vector<double> known;
  for (const double v : values.row(state)) {
    if (std::isfinite(v)) known.push_back(v);
  }
  return spread_of(known);
}

std::string shown(const Spread& s) { return with_error(s.mean, s.standard_error); }

struct Stage {
  Spread grains, law, difference;
  /// The mean difference over its standard error.
  double over_error() const { return difference.mean / difference.standard_error; }
};

// What a law says, by stage and realization. Where it has no answer for some realizations, moved by
// what the others' grains are off the mean of all: its mean is then that of the grains and the mean
// difference.
Eigen::MatrixXd law_beside(const BlockQuantity& q, const std::string& law) {
  Eigen::MatrixXd values = q.laws.at(law);
  for (Index k = 0; k < values.rows(); ++k) {
    const Eigen::ArrayXd there = values.row(k).array().isFinite().cast<double>();
    if (there.sum() == 0 || there.minCoeff() == 1) continue;
    const double of_those = (there > 0).select(q.grains.row(k).transpose().array(), 0.0).sum();
    values.row(k).array() += spread_in(q.grains, k).mean - of_those / there.sum();
  }
  return values;
}

Stage stage_of(const BlockQuantity& q, const std::string& law, Index k) {
  const Eigen::MatrixXd& values = q.laws.at(law);
  Stage out{spread_in(q.grains, k), spread_in(law_beside(q, law), k),
            spread_in(values - q.grains, k)};
  if (std::fabs(out.difference.mean) <= kNoDifference * std::fabs(out.law.mean)) {
    out.difference.mean = 0;
  }
  return out;
}

Series block_series(const BlockComparison& c, const std::string& label,
                    const Eigen::MatrixXd& values, bool grains) {
  VectorXd mean(values.rows()), error(values.rows());
  for (Index k = 0; k < values.rows(); ++k) {
    const Spread s = spread_in(values, k);
    mean[k] = s.mean;
    error[k] = s.standard_error;
  }
  return {label, c.strain, mean, error, grains, true};
}

Table stages_table(const BlockComparison& c) {
  Table table;
  table.title = "Stage by stage";
  table.caption = fmt::format(
      "Mean over realizations and standard error of the grains, each law less the grains with its "
      "standard error. A law has left the grains where its driving stress is off by {:.0f} % of "
      "their largest.",
      100 * kHasLeft);
  table.header = {"strain"};
  for (const BlockQuantity& q : c.quantities) {
    const std::string unit = q.unit == "-" ? "" : " (" + q.unit + ")";
    table.header.push_back(q.name + unit + ", grains");
    for (const std::string& law : c.laws) table.header.push_back(law + " − grains");
  }
  for (Index k = 0; k < c.strain.size(); ++k) {
    auto& row = table.rows.emplace_back();
    row.push_back(fmt::format("{:.4g}", c.strain[k]));
    for (const BlockQuantity& q : c.quantities) {
      row.push_back(shown(spread_in(q.grains, k)));
      for (const std::string& law : c.laws) row.push_back(shown(stage_of(q, law, k).difference));
    }
  }
  return table;
}

}  // namespace

std::string block_csv(const BlockComparison& c) {
  Csv out;
  out.comment("the sample as a block of finite elements beside the grains, mean over realizations");
  out.comment(
      "NAME: of the grains, with its standard error; NAME_LAW: of the block, then the block less "
      "the grains, its standard error, and the one over the other");
  out.add("state").add("strain");
  for (const BlockQuantity& q : c.quantities) {
    const std::string name = csv_heading(q.name, q.unit);
    out.add(name).add(name + "_error");
    for (const std::string& law : c.laws) {
      for (const char* part : {"", "_difference", "_difference_error", "_over_error"}) {
        out.add(name + "_" + law + part);
      }
    }
  }
  out.end_row();
  for (Index k = 0; k < c.strain.size(); ++k) {
    out.add(k).add(c.strain[k]);
    for (const BlockQuantity& q : c.quantities) {
      const Spread grains = spread_in(q.grains, k);
      out.add(grains.mean).add(grains.standard_error);
      for (const std::string& law : c.laws) {
        const Stage s = stage_of(q, law, k);
        out.add(s.law.mean).add(s.difference.mean).add(s.difference.standard_error);
        out.add(s.over_error());
      }
    }
    out.end_row();
  }
  return out.text();
}

namespace {

using Value = std::optional<double>;

// One realization that a law has an answer for: the driving stress, or the mean stress beside it.
struct LawPath {
  LawPath(const BlockComparison& all, const BlockQuantity& q, const std::string& name, Index r)
      : c(all), grains(q.grains.col(r)), block(q.laws.at(name).col(r)) {
    off = (block - grains).head(loading());
    const double most = kHasLeft * grains.head(loading()).cwiseAbs().maxCoeff();
    while (left < loading() && std::fabs(off[left]) <= most) ++left;
  }

  Index loading() const { return c.loading + 1; }
  bool leaves() const { return left < loading(); }
  Index back() const { return grains.size() - loading(); }

  const BlockComparison& c;
  VectorXd grains, block, off;  // off: of the loading
  Index left = 0;               // first state in which the law has left the grains
};
using L = const LawPath&;

Value unloading_rel_l2(L p) {
  if (p.back() == 0) return {};
  return (p.block - p.grains).tail(p.back()).norm() / p.grains.tail(p.back()).norm();
}

Value unloading_slopes(L p) {
  const Index from = p.c.loading, middle = from + (p.back() + 1) / 2;
  if (p.back() == 0) return {};
  return (p.block[middle] - p.block[from]) / (p.grains[middle] - p.grains[from]);
}

// Over grains that carry next to nothing any more a ratio says nothing.
Value unloaded_ratio(L p) {
  const double end = p.grains[p.grains.size() - 1];
  const bool carries = std::fabs(end) >= kUnloaded * p.grains.cwiseAbs().maxCoeff();
  return p.back() == 0 || !carries ? Value() : Value(p.block[p.block.size() - 1] / end);
}

const std::vector<Figure<LawPath>>& distance_rows() {
  // clang-format off
  static const std::vector<Figure<LawPath>> rows{
      {"rel_l2", "-", "root of the squared difference of the driving stress between block and grains over that of the grains, loading", [](L p) { return p.off.norm() / p.grains.head(p.loading()).norm(); }},
      {"end_ratio", "-", "driving stress of the block over the grains' at its end", [](L p) { return p.block[p.c.loading] / p.grains[p.c.loading]; }},
      {"leaves", "-", "share of the samples that the block leaves: its driving stress is off by more than 10 % of the grains' largest", [](L p) { return p.leaves() ? 1 : 0; }},
      {"leaves_at", "-", "imposed strain of the first such state, of these samples", [](L p) { return p.leaves() ? Value(p.c.strain[p.left]) : Value(); }},
  };
  // clang-format on
  return rows;
}

const std::vector<Figure<LawPath>>& unloading_rows() {
  // clang-format off
  static const std::vector<Figure<LawPath>> rows{
      {"unloading_rel_l2", "-", "as rel_l2, of the driving stress in the unloading", unloading_rel_l2},
      {"unloading_stiffness", "-", "slope of the block's driving stress to the middle state of the unloading over the grains'", unloading_slopes},
      {"unloaded_ratio", "-", "driving stress of the block at the end of the unloading over the grains', of samples that still carry a hundredth of their largest", unloaded_ratio},
  };
  // clang-format on
  return rows;
}

// The same rows of the mean stress, where another one drives.
std::vector<SummaryKey> of_mean_stress() {
  std::vector<SummaryKey> out = declared(distance_rows(), "block.*.pressure_");
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].meaning = fmt::format("as {}, of the mean stress", distance_rows()[k].key);
  }
  return out;
}

}  // namespace

FigureSamples block_figures(const BlockComparison& c) {
  FigureSamples out;
  const BlockQuantity &driving = c.quantities.front(), &volume = c.quantities.back();
  for (const std::string& law : c.laws) {
    const std::string begin = "block." + law + ".";
    for (const BlockQuantity& q : c.quantities) {
      const bool drives = &q == &driving;
      if (!drives && q.name != "p") continue;
      for (Index r = 0; r < q.grains.cols(); ++r) {
        if (!q.laws.at(law).col(r).allFinite()) continue;
        const LawPath path(c, q, law, r);
        add_samples(distance_rows(), path, out, drives ? begin : begin + "pressure_");
        if (drives) add_samples(unloading_rows(), path, out, begin);
      }
    }
    for (Index r = 0; r < volume.grains.cols(); ++r) {
      const double off = volume.laws.at(law)(c.loading, r) - volume.grains(c.loading, r);
      if (std::isfinite(off)) out[begin + "volumetric_difference"].push_back(off);
    }
    if (law != kPlasticBlock) continue;
    if (!c.friction.empty()) out[begin + "friction_deg"] = c.friction;
    if (!c.dilation.empty()) out[begin + "dilation_deg"] = c.dilation;
  }
  return out;
}

namespace {

// Where each law leaves the grains, from the same figures as summary.json.
Table leaving_table(const BlockComparison& c) {
  Table table;
  table.title = "Where the continuum leaves the grains";
  table.caption = fmt::format(
      "Mean over realizations and its standard error. A law has left where its driving stress is "
      "off by {:.0f} % of the grains' largest; the strain of that is of the samples that it "
      "leaves.",
      100 * kHasLeft);
  table.header = {""};
  for (const std::string& law : c.laws) table.header.push_back(law);
  const auto figures = block_figures(c);
  for (const SummaryKey& key : block_summary_keys()) {
    const std::string name = key.pattern.substr(key.pattern.rfind('.') + 1);
    std::vector<std::string> row{key.meaning};
    bool any = false;
    for (const std::string& law : c.laws) {
      const auto found = figures.find(fmt::format("block.{}.{}", law, name));
      any = any || found != figures.end();
      row.push_back(found == figures.end() ? "–" : shown(spread_of(found->second)));
    }
    if (any) table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::vector<Section> block_sections(const BlockComparison& c) {
  std::vector<Section> out;
  for (const std::string& line : c.remarks) out.emplace_back(Text{"", line});
  if (c.laws.empty()) return out;
  std::vector<Frame> frames;
  for (const BlockQuantity& q : c.quantities) {
    Frame frame{q.unit == "-" ? q.name : q.name + " (" + q.unit + ")", {}};
    frame.series.push_back(block_series(c, "grains", q.grains, true));
    for (const std::string& law : c.laws) {
      frame.series.push_back(block_series(c, law, law_beside(q, law), false));
    }
    frames.push_back(std::move(frame));
  }
  Picture picture =
      curves("The grains and a block of finite elements", "imposed strain", "", frames);
  picture.caption =
      "The block has the moduli of small strains in the first state and the angles of the grains' "
      "strength; it starts from their stress and goes their way. Bands: one standard error over "
      "realizations.";
  out.emplace_back(std::move(picture));
  out.emplace_back(leaving_table(c));
  out.emplace_back(stages_table(c));
  return out;
}

void declare_block_keys(SectionKeys s) {
  s.word("law", GRAINFIELD_MEMBER(BlockSetup, law), {"none", "elastic", "mohr_coulomb", "both"},
         "laws of a block of finite elements that goes the sample's way beside the grains, with "
         "the moduli of small strains (sample.probe); Mohr-Coulomb: elastic, perfectly plastic, "
         "without cohesion");
  s.space();
  s.word("angles", GRAINFIELD_MEMBER(BlockSetup, angles), {"peak", "residual", "given"},
         "its friction and dilation: those of the grains at their peak, in the last quarter of "
         "strain (strength.*), or given, such as those of another test; where a shear holds the "
         "volume "
         "the grains show no dilation, and only a given block has one");
  s.only("block.law", {"mohr_coulomb", "both"});
  s.number("friction_deg", "deg", GRAINFIELD_MEMBER(BlockSetup, friction_deg), {0.1, 80},
           "its friction angle");
  s.only("block.law", {"mohr_coulomb", "both"});
  s.only("block.angles", {"given"});
  s.number("dilation_deg", "deg", GRAINFIELD_MEMBER(BlockSetup, dilation_deg), {0, 80},
           "its dilation angle, up to the friction angle");
  s.only("block.law", {"mohr_coulomb", "both"});
  s.only("block.angles", {"given"});
  s.number("cells", "-", GRAINFIELD_MEMBER(BlockSetup, cells), {1, 8},
           "cells of its mesh along each edge; the block stays uniform, so that more only check");
  s.only("block.law", {"elastic", "mohr_coulomb", "both"});
}

std::vector<SummaryKey> block_summary_keys() {
  std::vector<SummaryKey> out{
      {"block.*.volumetric_difference", "-",
       "volumetric strain of the block less the grains' at the end of the loading"}};
  for (const auto& part : {declared(distance_rows(), "block.*."), of_mean_stress(),
                           declared(unloading_rows(), "block.*.")}) {
    out.insert(out.end(), part.begin(), part.end());
  }
  out.push_back({"block.mohr_coulomb.friction_deg", "deg", "friction angle that the block had"});
  out.push_back({"block.mohr_coulomb.dilation_deg", "deg", "dilation angle that it had"});
  return out;
}

}  // namespace grainfield::coupling
