// How much memory a process may take here.
#pragma once

namespace grainfield::coupling {

/// Bytes: the least of the machine's memory, what its control group allows (a container, a batch
/// job), and the limit on the process's address space (ulimit -v); infinity where none is known.
double memory_limit();

}  // namespace grainfield::coupling
