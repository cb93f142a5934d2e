#include "coupling/reproduce/fit_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainfield::coupling {
namespace {

// Readings: constants are printed to 0.01, angles to 1 degree.
constexpr double kFraction = 0.01, kAngle = 1;

using Word = std::function<std::optional<std::string>(const Results&)>;

std::optional<Measured> fitted(const Results& r, const std::string& study, const std::string& key) {
  const auto value = r.plain(study, key);
  if (!value || std::isnan(*value)) return std::nullopt;
  double error = std::nan("");
  for (const char* kind : {".error", ".bootstrap_error"}) {
    const auto one = r.plain(study, key + kind);
    if (one && std::isfinite(*one)) error = std::isnan(error) ? *one : std::max(error, *one);
  }
  return Measured{*value, error};
}

SourceFigure constant(const std::string& source, const std::string& what, const std::string& unit,
                      const std::string& study, const std::string& key, const std::string& theirs,
                      double value) {
  const double off = unit == "deg" ? kAngle : kFraction;
  SourceFigure out;
  out.source = source;
  out.what = what;
  out.unit = unit;
  out.study = study;
  out.theirs = theirs;
  out.low = value - off;
  out.high = value + off;
  out.number = [=](const Results& r) { return fitted(r, study, key); };
  return out;
}

SourceFigure in_words(const std::string& source, const std::string& what, const std::string& study,
                      const std::string& theirs, std::vector<std::string> words, Word ours) {
  SourceFigure out;
  out.source = source;
  out.what = what;
  out.study = study;
  out.theirs = theirs;
  out.words = std::move(words);
  out.word = std::move(ours);
  return out;
}

// How well a model fits, as a word with its numbers.
Word quality(const std::string& study, const std::string& model) {
  return [=](const Results& r) -> std::optional<std::string> {
    const std::string prefix = "fit." + model + ".";
    const auto chi2 = r.plain(study, prefix + "chi2_per_dof");
    const auto rel = r.plain(study, prefix + "rel_l2");
    const auto chance = r.plain(study, prefix + "chi2_chance");
    if (!chi2 || !rel || !chance || std::isnan(*chi2)) return std::nullopt;
    return fit_word(*chi2, *chance, *rel);
  };
}

Word branch(const std::string& study) {
  return [=](const Results& r) -> std::optional<std::string> {
    const auto name = r.text(study, "fit.cantelaube.branch");
    const auto angle = fitted(r, study, "fit.cantelaube.beta_hat_deg");
    if (!name || !angle) return std::nullopt;
    return fmt::format("{}: nearest to β̂ = {:.1f}°", *name, angle->value);
  };
}

// Kink of the free core: a dip or a peak beyond two errors.
Word kink(const std::string& study) {
  return [=](const Results& r) -> std::optional<std::string> {
    const auto size = fitted(r, study, "fit.cantelaube_asymmetric.kink");
    const auto ray = fitted(r, study, "fit.cantelaube_asymmetric.ray_deg");
    if (!size || !ray || std::isnan(size->error)) return std::nullopt;
    const bool seen = std::fabs(size->value) > 2 * size->error;
    return fmt::format("{}: kink {:.2f} ± {:.2f} ρg on the ray at {:.0f}° from the vertical",
                       !seen             ? "neither"
                       : size->value < 0 ? "dip"
                                         : "peak",
                       size->value, size->error, ray->value);
  };
}

struct Constant {
  const char *name, *unit, *theirs;
  double value;
};

}  // namespace

std::string fit_word(double chi2_per_dof, double most, double rel_l2) {
  return fmt::format("{} the errors: χ²/dof {:.2f} (chance: up to {:.2f}), relative L2 {:.1f} %",
                     chi2_per_dof > most ? "beyond" : "within", chi2_per_dof, most, 100 * rel_l2);
}

