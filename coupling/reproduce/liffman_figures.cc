#include "coupling/reproduce/liffman_figures.h"

#include <fmt/format.h>

namespace grainfield::coupling {
namespace {

constexpr const char *kHard = "liffman-lattice", *kSoft = "liffman-soft-piles",
                     *kTent = "liffman-tent", *kDropped = "liffman-dropped",
                     *kDroppedGrains = "liffman-dropped-grains", *kImplicit = "implicit-settling",
                     *kSwitching = "liffman-switching", *kHardDisks = "hard-disks";
// The middle of a flat normal force stays within this of its largest value: whole disks make steps.
constexpr double kDip = 0.98;
// A share of lines below this is none, above ten times this it is many.
constexpr double kFewLines = 0.01;
// A quarter of a sine, level at the window's end, has 0.986 of its variance on a line. The share
// that counts as straight and the window (run/measured_base.cc) were set after the piles were seen.
constexpr double kStraight = 0.99, kSameDifference = 0.8, kAsPredicted = 0.01;
constexpr double kMostSoft = 0.9;  // of the disks; the others lie loose

std::string level_lines(double share) {
  const char* word = share < kFewLines ? "none" : share > 10 * kFewLines ? "many" : "some";
  return fmt::format("{}: {:.2g} % of the lines", word, 100 * share);
}
std::string dip_word(double ratio) {
  return fmt::format("{}: middle over largest {:.3f}", ratio < kDip ? "dip" : "no dip", ratio);
}
std::string straight_word(double explained) {
  return fmt::format(
      "{}: a line explains {:.2f} % up to 0.8 of the way to the line model's bend; "
      "the 0.8, and {:.0f} % as least, were chosen after the piles were seen",
      explained > kStraight ? "linear" : "not linear", 100 * explained, 100 * kStraight);
}
std::string exact_word(double error) {
  return fmt::format("{} 1 %: {:.2g} %", error <= kAsPredicted ? "within" : "beyond", 100 * error);
}

SourceFigure told(const char* figure, const char* what, const char* study, const char* theirs,
                  std::vector<std::string> words, const std::string& key,
                  std::string (*describe)(double)) {
  const std::string name = study;
  return {std::string("Liffman ") + figure,
          what,
          "",
          study,
          theirs,
          0,
          0,
          std::move(words),
          nullptr,
          [=](const Results& r) -> std::optional<std::string> {
            const auto value = r.plain(name, key);
            return value ? std::optional(describe(*value)) : std::nullopt;
          },
          0};
}

// Whether more disks bring H nearer to the line model.
SourceFigure convergence() {
  SourceFigure out = told("fig. 15", "H of 5,490 disks at 30° against the lines, rows that touch",
                          kSoft, "does not converge", {"does not converge"}, "", nullptr);
  out.word = [](const Results& r) -> std::optional<std::string> {
    const std::string key = "liffman.line_horizontal_max_difference.";
    const auto few = r.plain(kSoft, key + "slope_30"), many = r.plain(kSoft, key + "large_30");
    if (!few || !many) return std::nullopt;
    return fmt::format("{}: differs by {:.2g} % with 360 disks, by {:.2g} % with 5,490",
                       *many > kSameDifference * *few ? "does not converge" : "converges",
                       100 * *few, 100 * *many);
  };
  return out;
}

// An ensemble of dropped piles. `member`: of a sweep, ".NAME", or nothing.
SourceFigure dropped(const char* figure, const char* what, const char* theirs,
                     std::vector<std::string> words, const char* study, const std::string& member) {
  SourceFigure out = told(figure, what, study, theirs, std::move(words), "", nullptr);
  out.word = [=](const Results& r) -> std::optional<std::string> {
    const auto word = r.text(study, "dip.verdict" + member);
    const auto difference = r.plain(study, "dip.difference" + member);
    const auto error = r.plain(study, "dip.standard_error" + member);
    if (!word || !difference || !error) return std::nullopt;
    return fmt::format("{}: shoulder - centre = {:.3f} ± {:.3f} ρgh, by itself", *word, *difference,
                       *error);
  };
  return out;
}
// The source has single piles of equal disks.
SourceFigure dropped(const char* what, const char* study, const std::string& member) {
  return dropped("fig. 20", what, "slight depression in one pile, none in others",
                 {"neither", "peak"}, study, member);
}
// Its third suggestion why its piles have no dip such as was measured.
SourceFigure dropped_others(const char* what, const std::string& member) {
  return dropped("suggestion 3", what, "a dip, if it is due to the grains", {"dip"}, kDroppedGrains,
                 member);
}

// What viscous friction alone, without the ground's wells, does with a pile.
SourceFigure creep() {
  SourceFigure out =
      told("30", "static friction of the ground under a pile of 20 rows, viscous friction between",
           kImplicit, "needed", {"needed"}, "", nullptr);
  out.word = [](const Results& r) -> std::optional<std::string> {
    const auto rests = r.plain(kImplicit, "settling.at_rest.viscous_alone");
    const auto speed = r.plain(kImplicit, "settling.spread_speed.viscous_alone");
    if (!rests || !speed) return std::nullopt;
    return fmt::format("{}: without it the base goes apart at {:.2g} sqrt(g d)",
                       *rests == 0 ? "needed" : "not needed", *speed);
  };
  return out;
}

// Whether the rule of eq. 22 brings a rain of hard disks to rest as soft ones.
SourceFigure turning() {
  SourceFigure out = told("22", "hard disks that rain into a box and come to rest", kSwitching,
                          "turn soft", {"turn soft"}, "", nullptr);
  out.word = [](const Results& r) -> std::optional<std::string> {
    const auto rests = r.plain(kSwitching, "switch.at_rest");
    const auto share = r.plain(kSwitching, "switch.soft_share");
    const auto hard = r.plain(kSwitching, "switch.to_hard");
    if (!rests || !share || !hard) return std::nullopt;
    return fmt::format("{}: {:.3g} % at rest; {:.0f} times one turned hard again on the way",
                       *rests == 1 && *share > kMostSoft ? "turn soft" : "do not rest",
                       100 * *share, *hard);
  };
  return out;
}

SourceFigure henderson(const char* what, const std::string& fraction) {
  const std::string key = "gas.fraction_" + fraction + ".compressibility_over_theory.";
  return {"Henderson 1975",
          what,
          "",
          kHardDisks,
          "1 (within 1 %)",
          1 - kAsPredicted,
          1 + kAsPredicted,
          {},
          [=](const Results& r) -> std::optional<Measured> {
            const auto ours = r.plain(kHardDisks, key + "pressure");
            const auto error = r.plain(kHardDisks, key + "standard_error.pressure");
            if (!ours || !error) return std::nullopt;
            return Measured{*ours, *error};
          },
          nullptr,
          0};
}

}  // namespace

std::vector<SourceFigure> liffman_figures() {
  return {
      told("fig. 8", "N below 45 layers at m g/(K d) = 1e-4, without any tangential force", kSoft,
           "0 (within 1 %)", {"within 1 %"}, "liffman.normal_max_error.slope_60", exact_word),
      told("fig. 9", "H below 45 layers at m g/(K d) = 1e-4, likewise", kSoft, "0 (within 1 %)",
           {"within 1 %"}, "liffman.horizontal_max_error.slope_60", exact_word),
      told("fig. 10", "horizontal lines of minimum force, equilateral pile", kHard, "none",
           {"none"}, "liffman.minimum_lines_level.slope_deg_60", level_lines),
      convergence(),
      told("fig. 16", "horizontal lines of maximum force at 30°", kSoft, "none", {"none"},
           "liffman.maximum_lines_level.slope_30", level_lines),
      told("fig. 16", "horizontal lines of minimum force at 30°", kSoft, "many", {"many"},
           "liffman.minimum_lines_level.slope_30", level_lines),
      told("fig. 17", "H in the middle of the base at 32.6°", kSoft, "linear", {"linear"},
           "liffman.horizontal_explained.slope_32_6", straight_word),
      told("fig. 17", "N in the middle of the base at 32.6°", kSoft, "no dip", {"no dip"},
           "liffman.normal_centre.slope_32_6", dip_word),
      told("fig. 19", "N of the line model under a tent", kTent, "dip", {"dip"},
           "liffman.line_normal_centre.tent", dip_word),
      told("fig. 19", "N of the grains under a tent", kTent, "no dip", {"no dip"},
           "liffman.normal_centre.tent", dip_word),
      dropped("base pressure of piles dropped disk by disk, 968 disks", kDropped, ""),
      dropped("base pressure of piles dropped disk by disk, 200 disks", kDroppedGrains, ".equal"),
      dropped_others("the same with radii within 30 %", ".unlike"),
      dropped_others("the same with a friction of 0.5 between equal disks", ".coulomb"),
      dropped_others("the same with irregular pentagons", ".pentagons"),
      turning(),
      creep(),
      told("42", "N below 20 rows of soft disks on the ground's wells, implicit motion", kImplicit,
           "0 (within 1 %)", {"within 1 %"}, "settling.normal_max_error.wells", exact_word),
      told("44", "H below 20 rows of soft disks, likewise", kImplicit, "0 (within 1 %)",
           {"within 1 %"}, "settling.horizontal_max_error.wells", exact_word),
      henderson("pressure of hard disks over Henderson's at an area fraction of 0.2", "0.2"),
      henderson("the same at 0.35", "0.35"),
      henderson("the same at 0.5", "0.5"),
  };
}

}  // namespace grainfield::coupling
