#include "coupling/studies/sample/rve_page.h"

#include <fmt/format.h>

#include <cmath>

#include "coupling/statistics/spread.h"
#include "coupling/store/vtu.h"

namespace grainfield::coupling {
namespace {

constexpr int kHullSize = 620, kHullHeight = 560;  // pixels

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

double error_bar_of(const RveTable& table, std::size_t r, std::size_t state,
                    double (*of)(const RveValue&)) {
  double sum = 0;
  for (const RveStates& states : table.values[r]) {
    const RveMean zz = mean_over(states[state], of);
    sum += std::fabs(zz.error_bar / zz.mean);
  }
  return sum / static_cast<double>(table.values[r].size());
}

Frame bar_frame(const RveTable& table, const std::string& title, double (*of)(const RveValue&)) {
  Frame out{title, {}};
  for (std::size_t r = 0; r < table.radii.size(); ++r) {
    Series series;
    series.label = fmt::format("radius {:g}", table.radii[r]);
    series.x = vector_of(table.strain);
    series.y.resize(series.x.size());
    for (std::size_t s = 0; s < table.strain.size(); ++s) {
      series.y[static_cast<Eigen::Index>(s)] = error_bar_of(table, r, s, of);
    }
    out.series.push_back(std::move(series));
  }
  return out;
}

// Mean over realizations of a strain, and of its error bar.
Series strain_series(const RveTable& table, std::size_t r, const std::string& label,
                     double (*of)(const RveValue&)) {
  Series out;
  out.label = label;
  const std::size_t states = table.strain.size(), n = table.values[r].size();
  out.x = vector_of(table.strain);
  out.y = out.error = Eigen::VectorXd::Zero(out.x.size());
  for (std::size_t s = 0; s < states; ++s) {
    for (const RveStates& one : table.values[r]) {
      const RveMean mean = mean_over(one[s], of);
      out.y[static_cast<Eigen::Index>(s)] += mean.mean / static_cast<double>(n);
      out.error[static_cast<Eigen::Index>(s)] += mean.error_bar / static_cast<double>(n);
    }
  }
  out.banded = true;
  return out;
}

// Mean over realizations of trace/3, and its standard error.
Series volume_series(const RveTable& table, std::size_t r) {
  Series out =
      strain_series(table, r, "trace/3", [](const RveValue& v) { return v.hull.trace() / 3; });
  for (std::size_t s = 0; s < table.strain.size(); ++s) {
    std::vector<double> of;
    for (const RveStates& one : table.values[r]) {
      of.push_back(mean_over(one[s], [](const RveValue& v) { return v.hull.trace() / 3; }).mean);
    }
    out.error[static_cast<Eigen::Index>(s)] = spread_of(of).standard_error;
  }
  return out;
}

Picture hull_picture(const RveSurface& surface) {
  std::string polygons, centres;
  const auto line = [](const Eigen::RowVector3d& at) {
    return fmt::format("{:.6g} {:.6g} {:.6g}\n", at[0], at[1], at[2]);
  };
  for (const auto& t : surface.hull) {
    for (const int corner : t) polygons += line(surface.points.row(corner));
    polygons += line(surface.points.row(t[0])) + "\n\n";
  }
  for (const auto& at : surface.points.rowwise()) centres += line(at);
  Picture picture;
  picture.title = "An RVE with its convex hull";
  picture.width = kHullSize;
  picture.height = kHullHeight;
  picture.bitmap = true;
  picture.program =
      "$hull << EOD\n" + polygons + "EOD\n$centres << EOD\n" + centres +
      "EOD\nset view 65, 35, 1.75\nset view equal xyz\nset xyplane relative 0\n"
      "set lmargin 0\nset rmargin 0\nset tmargin 0\nset bmargin 0\n"
      "unset border\nunset tics\nunset key\n"
      "set style fill transparent solid 0.35\nset pm3d depthorder\n"
      "splot $hull with polygons fc rgb '#9ecae1', $hull with lines lw 1.2 lc rgb '#0072b2', "
      "$centres with points pt 7 ps 1.1 lc rgb '#d55e00'\n";
  picture.caption = fmt::format(
      "Centres of the {} grains of the first RVE of the largest radius, in the first state, and "
      "the "
      "{} triangles of their convex hull.",
      surface.points.rows(), surface.hull.size());
  return picture;
}

}  // namespace

std::vector<Section> rve_sections(const RveTable& table, const std::string& deformation) {
  std::vector<Section> out;
  if (table.radii.empty()) return out;
  const Frame over_hull = bar_frame(table, "stress over the hull: error bar over mean",
                                    [](const RveValue& v) { return v.boundary(2, 2); });
  const Frame over_sphere = bar_frame(table, "stress over the sphere: error bar over mean",
                                      [](const RveValue& v) { return v.grains(2, 2); });
  Picture errors = curves("Scatter between RVEs", "imposed strain", "", {over_hull, over_sphere});
  errors.caption =
      "Of the axial stress: s/√N over the RVEs of a sample, mean over samples (Wellmann fig. 8). "
      "Over "
      "the hull: from the forces on the boundary; over the sphere: from all contacts of its "
      "grains.";
  out.emplace_back(std::move(errors));
  const std::size_t largest = table.radii.size() - 1;
  using V = const RveValue&;
  Frame normal{"normal strains",
               {strain_series(table, largest, "xx", [](V v) { return v.hull(0, 0); }),
                strain_series(table, largest, "yy", [](V v) { return v.hull(1, 1); }),
                strain_series(table, largest, "zz", [](V v) { return v.hull(2, 2); })},
               true};
  Frame shear{
      "shear strains",
      {strain_series(table, largest, "xz", [](V v) { return 0.5 * (v.hull(0, 2) + v.hull(2, 0)); }),
       strain_series(table, largest, "xy", [](V v) { return 0.5 * (v.hull(0, 1) + v.hull(1, 0)); }),
       strain_series(table, largest, "yz",
                     [](V v) { return 0.5 * (v.hull(1, 2) + v.hull(2, 1)); })},
      true};
  std::vector<Frame> frames{normal, shear};
  if (deformation == "simple_shear") {
    frames.push_back({"volumetric strain over three", {volume_series(table, largest)}, true});
  }
  Picture strains = curves("Strain of the RVEs", "imposed strain", "", frames);
  strains.caption = fmt::format(
      "Of the hulls of the RVEs of radius {:g}, mean over {} samples. Bands: error bars over the "
      "RVEs "
      "of one sample (Wellmann 31){}.",
      table.radii[largest], table.gradients.size(),
      deformation == "simple_shear" ? "; of the volumetric strain the standard error over samples"
                                    : "");
  out.emplace_back(std::move(strains));
  if (!table.surface.hull.empty()) out.emplace_back(hull_picture(table.surface));
  return out;
}

std::string rve_vtu(const RveTable& table) {
  const RveSurface& s = table.surface;
  if (s.hull.empty()) return "";
  return surface_vtu(s.points, s.hull,
                     {{"displacement_x", s.displacements.col(0)},
                      {"displacement_y", s.displacements.col(1)},
                      {"displacement_z", s.displacements.col(2)}});
}

}  // namespace grainfield::coupling
