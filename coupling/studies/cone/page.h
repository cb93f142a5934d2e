// The report of cones.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/report/report.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// What it draws besides the comparison: ensemble means, lengths in h, stresses in rho g h.
struct ConePage {
  Field base;    ///< on a square grid of the base
  Field rings;   ///< of the base by radius: pressure and radial shear
  Field inside;  ///< by radius and height, columns of points 0 and 2
  struct Model {
    std::string key, label;
    Eigen::VectorXd inside;  ///< sigma_zz on its points, rho g h
  };
  std::vector<Model> models;
  std::string averaged;  ///< how, for captions
};

Report cone_page(const StudyResult& result, const Realization* first, const ConePage& page);

}  // namespace grainfield::coupling
