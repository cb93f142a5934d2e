// The studies that ship, a line each in the order of the documentation: NAME stands for the
// function `Study NAME_study()` of a folder beside this file.
#include "coupling/case/study.h"

// clang-format off
#define GRAINFIELD_STUDIES(STUDY) \
  STUDY(point_load) \
  STUDY(boussinesq_limit) \
  STUDY(pile) \
  STUDY(pile_fields) \
  STUDY(cone) \
  STUDY(lattice_pile) \
  STUDY(sample) \
  STUDY(pair) \
  STUDY(hard_disks) \
  STUDY(implicit_settling) \
  STUDY(hard_to_soft) \
  STUDY(elastic_layer) \
  STUDY(elastic_half_space) \
  STUDY(osl_wedge) \
  STUDY(osl_layer) \
  STUDY(orthotropic_layer) \
  STUDY(wedge_core) \
  STUDY(wedge)
// clang-format on

namespace grainfield::coupling {

#define DECLARED(NAME) Study NAME##_study();
GRAINFIELD_STUDIES(DECLARED)
#undef DECLARED

std::vector<Study> shipped_studies() {
#define MADE(NAME) NAME##_study(),
  return {GRAINFIELD_STUDIES(MADE)};
#undef MADE
}

}  // namespace grainfield::coupling
