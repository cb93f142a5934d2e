// Finite-element models of linear elasticity (deal.II): what the rest of the project sees of them.
#pragma once
#include "continuum/model.h"

namespace grainfield::continuum {

/// Who solves: every rank of MPI_COMM_WORLD together, or each rank its own copy.
enum class Ranks { all, own };

/// Chooses for the models made from now on; the default is Ranks::all. With Ranks::all every rank
/// must call stress() with the same points, and every rank gets the complete result. With
/// Ranks::own a rank may call alone, and the result has the same bits for any number of ranks. MPI
/// is started by the first evaluation, unless the program has started it.
void solve_on(Ranks ranks);

/// A layer on a rigid base under a point load, plane strain or 3D.
ModelInfo fe_elastic_layer_info();
/// A layer with two elastic axes on a rigid base under a line load, constants or a map of them.
ModelInfo fe_orthotropic_layer_info();
/// A half plane or half space under a load on a small patch.
ModelInfo fe_elastic_half_space_info();
/// Both in space with a vertical axis of symmetry.
ModelInfo fe_transverse_layer_info();
ModelInfo fe_transverse_half_space_info();

/// The elastic core of Cantelaube's heap as a boundary value problem.
ModelInfo fe_cantelaube_core_info();

/// A heap of Mohr-Coulomb material under its own weight, plane strain (fe/wedge.h).
ModelInfo fe_mohr_coulomb_wedge_info();
/// The same as a body of revolution.
ModelInfo fe_cone_info();

}  // namespace grainfield::continuum
