// Grains, contacts and force chains as VTK unstructured grids (ASCII .vtu), written complete or not
// at all.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "continuum/model.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// The outline of a grain where it is, as a closed polygon (without repeating the first corner), m:
/// its own corners, or `sides` points on a disk.
std::vector<dem::Vec3> outline(const dem::Grain& grain, int sides = 32);
/// The surface of a superellipsoid as one strip of triangles from pole to pole, m: `bands` of twice
/// as many sides.
std::vector<dem::Vec3> surface_strip(const dem::Grain& grain, int bands = 10);

/// In 2D one polygon per grain. Cell data: id, radius, mass, fixed, coordination, force (sum of
/// contact forces), pressure and stress (sum x F / V, tension positive), velocity, angle; with
/// `reference` (the same grains earlier) also displacement and rotation. In 3D one vertex per
/// sphere with the same as point data, for glyphs scaled by `radius`; instead of angle orientation
/// (quaternion w, x, y, z) and angular_velocity, and rotation is a vector (rad along its axis).
/// Displacements across periodic boundaries are as the images tell, else the shortest.
void write_grains_vtu(const std::string& file, const dem::Snapshot& snapshot,
                      const dem::Snapshot* reference = nullptr);
/// One line from centre to centre (centre to contact point for walls) per contact; across a
/// periodic boundary it goes to the image of the second grain, beyond the cell. Cell data: i, j
/// (ids of the two grains; j is -1 for a wall), force (on grain i), normal_force, tangential_force,
/// sliding, wall (-1: a pair).
void write_contacts_vtu(const std::string& file, const dem::Snapshot& snapshot);
/// One quadrilateral per contact of a force chain, along the branch; its width grows with the
/// normal force (that of the packing's largest force is the smaller grain's radius). `chain_of`:
/// per contact, its chain or -1 (structure/force_chains.h). Cell data: chain, normal_force,
/// relative_force. In 3D lines for tubes: the same as point data, with tube_radius (m). Throws
/// std::invalid_argument where the sizes differ.
void write_chains_vtu(const std::string& file, const dem::Snapshot& snapshot,
                      const std::vector<int>& chain_of);

/// Triangles with point data and cell data; z = 0. Throws std::invalid_argument for data of another
/// size.
std::string triangles_vtu(const continuum::MeshField& mesh);
/// Triangles between points in space (n x 3) with data of the points. Throws likewise.
std::string surface_vtu(const Eigen::MatrixXd& points,
                        const std::vector<std::array<int, 3>>& triangles,
                        const std::vector<continuum::Quantity>& at_points);
/// One polyline per n x 2 matrix; points that are nan are left out. Cell data: line, its number.
std::string lines_vtu(const std::vector<Eigen::MatrixXd>& lines);

}  // namespace grainfield::coupling
