// Numbers of a material that follow from others, where nobody gave them.
//
//   k_t        2/7 k_n: both springs of two spheres then swing in step
//   linear     gamma_n from the restitution e of two grains of the nominal size:
//              gamma_n = 2 b sqrt(k_n/m_eff), b the share of the critical dashpot that leaves e;
//              gamma_t = gamma_n/2
//   hertz, viscoelastic   the same at an overlap of 2 % of the radius, where k_n = 2 E* a
//   penalty, hertz, hertz_elliptic   the share of the critical dashpot, if e was given
#pragma once
#include <functional>
#include <string_view>

#include "dem/laws/material_setup.h"
#include "dem/laws/restitution.h"

namespace grainfield::dem {

/// Whether somebody gave a member of MaterialSetup a number, by its name.
using IsGiven = std::function<bool(std::string_view)>;

/// Fills in what follows; the others of these members become those of `usual`. A restitution that
/// nobody gave follows from the dashpot that somebody gave, where the law has one restitution for
/// all speeds. `grain`: of the nominal size; without a radius the dashpots stay as they are. Throws
/// std::invalid_argument naming material.restitution where that and the dashpot are both given and
/// contradict each other.
void follow_defaults(MaterialSetup& material, const MaterialSetup& usual, const IsGiven& given,
                     const RoundGrain& grain);

/// What a member follows, for the documentation: "2/7 of normal_stiffness"; "": nothing.
const char* followed_by(std::string_view member);

}  // namespace grainfield::dem
