// Fabric over the heap and what it goes with (Roul 3.5 to 3.9, figs 3.12-3.15, 3.20-3.24).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include "coupling/judge/words.h"
#include "coupling/run/study_result.h"
#include "coupling/statistics/correlation.h"
#include "coupling/statistics/spread.h"
#include "coupling/structure/coordination_counts.h"
#include "coupling/structure/grain_axes.h"
#include "coupling/structure/size_factor.h"
#include "coupling/structure/tensor_axes.h"
#include "coupling/studies/pile_fields/drawing.h"
#include "coupling/studies/pile_fields/robust.h"
#include "coupling/studies/pile_fields/topic.h"

namespace grainfield::coupling {
namespace {

// Share of the half base from which on a point belongs to a flank.
constexpr double kOuter = 0.4;
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kBins = 15;

using Tensors = Eigen::MatrixX3d;  // xx, yy, xy per point

Tensors tensors(const Field& f, const std::string& name) {
  Tensors out(f.points.rows(), 3);
  out << f.find(name + "_xx")->value, f.find(name + "_yy")->value, f.find(name + "_xy")->value;
  if (const Column* yx = f.find(name + "_yx")) out.col(2) = (out.col(2) + yx->value) / 2;
  return out;
}

struct PileTensors {
  Tensors fabric, stress, strain;  // stress over rho g h; strain as if gravity had risen
};

std::vector<PileTensors> all_tensors(const PileSet& piles) {
  const auto at = std::find(piles.changes().begin(), piles.changes().end(), piles.change());
  const double ratio =
      piles.gravity_ratios()[static_cast<std::size_t>(at - piles.changes().begin())];
  std::vector<PileTensors> out;
  for (int r = 0; r < piles.count(); ++r) {
    const PileFields& f = piles.fields(r);
    out.push_back({tensors(f.rest, "fabric"), tensors(f.rest, "sigma") / piles.frame(r).pressure(),
                   (ratio < 1 ? -1 : 1) * tensors(f.strain.field, "strain")});
  }
  return out;
}

// Means of fabric and stress, medians of the strain, over the chosen piles.
PileTensors mean_of(const std::vector<PileTensors>& all, const std::vector<int>& chosen) {
  const Eigen::Index n = all.front().fabric.rows();
  PileTensors out{Tensors::Zero(n, 3), Tensors::Zero(n, 3), Tensors::Zero(n, 3)};
  const auto count = static_cast<double>(chosen.size());
  for (const int r : chosen) {
    out.fabric += all[static_cast<std::size_t>(r)].fabric / count;
    out.stress += all[static_cast<std::size_t>(r)].stress / count;
  }
  std::vector<double> values;
  for (Eigen::Index p = 0; p < n; ++p) {
    for (int c = 0; c < 3; ++c) {
      values.clear();
      for (const int r : chosen) values.push_back(all[static_cast<std::size_t>(r)].strain(p, c));
      out.strain(p, c) = median_of(values);
    }
  }
  return out;
}

double angle(const Tensors& t, Eigen::Index p, bool compressive) {
  return tensor_axes(t(p, 0), t(p, 1), t(p, 2)).angle_deg(compressive ? 1 : 0);
}

// Mean axis, deg, of axes given in degrees: half the argument of the mean of exp(2 i a).
double mean_axis(const std::vector<double>& degrees) {
  std::complex<double> sum = 0;
  for (const double a : degrees) {
    if (std::isfinite(a)) sum += std::polar(1.0, 2 * a / kDegrees);
  }
  return std::abs(sum) > 0 ? std::arg(sum) / 2 * kDegrees : NAN;
}

// Figures of the mean tensors on the points inside, in the order of axis_rows().
using AxisFigures = std::vector<ValueWithError>;
const std::vector<ErrorFigure<AxisFigures>>& axis_rows() {
  const auto number = [](std::size_t k) { return [k](const AxisFigures& all) { return all[k]; }; };
  static const std::vector<ErrorFigure<AxisFigures>> rows{
      {"fabric.angle_to_stress_deg", "deg",
       "between the major axes of fabric and stress; median over the points inside", number(0)},
      {"fabric.angle_to_strain_deg", "deg", "the same of fabric and strain", number(1)},
      {"fabric.angle_stress_strain_deg", "deg", "the same of stress and strain", number(2)},
      {"fabric.anisotropy", "-", "F_D / tr F; median over the points inside", number(3)},
      {"fabric.anisotropy_centre", "-", "the same within 0.4 half bases of the apex", number(4)},
      {"fabric.anisotropy_flanks", "-", "the same beyond", number(5)},
      {"fabric.axis_left_deg", "deg",
       "fabric's major axis from x, mean beyond 0.4 half bases on the left", number(6)},
      {"fabric.axis_right_deg", "deg", "the same on the right", number(7)},
  };
  return rows;
}

Eigen::VectorXd axis_figures(const PileSet& piles, const PileTensors& t) {
  std::array<std::vector<double>, 8> v;
  const double half = (piles.mean(&PileFrame::half_left) + piles.mean(&PileFrame::half_right)) /
                      (2 * piles.height());
  for (const Eigen::Index p : piles.inside()) {
    const double fabric = angle(t.fabric, p, false), stress = angle(t.stress, p, true),
                 strain = angle(t.strain, p, true);
    const auto between = [](double a, double b) {
      return std::isnan(a) || std::isnan(b) ? NAN : angle_between_axes_deg(a, b);
    };
    v[0].push_back(between(fabric, stress));
    v[1].push_back(between(fabric, strain));
    v[2].push_back(between(stress, strain));
    const double fraction =
        tensor_axes(t.fabric(p, 0), t.fabric(p, 1), t.fabric(p, 2)).deviatoric_fraction();
    v[3].push_back(fraction);
    const double x = piles.grid()(p, 0) / half;
    v[std::fabs(x) > kOuter ? 5 : 4].push_back(fraction);
    if (std::fabs(x) > kOuter) v[x < 0 ? 6 : 7].push_back(fabric);
  }
  Eigen::VectorXd out(8);
  for (int k = 0; k < 6; ++k) out[k] = median_of(v[static_cast<std::size_t>(k)]);
  out[6] = mean_axis(v[6]);
  out[7] = mean_axis(v[7]);
  return out;
}

// Fields of mean tensors with their invariants, axes and the angles between the axes.
Field axes_field(const PileSet& piles, const PileTensors& t) {
  Field out = piles.on_grid();
  const auto put = [&](const char* name, const Tensors& m, const char* unit) {
    const char* suffix[] = {"_xx", "_yy", "_xy"};
    for (int c = 0; c < 3; ++c) out.add(name + std::string(suffix[c]), unit).value = m.col(c);
  };
  put("fabric", t.fabric, "1");
  put("sigma", piles.pressure() * t.stress, "N/m");
  put("strain", t.strain, "1");
  add_tensor_columns(out, "fabric", MajorAxis::largest);
  add_tensor_columns(out, "sigma", MajorAxis::most_compressive);
  add_tensor_columns(out, "strain", MajorAxis::most_compressive);
  add_angle_between(out, "fabric", "sigma");
  add_angle_between(out, "fabric", "strain");
  add_angle_between(out, "sigma", "strain");
  return out;
}

// nu c, tr F and nu over the points inside of every pile, with the pile's number.
struct Pairs {
  std::vector<double> nu_c, trace, nu;
  std::vector<int> pile;
};

Pairs pairs_of(const PileSet& piles) {
  Pairs out;
  for (int r = 0; r < piles.count(); ++r) {
    const Field& f = piles.fields(r).rest;
    const Eigen::VectorXd& nu = f.find("volume_fraction")->value;
    for (const Eigen::Index p : piles.inside()) {
      out.nu.push_back(nu[p]);
      out.nu_c.push_back(nu[p] * f.find("coordination")->value[p]);
      out.trace.push_back(f.find("fabric_xx")->value[p] + f.find("fabric_yy")->value[p]);
      out.pile.push_back(r);
    }
  }
  return out;
}

Eigen::VectorXd vector_of(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}

// tr F against nu c and against nu.
struct Laws {
  Correlation product, density;
  double trace_over_product = NAN;
  bool have_errors = false;

