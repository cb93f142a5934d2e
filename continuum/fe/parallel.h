// Which MPI ranks solve a finite-element problem together, and MPI's start on first use.
#pragma once
#include <mpi.h>

namespace grainfield::continuum::fe {

/// The communicator of solve_on() in elastic.h, with MPI and p4est ready. Starts MPI when the
/// program has not, and then also ends it at exit.
MPI_Comm communicator();

}  // namespace grainfield::continuum::fe
