// Maps and curves of piles on their grid, in units of h.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/report/picture.h"
#include "coupling/studies/pile_fields/pile_set.h"

namespace grainfield::coupling {

/// One map of a value per grid point, drawn where PileSet::shown.
Map map_of(const PileSet& piles, const std::string& title, const Eigen::VectorXd& value);

/// The values along a row of the grid, over x/h, where shown; `error` may be empty.
Series row_of(const PileSet& piles, const std::string& label, int row, const Eigen::VectorXd& value,
              const Eigen::VectorXd& error, bool simulation);

/// One series per height of fields.heights, each at the nearest row of the grid.
Frame rows_of(const PileSet& piles, const std::string& title, const Eigen::VectorXd& value);

/// y over x in `bins` of equally many pairs: means and their standard errors. Pairs with a nan are
/// left out.
Series binned(const std::string& label, const std::vector<double>& x, const std::vector<double>& y,
              int bins);

/// "RVE of radius 0.017 m (6 mean diameters), particle-centre averaging; mean of 8 piles":
/// captions.
std::string how_averaged(const PileSet& piles);

}  // namespace grainfield::coupling
