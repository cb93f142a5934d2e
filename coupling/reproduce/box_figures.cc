#include "coupling/reproduce/box_figures.h"

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

constexpr const char *kCompression = "box-compression", *kShear = "box-shear", *kRve = "rve-3d";

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
      {"fig. 8", "error bar of the axial stress, RVEs of radius 2", kRve, "rve.r2.error_bar", "", "about 0.20", 0.15, 0.25},
      {"fig. 8", "error bar of the axial stress, RVEs of radius 3", kRve, "rve.r3.error_bar", "", "about 0.08", 0.06, 0.1},
      {"fig. 8", "error bar of the axial stress, RVEs of radius 5", kRve, "rve.r5.error_bar", "", "about 0.02", 0.015, 0.025},
      {"fig. 8", "error bar of the axial stress, RVEs of radius 7", kRve, "rve.r7.error_bar", "", "about 0.01", 0.0075, 0.0125},
      {"fig. 9", "axial strain of RVEs over the imposed one", kRve, "rve.r5.strain_ratio", "", "1 within 10 %", 0.9, 1.1},
      {"fig. 10", "late over early stiffness, penalty law", kCompression, "sample.stiffening_late", "penalty_05", "linear (0.9-1.1)", 0.9, 1.1},
      {"fig. 10", "late over early stiffness, Hertz law", kCompression, "sample.stiffening_late", "hertz_05", "stiffening (above 1.1)", 1.1, 3},
      {"fig. 11", "q/p without friction, penalty law", kCompression, "sample.end_stress_ratio", "penalty_0", "about 0.1", 0.075, 0.125},
      {"fig. 11", "q/p without friction, Hertz law", kCompression, "sample.end_stress_ratio", "hertz_0", "about 0.1", 0.075, 0.125},
      {"fig. 12", "plastic strain without friction", kCompression, "sample.plastic_strain", "hertz_0", "about 0.02", 0.015, 0.025},
      {"fig. 12", "plastic strain, mu = 0.5", kCompression, "sample.plastic_strain", "hertz_05", "none", 0, 0.002},
      {"fig. 12", "unloading over loading stiffness, mu = 0.5", kCompression, "sample.unloading_stiffness", "hertz_05", "clearly stiffer (above 1.1)", 1.1, 10},
      {"fig. 15", "shear strain xz of RVEs over the imposed one", kShear, "rve.r5.strain_ratio", "hertz_05", "1 within 10 %", 0.9, 1.1},
      {"fig. 15", "shear strain xz at the largest contraction", kShear, "rve.contraction_strain", "hertz_05", "about 0.05", 0.0375, 0.0625},
      {"fig. 17", "volumetric stress over its start, mu = 0.25", kShear, "sample.pressure_ratio", "hertz_025", "about 1.7", 1.275, 2.125},
      {"fig. 17", "volumetric stress over its start, mu = 0.5", kShear, "sample.pressure_ratio", "hertz_05", "about 3", 2.25, 3.75},
      {"fig. 17", "shear stress over the first volumetric stress, mu = 0.25", kShear, "sample.shear_over_pressure", "hertz_025", "about 1", 0.75, 1.25},
      {"fig. 17", "shear stress over the first volumetric stress, mu = 0.5", kShear, "sample.shear_over_pressure", "hertz_05", "about 2", 1.5, 2.5},
  };
  // clang-format on
  return rows;
}

}  // namespace

std::vector<SourceFigure> box_figures() {
  std::vector<SourceFigure> out;
  for (const BoxRow& row : box_rows()) {
    SourceFigure figure{std::string("Wellmann ") + row.figure,
                        row.what,
                        "",
                        row.study,
                        row.theirs,
                        row.low,
                        row.high,
                        {},
                        nullptr,
                        nullptr,
                        0};
    figure.number = [row](const Results& r) {
      return *row.member == '\0' ? r.number(row.study, row.key)
                                 : of_member(r, row.study, row.key, row.member);
    };
    out.push_back(std::move(figure));
  }
  return out;
}

}  // namespace grainfield::coupling
