#include "coupling/elastic_constants/samples.h"

#include <fmt/format.h>

#include <stdexcept>

#include "coupling/unknown_name.h"

namespace grainfield::coupling {

std::vector<Samples> gather(const Increments& increments, const Locality& where) {
  check_increments(increments, where);
  std::vector<Samples> all(increments.stress.size());
  for (std::size_t r = 0; r < all.size(); ++r)
    for (Eigen::Index p = 0; p < increments.points.rows(); ++p) {
      const Eigen::Vector3d stress = increments.stress[r].row(p).transpose(),
                            strain = increments.strain[r].row(p).transpose();
      if (where.weights[p] == 0 || !stress.allFinite() || !strain.allFinite()) continue;
      all[r].list.push_back(
          {increments.points.row(p).transpose() - where.centre, where.weights[p], stress, strain});
      all[r].point.push_back(p);
    }
  return all;
}

std::vector<Sample> mean_samples(const std::vector<Samples>& all, const std::vector<int>& chosen,
                                 Eigen::Index points) {
  std::vector<Sample> sums(static_cast<std::size_t>(points)), means;
  std::vector<int> count(static_cast<std::size_t>(points), 0);
  for (const int r : chosen) {
    const Samples& samples = all[static_cast<std::size_t>(r)];
    for (std::size_t k = 0; k < samples.list.size(); ++k) {
      const auto p = static_cast<std::size_t>(samples.point[k]);
      const Sample& sample = samples.list[k];
      sums[p].offset = sample.offset;
      sums[p].weight = sample.weight;
      sums[p].stress += sample.stress;
      sums[p].strain += sample.strain;
      ++count[p];
    }
  }
  for (std::size_t p = 0; p < sums.size(); ++p) {
    if (count[p] == 0) continue;
    sums[p].stress /= count[p];
    sums[p].strain /= count[p];
    means.push_back(sums[p]);
  }
  return means;
}

void check_options(const ElasticOptions& options) {
  if (options.samples != "pooled" && options.samples != "mean")
    throw std::invalid_argument(
        unknown_name("samples of the elastic fit", options.samples, {"pooled", "mean"}));
  if (options.degree != 0 && options.degree != 1)
    throw std::invalid_argument(
        fmt::format("degree of the elastic fit is {}; it must be 0 or 1", options.degree));
}

}  // namespace grainfield::coupling