  ValueWithError correlation_of(const Correlation& c) const {
    return {c.r, have_errors ? std::optional(c.interval.error) : std::nullopt};
  }
};
const std::vector<ErrorFigure<Laws>>& law_rows() {
  using L = const Laws&;
  static const std::vector<ErrorFigure<Laws>> rows{
      {"fabric.nu_c_correlation", "-", "of tr F with nu c over the points of all piles",
       [](L l) { return l.correlation_of(l.product); }},
      {"fabric.nu_c_slope", "-", "slope of tr F over nu c",
       [](L l) { return ValueWithError{l.product.slope}; }},
      {"fabric.trace_over_nu_c", "-", "sum of tr F over sum of nu c, points of all piles",
       [](L l) { return ValueWithError{l.trace_over_product}; }},
      {"fabric.nu_correlation", "-", "of tr F with nu over the points of all piles",
       [](L l) { return l.correlation_of(l.density); }},
      {"fabric.nu_slope", "-", "slope of tr F over nu",
       [](L l) { return ValueWithError{l.density.slope}; }},
  };
  return rows;
}

void add_laws(const PileSet& piles, TopicResult& out) {
  const Pairs pairs = pairs_of(piles);
  BootstrapOptions options;
  options.interval = "percentile";
  options.resamples = piles.resamples();
  const auto law = [&](const std::vector<double>& x) {
    return correlation(vector_of(x), vector_of(pairs.trace), pairs.pile, options);
  };
  Laws laws{law(pairs.nu_c), law(pairs.nu), NAN, piles.count() > 1};
  double trace = 0, nu_c = 0;
  for (std::size_t k = 0; k < pairs.trace.size(); ++k) {
    if (!std::isfinite(pairs.trace[k]) || !std::isfinite(pairs.nu_c[k])) continue;
    trace += pairs.trace[k];
    nu_c += pairs.nu_c[k];
  }
  laws.trace_over_product = trace / nu_c;
  add_values(law_rows(), laws, out.summary);
  Series line = binned("tr F = ν c", pairs.nu_c, pairs.nu_c, kBins);
  line.simulation = false;
  line.error.resize(0);
  Picture picture =
      curves("Trace of the fabric against ν c and ν", "ν c  |  ν", "tr F",
             {Frame{fmt::format("tr F against nu c: r = {:.2f}", laws.product.r),
                    {binned("points inside, all piles", pairs.nu_c, pairs.trace, kBins), line}},
              Frame{fmt::format("tr F against nu: r = {:.2f}", laws.density.r),
                    {binned("points inside, all piles", pairs.nu, pairs.trace, kBins)}}});
  picture.caption =
      "In bins of equally many points; band: standard error within the bin (Roul figs 3.21, 3.22).";
  out.sections.emplace_back(std::move(picture));
}

// A state of a pile: "heap." comes before the keys, of another gravity "change.NAME.".
const std::vector<Figure<CoordinationCounts>>& count_rows() {
  using C = const CoordinationCounts&;
  static const std::vector<Figure<CoordinationCounts>> rows{
      {"coordination", "-", "contacts of a grain", [](C c) { return c.mean; }},
      {"coordination_bearing", "-", "contacts of a grain without rattlers",
       [](C c) { return c.mean_bearing; }},
      {"rattlers", "-", "share of the grains that bear nothing",
       [](C c) { return static_cast<double>(c.rattlers) / c.grains; }},
  };
  return rows;
}
struct ChangedCounts {
  const CoordinationCounts &changed, &rest;
};
const std::vector<Figure<ChangedCounts>>& changed_count_rows() {
  using C = const ChangedCounts&;
  static const std::vector<Figure<ChangedCounts>> rows{
      {"coordination_ratio", "-", "coordination over that of the pile",
       [](C c) { return c.changed.mean / c.rest.mean; }},
      {"coordination_bearing_ratio", "-", "coordination_bearing over that of the pile",
       [](C c) { return c.changed.mean_bearing / c.rest.mean_bearing; }},
  };
  return rows;
}

// Share of the grains with k contacts, one row per k, one column of piles per state.
struct Contacts {
  std::vector<std::string> states;     // "pile", changes
  std::vector<Eigen::MatrixXd> share;  // state: k x piles
  FigureSamples figures;
};

Contacts count_contacts(const PileSet& piles) {
  constexpr Eigen::Index kMost = 13;
  Contacts out;
  out.states = piles.changes();
  out.states.insert(out.states.begin(), "pile");
  out.share.assign(out.states.size(), Eigen::MatrixXd::Zero(kMost, piles.count()));
  for (int r = 0; r < piles.count(); ++r) {
    const Realization one = piles.realization(r);
    CoordinationCounts rest;
    for (std::size_t s = 0; s < out.states.size(); ++s) {
      const CoordinationCounts c = coordination_counts(one[out.states[s]]);
      for (std::size_t k = 0; k < c.with.size(); ++k) {
        out.share[s](std::min<Eigen::Index>(static_cast<Eigen::Index>(k), kMost - 1), r) +=
            static_cast<double>(c.with[k]) / c.grains;
      }
      const std::string prefix = s == 0 ? "heap." : "change." + out.states[s] + ".";
      add_samples(count_rows(), c, out.figures, prefix);
      if (s == 0)
        rest = c;
      else
        add_samples(changed_count_rows(), {c, rest}, out.figures, prefix);
    }
  }
  return out;
}

void add_contacts(const PileSet& piles, TopicResult& out) {
  const Contacts found = count_contacts(piles);
  add_figures(out.summary, found.figures);
  Frame frame;
  Field field;
  const Eigen::Index n = found.share.front().rows();
  field.points = Eigen::MatrixXd::Zero(n, 2);
  field.points.col(0) = Eigen::VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1));
  field.attributes["points"] = "x: contacts of a grain; y: 0";
  Table table{"Contacts per grain under other gravities",
              "Means over piles ± standard error.",
              {"gravity", "g / g of the pour", "contacts per grain", "without rattlers", "rattlers",
               "contacts over those at rest"},
              {}};
  for (std::size_t s = 0; s < found.states.size(); ++s) {
    const std::string prefix = s == 0 ? "heap." : "change." + found.states[s] + ".";
    const auto cell = [&](const std::string& key, double factor, const char* unit) {
      const auto at = found.figures.find(prefix + key);
      if (at == found.figures.end()) return std::string("1");
      const Spread m = spread_of(at->second);
      return with_error(factor * m.mean, factor * m.standard_error) + unit;
    };
    table.rows.push_back({found.states[s],
                          s == 0 ? "1" : fmt::format("{:.3g}", piles.gravity_ratios()[s - 1]),
                          cell("coordination", 1, ""), cell("coordination_bearing", 1, ""),
                          cell("rattlers", 100, " %"), cell("coordination_ratio", 1, "")});
    Eigen::VectorXd mean(n), error(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::VectorXd shares = found.share[s].row(k);
      const Spread m = spread_of({shares.begin(), shares.end()});
      mean[k] = m.mean;
      error[k] = m.standard_error;
    }
    Column& column = field.add("share_" + found.states[s], "1");
    column.value = mean;
    column.error = error;
    frame.series.push_back(
        {s == 0 ? "at rest" : fmt::format("g x {:.3g}", piles.gravity_ratios()[s - 1]),
         field.points.col(0), mean, s == 0 ? error : Eigen::VectorXd(), s == 0});
  }
  Picture picture = curves("Distribution of coordination", "contacts of a grain",
                           "share of the grains", {std::move(frame)});
  picture.caption = fmt::format("Means over piles; {:d} stands for {:d} and more (Roul fig. 3.24).",
                                n - 1, n - 1);
  out.sections.emplace_back(std::move(picture));
  out.sections.emplace_back(std::move(table));
  out.fields.emplace_back("coordination", std::move(field));
}

