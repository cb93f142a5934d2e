#include "coupling/case/material.h"

#include <fmt/format.h>

#include <cmath>

#include "coupling/case/study.h"
#include "dem/laws/material_defaults.h"

namespace grainfield::coupling {
namespace {

constexpr double kGravity = 9.81;  // m/s2

const dem::MaterialSetup& material_in(const Case& value) {
  return find_study(value.study)->material(const_cast<Case&>(value));  // only read
}

}  // namespace

std::optional<dem::RoundGrain> nominal_grain(const Case& value) {
  const Study* study = find_study(value.study);
  if (study == nullptr || study->material == nullptr) return std::nullopt;
  return dem::RoundGrain{dimension_of(value),
                         study->grain_radius != nullptr ? study->grain_radius(value) : 0};
}

void follow_material(Case& value) {
  const auto grain = nominal_grain(value);
  if (!grain) return;
  Case usual;
  usual.study = value.study;
  const auto given = [&](std::string_view member) {
    return value.given.contains("material." + std::string(member));
  };
  dem::follow_defaults(find_study(value.study)->material(value), material_in(usual), given, *grain);
}

std::string material_text(const Case& value) {
  const auto grain = nominal_grain(value);
  if (!grain || !(grain->radius > 0)) return "";
  const dem::MaterialSetup& m = material_in(value);
  // The speed of a fall over one diameter.
  const double speed = std::sqrt(4 * kGravity * grain->radius);
  const double e = dem::head_on_restitution(m, *grain, speed);
  return fmt::format(
      "k_t/k_n = {:.3g}, restitution {:.3g} of two {} of radius {:.3g} mm at {:.2g} "
      "m/s",
      dem::stiffness_ratio(m), e, grain->dim == 3 ? "spheres" : "disks", 1e3 * grain->radius,
      speed);
}

}  // namespace grainfield::coupling
