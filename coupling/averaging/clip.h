// Areas of shapes cut by circles and by boxes, in closed form.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace grainfield::coupling {

/// Corners of a simple polygon, counter-clockwise (clockwise ones give negative areas), m.
using Corners = std::vector<Eigen::Vector2d>;

/// Signed area, m2.
double area_of(const Corners& corners);
/// Area of the polygon inside the circle about the origin, m2: over the edges, the triangle
/// with the origin cut by the circle (pieces of triangle inside, of sector outside).
double area_in_circle(const Corners& corners, double radius);
/// Area of the polygon inside the box, m2: clipped at its four sides one after the other
/// (Sutherland and Hodgman 1974).
double area_in_box(const Corners& corners, const Eigen::Vector2d& low, const Eigen::Vector2d& high);
/// Area of the disk about the origin inside the box, m2.
double disk_in_box(double radius, const Eigen::Vector2d& low, const Eigen::Vector2d& high);
/// Area that two disks share whose centres are `distance` apart, m2.
double disk_in_disk(double distance, double r1, double r2);
/// Area of a disk above the height y0 relative to its centre, m2.
double disk_above(double radius, double y0);

}  // namespace grainfield::coupling
