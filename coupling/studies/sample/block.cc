#include "coupling/studies/sample/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "continuum/constants.h"
#include "continuum/model.h"
#include "coupling/studies/sample/figures.h"
#include "coupling/studies/sample/simulation/path.h"

namespace grainfield::coupling {
namespace {

using continuum::BlockLoad;
using continuum::BlockMaterial;
using continuum::BlockState;
using Eigen::Index;
using Eigen::MatrixXd;

// A quantity of a state of the block, by the name of the grains' column, in its sign.
double value_of(const std::string& column, const BlockState& s) {
  const Eigen::Matrix3d& t = s.stress;
  const double p = -t.trace() / 3;
  if (column == "p") return p;
  if (column == "q") {
    return std::sqrt(1.5) * (t + p * Eigen::Matrix3d::Identity()).norm();
  }
  if (column == "sigma_xz") return t(0, 2);
  if (column == "sigma_zz") return t(2, 2);
  if (column == "volumetric_strain") return s.strain.trace();
  throw std::logic_error("a block has no column " + column);
}

Eigen::Matrix3d first_stress(const StateTable& table, Index r) {
  Eigen::Matrix3d out;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      out(a, b) = table.of(fmt::format("sigma_{}{}", "xyz"[a], "xyz"[b]))(0, r);
    }
  }
  return 0.5 * (out + out.transpose());
}

std::vector<BlockLoad> path_of(const StateTable& table, const dem::SamplePlan& plan, Index r) {
  std::vector<BlockLoad> out;
  for (Index k = 1; k < table.states(); ++k) {
    BlockLoad& load = out.emplace_back();
    const auto phase = k <= plan.records ? dem::SamplePhase::deform : dem::SamplePhase::unload;
    for (int a = 0; a < 3; ++a) {
      load.strain[a] = table.of(fmt::format("strain_{0}{0}", "xyz"[a]))(k, r);
      load.held[static_cast<std::size_t>(a)] = dem::is_led(plan, phase, a);
      load.stress[a] = -plan.pressure;
    }
    if (dem::shears(plan)) load.shear = table.of("strain")(k, r);
  }
  return out;
}

struct Angles {
  double friction = 0, dilation = 0;
};

// The friction angle of a law that carries tan = tau/sigma on the planes that slide with this
// dilation (Davis 1968): tan = sin phi cos psi/(1 - sin phi sin psi). 90 degrees: none does.
double friction_behind(double plane_deg, double dilation_deg) {
  const double t = std::tan(plane_deg * kDegree), psi = dilation_deg * kDegree;
  const double sine = t / (std::cos(psi) + t * std::sin(psi));
  return std::asin(std::min(1.0, sine)) / kDegree;
}

// nan: the grains do not tell.
Angles angles_of(const BlockSetup& setup, const std::vector<StrengthPath>& paths, std::size_t r) {
  if (setup.angles == "given") return {setup.friction_deg, setup.dilation_deg};
  const Strength s = strength_of(paths[r]);
  const bool peak = setup.angles == "peak";
  const double dilation = paths[r].volumetric.size() == 0 ? 0
                          : peak                          ? s.dilation_at_peak
                                                          : s.residual_dilation;
  const double friction = peak ? s.peak_friction : s.residual_friction;
  if (paths[r].test == StrengthTest::axial) return {friction, dilation};
  return {friction_behind(friction, std::max(0.0, dilation)), dilation};
}

// Law by law the material of a realization; `lacking`: what it needs and the grains do not tell.
BlockMaterial material_of(const BlockSetup& setup, const std::string& law, const SpaceModuli& m,
                          const std::vector<StrengthPath>& paths, std::size_t r, bool& bent,
                          std::string& lacking) {
  BlockMaterial out;
  out.constants.E = m.young;
  out.constants.nu = m.poisson;
  out.plastic = law == kPlasticBlock;
  if (!std::isfinite(m.young) || !std::isfinite(m.poisson)) {
    lacking = "small strains give no moduli";
    return out;
  }
  if (!out.plastic) return out;
  const Angles angles = angles_of(setup, paths, r);
  const bool friction = std::isfinite(angles.friction);
  if (!friction || !std::isfinite(angles.dilation)) {
    lacking = fmt::format("the grains show no {} angle {}", friction ? "dilation" : "friction",
                          setup.angles == "peak" ? "at a peak: too few states bear load"
                                                 : "in the last quarter of the strain: it has too "
                                                   "few states, or one that bears no load");
    return out;
  }
  out.constants.friction_deg = angles.friction;
  out.constants.dilation_deg = std::clamp(angles.dilation, 0.0, angles.friction);
  bent = bent || out.constants.dilation_deg != angles.dilation;
  return out;
}

