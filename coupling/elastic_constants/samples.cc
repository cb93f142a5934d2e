#include "coupling/elastic_constants/samples.h"

namespace grainfield::coupling {

std::vector<Samples> gather(const Increments& increments, const Locality& where) {
  check_increments(increments, where);
  std::vector<Samples> all(increments.stress.size());
  for (std::size_t r = 0; r < all.size(); ++r)
    for (Eigen::Index p = 0; p < increments.points.rows(); ++p) {
      const Eigen::Vector3d stress = increments.stress[r].row(p).transpose(),
                            strain = increments.strain[r].row(p).transpose();
      if (where.weights[p] == 0 || !stress.allFinite() || !strain.allFinite()) continue;
      all[r].push_back({where.weights[p], stress, strain});
    }
  return all;
}

}  // namespace grainfield::coupling
