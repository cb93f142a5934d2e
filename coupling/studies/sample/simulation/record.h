// What is kept of a sample at a state of its path.
#pragma once
#include <cstdint>

#include "coupling/studies/sample/simulation/path.h"
#include "dem/engine/engine.h"

namespace grainfield::dem {

/// "state_000", ...
std::string state_name(std::size_t number);

/// The snapshot with its attributes (sample.h). `strain`: imposed, against the first state.
Snapshot sample_record(const Engine& engine, const SamplePlan& plan, std::size_t number,
                       double strain, std::uint64_t seed);

}  // namespace grainfield::dem
