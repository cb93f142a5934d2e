// What a strain measure is. A new measure is one file that implements StrainMeasure and one line in
// registry.cc.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "coupling/strain/motion.h"
#include "coupling/strain/strain.h"

namespace grainfield::coupling {

/// The displacement gradient at one point and how good its ground is.
struct GradientFit {
  enum class Verdict { good, too_few, degenerate };
  Verdict verdict = Verdict::too_few;
  Eigen::MatrixXd gradient;      ///< du_i/dx_j, row i, column j; only when good
  Eigen::VectorXd displacement;  ///< mean over the grains, m; only when good
  int grains = 0, contacts = 0;  ///< used
  double condition = std::numeric_limits<double>::quiet_NaN();
  double misfit = std::numeric_limits<double>::quiet_NaN();
};

class StrainMeasure {
 public:
  virtual ~StrainMeasure() = default;
  /// Called from several threads at once.
  virtual GradientFit at(const Eigen::VectorXd& point) const = 0;
};

/// The motion must outlive the measure.
using MakeMeasure = std::unique_ptr<StrainMeasure> (*)(const GrainMotion&, const StrainOptions&);

std::unique_ptr<StrainMeasure> make_cambou(const GrainMotion&, const StrainOptions&);
std::unique_ptr<StrainMeasure> make_cundall(const GrainMotion&, const StrainOptions&);
std::unique_ptr<StrainMeasure> make_liao(const GrainMotion&, const StrainOptions&);
std::unique_ptr<StrainMeasure> make_derivative(const GrainMotion&, const StrainOptions&);
std::unique_ptr<StrainMeasure> make_kernel_gradient(const GrainMotion&, const StrainOptions&);

struct MeasureEntry {
  std::string name;
  std::string summary;                ///< one line: what is fitted to what
  std::vector<std::string> supports;  ///< allowed values of StrainOptions::support
  MakeMeasure make;
};

const std::vector<MeasureEntry>& strain_registry();
/// Throws std::invalid_argument with the nearest name.
const MeasureEntry& find_measure(const std::string& name);

}  // namespace grainfield::coupling
