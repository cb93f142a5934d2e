// A block of material in space on a path of strains and held stresses, solved by finite elements
// (continuum/fe/block.cc): what a sample of grains in a box is as a continuum.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "continuum/plasticity/mohr_coulomb.h"

namespace grainfield::continuum {

struct BlockMaterial {
  plasticity::MohrCoulomb constants;  ///< E in Pa; without `plastic` E and nu alone
  bool plastic = true;                ///< false: linear elastic
};

/// Where the block's boundary is to be at the end of a part of its path. Its nodes move with the
/// strain of the edges; where a stress is held, that edge's strain is what the block answers.
struct BlockLoad {
  Eigen::Vector3d strain{0, 0, 0};  ///< of the edges since the beginning, extension positive
  double shear = 0;                 ///< since the beginning, of z planes along x, engineering
  std::array<bool, 3> held{};       ///< along these axes the mean normal stress is held at
  Eigen::Vector3d stress{0, 0, 0};  ///< this, tension positive, Pa
};

/// Mean over the block at the end of a part.
struct BlockState {
  Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();  ///< since the beginning
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();  ///< tension positive, Pa
  double plastic_strain = 0;                         ///< norm of its plastic part
};

/// The states at the beginning (its stress returned to what the material bears) and after each part
/// of the path, which is gone along straight lines in as many steps as Newton's method needs.
/// `cells`: of the mesh along each edge. Strains are small ones: over a long path give logarithms.
/// Loads the finite-element library. Throws BadParameter for constants out of range,
/// ComputationFailed naming the part where no equilibrium was found.
std::vector<BlockState> load_block(const BlockMaterial& material,
                                   const Eigen::Matrix3d& initial_stress,
                                   const std::vector<BlockLoad>& path, int cells = 2);

}  // namespace grainfield::continuum
