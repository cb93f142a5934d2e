// Contacts side by side: what a law's kernel reads beside the overlaps (overlap_batch.h), and what
// it gives. Plain numbers.
#pragma once
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// By slot.
struct alignas(64) ContactBatch {
  double velocity[3][kBatch];                   ///< of the centre of i relative to that of j, m/s
  double spin_i[3][kBatch], spin_j[3][kBatch];  ///< rad/s
  double inverse_mass[kBatch];                  ///< sum of both, 1/kg
  double spring[3][kBatch];                     ///< memory, in and out: its force on i, N
  double contact_radius[kBatch];                ///< memory, in and out, m
  double force[3][kBatch];                      ///< out: on i, N
  double torque_i[3][kBatch], torque_j[3][kBatch];  ///< out: about the centres, N m
  /// Out, not 0: nothing has been done, because the contact turns by more in a step than the
  /// kernel's series allow.
  double left[kBatch];
};

}  // namespace grainfield::dem