// The grains of one pile.
struct PileGrains {
  GrainAxes axes;
  SizeFactor size;
};
const std::vector<Figure<PileGrains>>& grain_rows() {
  using G = const PileGrains&;
  static const std::vector<Figure<PileGrains>> rows{
      {"orientation.order", "-", "nematic order of the grains' long axes",
       [](G g) { return g.axes.order; }},
      {"fabric.g2", "-", "tr F/(nu c) of all grains of a pile", [](G g) { return g.size.measured; },
       "g2"},
      {"fabric.g2_theory", "-", "g2 by Madadi et al. (2004) from the grains' sizes",
       [](G g) { return g.size.theory; }},
  };
  return rows;
}
// Long axes of all piles together.
struct LongAxes {
  double random_order = 0;
  std::complex<double> mean = 0;  // exp(2 i a), weighted by the piles' orders
};
const std::vector<RunFigure<LongAxes>>& long_axis_rows() {
  using L = const LongAxes&;
  static const std::vector<RunFigure<LongAxes>> rows{
      {"orientation.random_order", "-", "order of as many random axes",
       [](L l) { return l.random_order; }},
      {"orientation.director_deg", "deg", "mean long axis from x",
       [](L l) { return std::abs(l.mean) > 0 ? std::arg(l.mean) / 2 * kDegrees : NAN; }},
  };
  return rows;
}

