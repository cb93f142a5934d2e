// The measures of strain on the same points (Roul 3.8, figs 3.17-3.19).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "coupling/studies/pile_fields/drawing.h"
#include "coupling/studies/pile_fields/robust.h"
#include "coupling/studies/pile_fields/topic.h"

namespace grainfield::coupling {
namespace {

constexpr const char* kReference = "cambou";
// Strains are drawn in units of 1e-4.
constexpr double kPlotted = 1e4;
// |x| in half bases: under the apex, and beside it (as of the base pressure's dip).
constexpr double kCentre = 0.1, kShoulderFrom = 0.15, kShoulderTo = 0.4;

// Sums over points with both strains: the reference's square, the product, the difference's square;
// of the tensor and of yy alone.
struct Overlap {
  double reference = 0, product = 0, difference = 0;
  double reference_yy = 0, difference_yy = 0;
  int points = 0;
};

Overlap overlap(const Field& a, const Field& b, const std::vector<Eigen::Index>& points) {
  Overlap out;
  for (const Eigen::Index p : points) {
    Eigen::Vector4d e[2];
    for (int side = 0; side < 2; ++side) {
      const Field& f = side == 0 ? a : b;
      const double xy = f.find("strain_xy")->value[p];
      e[side] << f.find("strain_xx")->value[p], f.find("strain_yy")->value[p], xy, xy;
    }
    if (!e[0].allFinite() || !e[1].allFinite()) continue;
    out.reference += e[0].squaredNorm();
    out.product += e[0].dot(e[1]);
    out.difference += (e[1] - e[0]).squaredNorm();
    out.reference_yy += e[0][1] * e[0][1];
    out.difference_yy += (e[1][1] - e[0][1]) * (e[1][1] - e[0][1]);
    ++out.points;
  }
  return out;
}

struct Measured {
  std::vector<Field> piles;  // strain, rotation per pile
  Ensemble ensemble;
  std::string gaps;
};

// At every point the median over piles.
Eigen::VectorXd median_field(const std::vector<Field>& all, const std::string& column) {
  Eigen::VectorXd out(all.front().points.rows());
  for (Eigen::Index p = 0; p < out.size(); ++p) {
    std::vector<double> values;
    for (const Field& f : all) values.push_back(f.find(column)->value[p]);
    out[p] = median_of(std::move(values));
  }
  return out;
}

std::map<std::string, Measured> measure(const PileSet& piles) {
  std::map<std::string, Measured> out;
  for (int r = 0; r < piles.count(); ++r) {
    const Realization one = piles.realization(r);
    const Eigen::MatrixXd points = piles.frame(r).to_packing(piles.grid());
    for (const std::string& name : strain_measures()) {
      StrainResult found = strain(one["pile"], one[piles.change()], points,
                                  piles.strain_options(name, piles.radius()));
      Measured& m = out[name];
      if (r == 0) {
        std::size_t few = 0, degenerate = 0;
        for (const Eigen::Index p : piles.inside()) {
          few +=
              static_cast<std::size_t>(std::count(found.too_few.begin(), found.too_few.end(), p));
          degenerate += static_cast<std::size_t>(
              std::count(found.degenerate.begin(), found.degenerate.end(), p));
        }
        m.gaps = fmt::format("{} / {}", few, degenerate);
      }
      found.field.points = piles.grid();
      m.ensemble.add(found.field);
      m.piles.push_back(std::move(found.field));
    }
  }
  return out;
}

// Grid points of the row nearest to the lowest height whose RVEs are inside.
std::vector<Eigen::Index> lowest_row(const PileSet& piles) {
  std::vector<Eigen::Index> out;
  const int first = static_cast<int>(piles.inside().front()) / piles.columns();
  for (const Eigen::Index p : piles.inside()) {
    if (static_cast<int>(p) / piles.columns() == first) out.push_back(p);
  }
  return out;
}

// Differences of a measure from the reference: of every pile, and of the mean of the piles along
// the lowest row, which is what Roul compares.
struct Differences {
  std::vector<double> tensor, yy, ratio;  // of every pile
  ValueWithError low;
};
const std::vector<MedianFigure<Differences>>& difference_rows() {
  using D = const Differences&;
  static const std::vector<MedianFigure<Differences>> rows{
      {"difference", "-",
       "relative difference of the strain tensor from Cambou's over the points inside; median",
       [](D d) { return d.tensor; }},
      {"difference_yy", "-", "the same of the yy component", [](D d) { return d.yy; }},
      {"ratio", "-", "projection of the strain onto Cambou's: 1 is equal size; median",
       [](D d) { return d.ratio; }},
  };
  return rows;
}
const std::vector<ErrorFigure<Differences>>& low_rows() {
  static const std::vector<ErrorFigure<Differences>> rows{
      {"difference_yy_low", "-",
       "difference_yy of the mean over piles along the lowest row of elements",
       [](const Differences& d) { return d.low; }},
  };
  return rows;
}

// What a measure leaves of the displacements, in every pile; the derivative fits none.
struct Misfits {
  const std::string& measure;
  std::vector<double> shares;
};
const std::vector<MedianFigure<Misfits>>& misfit_rows() {
  static const std::vector<MedianFigure<Misfits>> rows{
      {"misfit", "-", "share of the displacements that the gradient leaves; median",
       [](const Misfits& m) {
         return m.measure == "derivative" ? std::nullopt : std::optional(m.shares);
       }},
  };
  return rows;
}

using DipRatios = std::vector<double>;
const std::vector<MedianFigure<DipRatios>>& dip_ratio_rows() {
  static const std::vector<MedianFigure<DipRatios>> rows{
      {"strain.dip_ratio", "-",
       "Cambou's vertical strain within 0.1 half bases of the apex over that from 0.15 to 0.4, "
       "along the lowest row; median over piles",
       [](const DipRatios& ratios) { return ratios; }},
  };
  return rows;
}

void add_differences(const PileSet& piles, const std::map<std::string, Measured>& all,
                     const std::string& name, Summary& summary, std::vector<std::string>& row) {
  const Measured &own = all.at(name), &reference = all.at(kReference);
  Differences found;
  for (std::size_t r = 0; r < own.piles.size(); ++r) {
    const Overlap o = overlap(reference.piles[r], own.piles[r], piles.inside());
    found.tensor.push_back(std::sqrt(o.difference / o.reference));
    found.yy.push_back(std::sqrt(o.difference_yy / o.reference_yy));
    found.ratio.push_back(o.product / o.reference);
  }
  const std::vector<Eigen::Index> low = lowest_row(piles);
  BootstrapOptions options;
  options.interval = "percentile";
  options.resamples = piles.resamples();
  const auto base = bootstrap(
      piles.count(),
      [&](const std::vector<int>& chosen) {
        double difference = 0, size = 0;
        for (const Eigen::Index p : low) {
          double a = 0, b = 0;
          for (const int r : chosen) {
            a += reference.piles[static_cast<std::size_t>(r)].find("strain_yy")->value[p];
            b += own.piles[static_cast<std::size_t>(r)].find("strain_yy")->value[p];
          }
          if (!std::isfinite(a) || !std::isfinite(b)) continue;
          difference += (b - a) * (b - a);
          size += a * a;
        }
        return Eigen::VectorXd::Constant(1, std::sqrt(difference / size));
      },
      options);
  const std::string prefix = "strain." + name + ".";
  found.low = {base[0].value, std::nullopt};
  if (piles.count() > 1) found.low.error = base[0].error;
  add_medians(difference_rows(), found, piles.resamples(), summary, prefix);
  add_values(low_rows(), found, summary, prefix);
  const auto percent = [&](const std::vector<double>& values) {
    const RobustMean m = robust_mean(values, piles.resamples());
    return fmt::format("{:.1f} ± {:.1f} %", 100 * m.median, 100 * m.error);
  };
  const RobustMean size = robust_mean(found.ratio, piles.resamples());
  row = {name,
         percent(found.tensor),
         percent(found.yy),
         fmt::format("{:.1f} ± {:.1f} %", 100 * base[0].value, 100 * base[0].error),
         fmt::format("{:.3f} ± {:.3f}", size.median, size.error),
         own.gaps};
}

// Vertical strain under the apex over that beside it, along the lowest row, of every pile.
std::vector<double> dip_ratios(const PileSet& piles, const std::vector<Field>& all) {
  const double half = (piles.mean(&PileFrame::half_left) + piles.mean(&PileFrame::half_right)) /
                      (2 * piles.height());
  std::vector<double> out;
  for (const Field& f : all) {
    std::vector<double> centre, shoulder;
    for (const Eigen::Index p : lowest_row(piles)) {
      const double x = std::fabs(piles.grid()(p, 0)) / half;
      if (x <= kCentre) centre.push_back(f.find("strain_yy")->value[p]);
      if (x >= kShoulderFrom && x <= kShoulderTo) {
        shoulder.push_back(f.find("strain_yy")->value[p]);
      }
    }
    out.push_back(median_of(std::move(centre)) / median_of(std::move(shoulder)));
  }
  return out;
}

TopicResult strain_measures_of_piles(const PileSet& piles) {
  const std::map<std::string, Measured> all = measure(piles);
  TopicResult out;
  std::vector<Map> pictures;
  Frame low;
  const int row = static_cast<int>(piles.inside().front()) / piles.columns();
  Table table{"Strain measures against Cambou's",
              "Medians over piles ± standard error. Difference: root of the sum of squared "
              "differences over that of Cambou's strain, over all points whose element is inside "
              "the heap; of the tensor, of its yy component, and of the yy component of the mean "
              "over piles along the lowest row. Size: projection onto Cambou's strain, 1 = equal. "
              "Gaps: points inside without a value in the first pile, for too few grains / for "
              "degenerate least squares.",
              {"measure", "difference", "of yy", "of mean yy, lowest row", "size", "gaps"},
              {}};
  for (const std::string& name : strain_measures()) {
    const Measured& m = all.at(name);
    const Field mean = m.ensemble.mean();
    const Eigen::VectorXd yy = median_field(m.piles, "strain_yy");
    pictures.push_back(map_of(piles, name, kPlotted * yy));
    Eigen::VectorXd error;
    if (name == kReference) error = mean.find("strain_yy")->error;
    low.series.push_back(
        row_of(piles, name, row, kPlotted * yy, kPlotted * error, name == kReference));
    std::vector<std::string> cells{name, "reference", "", "", "", m.gaps};
    if (name != kReference) add_differences(piles, all, name, out.summary, cells);
    table.rows.push_back(std::move(cells));
    std::vector<double> misfit;
    for (const Field& f : m.piles) {
      std::vector<double> own;
      for (const Eigen::Index p : piles.inside()) own.push_back(f.find("misfit")->value[p]);
      misfit.push_back(median_of(std::move(own)));
    }
    add_medians(misfit_rows(), {name, misfit}, piles.resamples(), out.summary,
                "strain." + name + ".");
    if (name == kReference) {
      add_medians(dip_ratio_rows(), dip_ratios(piles, m.piles), piles.resamples(), out.summary);
    }
    Field field = piles.in_metres(m.ensemble);
    field.add("strain_yy_median", "1").value = yy;
    out.fields.emplace_back("strain_" + name, std::move(field));
  }
  const auto percent = [&](const char* key) { return 100 * std::get<double>(out.summary.at(key)); };
  out.sentence = fmt::format(
      "From Cambou's strain Cundall's differs by {:.1f} %, Liao's by {:.1f} %, the derivative's by "
      "{:.1f} %, the kernel's by {:.1f} %.",
      percent("strain.cundall.difference"), percent("strain.liao.difference"),
      percent("strain.derivative.difference"), percent("strain.kernel.difference"));
  Picture picture = maps(fmt::format("Vertical strain ε_yy of the change to {}", piles.change()),
                         "x / h", "y / h", "ε_yy (1e-4)", pictures, true);
  picture.caption = "Medians over piles, extension positive. " + how_averaged(piles);
  out.sections.emplace_back(std::move(picture));
  Picture along = curves("Vertical strain along the lowest row of elements inside the heap",
                         "x / h (apex at 0)", "ε_{yy} (10^{-4})", {std::move(low)});
  along.caption = fmt::format(
      "At height {:.2f} h. Medians over piles; band: one standard error of Cambou's mean.",
      static_cast<double>(row) / (piles.rows() - 1));
  out.sections.emplace_back(std::move(along));
  out.sections.emplace_back(std::move(table));
  return out;
}

std::vector<SummaryKey> strain_measure_figures() {
  return joined({declared(difference_rows(), "strain.*."), declared(low_rows(), "strain.*."),
                 declared(misfit_rows(), "strain.*."), declared(dip_ratio_rows())});
}

}  // namespace

Topic strain_measures_topic() {
  return {"strain_measures", "five measures of strain on the same points", strain_measures_of_piles,
          strain_measure_figures};
}

}  // namespace grainfield::coupling
