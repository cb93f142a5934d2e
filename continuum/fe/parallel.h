// Which MPI ranks solve a finite-element problem together, and MPI's start on first use.
#pragma once
#include <mpi.h>

#include "continuum/fe_models.h"

namespace grainfield::continuum::fe {

/// What choose_ranks() (plugin.h) last chose.
Ranks chosen_ranks();

/// The communicator of these ranks, with MPI and p4est ready. Starts MPI when the program has not,
/// and then also ends it at exit.
MPI_Comm communicator(Ranks ranks);

}  // namespace grainfield::continuum::fe
