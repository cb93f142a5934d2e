// Grains beside models in reports: pictures and tables of a comparison's profiles.
#pragma once
#include <Eigen/Core>
#include <string>

#include "coupling/compare/compare.h"
#include "coupling/report/report.h"

namespace grainfield::coupling {

/// "rough" of a model "rough=layer (base=rough)"; of others the label.
std::string legend_of(const ModelProfiles& model);

/// Grains, with the band of their error, and models: lengths in h, stresses in
/// comparison.scale.unit.
/// The legend has a model's own label without its settings, which distances_table tells.
Frame profile_frame(const Comparison& comparison, std::size_t profile);
std::vector<Frame> profile_frames(const Comparison& comparison);

/// How far each model is from the grains, nearest first, and the shapes of the profiles.
/// `unit`: the name of comparison.scale.unit, for people: "F/h²". `at`: what places are called:
/// "x/h", or "r/h" of profiles by radius.
Table distances_table(const Comparison& comparison, const std::string& unit,
                      const std::string& at = "x/h");
Table shapes_table(const Comparison& comparison, const std::string& unit,
                   const std::string& at = "x/h");
/// Writes folder/tables.html, the comparison place by place (profile_tables of output/tables.h),
/// and adds to the report where it is; nothing without models. A picture then comes first.
void write_profile_tables(const std::string& folder, Report& report, const Comparison& comparison);

/// Values by radius from 0, drawn to both sides of the axis: 2 n - 1, of a matrix its rows.
Eigen::VectorXd both_sides(const Eigen::VectorXd& by_radius);
Eigen::MatrixXd both_sides(const Eigen::MatrixXd& by_radius);

}  // namespace grainfield::coupling