std::vector<SourceFigure> fit_figures() {
  const std::string point = "fit-cantelaube-point", line = "fit-cantelaube-line",
                    osl = "fit-osl-point", asymmetric = "fit-asymmetric";
  std::vector<SourceFigure> out;
  const auto cantelaube = [&out](const std::string& study, const std::string& source,
                                 const std::string& equations,
                                 const std::vector<Constant>& constants) {
    for (const Constant& c : constants) {
      out.push_back(constant(
          equations, fmt::format("Cantelaube, {} source: {}", source, c.name), c.unit, study,
          std::string("fit.cantelaube.") + (std::string(c.unit) == "deg" ? "beta_hat_deg" : c.name),
          c.theirs, c.value));
    }
  };
  // Roul's a11 and a22 stand exchanged (misprints below): a22 is a_xx.
  cantelaube(point, "point", "Roul 4.14, 4.15",
             {{"a1", "", "0.34", 0.34},
              {"a2", "", "0.49", 0.49},
              {"b1", "", "-0.2", -0.2},
              {"a_xx", "", "0.78", 0.78},
              {"a_yy", "", "1.23", 1.23},
              {"a_xy", "", "0.38", 0.38},
              {"β̂", "deg", "35", 35}});
  out.push_back(in_words("Roul 4.3", "Cantelaube, point source: branch nearest to β̂", point,
                         "35° (dip branch: 22°)", {"zero"}, branch(point)));
  out.push_back(in_words("Roul fig. 4.4", "Cantelaube, point source, seven free numbers: agreement",
                         point, "very good", {"within the errors"}, quality(point, "cantelaube")));
  out.push_back(
      in_words("Roul 4.3", "Cantelaube, point source, dip branch without free numbers: agreement",
               point, "not well", {"beyond the errors"}, quality(point, "cantelaube_minus")));
  cantelaube(line, "line", "Roul 4.16, 4.17",
             {{"a1", "", "0.15", 0.15},
              {"a2", "", "0.64", 0.64},
              {"b1", "", "0.27", 0.27},
              {"a_xx", "", "0.79", 0.79},
              {"a_yy", "", "1.20", 1.20},
              {"a_xy", "", "0.39", 0.39},
              {"β̂", "deg", "49", 49}});
  out.push_back(in_words("Roul 4.3", "Cantelaube, line source: branch nearest to β̂", line,
                         "49°, called plateau: is the + branch", {"plus"}, branch(line)));
  out.push_back(in_words("Roul fig. 4.5", "Cantelaube, line source, seven free numbers: agreement",
                         line, "very good", {"within the errors"}, quality(line, "cantelaube")));
  out.push_back(in_words("Roul 4.3",
                         "Cantelaube, line source, + branch without free numbers: agreement", line,
                         "works well", {"within the errors"}, quality(line, "cantelaube_plus")));
  for (const Constant& c : {Constant{"η", "", "0.74", 0.74}, Constant{"μ", "", "-0.31", -0.31},
                            Constant{"K", "", "1.345", 1.345}, Constant{"τ", "deg", "85", 85}}) {
    const std::string name = c.name;
    const std::string key = name == "η"   ? "eta"
                            : name == "μ" ? "mu"
                            : name == "K" ? "K"
                                          : "tau_deg";
    out.push_back(constant("Roul 4.31", fmt::format("OSL, point source: {}", name), c.unit, osl,
                           "fit.osl." + key, c.theirs, c.value));
  }
  out.push_back(in_words("Roul fig. 4.9", "OSL, point source, η and μ free: agreement", osl,
                         "very good", {"within the errors"}, quality(osl, "osl")));
  out.push_back(in_words("Roul fig. 3.31, 3.32",
                         "asymmetric point source, two slopes and one linear core: agreement",
                         asymmetric, "good", {"within the errors"},
                         quality(asymmetric, "cantelaube_asymmetric_zero")));
  out.push_back(in_words("Roul fig. 3.31", "asymmetric point source: kink of the pressure",
                         asymmetric, "dip below or slightly right of the apex", {"dip"},
                         kink(asymmetric)));
  return out;
}

}  // namespace grainfield::coupling
