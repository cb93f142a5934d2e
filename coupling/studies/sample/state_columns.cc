#include "coupling/studies/sample/state_columns.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/averaging/grain_facts.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

double attribute(const dem::Snapshot& s, const char* name, bool may_lack = false) {
  const auto at = s.attributes.find(name);
  if (at != s.attributes.end()) {
    if (const auto number = parse_number(at->second)) return *number;
  }
  if (may_lack && at == s.attributes.end()) return kNan;
  throw std::invalid_argument(
      fmt::format("found a state of a sample {} the attribute \"{}\", allowed: a number",
                  at == s.attributes.end() ? "without" : "that cannot tell", name));
}

// The last axis' pressure less the mean of the others' (Wellmann 32 with s2 = s3 their mean).
double axial_deviator(const StateFacts& f) {
  const Eigen::Matrix3d& s = f.now.contact_stress;
  return 0.5 * (s(0, 0) + s(1, 1)) - s(2, 2);
}

// The mobilised angle of friction: sin phi = (s1 - s3)/(s1 + s3), compression positive.
double friction_angle_deg(const StateFacts& f) {
  const double most = -f.stress.values[f.dim - 1], least = -f.stress.values[0];
  const double sine = (most - least) / (most + least);
  return std::fabs(sine) <= 1 ? std::asin(sine) * 180 / std::numbers::pi : kNan;
}

// The stretch of an edge since the first state, logarithmic, extension positive.
double stretch(const StateFacts& f, int axis) {
  return std::log(f.now.edges(axis, axis) / f.first.edges(axis, axis));
}

std::vector<StateColumn> tensor(
    const std::string& name, const std::string& unit_2d, const std::string& unit_3d,
    const std::string& meaning, bool symmetric,
    const std::function<const Eigen::Matrix3d&(const StateFacts&)>& of) {
  std::vector<StateColumn> out;
  const auto add = [&](int a, int b) {
    const bool in_space = a == 2 || b == 2;
    out.push_back({fmt::format("{}_{}{}", name, "xyz"[a], "xyz"[b]), unit_2d, unit_3d, meaning,
                   [=](const StateFacts& f) { return of(f)(a, b); }, in_space});
  };
  for (int a = 0; a < 3; ++a) add(a, a);
  for (int a = 0; a < 3; ++a) {
    for (int b = a + 1; b < 3; ++b) {
      add(a, b);
      if (!symmetric) add(b, a);
    }
  }
  return out;
}

