// How many grains an RVE needs (Roul figs 2.8-2.10): circles of growing radius about five places,
// in every pile.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "coupling/studies/pile_fields/drawing.h"
#include "coupling/studies/pile_fields/robust.h"
#include "coupling/studies/pile_fields/topic.h"

namespace grainfield::coupling {
namespace {

// Abscissas (half bases) and height (h) of the places: as far from floor and flanks as a heap
// allows.
constexpr std::array kPlaces{-0.32, -0.16, 0.0, 0.16, 0.32};
constexpr double kPlaceHeight = 0.32;

struct Watched {
  const char *key, *label;
};
constexpr std::array<Watched, 3> kWatched{
    Watched{"stress", "stress: -σ_yy"}, {"strain", "strain: ε_yy"}, {"fabric", "fabric: tr F"}};

// One quantity at one size.
struct Step {
  double value = NAN;  // over that of the largest RVE at the same place, mean over places
  // Between piles at the same place over the mean, rms over places; of a single pile the distance
  // from its largest RVE there.
  double scatter = NAN;
};

// What one quantity asks for, and how it scatters at the size that the fields have.
struct SizeNeeds {
  double grains = NAN;
  std::optional<double> scatter;
};
const std::vector<RunFigure<SizeNeeds>>& needs_rows() {
  using N = const SizeNeeds&;
  static const std::vector<RunFigure<SizeNeeds>> rows{
      {"_grains", "-",
       "grains from which on larger RVEs differ by less than half the tolerance in the mean and "
       "scatter by less than it between piles; nan: none that fits",
       [](N n) { return n.grains; }},
      {"_scatter", "-",
       "robust relative scatter between piles of a single RVE of the size used for the fields",
       [](N n) { return n.scatter ? std::optional<FigureValue>(*n.scatter) : std::nullopt; }},
  };
  return rows;
}

// The quantity that asks for the most.
struct LargestNeed {
  double grains = 0;
  std::string quantity;
};
const std::vector<RunFigure<LargestNeed>>& largest_rows() {
  using L = const LargestNeed&;
  static const std::vector<RunFigure<LargestNeed>> rows{
      {"rve_size.grains", "-", "grains an RVE needs: the most that a quantity asks for",
       [](L l) { return l.grains; }, "RVE (grains)"},
      {"rve_size.limited_by", "text", "that quantity", [](L l) { return l.quantity; }},
  };
  return rows;
}

struct SizeSeries {
  std::vector<double> grains, radius;               // per size
  std::array<std::vector<Eigen::MatrixXd>, 3> raw;  // quantity, size: places x piles
  std::array<std::vector<Step>, 3> steps;           // quantity, size
  std::array<double, 3> enough{NAN, NAN, NAN};      // grains
  std::array<std::string, 3> why;
};

void measure(const PileSet& piles, SizeSeries& out) {
  Eigen::MatrixXd places(kPlaces.size(), 2);
  const double half = (piles.mean(&PileFrame::half_left) + piles.mean(&PileFrame::half_right)) /
                      (2 * piles.height());
  for (std::size_t k = 0; k < kPlaces.size(); ++k) {
    places.row(static_cast<Eigen::Index>(k)) << kPlaces[k] * half, kPlaceHeight - 1;
  }
  std::vector<double> sizes = piles.setup().get<FieldsSetup>().sizes;
  std::sort(sizes.begin(), sizes.end());
  const auto n = static_cast<Eigen::Index>(kPlaces.size());
  for (const double size : sizes) out.radius.push_back(size * piles.diameter());
  out.grains.assign(sizes.size(), 0);
  for (auto& q : out.raw) {
    q.assign(sizes.size(), Eigen::MatrixXd::Constant(n, piles.count(), NAN));
  }
  for (int r = 0; r < piles.count(); ++r) {
    const Realization one = piles.realization(r);
    const dem::Snapshot &pile = one["pile"], &changed = one[piles.change()];
    const Eigen::MatrixXd points = piles.frame(r).to_packing(places);
    for (std::size_t s = 0; s < sizes.size(); ++s) {
      AverageOptions options = piles.average_options(out.radius[s]);
      options.quantities = {"sigma", "fabric", "grains"};
      options.least_grains = 1;
      const Field f = average(pile, points, options);
      StrainOptions by =
          piles.strain_options(piles.setup().get<FieldsSetup>().measure, out.radius[s]);
      by.least_grains = 3;
      const Field e = strain(pile, changed, points, by).field;
      for (Eigen::Index p = 0; p < n; ++p) {
        if (piles.room(places.row(p)) * piles.height() < out.radius[s]) continue;
        out.raw[0][s](p, r) = -f.find("sigma_yy")->value[p] / piles.frame(r).pressure();
        out.raw[1][s](p, r) = e.find("strain_yy")->value[p];
        out.raw[2][s](p, r) = f.find("fabric_xx")->value[p] + f.find("fabric_yy")->value[p];
        out.grains[s] += f.find("grains")->value[p];
      }
    }
  }
}

// Median over the piles of one place.
double centre(const Eigen::MatrixXd& m, Eigen::Index place) {
  const Eigen::VectorXd row = m.row(place);
  return median_of({row.begin(), row.end()});
}

void compare(SizeSeries& out, double tolerance) {
  for (std::size_t s = 0; s < out.grains.size(); ++s) {
    const auto cells = out.raw[2][s].array().isFinite().count();
    out.grains[s] = cells > 0 ? out.grains[s] / static_cast<double>(cells) : NAN;
  }
  for (std::size_t q = 0; q < kWatched.size(); ++q) {
    const auto& raw = out.raw[q];
    out.steps[q].resize(raw.size());
    for (std::size_t s = 0; s < raw.size(); ++s) {
      double sum = 0, squares = 0;
      int places = 0, spread = 0;
      for (Eigen::Index p = 0; p < raw[s].rows(); ++p) {
        double last = NAN;
        for (const auto& larger : raw) {
          if (const double c = centre(larger, p); std::isfinite(c)) last = c;
        }
        const double own = centre(raw[s], p);
        if (!std::isfinite(own / last)) continue;
        sum += own / last;
        ++places;
        const Eigen::VectorXd row = raw[s].row(p);
        const double deviation =
            row.size() > 1 ? robust_deviation({row.begin(), row.end()}) / own : own / last - 1;
        if (!std::isfinite(deviation)) continue;
        squares += deviation * deviation;
        ++spread;
      }
      if (places > 0) out.steps[q][s].value = sum / places;
      if (spread > 0) out.steps[q][s].scatter = std::sqrt(squares / spread);
    }
    // The first size from which on every larger one will do.
    bool moved = false, scattered = false;
    for (std::size_t s = raw.size(); s-- > 0;) {
      const Step& step = out.steps[q][s];
      if (!std::isfinite(step.value)) continue;
      moved = std::fabs(step.value - 1) > tolerance / 2;
      scattered = step.scatter > tolerance;
      if (moved || scattered) break;
      out.enough[q] = out.grains[s];
    }
    if (std::isnan(out.enough[q])) {
      out.why[q] = fmt::format("no size scatters by less than {:g} %", 100 * tolerance);
    } else if (!moved && !scattered) {
      out.why[q] = "the smallest size tried will do";
    } else {
      out.why[q] = moved ? fmt::format("below, the mean is off by more than {:g} %", 50 * tolerance)
                         : fmt::format("below, it scatters by more than {:g} %", 100 * tolerance);
    }
  }
}

TopicResult rve_size_of_piles(const PileSet& piles) {
  SizeSeries study;
  measure(piles, study);
  const double tolerance = piles.setup().get<FieldsSetup>().tolerance;
  compare(study, tolerance);

  TopicResult out;
  Field field;
  const auto sizes = static_cast<Eigen::Index>(study.grains.size());
  field.points = Eigen::MatrixXd::Zero(sizes, 2);
  field.attributes["points"] = "x: radius of the RVE, m; y: 0";
  for (Eigen::Index s = 0; s < sizes; ++s) {
    field.points(s, 0) = study.radius[static_cast<std::size_t>(s)];
  }
  Eigen::VectorXd grains = Eigen::Map<const Eigen::VectorXd>(study.grains.data(), sizes);
  field.add("grains", "1").value = grains;
  std::vector<Frame> values;
  Table table{"Size of the RVE", "", {"quantity", "grains needed", "why"}, {}};
  LargestNeed most;
  for (std::size_t q = 0; q < kWatched.size(); ++q) {
    const std::string key = kWatched[q].key;
    Eigen::VectorXd value(sizes), scatter(sizes);
    for (Eigen::Index s = 0; s < sizes; ++s) {
      value[s] = study.steps[q][static_cast<std::size_t>(s)].value;
      scatter[s] = study.steps[q][static_cast<std::size_t>(s)].scatter;
    }
    field.add(key, "1").value = value;
    field.add(key + "_scatter", "1").value = scatter;
    Frame frame{kWatched[q].label, {{"mean", grains, value, value.cwiseProduct(scatter), true}}};
    for (std::size_t p = 0; p < kPlaces.size(); ++p) {
      Eigen::VectorXd own(sizes);
      double last = NAN;
      for (Eigen::Index s = 0; s < sizes; ++s) {
        own[s] = centre(study.raw[q][static_cast<std::size_t>(s)], static_cast<Eigen::Index>(p));
        if (std::isfinite(own[s])) last = own[s];
      }
      frame.series.push_back(
          {fmt::format("x = {:g} half bases", kPlaces[p]), grains, own / last, {}, false});
    }
    values.push_back(std::move(frame));
    const double enough = study.enough[q];
    SizeNeeds needs{enough, std::nullopt};
    for (Eigen::Index s = 0; s < sizes; ++s) {
      if (study.radius[static_cast<std::size_t>(s)] <= piles.radius() * (1 + 1e-9)) {
        needs.scatter = scatter[s];
      }
    }
    add_values(needs_rows(), needs, out.summary, "rve_size." + key);
    if (!std::isnan(most.grains) && !(enough <= most.grains)) most = {enough, key};
    table.rows.push_back({kWatched[q].label,
                          std::isnan(enough) ? "more than fit" : fmt::format("{:.0f}", enough),
                          study.why[q]});
  }
  add_values(largest_rows(), most, out.summary);
  out.sentence = std::isnan(most.grains)
                     ? fmt::format("No RVE that fits gives the {} within {:g} %.", most.quantity,
                                   100 * tolerance)
                     : fmt::format("An RVE needs {:.0f} grains; the {} asks for the most.",
                                   most.grains, most.quantity);
  Picture picture = curves("RVE size: value against number of grains", "grains in the RVE",
                           "value / value of the largest RVE", values);
  picture.caption = fmt::format(
      "Circles about {} places {:g} h above the base that stay inside the heap; medians over {} "
      "piles. Band: one robust standard deviation of a single RVE between piles (one pile: "
      "distance from its largest RVE). An RVE is large enough when no larger one differs by more "
      "than {:g} % in the mean or scatters by more than {:g} % (Roul figs 2.8-2.10: 100-200 "
      "grains).",
      kPlaces.size(), kPlaceHeight, piles.count(), 50 * tolerance, 100 * tolerance);
  out.sections.emplace_back(std::move(picture));
  out.sections.emplace_back(std::move(table));
  out.fields.emplace_back("rve_size", std::move(field));
  return out;
}

std::vector<SummaryKey> rve_size_figures() {
  return joined({declared(largest_rows()), declared(needs_rows(), "rve_size.*")});
}

}  // namespace

Topic rve_size_topic() {
  return {"rve_size", "stress, strain and fabric against the size of the RVE", rve_size_of_piles,
          rve_size_figures};
}

}  // namespace grainfield::coupling
