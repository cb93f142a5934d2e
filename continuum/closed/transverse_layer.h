// Elastic layer of depth h on a rigid base under a point load, the same in every horizontal
// direction: the material of transverse.h, the plane waves of orthotropic_layer.h from all
// directions of the plane.
//
// A wave along x, g cos(k x), is one of plane strain: its crests carry
//   sigma_yy = nu_h sigma_xx + nu_v (E_h/E_v) sigma_zz ~ c = nu_h g'' - nu_v (E_h/E_v) g.
// The mean over the directions in the plane, with J0 and J1 at k r:
//   sigma_zz = -(F/2 pi) Int k g J0 dk,   sigma_rd = (F/2 pi) Int k g' J1 dk,
//   sigma_rr = (F/2 pi) Int k [g'' (J0 - J1/kr) + c J1/kr] dk,
//   sigma_tt = (F/2 pi) Int k [g'' J1/kr + c (J0 - J1/kr)] dk.
// The half space's part of g is known in closed form.
#pragma once
#include <array>
#include <functional>
#include <memory>

#include "continuum/closed/orthotropic_layer.h"

namespace grainfield::continuum {

/// Stress xx, yy, zz, yz, xz, xy of the half space under the load at x, y, z < 0.
using HalfSpaceStress = std::function<std::array<double, 6>(double x, double y, double z)>;

/// Stress along the crests of a wave: nu_h g'' - across g.
struct Crests {
  double nu_h = 0, across = 0;
};

/// The layer as a model, nan outside. `waves`: of the material's vertical planes.
std::unique_ptr<Model> layer_in_space(double F, double h, const OrthotropicWaves& waves,
                                      const Crests& crests, HalfSpaceStress half_space);

}  // namespace grainfield::continuum