// How grains lie: order and director of each pile, and the long axis over the heap.
void add_orientation(const PileSet& piles, TopicResult& out) {
  FigureSamples figures;
  LongAxes all;
  for (int r = 0; r < piles.count(); ++r) {
    const Realization one = piles.realization(r);
    const PileGrains grains{grain_axes(one["pile"]), size_factor(one["pile"])};
    add_samples(grain_rows(), grains, figures);
    const GrainAxes& axes = grains.axes;
    all.random_order +=
        std::sqrt(std::numbers::pi / (4.0 * static_cast<double>(axes.elongation.size()))) /
        piles.count();
    if (std::isfinite(axes.director_deg)) {
      all.mean += std::polar(axes.order, 2 * axes.director_deg / kDegrees);
    }
  }
  add_figures(out.summary, figures);
  add_values(long_axis_rows(), all, out.summary);
  Ensemble inertia;
  for (int r = 0; r < piles.count(); ++r) {
    Field one;
    one.points = piles.grid();
    for (const char* name : {"inertia_xx", "inertia_yy", "inertia_xy"}) {
      one.add(name, "m4").value = piles.fields(r).rest.find(name)->value;
    }
    inertia.add(one);
  }
  Field field = piles.in_metres(inertia);
  add_tensor_columns(field, "inertia", MajorAxis::largest);
  Eigen::VectorXd along = field.find("inertia_angle")->value;
  for (double& a : along) a += a > 0 ? -90 : 90;
  field.add("long_angle", "deg").value = along;
  Picture picture = maps("Orientation of the grains: mean long axis", "x / h", "y / h",
                         "angle from x (deg)", {map_of(piles, "", along)}, true);
  picture.caption = fmt::format(
      "Across the major axis of the averaged inertia tensor; 0: horizontal (Roul figs 3.14, 3.15). "
      "Order of all grains {:.3f}; random grains have about {:.3f}.",
      std::get<double>(out.summary.at("orientation.order")), all.random_order);
  out.sections.emplace_back(std::move(picture));
  out.fields.emplace_back("orientation", std::move(field));
}

