#include "coupling/reproduce/box_figures.h"

#include <fmt/format.h>

#include <cmath>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

constexpr const char *kCompression = "box-compression", *kShear = "box-shear", *kRve = "rve-3d",
                     *kLaws = "contact-laws";

// A share of q/p below which it hardly changes, and beyond which it changes: by two errors either
// way.
constexpr double kHardly = 0.1;

// Of a member of a sweep.
std::optional<Measured> of_member(const Results& r, const std::string& study,
                                  const std::string& key, const std::string& member) {
  const auto value = r.plain(study, key + "." + member);
  if (!value) return std::nullopt;
  return Measured{*value, r.plain(study, key + ".standard_error." + member).value_or(kNan)};
}

struct BoxRow {
  const char *figure, *what, *study, *key, *member, *theirs;
  double low, high;
};

// Where the source says "about", a quarter of the value on either side, as everywhere.
const std::vector<BoxRow>& box_rows() {
  // clang-format off
  static const std::vector<BoxRow> rows{
      {"table 1", "grains of an RVE of radius 2", kRve, "rve.r2.grains", "", "5.25", 5, 5.5},
      {"table 1", "grains of an RVE of radius 3", kRve, "rve.r3.grains", "", "18.25", 17.75, 18.75},
      {"table 1", "grains of an RVE of radius 5", kRve, "rve.r5.grains", "", "83.5", 83, 84},
      {"table 1", "grains of an RVE of radius 7", kRve, "rve.r7.grains", "", "227.4", 226.9, 227.9},
      {"fig. 5", "largest kinetic over elastic energy after the start, mu = 0.5", kCompression, "sample.kinetic_share", "hertz_05", "below 0.001", 0, 0.001},
      {"fig. 5", "the same, box of 1609 grains", kRve, "sample.kinetic_share", "", "below 0.001", 0, 0.001},
      {"fig. 8", "error bar of the axial stress, RVEs of radius 2", kRve, "rve.r2.error_bar", "", "about 0.20", 0.15, 0.25},
      {"fig. 8", "error bar of the axial stress, RVEs of radius 3", kRve, "rve.r3.error_bar", "", "about 0.08", 0.06, 0.1},
      {"fig. 8", "error bar of the axial stress, RVEs of radius 5", kRve, "rve.r5.error_bar", "", "about 0.02", 0.015, 0.025},
      {"fig. 8", "error bar of the axial stress, RVEs of radius 7", kRve, "rve.r7.error_bar", "", "about 0.01", 0.0075, 0.0125},
      {"fig. 9", "axial strain of RVEs over the imposed one", kRve, "rve.r5.strain_ratio", "", "1 within 10 %", 0.9, 1.1},
      {"fig. 10", "late over early stiffness, penalty law", kCompression, "sample.stiffening_late", "penalty_05", "linear (0.9-1.1)", 0.9, 1.1},
      {"fig. 10", "late over early stiffness, Hertz law", kCompression, "sample.stiffening_late", "hertz_05", "stiffening (above 1.1)", 1.1, 3},
      {"fig. 11", "q/p without friction, penalty law", kCompression, "sample.end_axial_stress_ratio", "penalty_0", "about 0.1", 0.075, 0.125},
      {"fig. 11", "q/p without friction, Hertz law", kCompression, "sample.end_axial_stress_ratio", "hertz_0", "about 0.1", 0.075, 0.125},
      {"fig. 12", "plastic strain without friction", kCompression, "sample.plastic_strain", "hertz_0", "about 0.02", 0.015, 0.025},
      {"fig. 12", "plastic strain, mu = 0.5", kCompression, "sample.plastic_strain", "hertz_05", "none", 0, 0.002},
      {"fig. 12", "unloading over loading stiffness, mu = 0.5", kCompression, "sample.unloading_stiffness", "hertz_05", "clearly stiffer (above 1.1)", 1.1, 10},
      {"fig. 15", "shear strain xz of RVEs over the imposed one", kShear, "rve.r5.strain_ratio", "hertz_05", "1 within 10 %", 0.9, 1.1},
      {"fig. 15", "shear strain xz where the RVEs' mean volume is least, mu = 0.5", kShear, "rve.contraction_strain", "hertz_05", "about 0.05", 0.0375, 0.0625},
      {"fig. 16", "shear strain xz where the axial stress is least, Hertz law, mu = 0.25", kShear, "sample.axial_dip_strain", "hertz_025", "about 0.02", 0.015, 0.025},
      {"fig. 16", "shear strain xz where the axial stress is least, penalty law, mu = 0.25", kShear, "sample.axial_dip_strain", "penalty_025", "about 0.05", 0.0375, 0.0625},
      {"fig. 17", "volumetric stress over its start, mu = 0", kShear, "sample.pressure_ratio", "hertz_0", "about 1", 0.75, 1.25},
      {"fig. 17", "volumetric stress over its start, mu = 0.25", kShear, "sample.pressure_ratio", "hertz_025", "about 1.7", 1.275, 2.125},
      {"fig. 17", "volumetric stress over its start, mu = 0.5", kShear, "sample.pressure_ratio", "hertz_05", "about 3", 2.25, 3.75},
      {"fig. 17", "shear stress over the first volumetric stress, mu = 0.25", kShear, "sample.shear_over_pressure", "hertz_025", "about 1", 0.75, 1.25},
      {"fig. 17", "shear stress over the first volumetric stress, mu = 0.5", kShear, "sample.shear_over_pressure", "hertz_05", "about 2", 1.5, 2.5},
  };
  // clang-format on
  return rows;
}

