// Elastic constants over the heap from the change of gravity (Roul 3.10, figs 3.25, 3.26). Every
// pile has its own constants; medians over piles are reported, so that a pile in which grains
// rearranged (large strain at the same stress) does not pull them down.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <optional>

#include "coupling/elastic_constants/elastic_map.h"
#include "coupling/elastic_constants/symmetry.h"
#include "coupling/judge/words.h"
#include "coupling/studies/pile/simulation.h"
#include "coupling/studies/pile_fields/drawing.h"
#include "coupling/studies/pile_fields/robust.h"
#include "coupling/studies/pile_fields/topic.h"

namespace grainfield::coupling {
namespace {

// A point has rearranged where its strain is this many times the median over piles; a pile where
// more than this share of its points has. Needs a median that one pile does not make.
constexpr double kOutlier = 3, kOutlierShare = 0.05;
constexpr int kLeastPiles = 3;
// Draws per point of the map: its errors need fewer digits than the heap's.
constexpr int kMapDraws = 200;
constexpr int kClasses = 12;

enum { kBulk, kShear, kYoung, kPoisson, kConstants };
constexpr std::array<const char*, kConstants> kNames{"bulk", "shear", "young", "poisson"};
constexpr std::array<const char*, kConstants> kLabels{"K (N/m)", "G (N/m)", "E (N/m)", "ν"};

using Four = std::array<double, kConstants>;

Four values_of(const IsotropicConstants& c) {
  return {c.bulk.value, c.shear.value, c.young.value, c.poisson.value};
}

struct Fits {
  std::vector<Increments> piles;  // one realization each
  Locality whole;                 // the points inside
  std::vector<Four> constants;    // per pile, over the whole
  std::vector<double> bulk_share, shear_share;
  std::vector<double> rearranged_share;                        // of the points, per pile
  std::vector<int> rearranged;                                 // piles
  std::array<std::vector<Eigen::VectorXd>, kConstants> local;  // constant, pile: per grid point
};

// The fits of every pile.
struct ElasticFacts {
  const Fits& fits;
  double of_grain = 0;  // the grains' own stiffness, N/m