void add_maps(const PileSet& piles, const Field& mean, const Field& density, TopicResult& out) {
  const auto single = [&](const std::string& title, const char* label, const Field& field,
                          const char* column, bool diverging) {
    return maps(title, "x / h", "y / h", label, {map_of(piles, "", field.find(column)->value)},
                diverging);
  };
  Picture trace = single("Trace of the fabric", "tr F", mean, "fabric_trace", false);
  trace.caption = how_averaged(piles);
  out.sections.emplace_back(std::move(trace));
  Picture fraction =
      single("Anisotropy of the fabric", "F_D / tr F", mean, "fabric_fraction", false);
  fraction.caption = "Largest less smallest principal value over the trace, of the mean tensor.";
  out.sections.emplace_back(std::move(fraction));
  // From the vertical, so that nothing jumps where an axis is upright.
  const auto tilt = [&](const char* column) {
    Eigen::VectorXd a = mean.find(column)->value;
    for (double& v : a) v = v > 0 ? 90 - v : -90 - v;
    return a;
  };
  const auto angles = [&](const char* title, const char* column) {
    return map_of(piles, title, tilt(column));
  };
  Picture axes = maps(
      "Major axes: angle from the vertical, tilted to the right above 0", "x / h", "y / h", "deg",
      {angles("fabric", "fabric_angle"), angles("stress, greatest compression", "sigma_angle"),
       angles("strain, greatest compression under rising gravity", "strain_angle")});
  axes.caption = "Of mean tensors (strain: medians over piles). " + how_averaged(piles);
  out.sections.emplace_back(std::move(axes));
  Picture between =
      maps("Angle between the major axes", "x / h", "y / h", "deg",
           {map_of(piles, "fabric and stress", mean.find("angle_fabric_sigma")->value),
            map_of(piles, "stress and strain", mean.find("angle_sigma_strain")->value)},
           false);
  between.caption = "0 where the tensors are collinear.";
  out.sections.emplace_back(std::move(between));
  Picture profiles =
      curves("Fabric and density along rows of the heap", "x / h (apex at 0)", "value",
             {rows_of(piles, "tr F", mean.find("fabric_trace")->value),
              rows_of(piles, "F_D / tr F", mean.find("fabric_fraction")->value),
              rows_of(piles, "fabric's major axis from the vertical (deg)", tilt("fabric_angle")),
              rows_of(piles, "volume fraction", density.find("volume_fraction")->value)});
  profiles.caption = "Roul figs 3.12, 3.20. " + how_averaged(piles);
  out.sections.emplace_back(std::move(profiles));
}

