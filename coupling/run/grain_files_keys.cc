// The key of finished grains: [grains].
#include "coupling/case/declare.h"
#include "coupling/run/finished_runs.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(GrainFiles, MEMBER)

namespace grainfield::coupling {

void declare_grain_files_keys(SectionKeys s) {
  s.word(
      "files", IN(files), {},
      "finished piles, one a realization, in this order: snapshots.h5 of earlier runs of study "
      "pile or pile-fields, or of cone; only the changes of gravity that they do not hold are "
      "computed. [material], and of cones cone.source, shape and floor, must be that of the "
      "piles; [shape], [source] and [floor] are not used. []: the piles are poured. Of study "
      "sample with sample.filling = dropped: first states (state_000) of earlier runs between "
      "walls, which take the place of dropping; another material may load them, of the same "
      "density. Of study point-load in the plane: layers of the same load.force, gravity, density "
      "and friction; of study boussinesq-limit: under any load; the keys packing.* are not used");
  s.or_none();
}

}  // namespace grainfield::coupling

#undef IN