  std::vector<double> constant(std::size_t q, double unit = 1) const {
    std::vector<double> out;
    for (const Four& c : fits.constants) out.push_back(c[q] / unit);
    return out;
  }
};
const std::vector<MedianFigure<ElasticFacts>>& constant_rows() {
  using E = const ElasticFacts&;
  static const std::vector<MedianFigure<ElasticFacts>> rows{
      {"elastic.bulk", "N/m", "K of the plane, one fit a pile; median over piles",
       [](E e) { return e.constant(kBulk); }},
      {"elastic.shear", "N/m", "G likewise", [](E e) { return e.constant(kShear); }},
      {"elastic.young", "N/m", "E = 3 G - G^2/K likewise", [](E e) { return e.constant(kYoung); },
       "E (N/m)"},
      {"elastic.poisson", "-", "nu likewise", [](E e) { return e.constant(kPoisson); }},
      {"elastic.young_over_grain", "-", "E over the grains' stiffness (material)",
       [](E e) { return e.constant(kYoung, e.of_grain); }},
      {"elastic.bulk_share", "-", "share of the change of pressure that K explains; median",
       [](E e) { return e.fits.bulk_share; }},
      {"elastic.shear_share", "-", "share of the change of shear that G explains; median",
       [](E e) { return e.fits.shear_share; }},
  };
  return rows;
}
const std::vector<RunFigure<ElasticFacts>>& rearranged_rows() {
  using E = const ElasticFacts&;
  static const std::vector<RunFigure<ElasticFacts>> rows{
      {"elastic.rearranged", "-", "piles whose strain stands out: grains rearranged",
       [](E e) { return static_cast<std::int64_t>(e.fits.rearranged.size()); }},
      {"elastic.rearranged_piles", "text", "their numbers, from 0",
       [](E e) {
         return e.fits.rearranged.empty() ? "none"
                                          : fmt::format("{}", fmt::join(e.fits.rearranged, ", "));
       }},
  };
  return rows;
}

// E of all points in one fit, of all piles and of those in which no grains rearranged.
struct PooledYoung {
  std::optional<Constant> all, kept;
};
std::optional<ValueWithError> with_its_error(const std::optional<Constant>& c) {
  return c ? std::optional(ValueWithError{c->value, c->error}) : std::nullopt;
}
const std::vector<ErrorFigure<PooledYoung>>& pooled_rows() {
  using P = const PooledYoung&;
  static const std::vector<ErrorFigure<PooledYoung>> rows{
      {"elastic.young_pooled", "N/m", "E from the points of all piles in one fit",
       [](P p) { return with_its_error(p.all); }},
      {"elastic.young_pooled_kept", "N/m", "the same without the rearranged piles",
       [](P p) { return with_its_error(p.kept); }},
  };
  return rows;
}

std::string isotropy_word(const SymmetryFit& s) {
  return std::isnan(s.p_realizations) ? "undecided" : s.isotropy_holds() ? "holds" : "rejected";
}
const std::vector<ErrorFigure<SymmetryFit>>& symmetry_rows() {
  using S = const SymmetryFit&;
  static const std::vector<ErrorFigure<SymmetryFit>> rows{
      {"elastic.normal_ratio", "-", "C11/C22 of the orthotropic fit: 1 if isotropic",
       [](S s) { return with_its_error(s.normal_ratio); }},
      {"elastic.shear_ratio", "-", "4 C66/(C11 + C22 - 2 C12): 1 if isotropic",
       [](S s) { return with_its_error(s.shear_ratio); }},
      {"elastic.isotropy_p", "-", "probability of such ratios if isotropy holds; nan below 4 piles",
       [](S s) { return ValueWithError{s.p_realizations}; }},
      {"elastic.isotropy", "text", "holds | rejected (at 5 %) | undecided",
       [](S s) { return ValueWithError{isotropy_word(s)}; }},
      {"elastic.residual_isotropic", "-", "stress that the isotropic fit leaves, relative",
       [](S s) { return ValueWithError{s.residual_isotropic}; }},
      {"elastic.residual_orthotropic", "-", "stress that the orthotropic fit leaves, relative",
       [](S s) { return ValueWithError{s.residual_orthotropic}; }},
  };
  return rows;
}

const std::vector<ErrorFigure<ValueWithError>>& fabric_rows() {
  static const std::vector<ErrorFigure<ValueWithError>> rows{
      {"_fabric_correlation", "-",
       "correlation of a constant with tr F over the points inside (medians, means over piles)",
       [](const ValueWithError& r) { return r; }},
  };
  return rows;
}

ElasticOptions few_draws() {
  ElasticOptions out;
  out.bootstrap.resamples = 10;  // one realization has no interval
  return out;
}

Fits fit(const PileSet& piles) {
  Fits out;
  const Eigen::MatrixXd points = piles.grid() * piles.height();
  out.whole = everywhere(points);
  out.whole.weights.setZero();
  for (const Eigen::Index p : piles.inside()) out.whole.weights[p] = 1;
  std::vector<Locality> around;
  for (const Eigen::Index p : piles.inside()) {
    Locality l = locality(points, points.row(p), "lucy", piles.radius() / 2);
    l.weights = l.weights.cwiseProduct(out.whole.weights);
    around.push_back(std::move(l));
  }
  for (int r = 0; r < piles.count(); ++r) {
    Field stress = piles.fields(r).stress_change, strains = piles.fields(r).strain.field;
    stress.points = strains.points = points;
    Increments one;
    one.add(stress, strains);
    const IsotropicConstants c = isotropic_constants(one, out.whole, few_draws());
    out.constants.push_back(values_of(c));
    out.bulk_share.push_back(c.bulk_share);
    out.shear_share.push_back(c.shear_share);
    std::array<Eigen::VectorXd, kConstants> map;
    map.fill(Eigen::VectorXd::Constant(points.rows(), NAN));
    for (std::size_t k = 0; k < around.size(); ++k) {
      const Four v = values_of(isotropic_constants(one, around[k], few_draws()));
      // What no stable material has is no value.
      if (!(v[kBulk] > 0 && v[kShear] > 0 && v[kYoung] > 0)) continue;
      for (std::size_t q = 0; q < kConstants; ++q) map[q][piles.inside()[k]] = v[q];
    }
    for (std::size_t q = 0; q < kConstants; ++q) out.local[q].push_back(std::move(map[q]));
    out.piles.push_back(std::move(one));
  }
  return out;
}

// Which piles have points whose strain stands out from the same place in the others.
void find_rearranged(const PileSet& piles, Fits& fits) {
  fits.rearranged_share.assign(fits.piles.size(), NAN);
  if (piles.count() < kLeastPiles) return;
  std::vector<int> beyond(fits.piles.size(), 0);
  int points = 0;
  for (const Eigen::Index p : piles.inside()) {
    std::vector<double> sizes;
    for (const Increments& one : fits.piles) {
      const Eigen::RowVector3d e = one.strain.front().row(p);
      sizes.push_back(std::sqrt(e[0] * e[0] + e[1] * e[1] + 2 * e[2] * e[2]));
    }
    const double limit = kOutlier * median_of(sizes);
    if (!std::isfinite(limit)) continue;
    ++points;
    for (std::size_t r = 0; r < sizes.size(); ++r) beyond[r] += sizes[r] > limit ? 1 : 0;
  }
  for (std::size_t r = 0; r < beyond.size(); ++r) {
    fits.rearranged_share[r] = static_cast<double>(beyond[r]) / points;
    if (fits.rearranged_share[r] > kOutlierShare) fits.rearranged.push_back(static_cast<int>(r));
  }
}

Increments pooled(const Fits& fits, bool keep_rearranged) {
  Increments out;
  for (std::size_t r = 0; r < fits.piles.size(); ++r) {
    const bool odd = std::find(fits.rearranged.begin(), fits.rearranged.end(),
                               static_cast<int>(r)) != fits.rearranged.end();
    if (odd && !keep_rearranged) continue;
    out.points = fits.piles[r].points;
    out.stress.push_back(fits.piles[r].stress.front());
    out.strain.push_back(fits.piles[r].strain.front());
  }
  return out;
}

// Medians over the chosen piles, with errors when all are chosen.
Field constants_map(const PileSet& piles, const Fits& fits) {
  Field out = piles.on_grid();
  for (std::size_t q = 0; q < kConstants; ++q) {
    Column& column = out.add(kNames[q], q == kPoisson ? "1" : "N/m");
    column.value = column.error = Eigen::VectorXd::Constant(out.points.rows(), NAN);
    for (const Eigen::Index p : piles.inside()) {
      std::vector<double> values;
      for (const Eigen::VectorXd& own : fits.local[q]) values.push_back(own[p]);
      const RobustMean m = robust_mean(values, kMapDraws);
      // The median of a minority of the piles is not one of the ensemble.
      if (2 * m.count <= piles.count()) continue;
      column.value[p] = m.median;
      column.error[p] = m.error;
    }
  }
  return out;
}

double pearson(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0, mx = 0, my = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!std::isfinite(x[k]) || !std::isfinite(y[k])) continue;
    mx += x[k];
    my += y[k];
    ++n;
  }
  if (n < 3) return NAN;
  mx /= n;
  my /= n;
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!std::isfinite(x[k]) || !std::isfinite(y[k])) continue;
    xx += (x[k] - mx) * (x[k] - mx);
    yy += (y[k] - my) * (y[k] - my);
    xy += (x[k] - mx) * (y[k] - my);
  }
  return xy / std::sqrt(xx * yy);
}

