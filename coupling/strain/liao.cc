// Liao, Chang, Young, Chang 1997 (Roul 2.67-2.73): as Cambou, but of the bodies' points at the
// contact, du + dw x r on both sides:
//   sum over contacts |(du_q + dw_q x r_qc) - (du_p + dw_p x r_pc) - G l|^2.
// It sees the deformation of the contacts only: a rigid rotation in which the grains turn along
// gives zero, so its antisymmetric part is the rotation of the centres less the spin of the grains.
#include <stdexcept>

#include "coupling/strain/branch_fit.h"

namespace grainfield::coupling {

std::unique_ptr<StrainMeasure> make_liao(const GrainMotion& motion, const StrainOptions& options) {
  if (!motion.turns)
    throw std::invalid_argument(
        "strain measure liao needs the grains' rotations, and neither snapshot tells an "
        "orientation; use cambou");
  return std::make_unique<BranchFit>(motion, motion.slip, options);
}

}  // namespace grainfield::coupling
