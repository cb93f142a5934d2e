// The report of a point load on a layer of spheres.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/report/report.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// What it draws besides the comparison: mean responses in the models' frame.
struct SpaceLoadPage {
  Field base;           ///< on a square grid of the base
  Field base_unloaded;  ///< by radius, before loading
  Field cut;            ///< on a grid of the plane y = 0
  struct Model {
    std::string key, label;
    Eigen::VectorXd base, cut;  ///< sigma_zz on their points, Pa
  };
  std::vector<Model> models;
};

Report space_load_page(const StudyResult& result, const Realization* first,
                       const SpaceLoadPage& page);

}  // namespace grainfield::coupling
