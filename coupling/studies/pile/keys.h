// Sections that the studies of piles share, and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_shape_keys(SectionKeys s);
void declare_source_keys(SectionKeys s);
void declare_floor_keys(SectionKeys s);
void declare_sleep_keys(SectionKeys s);
void declare_change_keys(SectionKeys s);
void declare_heap_keys(SectionKeys s);

inline constexpr KeySection kShapeKeys{"shape", KeyRole::grains, declare_shape_keys};
inline constexpr KeySection kSourceKeys{"source", KeyRole::grains, declare_source_keys};
inline constexpr KeySection kFloorKeys{"floor", KeyRole::grains, declare_floor_keys};
inline constexpr KeySection kSleepKeys{"sleep", KeyRole::grains, declare_sleep_keys};
inline constexpr KeySection kChangeKeys{"change", KeyRole::grains, declare_change_keys};
inline constexpr KeySection kHeapKeys{"heap", KeyRole::analysis, declare_heap_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> pile_figures();

}  // namespace grainfield::coupling
