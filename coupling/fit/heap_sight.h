// Models of heaps as the averaging shows grains.
#pragma once
#include "coupling/fit/model.h"

namespace grainfield::coupling {

/// The model smoothed over a kernel of the standard deviation `smoothing` along a line: the mean of
/// its point (half of the weight) and six around it at twice that distance, which have the kernel's
/// second moments. Outside the heap there is nothing, 0; where the point itself is outside: nan.
/// Kinks are judged as the grains show them, and the misfit is smooth where one crosses a point.
/// `at_point` of the result is the model as it was. `cantelaube` passes from core to flank over the
/// same width by itself and stays as it is.
FitModel seen_through_kernel(FitModel model, double smoothing);

}  // namespace grainfield::coupling