Eigen::VectorXd fabric_trace(const Field& rest) {
  return rest.find("fabric_xx")->value + rest.find("fabric_yy")->value;
}

// Constants against tr F over the points inside: of the maps, medians and means over piles, with
// piles drawn for the error (Roul fig. 3.26).
Picture against_fabric(const PileSet& piles, const Fits& fits, Summary& summary) {
  std::vector<Eigen::VectorXd> traces;
  for (int r = 0; r < piles.count(); ++r) traces.push_back(fabric_trace(piles.fields(r).rest));
  const auto maps_of = [&](const std::vector<int>& chosen, std::size_t q, std::vector<double>& x,
                           std::vector<double>& y) {
    x.clear();
    y.clear();
    for (const Eigen::Index p : piles.inside()) {
      double trace = 0;
      std::vector<double> values;
      for (const int r : chosen) {
        trace += traces[static_cast<std::size_t>(r)][p] / static_cast<double>(chosen.size());
        values.push_back(fits.local[q][static_cast<std::size_t>(r)][p]);
      }
      x.push_back(trace);
      y.push_back(median_of(std::move(values)));
    }
  };
  BootstrapOptions options;
  options.interval = "percentile";
  options.resamples = kMapDraws;
  options.threads = piles.threads();
  std::vector<int> everyone;
  for (int r = 0; r < piles.count(); ++r) everyone.push_back(r);
  std::vector<Frame> frames;
  for (std::size_t q = 0; q < kConstants; ++q) {
    const auto r = bootstrap(
        piles.count(),
        [&](const std::vector<int>& chosen) {
          std::vector<double> x, y;
          maps_of(chosen, q, x, y);
          return Eigen::VectorXd::Constant(1, pearson(x, y));
        },
        options);
    ValueWithError found{r[0].value};
    if (piles.count() > 1) found.error = r[0].error;
    add_values(fabric_rows(), found, summary, fmt::format("elastic.{}", kNames[q]));
    std::vector<double> x, y;
    maps_of(everyone, q, x, y);
    frames.push_back({fmt::format("{}: r = {:.2f}", kLabels[q], r[0].value),
                      {binned("mean of points with like tr F", x, y, kClasses)}});
  }
  Picture out =
      curves("Elastic constants against the trace of the fabric", "tr F", "constant", frames);
  out.caption =
      "Points inside the heap, medians over piles, in bins of equally many points; band: standard "
      "error within the bin. r: Pearson's correlation over the points (Roul fig. 3.26).";
  return out;
}