SourceFigure in_words(const char* figure, const std::string& what, const char* study,
                      const char* theirs, std::vector<std::string> words,
                      std::function<std::optional<std::string>(const Results&)> word) {
  return {std::string("Wellmann ") + figure,
          what,
          "",
          study,
          theirs,
          0,
          0,
          std::move(words),
          nullptr,
          std::move(word),
          0};
}

// Of samples that flow: their stresses are no states of rest.
std::string flow_note(const Results& r, const std::string& member) {
  const auto share = r.plain(kCompression, "sample.kinetic_share." + member);
  if (!share || !(*share > 0.01)) return "";
  return fmt::format("slow flow, not at rest: kinetic over elastic energy up to {:.2g}", *share);
}

SourceFigure row_figure(const BoxRow& row) {
  SourceFigure out = in_words(row.figure, row.what, row.study, row.theirs, {}, nullptr);
  out.low = row.low;
  out.high = row.high;
  out.number = [row](const Results& r) {
    return *row.member == '\0' ? r.number(row.study, row.key)
                               : of_member(r, row.study, row.key, row.member);
  };
  if (std::string(row.figure) == "fig. 11") {
    out.note = [row](const Results& r) { return flow_note(r, row.member); };
  }
  return out;
}

// By the mean over samples at its least value and by what it regains from there.
std::optional<std::string> contraction_word(const Results& r) {
  const auto down = of_member(r, kShear, "rve.contraction", "hertz_05");
  const auto up = of_member(r, kShear, "rve.dilation", "hertz_05");
  if (!down || !up) return std::nullopt;
  const bool falls = down->value > 2 * down->error, rises = up->value > 2 * up->error;
  const char* word = falls && rises ? "contraction, then dilation"
                     : falls        ? "contraction"
                     : rises        ? "dilation"
                                    : "neither";
  const std::string then = up->value == 0 && up->error == 0
                               ? "least at the end"
                               : fmt::format("then rises by {:.5f} ± {:.5f}", up->value, up->error);
  return fmt::format("{}: trace/3 falls by {:.5f} ± {:.5f}, {}", word, down->value, down->error,
                     then);
}

// A figure of one member of a sweep less that of another. Samples of one seed share their first
// state where only the friction differs; the error is that of independent ones, which is no less.
struct Change {
  double of, error, base;
};
std::optional<Change> change_of(const Results& r, const char* study, const char* key,
                                const std::string& from, const std::string& to) {
  const auto a = of_member(r, study, key, from), b = of_member(r, study, key, to);
  if (!a || !b) return std::nullopt;
  return Change{b->value - a->value, std::hypot(a->error, b->error), a->value};
}