// Fills the columns of one law; nan in realizations whose block cannot be solved. False with a
// remark when it is so in all of them.
bool add_law(const BlockSetup& setup, const StateTable& table, const dem::SamplePlan& plan,
             const ProbedState& moduli, const std::vector<StrengthPath>& paths,
             const std::string& law, BlockComparison& out) {
  bool bent = false;
  std::string why;
  Index missing = 0;
  for (BlockQuantity& quantity : out.quantities) {
    quantity.laws[law] = MatrixXd::Constant(table.states(), table.realizations(), kNan);
  }
  for (Index r = 0; r < table.realizations(); ++r) {
    const auto number = static_cast<std::size_t>(r);
    std::string lacking;
    const BlockMaterial material =
        material_of(setup, law, moduli.moduli[number], paths, number, bent, lacking);
    std::vector<BlockState> states;
    if (lacking.empty()) {
      try {
        states = continuum::load_block(material, first_stress(table, r), path_of(table, plan, r),
                                       setup.cells);
      } catch (const continuum::BadParameter& e) {
        // What the grains ask of a law it may be unable to give: that is a finding, not a failure.
        lacking = e.what();
      } catch (const ComputationFailed& e) {
        lacking = e.what();
      }
    }
    if (states.empty()) {
      ++missing;
      if (why.empty()) why = lacking;
      continue;
    }
    if (material.plastic) {
      out.friction.push_back(material.constants.friction_deg);
      out.dilation.push_back(material.constants.dilation_deg);
    }
    for (BlockQuantity& quantity : out.quantities) {
      for (Index k = 0; k < table.states(); ++k) {
        quantity.laws[law](k, r) = value_of(quantity.name, states[static_cast<std::size_t>(k)]);
      }
    }
  }
  if (missing > 0) {
    out.remarks.push_back(
        fmt::format("The block of law {} is left out{}: {}.", law,
                    table.realizations() == 1
                        ? ""
                        : fmt::format(" in {} of {} realizations", missing, table.realizations()),
                    why));
  }
  if (missing == table.realizations()) {
    for (BlockQuantity& quantity : out.quantities) quantity.laws.erase(law);
    return false;
  }
  if (bent) {
    out.remarks.push_back(fmt::format(
        "The block of law {} flows with a dilation angle bent into 0 to the friction angle.", law));
  }
  return true;
}

}  // namespace

void check_block(const BlockSetup& setup, const dem::SamplePlan& plan) {
  if (setup.law == "none") return;
  if (!dem::probes_first(plan)) {
    throw std::invalid_argument(fmt::format(
        "block.law: found \"{}\", allowed with sample.probe = \"{}\": none; its moduli are those "
        "of the first state: set sample.probe to \"first\" or \"both\"",
        setup.law, plan.probe));
  }
  if (!setup.has(kPlasticBlock)) return;
  if (setup.angles != "given" && plan.deformation != "axial" && !dem::shears(plan)) {
    throw std::invalid_argument(fmt::format(
        "block.angles: found \"{}\", allowed with sample.deformation = \"{}\": given, because it "
        "does not show the grains' strength; another test's (strength.*) go into "
        "block.friction_deg and block.dilation_deg",
        setup.angles, plan.deformation));
  }
  if (setup.angles == "given" && setup.dilation_deg > setup.friction_deg) {
    throw std::invalid_argument(
        fmt::format("block.dilation_deg: found {:g}, allowed: up to block.friction_deg = {:g}",
                    setup.dilation_deg, setup.friction_deg));
  }
}

BlockComparison compare_block(const BlockSetup& setup, const StateTable& table,
                              const dem::SamplePlan& plan, const ProbedState& moduli,
                              const std::vector<StrengthPath>& strength) {
  BlockComparison out;
  out.strain = table.mean("strain");
  out.loading = plan.records;
  const std::string driving = driving_of(plan.deformation, 3).stress;
  std::vector<std::pair<std::string, std::string>> columns{{driving, "Pa"}};
  if (driving != "p") columns.emplace_back("p", "Pa");
  columns.emplace_back("volumetric_strain", "-");
  for (const auto& [name, unit] : columns) {
    out.quantities.push_back({name, unit, table.of(name), {}});
  }
  if (setup.has(kPlasticBlock) && setup.angles != "given" && dem::shears(plan) &&
      plan.constant == "volume") {
    out.remarks.emplace_back(
        "The volume is held, so the grains show no dilation: the block of law mohr_coulomb flows "
        "without, and its mean stress cannot rise. Angles of a shear under constant stress may be "
        "given (block.angles).");
  }
  for (const char* law : {kElasticBlock, kPlasticBlock}) {
    if (!setup.has(law)) continue;
    if (add_law(setup, table, plan, moduli, strength, law, out)) out.laws.emplace_back(law);
  }
  return out;
}

}  // namespace grainfield::coupling
