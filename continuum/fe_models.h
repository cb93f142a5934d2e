// The finite-element models as the rest of the project sees them. Their solvers are in a library of
// their own (continuum/fe), which is loaded when the first of them is made: with it come deal.II's
// two hundred libraries, and a program that only checks a case must not wait for those.
#pragma once
#include <string>
#include <vector>

#include "continuum/model.h"

namespace grainfield::continuum {

/// Who solves: every rank of MPI_COMM_WORLD together, or each rank its own copy.
enum class Ranks { all, own };

/// Chooses for the models made from now on; the default is Ranks::all. With Ranks::all every rank
/// must call stress() with the same points, and every rank gets the complete result. With
/// Ranks::own a rank may call alone, and the result has the same bits for any number of ranks. MPI
/// is started by the first evaluation, unless the program has started it.
void solve_on(Ranks ranks);

/// Makes the model that has this name among the library's rows (continuum/fe/plugin.h), which is
/// loaded on first use; throws besides ComputationFailed when the library is missing.
MakeModel in_fe_library(const std::string& name);

/// Models of linear elasticity (fe/elastic_info.cc): layers, half spaces, Cantelaube's core.
std::vector<ModelInfo> elastic_models();
/// Heaps of Mohr-Coulomb material under their weight (fe/heap_info.cc).
std::vector<ModelInfo> heap_models();

}  // namespace grainfield::continuum
