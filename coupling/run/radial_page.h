// Profiles by the radius about a vertical axis: their pictures and tables in reports.
#pragma once
#include <Eigen/Core>
#include <string>

#include "coupling/compare/compare.h"
#include "coupling/report/report.h"

namespace grainfield::coupling {

/// Values by radius from 0, drawn to both sides of the axis: 2 n - 1, of a matrix its rows.
Eigen::VectorXd both_sides(const Eigen::VectorXd& by_radius);
Eigen::MatrixXd both_sides(const Eigen::MatrixXd& by_radius);

/// Grains and models, a frame for each profile: lengths in h, stresses in comparison.unit().
Picture radial_profiles(const std::string& title, const std::string& x_label,
                        const std::string& y_label, const Comparison& comparison);

/// How far each model is from the grains, and the shapes of the profiles. `unit`: the name of
/// comparison.unit(), for people: "F/h²".
void add_radial_tables(Report& report, const Comparison& comparison, const std::string& unit);

}  // namespace grainfield::coupling
