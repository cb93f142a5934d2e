// What is told of a block of finite elements beside the grains.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/case/declare.h"
#include "coupling/statistics/spread.h"
#include "coupling/studies/sample/block.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// A law has left the grains where its driving stress is off by this share of their largest.
constexpr double kHasLeft = 0.1;
// A block whose volume the path prescribes shows no difference of it beyond rounding.
constexpr double kNoDifference = 1e-9;

// Of the realizations that have a value.
Spread spread_in(const Eigen::MatrixXd& values, Index state) {
  std::vector<double> known;
  for (const double v : values.row(state)) {
    if (std::isfinite(v)) known.push_back(v);
  }
  return spread_of(known);
}

std::string spread_told(const Spread& s) {
  return std::isnan(s.standard_error) ? fmt::format("{:.4g}", s.mean)
                                      : fmt::format("{:.4g} ± {:.1g}", s.mean, s.standard_error);
}

std::string block_number(double value) {
  return std::isnan(value) ? "nan" : fmt::format("{:.6g}", value);
}

struct Stage {
  Spread grains, law, difference;
  /// Of the mean difference over its standard error.
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
      row.push_back(spread_told(spread_in(q.grains, k)));
      for (const std::string& law : c.laws)
        row.push_back(spread_told(stage_of(q, law, k).difference));
    }
  }
  return table;
}

}  // namespace

std::string block_csv(const BlockComparison& c) {
  std::string out =
      "# the sample as a block of finite elements beside the grains, mean over realizations\n"
      "# NAME: of the grains, with its standard error; NAME_LAW: of the block, then the block less "
      "the grains, its standard error, and the one over the other\n";
  std::string heading = "state,strain";
  for (const BlockQuantity& q : c.quantities) {
    const std::string name = q.unit == "-" ? q.name : q.name + "_" + q.unit;
    heading += fmt::format(",{0},{0}_error", name);
    for (const std::string& law : c.laws) {
      heading += fmt::format(
          ",{0}_{1},{0}_{1}_difference,{0}_{1}_difference_error,{0}_{1}_over_error", name, law);
    }
  }
  out += heading + "\n";
  for (Index k = 0; k < c.strain.size(); ++k) {
    out += fmt::format("{},{:.9g}", k, c.strain[k]);
    for (const BlockQuantity& q : c.quantities) {
      const Spread grains = spread_in(q.grains, k);
      out += fmt::format(",{},{}", block_number(grains.mean), block_number(grains.standard_error));
      for (const std::string& law : c.laws) {
        const Stage s = stage_of(q, law, k);
        for (const double v :
             {s.law.mean, s.difference.mean, s.difference.standard_error, s.over_error()}) {
          out += fmt::format(",{}", block_number(v));
        }
      }
    }
    out += "\n";
  }
  return out;
}

std::map<std::string, std::vector<double>> block_figures(const BlockComparison& c) {
  std::map<std::string, std::vector<double>> out;
  const Index n = c.loading + 1;
  for (const std::string& law : c.laws) {
    const BlockQuantity &driving = c.quantities.front(), &volume = c.quantities.back();
    const auto put = [&](const char* key, double value) {
      out[fmt::format("block.{}.{}", law, key)].push_back(value);
    };
    for (Index r = 0; r < driving.grains.cols(); ++r) {
      if (!driving.laws.at(law).col(r).allFinite()) continue;
      const VectorXd grains = driving.grains.col(r).head(n);
      const VectorXd off = driving.laws.at(law).col(r).head(n) - grains;
      put("rel_l2", off.norm() / grains.norm());
      put("end_ratio", driving.laws.at(law)(n - 1, r) / grains[n - 1]);
      put("volumetric_difference", volume.laws.at(law)(n - 1, r) - volume.grains(n - 1, r));
      const double most = kHasLeft * grains.cwiseAbs().maxCoeff();
      Index left = 0;
      while (left < n && std::fabs(off[left]) <= most) ++left;
      put("leaves", left < n ? 1 : 0);
      if (left < n) put("leaves_at", c.strain[left]);
    }
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
    auto& row = table.rows.emplace_back();
    row.push_back(key.meaning);
    for (const std::string& law : c.laws) {
      const auto found = figures.find(fmt::format("block.{}.{}", law, name));
      row.push_back(found == figures.end() ? "–" : spread_told(spread_of(found->second)));
    }
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
         "strain (strength.*), or given; where the volume is held, without dilation");
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
  return {
      {"block.*.rel_l2", "-",
       "root of the squared difference of the driving stress between block and grains over that of "
       "the grains, loading"},
      {"block.*.end_ratio", "-", "driving stress of the block over the grains' at its end"},
      {"block.*.volumetric_difference", "-",
       "volumetric strain of the block less the grains' there"},
      {"block.*.leaves", "-",
       "share of the samples that the block leaves: its driving stress is off by more than 10 % of "
       "the grains' largest"},
      {"block.*.leaves_at", "-", "imposed strain of the first such state, of these samples"},
  };
}

}  // namespace grainfield::coupling
