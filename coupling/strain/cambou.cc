// Cambou, Chaze, Dedecker 2000 (Roul 2.52-2.57): the gradient G that minimises
//   sum over contacts |du_q - du_p - G l|^2,   l = r_pc - r_qc = x_q - x_p.
// Spins do not enter. A rigid rotation comes back as a rotation.
#include "coupling/strain/branch_fit.h"

namespace grainfield::coupling {

std::unique_ptr<StrainMeasure> make_cambou(const GrainMotion& motion,
                                           const StrainOptions& options) {
  return std::make_unique<BranchFit>(motion, motion.relative, options);
}

}  // namespace grainfield::coupling