void add_symmetry(const Fits& fits, Summary& summary, Table& table, int resamples) {
  ElasticOptions options;
  options.bootstrap.resamples = resamples;
  const Increments kept = pooled(fits, false);
  if (kept.realizations() == 0) return;
  const SymmetryFit s = fit_symmetry(kept, fits.whole, options);
  add_values(symmetry_rows(), s, summary);
  table.rows.push_back({"isotropy (without rearranged piles)",
                        std::isnan(s.p_realizations)
                            ? "undecided: needs 4 piles"
                            : fmt::format("{} (p = {:.2g})", isotropy_word(s), s.p_realizations)});
  table.rows.push_back(
      {"C11/C22 (1 if isotropic)", with_error(s.normal_ratio.value, s.normal_ratio.error)});
  table.rows.push_back({"4 C66/(C11 + C22 - 2 C12) (1 if isotropic)",
                        with_error(s.shear_ratio.value, s.shear_ratio.error)});
  table.rows.push_back({"stress left over: isotropic, orthotropic",
                        fmt::format("{:.1f} %, {:.1f} %", 100 * s.residual_isotropic,
                                    100 * s.residual_orthotropic)});
  if (!s.note.empty()) table.rows.push_back({"note", s.note});
}

Table piles_table(const Fits& fits) {
  Table out{
      "Constants of every pile",
      fmt::format("One least-squares fit over the points inside. Share: of the stress that it "
                  "explains (compression, shear). Stands out: share of the points whose strain "
                  "is more than {:g} times the median over piles; above {:g} % the pile is "
                  "named as rearranged.",
                  kOutlier, 100 * kOutlierShare),
      {"pile", "K (N/m)", "G (N/m)", "E (N/m)", "ν", "share K", "share G", "stands out", ""},
      {}};
  for (std::size_t r = 0; r < fits.constants.size(); ++r) {
    const Four& c = fits.constants[r];
    const bool odd = std::find(fits.rearranged.begin(), fits.rearranged.end(),
                               static_cast<int>(r)) != fits.rearranged.end();
    out.rows.push_back(
        {std::to_string(r), fmt::format("{:.3g}", c[kBulk]), fmt::format("{:.3g}", c[kShear]),
         fmt::format("{:.3g}", c[kYoung]), fmt::format("{:.3f}", c[kPoisson]),
         fmt::format("{:.3f}", fits.bulk_share[r]), fmt::format("{:.3f}", fits.shear_share[r]),
         std::isnan(fits.rearranged_share[r])
             ? "needs 3 piles"
             : fmt::format("{:.1f} %", 100 * fits.rearranged_share[r]),
         odd ? "rearranged" : ""});
  }
  return out;
}

