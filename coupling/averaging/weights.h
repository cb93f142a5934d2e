// The ways of averaging, and what they share. Used by average.cc only.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/averaging/grain_facts.h"
#include "coupling/averaging/options.h"
#include "coupling/averaging/point_cells.h"
#include "coupling/averaging/quantities.h"
#include "coupling/averaging/region.h"

namespace grainfield::coupling {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What is averaged. `facts`: one per grain.
struct Job {
  const dem::Snapshot& snapshot;
  const Region& region;
  const Eigen::MatrixXd& points;
  const AverageOptions& options;
  const Layout& layout;
  const std::vector<GrainFacts>& facts;
};

/// What one grain carries, made when a point first asks for it.
class GrainLoad {
 public:
  explicit GrainLoad(const Job& job) : job_(job), row_(job.layout.load_size()) {}
  void take(std::size_t grain) {
    grain_ = grain;
    fresh_ = false;
  }
  const Eigen::RowVectorXd& row() {
    if (!fresh_) job_.layout.load(job_.facts[grain_], row_.data());
    fresh_ = true;
    return row_;
  }

 private:
  const Job& job_;
  Eigen::RowVectorXd row_;
  std::size_t grain_ = 0;
  bool fresh_ = false;
};

/// One row per point, as Layout says. `outside`: where the weight has no meaning.
struct Sums {
  RowMatrix rows;
  std::vector<char> outside;
};

/// A support cut by the packing's edges to less than this share is not averaged over: its few
/// grains stand for an area that their own size exceeds.
constexpr double least_share = 0.1;

/// Adds what the snapshot gives to the points [first, last). Every point sums in the order of
/// grains and contacts.
using AddBand = void (*)(const Job&, Eigen::Index first, Eigen::Index last, Sums&);

void add_coarse_graining(const Job&, Eigen::Index first, Eigen::Index last, Sums&);
void add_particle_centre(const Job&, Eigen::Index first, Eigen::Index last, Sums&);
void add_area_exact(const Job&, Eigen::Index first, Eigen::Index last, Sums&);

struct Method {
  std::string name;
  AddBand add;
  const std::vector<std::string>& (*kernels)();
};
/// Every method, in the order of the documentation.
const std::vector<Method>& methods();
/// Throws std::invalid_argument for an unknown method or a kernel that it does not have.
const Method& find_method(const AverageOptions& options);

/// Names of the supports: "circle", "square".
const std::vector<std::string>& support_names();

}  // namespace grainfield::coupling
