#include "coupling/reproduce/liffman_figures.h"

#include <fmt/format.h>

namespace grainfield::coupling {
namespace {

constexpr const char *kHard = "liffman-lattice", *kSoft = "liffman-soft-piles",
                     *kTent = "liffman-tent", *kDropped = "liffman-dropped",
                     *kDroppedGrains = "liffman-dropped-grains";
// The middle of a flat normal force stays within this of its largest value: whole disks make steps.
constexpr double kDip = 0.98;
// A share of lines below this is none, above ten times this it is many.
constexpr double kFewLines = 0.01;
constexpr double kStraight = 0.9, kSameDifference = 0.8, kAsPredicted = 0.01;

std::string level_lines(double share) {
  const char* word = share < kFewLines ? "none" : share > 10 * kFewLines ? "many" : "some";
  return fmt::format("{}: {:.2g} % of the lines", word, 100 * share);
}
std::string dip_word(double ratio) {
  return fmt::format("{}: middle over largest {:.3f}", ratio < kDip ? "dip" : "no dip", ratio);
}
std::string straight_word(double explained) {
  return fmt::format("{}: a line explains {:.1f} %",
                     explained > kStraight ? "linear" : "not linear", 100 * explained);
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

// An ensemble where the source has single piles. `member`: of a sweep, ".NAME", or nothing.
SourceFigure dropped(const char* what, const char* study, const std::string& member) {
  SourceFigure out = told("fig. 20", what, study, "slight depression in one pile, none in others",
                          {"neither", "peak"}, "", nullptr);
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
  };
}

}  // namespace grainfield::coupling