TopicResult fabric_of_piles(const PileSet& piles) {
  TopicResult out;
  const std::vector<PileTensors> all = all_tensors(piles);
  std::vector<int> everyone;
  for (int r = 0; r < piles.count(); ++r) everyone.push_back(r);
  BootstrapOptions options;
  options.interval = "percentile";
  options.resamples = std::min(200, piles.resamples());
  options.threads = piles.threads();
  const auto drawn = bootstrap(
      piles.count(),
      [&](const std::vector<int>& chosen) { return axis_figures(piles, mean_of(all, chosen)); },
      options);
  AxisFigures axes;
  for (const auto& figure : drawn) {
    axes.push_back({figure.value});
    if (piles.count() > 1) axes.back().error = figure.error;
  }
  add_values(axis_rows(), axes, out.summary);
  const Field mean = axes_field(piles, mean_of(all, everyone));
  Ensemble densities;
  for (int r = 0; r < piles.count(); ++r) {
    Field one;
    one.points = piles.grid();
    for (const char* name :
         {"volume_fraction", "coordination", "coordination_bearing", "rattlers", "grains"}) {
      one.add(name, "1").value = piles.fields(r).rest.find(name)->value;
    }
    densities.add(one);
  }
  Field density = piles.in_metres(densities);
  add_maps(piles, mean, density, out);
  add_laws(piles, out);
  add_contacts(piles, out);
  add_orientation(piles, out);
  const auto value = [&](const char* key) { return std::get<double>(out.summary.at(key)); };
  out.sentence = fmt::format(
      "tr F = {:.3f} ν c over the points, g2 = {:.3f} of the grains (theory {:.3f}); fabric's and "
      "stress' axes are {:.0f}° apart (median).",
      value("fabric.trace_over_nu_c"), value("fabric.g2"), value("fabric.g2_theory"),
      value("fabric.angle_to_stress_deg"));
  out.fields.emplace_back("fabric", mean);
  out.fields.emplace_back("density", std::move(density));
  return out;
}

std::vector<SummaryKey> fabric_figures() {
  return joined({declared(count_rows(), "heap."), declared(count_rows(), "change.*."),
                 declared(changed_count_rows(), "change.*."), declared(axis_rows()),
                 declared(law_rows()), declared(grain_rows()), declared(long_axis_rows())});
}

}  // namespace

Topic fabric_topic() {
  return {"fabric", "fabric, coordination, orientation of grains", fabric_of_piles, fabric_figures};
}

}  // namespace grainfield::coupling