constexpr const char* kStressRatio = "sample.end_axial_stress_ratio";

SourceFigure rise(const char* figure, const char* what, const char* study, const char* key,
                  const char* from, const char* to) {
  return in_words(
      figure, what, study, "rises", {"rises"}, [=](const Results& r) -> std::optional<std::string> {
        const auto c = change_of(r, study, key, from, to);
        if (!c) return std::nullopt;
        const double reach = 2 * c->error;
        const char* word = c->of > reach ? "rises" : c->of < -reach ? "falls" : "undecided";
        return fmt::format("{}: {:+.3f} ± {:.3f}", word, c->of, c->error);
      });
}

SourceFigure steady(const char* what, const char* from, const char* to) {
  return in_words("fig. 11", what, kLaws, "hardly changes", {"hardly changes"},
                  [=](const Results& r) -> std::optional<std::string> {
                    const auto c = change_of(r, kLaws, kStressRatio, from, to);
                    if (!c) return std::nullopt;
                    const double most = kHardly * std::fabs(c->base), reach = 2 * c->error;
                    if (!std::isfinite(reach))
                      return fmt::format("undecided: {:+.3f}, {:+.0f} %", c->of,
                                         100 * c->of / c->base);
                    const char* word = std::fabs(c->of) + reach <= most  ? "hardly changes"
                                       : std::fabs(c->of) - reach > most ? "changes"
                                                                         : "between";
                    return fmt::format("{}: {:+.3f} ± {:.3f}, {:+.0f} ± {:.0f} %", word, c->of,
                                       c->error, 100 * c->of / c->base, 100 * c->error / c->base);
                  });
}

std::vector<SourceFigure> law_figures() {
  return {rise("fig. 11", "q/p from mu = 0.25 to 0.5, penalty law", kLaws, kStressRatio,
               "ratio_1_friction_025", "ratio_1"),
          rise("fig. 11", "q/p from mu = 0.25 to 0.5, Hertz law", kLaws, kStressRatio,
               "poisson_0_friction_025", "poisson_0"),
          steady("q/p from c^T/c^N = 0.25 to 1, mu = 0.5", "ratio_025", "ratio_1"),
          steady("q/p from c^T/c^N = 0.25 to 1, mu = 0.25", "ratio_025_friction_025",
                 "ratio_1_friction_025"),
          steady("q/p from nu = 0 to 0.45, mu = 0.5", "poisson_0", "poisson_045"),
          steady("q/p from nu = 0 to 0.45, mu = 0.25", "poisson_0_friction_025",
                 "poisson_045_friction_025")};
}

}  // namespace

std::vector<SourceFigure> box_figures() {
  std::vector<SourceFigure> out;
  for (const BoxRow& row : box_rows()) {
    const std::string figure = row.figure;
    if (figure == "fig. 12" && out.back().source == "Wellmann fig. 11") {
      for (SourceFigure& own : law_figures()) out.push_back(std::move(own));
    }
    out.push_back(row_figure(row));
    if (row.study == std::string(kShear) && row.member == std::string("hertz_0")) {
      out.back().missing = "not in this run: without friction no sample came to rest before it";
    }
    if (row.member == std::string("penalty_025")) {
      out.push_back(rise("fig. 16", "volumetric stress over its start, from penalty to Hertz law",
                         kShear, "sample.pressure_ratio", "penalty_025", "hertz_025"));
      out.push_back(rise("fig. 16",
                         "shear stress over the first volumetric one, from penalty to Hertz law",
                         kShear, "sample.shear_over_pressure", "penalty_025", "hertz_025"));
    }
    if (std::string(row.key) != "rve.contraction_strain") continue;
    out.push_back(in_words("fig. 15", "volume of the RVEs under shear, mu = 0.5", kShear,
                           "contraction, then dilation", {"contraction, then dilation"},
                           contraction_word));
  }
  return out;
}

}  // namespace grainfield::coupling
