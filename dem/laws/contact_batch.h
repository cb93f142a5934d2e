// Contacts side by side: what a law's kernel reads beside the overlaps (overlap_batch.h), and where
// it writes. Bodies, memories and forces are read and written where the engine has them.
#pragma once
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// By slot.
struct alignas(64) ContactBatch {
  const double *body_i[kBatch], *body_j[kBatch];  ///< numbers of a Body<3>
  /// Not 0: the second body is an image, faster by this drift, m/s.
  double across[kBatch], drift[3][kBatch];
  /// Four numbers, in and out: a SpringMemory<3> with what comes behind it, or a HertzMemory<3>.
  double* memory[kBatch];
  double* force[kBatch];  ///< out: numbers of a ContactForce<3>
  /// Out, not 0: the memory is as it was, because the contact turns by more in a step than the
  /// kernel's series allow.
  double left[kBatch];
  double idle[12];  ///< for memories and forces that nobody asks for
};

}  // namespace grainfield::dem