TopicResult elastic_constants_of_piles(const PileSet& piles) {
  Fits fits = fit(piles);
  find_rearranged(piles, fits);
  TopicResult out;
  Summary& s = out.summary;
  const dem::MaterialSetup& m = piles.setup().get<dem::PileSetup>().material;
  const double of_grain = m.law == "linear" ? m.normal_stiffness : m.young;
  const ElasticFacts facts{fits, of_grain};
  add_medians(constant_rows(), facts, piles.resamples(), s);
  add_values(rearranged_rows(), facts, s);
  ElasticOptions options;
  options.bootstrap.resamples = piles.resamples();
  PooledYoung young;
  for (const bool all : {true, false}) {
    const Increments samples = pooled(fits, all);
    if (samples.realizations() == 0) continue;
    (all ? young.all : young.kept) = isotropic_constants(samples, fits.whole, options).young;
  }
  add_values(pooled_rows(), young, s);

  const Field constants = constants_map(piles, fits);
  const auto value = [&](const char* key) { return std::get<double>(s.at(key)); };
  const auto error = [&](const char* key) {
    const auto found = s.find(key + std::string(".standard_error"));
    return found == s.end() ? NAN : std::get<double>(found->second);
  };
  const auto spread = [&](const char* key) {
    return std::isnan(error(key)) ? std::string() : fmt::format(" ± {:.2g}", error(key));
  };
  out.sentence = fmt::format(
      "E = {:.3g}{} N/m, {:.3f} of the grains' {:.3g} N/m; ν = {:.2f}{}; rearranged piles: {}.",
      value("elastic.young"), spread("elastic.young"), value("elastic.young_over_grain"), of_grain,
      value("elastic.poisson"), spread("elastic.poisson"),
      std::get<std::string>(s.at("elastic.rearranged_piles")));

  const auto over_grain = [&](const char* name) -> Eigen::VectorXd {
    return constants.find(name)->value / of_grain;
  };
  Picture moduli =
      maps("Elastic moduli over the heap", "x / h", "y / h", "modulus / E of the grains",
           {map_of(piles, "bulk modulus K", over_grain("bulk")),
            map_of(piles, "shear modulus G", over_grain("shear")),
            map_of(piles, "Young's modulus E", over_grain("young"))},
           false);
  moduli.caption = fmt::format(
      "From the change to {}: K and G of each pile by least squares over neighbouring points (lucy "
      "kernel ending at one RVE radius), medians over piles; nan where most piles have no positive "
      "constants. {} elastic_map.csv holds E and ν.",
      piles.change(), how_averaged(piles));
  out.sections.emplace_back(std::move(moduli));
  Picture poisson = maps("Poisson's ratio over the heap", "x / h", "y / h", "ν",
                         {map_of(piles, "", constants.find("poisson")->value)}, false);
  poisson.caption = "Plane strain: ν = (1 - G/K)/2.";
  out.sections.emplace_back(std::move(poisson));
  std::vector<Frame> profiles;
  for (std::size_t q = 0; q < kConstants; ++q) {
    Frame frame = rows_of(piles, kLabels[q], constants.find(kNames[q])->value);
    if (!frame.series.empty()) profiles.push_back(std::move(frame));
  }
  if (!profiles.empty()) {
    Picture along = curves("Elastic constants along rows of the heap", "x / h (apex at 0)",
                           "constant", profiles);
    along.caption = "Medians over piles (Roul fig. 3.25).";
    out.sections.emplace_back(std::move(along));
  }
  out.sections.emplace_back(against_fabric(piles, fits, s));
  Table symmetry{"Elasticity of the heap", "", {}, {}};
  add_symmetry(fits, s, symmetry, piles.resamples());
  if (young.all) {
    symmetry.rows.push_back(
        {"E, all piles pooled (N/m)", with_error(young.all->value, young.all->error)});
  }
  if (young.kept) {
    symmetry.rows.push_back({"E, pooled without rearranged piles (N/m)",
                             with_error(young.kept->value, young.kept->error)});
  }
  out.sections.emplace_back(std::move(symmetry));
  out.sections.emplace_back(piles_table(fits));
  out.texts.emplace_back("elastic_map.csv", elastic_map_text(constants));
  out.fields.emplace_back("elastic_constants", constants);
  return out;
}

std::vector<SummaryKey> elastic_figures() {
  return joined({declared(constant_rows()), declared(rearranged_rows()), declared(pooled_rows()),
                 declared(symmetry_rows()), declared(fabric_rows(), "elastic.*")});
}

}  // namespace

Topic elastic_topic() {
  return {"elastic", "K, G, E and nu over the heap", elastic_constants_of_piles, elastic_figures};
}

}  // namespace grainfield::coupling
