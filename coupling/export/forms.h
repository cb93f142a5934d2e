// The forms in which packings and fields leave the program: tables, pages, pictures, ParaView.
#pragma once
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/report/picture.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct PackingTables {
  std::string grains, contacts, walls;  ///< CSV with a header, SI, all digits; walls may be empty
};

/// Its grains, contacts and plane walls. Forces of a Python function that act are told by a comment
/// above each table. Throws std::invalid_argument for what the tables have no
/// column for: superellipsoids, walls of other shapes, periodic cells.
PackingTables packing_tables(const dem::Snapshot& packing);

/// Script for STEM-grains.vtu, STEM-contacts.vtu and STEM-chains.vtu: grains coloured by their
/// pressure (spheres as balls of their radius), contacts by their normal force, chains hidden.
std::string paraview_of_packing(const std::string& stem, const dem::Snapshot& packing);
/// Script for STEM.vtu, coloured by the column, or the first where there is none of that name.
std::string paraview_of_field(const std::string& stem, const Field& field,
                              const std::string& column);

/// Every column, and COLUMN_error where there are errors, at the points: quadrilaterals of a grid
/// in the plane, hexahedra of one in space, single points else. nan stays nan.
std::string field_vtu(const Field& field);

/// The column of that name; of an empty name the vertical stress, or the first one. Throws
/// std::invalid_argument with the names that are there.
const Column& drawn_column(const Field& field, const std::string& column);

/// A grid in the plane becomes a map of drawn_column(). Other points lie on lines along one axis:
/// profiles of the column, or where none is named of every stress that is there, normal ones as
/// pressures (-sigma_yy), with bars of the standard error. A field that was measured stands with
/// points, others with lines. Throws std::invalid_argument for points that lie on too many lines or
/// on none.
Picture field_picture(const std::string& title, const Field& field, const std::string& column);

/// The page. Grains are drawn with their outlines, in space as balls of their radius (of a
/// superellipsoid: of its volume), coloured by mean stress, contacts, speed or size; contacts as
/// lines whose width grows with the normal force. Numbers have six digits.
std::string packing_page(const dem::Snapshot& packing, const std::string& title);

/// (1/V) sum of F (outer) x over a grain's contacts, x from its centre: minus its trace over the
/// dimension, of every grain, N/m2 (2D: N/m), compression positive; and its number of contacts.
struct GrainNumbers {
  std::vector<double> mean_stress;
  std::vector<int> contacts;
};
GrainNumbers grain_numbers(const dem::Snapshot& packing);

}  // namespace grainfield::coupling
