// The solver of continuum/block.h, and the second door of the finite-element library. Without
// deal.II.
#pragma once
#include "continuum/block.h"

namespace grainfield::continuum::fe {

std::vector<BlockState> solve_block(const BlockMaterial& material,
                                    const Eigen::Matrix3d& initial_stress,
                                    const std::vector<BlockLoad>& path, int cells);

inline constexpr char kBlockSymbol[] = "grainfield_fe_block";
using BlockFunction = void (*)(const BlockMaterial& material, const Eigen::Matrix3d& initial_stress,
                               const std::vector<BlockLoad>& path, int cells,
                               std::vector<BlockState>& states);

}  // namespace grainfield::continuum::fe
