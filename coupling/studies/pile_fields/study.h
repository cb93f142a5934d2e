// Study pile-fields: what a pile is as a continuum, topic by topic.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

/// Pours piles as study pile does, or takes finished ones from grains.files, changes their gravity
/// and looks at the topics of fields.topics (topic.h).
Study pile_fields_study();

}  // namespace grainfield::coupling
