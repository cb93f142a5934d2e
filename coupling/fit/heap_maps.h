// Where models of a heap fail, and how near it is to the limit of friction: maps for the page.
#pragma once
#include <string>
#include <vector>

#include "coupling/fit/heap_fits.h"
#include "coupling/fit/heap_rows.h"

namespace grainfield::coupling {

/// Empty maps on a grid over a heap with these slopes, from foot to foot.
StressMaps heap_map_grid(const HeapSlopes& slopes);

/// Mean and standard error of sigma_xx, _yy, _xy on maps.points; `samples`: 3n x heaps, the
/// components one after the other. nan above the mean flanks, and nearer to the floor than `margin`
/// over h (the averaging width: there the average mixes in what lies below the floor).
void fill_heap_maps(const Eigen::MatrixXd& samples, const HeapFacts& facts, double margin,
                    StressMaps& maps);

/// A fitted model on the maps' points seen through the averaging's kernel; n x 3, nan outside.
Eigen::MatrixXd model_on_maps(const HeapFits& fits, const std::string& name);

/// Pictures: grains, model and residual side by side; residuals in standard errors; the
/// Mohr-Coulomb expression (structure/yield.h) of grains and model over (sigma_xx + sigma_yy)^2, at
/// the friction angle of the models. None without maps.
std::vector<Section> heap_map_sections(const HeapFits& fits, const std::string& name);

}  // namespace grainfield::coupling