std::vector<StateColumn> all_columns() {
  using F = const StateFacts&;
  // clang-format off
  std::vector<StateColumn> all{
      {"strain", "1", "1", "imposed: tangent of the shear; of an edge, shortening positive, its logarithm (cell) or share (walls)", [](F f) { return f.strain; }},
      {"volumetric_strain", "1", "1", "ln(V/V0), dilation positive", [](F f) { return std::log(f.now.volume / f.first.volume); }},
      {"strain_xx", "1", "1", "ln(edge/edge0), extension positive", [](F f) { return stretch(f, 0); }},
      {"strain_yy", "1", "1", "likewise", [](F f) { return stretch(f, 1); }},
      {"strain_zz", "1", "1", "likewise", [](F f) { return stretch(f, 2); }, true},
  };
  const auto stress = tensor("sigma", "N/m", "Pa", "sum f_a l_b / V over contacts, tension positive (Love 1927, Weber 1966)", false, [](F f) -> const Eigen::Matrix3d& { return f.now.contact_stress; });
  all.insert(all.end(), stress.begin(), stress.end());
  const std::vector<StateColumn> scalars{
      {"p", "N/m", "Pa", "mean stress, compression positive: -trace/dim", [](F f) { return f.pressure(); }},
      {"q", "N/m", "Pa", "deviator: 2D largest - smallest principal stress, 3D sqrt(3/2 s:s)", [](F f) { return f.stress.deviator(); }},
      {"q_over_p", "1", "1", "q/p; in 2D twice the sine of the mobilised friction angle", [](F f) { return f.stress.deviator() / f.pressure(); }},
      {"axial_q", "Pa", "Pa", "deviator as the source has it for compressions: s1 - s3 with s1 along z and s3 the mean of x and y, compression positive (Wellmann 32)", axial_deviator, true},
      {"axial_q_over_p", "1", "1", "the same over p (Wellmann 33), below q/p by the shear stresses and by what x and y differ", [](F f) { return axial_deviator(f) / f.pressure(); }, true},
      {"friction_angle_deg", "deg", "deg", "mobilised: sin = (s1 - s3)/(s1 + s3)", friction_angle_deg},
      {"p_motion", "N/m", "Pa", "mean stress of the grains' motion, sum m u u / V, beside p", [](F f) { return -(f.now.stress - f.now.contact_stress).trace() / f.dim; }},
      {"solid_fraction", "1", "1", "volume of the grains over that of the sample", [](F f) { return f.now.solid_fraction; }},
      {"void_ratio", "1", "1", "volume of the voids over that of the grains", [](F f) { return 1 / f.now.solid_fraction - 1; }},
      {"coordination", "1", "1", "contacts of a grain", [](F f) { return f.counts.mean; }},
      {"coordination_bearing", "1", "1", "the same without rattlers and their contacts", [](F f) { return f.counts.mean_bearing; }},
      {"rattlers", "1", "1", "share of the grains that bear nothing", [](F f) { return double(f.counts.rattlers) / f.counts.grains; }},
  };
  all.insert(all.end(), scalars.begin(), scalars.end());
  const auto fabric = tensor("fabric", "1", "1", "(1/V) sum V_p sum n n, n along the branch (Roul 2.96)", true, [](F f) -> const Eigen::Matrix3d& { return f.fabric; });
  all.insert(all.end(), fabric.begin(), fabric.end());
  const std::vector<StateColumn> others{
      {"fabric_anisotropy", "1", "1", "deviator of the fabric over its trace", [](F f) { return f.fabric_axes.deviatoric_fraction(); }},
      {"kinetic_energy", "J", "J", "of the motion, in a cell of that against its flow", [](F f) { return f.kinetic; }},
      {"elastic_energy", "J", "J", "stored in the contacts", [](F f) { return f.elastic; }},
      {"work", "J", "J", "done on the grains by cell or walls since the first state", [](F f) { return f.work; }},
      {"dissipated", "J", "J", "lost since then; nan without motion.energy_balance, as the next six", [](F f) { return f.dissipated(); }},
      {"lost_in_dashpots", "J", "J", "of it in the normal dashpots of contacts", [](F f) { return f.in_dashpots; }},
      {"lost_to_friction", "J", "J", "of it by sliding and in dashpots along contacts", [](F f) { return f.to_friction; }},
      {"lost_to_rolling", "J", "J", "of it by rolling and twisting", [](F f) { return f.to_rolling; }},
      {"lost_to_damping", "J", "J", "of it to damping of single grains", [](F f) { return f.to_damping; }},
      {"work_of_law", "J", "J", "done by a law that is no gradient, or whose spring stiffens", [](F f) { return f.law_work; }},
      {"balance_error", "1", "1", "what the sum of energies less the works has changed by since then, over |work|", [](F f) { return f.work == 0 ? kNan : f.balance / std::fabs(f.work); }},
      {"pressure_on_right", "N/m", "Pa", "of the grains on the right wall, which a servo leads; nan in a cell, as the next", [](F f) { return f.now.moved_pressure.x(); }},
      {"pressure_on_lid", "N/m", "Pa", "likewise on the lid", [](F f) { return f.now.moved_pressure[f.dim - 1]; }},
      {"pressure_on_back", "Pa", "Pa", "likewise on the back", [](F f) { return f.now.moved_pressure.y(); }, true},
      {"lid_shear", "N/m", "Pa", "force of the grains on the lid along x over the floor's area", [](F f) { return f.now.lid_shear; }},
      {"unbalanced_force_ratio", "1", "1", "mean resultant over mean contact force", [](F f) { return f.unbalanced_force_ratio; }},
      {"inertial_number", "1", "1", "rate d sqrt(rho/p), d the mean diameter, rho the grains' density", [](F f) { return f.strain_rate * f.diameter * std::sqrt(f.density / f.pressure()); }},
  };
  // clang-format on
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace

double StateFacts::pressure() const { return -now.contact_stress.trace() / dim; }

StateFacts state_facts(const dem::Snapshot& s, const dem::Snapshot& first) {
  StateFacts out;
  out.snapshot = &s;
  out.dim = s.dim;
  out.now = dem::sample_state(s);
  out.first = dem::sample_state(first);
  out.stress = tensor_axes(out.now.contact_stress, s.dim);
  double volume = 0, mass = 0, diameters = 0;
  for (const GrainFacts& facts : grain_facts(s)) {
    out.fabric += facts.grain->volume / out.now.volume * facts.fabric;
    volume += facts.grain->volume;
    mass += facts.grain->mass;
    diameters += 2 * facts.grain->radius;
  }
  out.fabric_axes = tensor_axes(out.fabric, s.dim);
  out.diameter = diameters / static_cast<double>(s.grains.size());
  out.density = mass / volume;
  out.counts = coordination_counts(s);
  out.strain = attribute(s, "strain");
  out.strain_rate = attribute(s, "strain_rate");
  out.kinetic = attribute(s, "kinetic_energy");
  out.elastic = attribute(s, "elastic_energy");
  out.work = attribute(s, "work") - attribute(first, "work");
  const auto since = [&](const char* name) {
    return attribute(s, name, true) - attribute(first, name, true);
  };
  out.in_dashpots = since("lost_in_dashpots");
  out.to_friction = since("lost_to_friction");
  out.to_rolling = since("lost_to_rolling");
  out.to_damping = since("lost_to_damping");
  out.law_work = since("work_of_law");
  out.balance = since("energy_balance");
  out.unbalanced_force_ratio = attribute(s, "unbalanced_force_ratio");
  return out;
}

std::vector<StateColumn> state_columns(int dim) {
  std::vector<StateColumn> out;
  for (StateColumn& column : all_columns()) {
    if (dim == 3 || !column.in_space) out.push_back(std::move(column));
  }
  return out;
}

}  // namespace grainfield::coupling
