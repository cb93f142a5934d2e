// The sample as one block of finite elements on the same path, beside the grains
// (continuum/block.h).
#pragma once
#include <map>
#include <string>
#include <vector>

#include "continuum/block.h"
#include "coupling/case/study.h"
#include "coupling/report/report.h"
#include "coupling/studies/sample/moduli.h"
#include "coupling/studies/sample/simulation/setup.h"
#include "coupling/studies/sample/state_table.h"
#include "coupling/studies/sample/strength.h"

namespace grainfield::coupling {

/// The laws of a block, as block.law and the figures name them.
inline constexpr const char *kElasticBlock = "elastic", *kPlasticBlock = "mohr_coulomb";

/// The case keys [block].
struct BlockSetup {
  std::string law = "none";                    ///< none | elastic | mohr_coulomb | both
  std::string angles = "peak";                 ///< peak | residual | given
  double friction_deg = 30, dilation_deg = 0;  ///< given
  int cells = 2;

  bool has(const std::string& one) const { return law == one || law == "both"; }
};

void declare_block_keys(SectionKeys s);
inline constexpr KeySection kBlockKeys{"block", KeyRole::analysis, declare_block_keys};

/// Throws std::invalid_argument naming the key: moduli that no probe will give, angles that the
/// deformation does not tell.
void check_block(const BlockSetup& setup, const dem::SamplePlan& plan);

/// A quantity of the states: rows states, columns realizations.
struct BlockQuantity {
  std::string name, unit;  ///< "q", "Pa"
  Eigen::MatrixXd grains;
  /// By law; nan in realizations whose block could not be solved, without laws that never could.
  std::map<std::string, Eigen::MatrixXd> laws;
};

struct BlockComparison {
  Eigen::VectorXd strain;                 ///< imposed, mean over realizations
  int loading = 0;                        ///< last state of the loading
  std::vector<BlockQuantity> quantities;  ///< driving stress, p, volumetric strain
  std::vector<std::string> laws;          ///< "elastic", "mohr_coulomb"
  /// That the plastic blocks had, degrees, by realization without those that were not solved.
  std::vector<double> friction, dilation;
  std::vector<std::string> remarks;  ///< of laws that were left out, of angles that were bent
};

/// Each realization's block has its own moduli (of the first state), angles and first stress.
BlockComparison compare_block(const BlockSetup& setup, const StateTable& table,
                              const dem::SamplePlan& plan, const ProbedState& moduli,
                              const std::vector<StrengthPath>& strength);

/// block.csv: by state, of each quantity the grains with their standard error and each law with its
/// difference, the difference's standard error, and the one over the other.
std::string block_csv(const BlockComparison& comparison);

/// By summary key block.LAW.*, a number for each realization.
FigureSamples block_figures(const BlockComparison& comparison);

/// Curves side by side, the table of the stages, the remarks.
std::vector<Section> block_sections(const BlockComparison& comparison);

std::vector<SummaryKey> block_summary_keys();

}  // namespace grainfield::coupling
