// Piles of grains, poured or found in files: what the studies of piles begin with.
#pragma once
#include <cstdint>
#include <memory>

#include "coupling/case/study.h"
#include "coupling/studies/pile/simulation.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"

namespace grainfield::coupling {

/// The pile of that number: poured as `setup` says, or, where the case names grains.files, the one
/// found there ("pile") under the changes of `setup`. Throws as finished_run and dem's runs of
/// piles.
std::unique_ptr<dem::Run> make_pile(const Case& value, const dem::PileSetup& setup,
                                    std::int64_t number, int threads);

/// What that takes (Study::foresee). Throws as make_pile.
dem::Outlook foresee_pile(const Case& value, const dem::PileSetup& setup, std::int64_t draws);

/// What studies of piles have in common: sections, setups, the time of the pouring.
void describe_piles(Study& study);

}  // namespace grainfield::coupling
