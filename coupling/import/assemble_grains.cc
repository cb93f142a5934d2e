// What the columns of grains tell beyond plain numbers: ids, places, shapes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/import/assemble.h"
#include "coupling/import/synonyms.h"
#include "coupling/import/untaken.h"
#include "dem/shapes/superellipsoid.h"
#include "dem/snapshot/cell_places.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

// Names that tell a shape or a body of several grains.
bool tells_shape(const ForeignTable& table, const std::string& name) {
  const std::string plain = plain_untaken_name(table, name);
  constexpr std::array starts{"shape",         "blockiness", "roundness", "aspect",
                              "elongation",    "flatness",   "clump",     "multisphere",
                              "idmultisphere", "nvert",      "vertices",  "corner",
                              "facets",        "halflength", "semiaxis",  "sphericity"};
  return std::any_of(starts.begin(), starts.end(),
                     [&](const char* start) { return plain.starts_with(start); });
}

}  // namespace

ForeignColumn Assembly::find_id(const ForeignTable& table, const TableColumns& columns) {
  ForeignColumn id = columns.find("id");
  if (id || format_.rows_are_ids) return id;
  if (contacts_expected_) {
    if (format_.name == "yade")
      throw std::invalid_argument(fmt::format(
          "{}:{}: no column \"id\"; found: {}; the contacts name their grains by it: "
          "export.textExt(FILE, 'id_x_y_z_r_matId') and docs/import.md's yade_export.py write it, "
          "--without-contacts counts the grains",
          table.file, table.header_line, fmt::join(*table.columns, " ")));
    columns.missing("id");
  }
  if (rows_.empty())
    out_.notes.push_back(table.file + ": no column id: the grains are counted from 1 in its order");
  return id;
}

ForeignColumn Assembly::find_bodies(const ForeignTable& table, const TableColumns& columns) {
  constexpr std::array bodies{"mol",    "molid",    "molecule",    "moleculeid", "cmol",
                              "body",   "bodyid",   "rigid",       "rigidid",    "rigidbody",
                              "ms",     "msid",     "agglomerate", "aggregate",  "agglomerateid",
                              "parent", "parentid", "aggregateid", "idbody",     "ibody",
                              "idms",   "fms",      "fmsid"};
  for (const std::string& name : columns.untaken()) {
    std::string plain = plain_untaken_name(table, name);
    if (plain.ends_with('1') && name.ends_with("[1]")) plain.pop_back();  // "f_ms[1]"
    for (const char* body : bodies)
      if (plain == body) return columns.need_theirs(name);
  }
  return {};
}

void Assembly::Bodies::add(const ForeignRow& row) {
  if (!column || any()) return;
  const std::string_view text = row.text(column);
  if (text.empty() || text == "0" || text == "-1" || text == "nan") return;
  repeated = !met.emplace(text).second || repeated;
}

Assembly::PlaceColumns Assembly::place_columns(const ForeignTable& table,
                                               const TableColumns& columns) const {
  PlaceColumns out;
  int scaled = 0, axes = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::string axis = kAxes[a];
    ForeignColumn& place = out.place[a];
    place = columns.find(axis);
    out.image[a] = columns.find("i" + axis);
    out.carried_back[a] = bool(place);
    // Beside image flags x is what the program has computed; without, xu tells more.
    if (!place || !out.image[a])
      if (const ForeignColumn other = columns.find(axis + "u")) {
        place = other;
        out.carried_back[a] = false;
        out.image[a] = {};
      }
    if (!place)
      if ((place = columns.find(axis + "s"))) {
        out.scaled[a] = true;
        out.carried_back[a] = true;
      }
    if (!place)
      if ((place = columns.find(axis + "su"))) {
        out.scaled[a] = true;
        out.image[a] = {};
      }
    if (!place && (a < 2 || options_.dim == 3)) columns.missing(axis);
    axes += place ? 1 : 0;
    scaled += out.scaled[a] ? 1 : 0;
  }
  if (scaled == 0) return out;
  if (!table.box)
    throw std::invalid_argument(fmt::format(
        "{}:{}: places over the box ({}), and no box: they need ITEM: BOX BOUNDS with numbers",
        table.file, table.header_line, fmt::join(*table.columns, " ")));
  out.box = table.box.get();
  if (scaled < axes && !table.box->edges.isDiagonal(0))
    throw std::invalid_argument(fmt::format(
        "{}:{}: places over the box along some axes only, allowed in a tilted box: along "
        "all",
        table.file, table.header_line));
  return out;
}

void Assembly::read_place(const PlaceColumns& columns, const ForeignRow& row, GrainRow& out) {
  dem::Vec3& place = out.grain.position;
  dem::Vec3 share = dem::Vec3::Zero();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double number = columns.place[a] ? row.number(columns.place[a]) : 0;
    if (columns.place[a]) place_digits_ = std::max(place_digits_, row.digits(columns.place[a]));
    (columns.scaled[a] ? share : place)[axis] = number;
    if (columns.scaled[a]) place[axis] = columns.box->low[axis];
    if (!columns.image[a] || row.empty(columns.image[a])) continue;
    const std::int64_t image = row.told_id(columns.image[a]).id;
    if (std::abs(image) > dem::kMostImages)
      row.refuse(fmt::format("found the image flag {} along {}, allowed: up to {}", image, kAxes[a],
                             dem::kMostImages));
    out.image[a] = static_cast<int>(image);
  }
  if (columns.box != nullptr) place += columns.box->edges * share;
}

Assembly::ShapeColumns Assembly::shape_columns(const TableColumns& columns) const {
  ShapeColumns out;
  const auto all = [&](const char* stem) {
    out.axes[0] = columns.find(std::string(stem) + "x");
    if (!out.axes[0]) return false;
    out.axes[1] = columns.need(std::string(stem) + "y");
    out.axes[2] = columns.need(std::string(stem) + "z");
    return true;
  };
  if (!all("axis_") && all("diameter_")) out.axis_factor = 0.5;
  if (!out) return out;
  out.exponents = {columns.find("exponent_1"), columns.find("exponent_2")};
  if (out.exponents[0] || out.exponents[1]) return out;
  out.exponents = {columns.find("blockiness_2"), columns.find("blockiness_1")};
  out.blockiness = out.exponents[0] || out.exponents[1];
  return out;
}

void Assembly::read_shape(const ShapeColumns& columns, const ForeignRow& row,
                          dem::Grain& grain) const {
  for (std::size_t a = 0; a < 3; ++a)
    grain.axes[static_cast<Eigen::Index>(a)] = columns.axis_factor * row.number(columns.axes[a]);
  grain.exponents = {1, 1};
  for (std::size_t k = 0; k < 2; ++k) {
    if (!columns.exponents[k]) continue;
    const double told = row.number(columns.exponents[k]);
    grain.exponents[k] = columns.blockiness ? 2 / told : told;
  }
  try {
    dem::superellipsoid({grain.axes[0], grain.axes[1], grain.axes[2]}, grain.exponents);
  } catch (const std::invalid_argument& e) {
    row.refuse(fmt::format("grain {}: {}{}", grain.id, e.what(),
                           columns.blockiness ? " (an exponent is 2 over the blockiness)" : ""));
  }
}

double Assembly::complete_superellipsoid(dem::Grain& g) const {
  const dem::Superellipsoid body =
      dem::superellipsoid({g.axes[0], g.axes[1], g.axes[2]}, g.exponents);
  const dem::Solid<3> solid = dem::solid_of(body);
  g.radius = solid.radius;
  g.moments = {solid.moments[0], solid.moments[1], solid.moments[2]};
  return solid.volume;
}

void Assembly::warn_of_shapes(const ForeignTable& table, const TableColumns& columns, bool taken) {
  std::vector<std::string> left;
  for (const std::string& name : columns.untaken())
    if (tells_shape(table, name)) left.push_back(name);
  if (left.empty()) return;
  out_.warnings.push_back(
      fmt::format("{}:{}: the columns {} tell of shapes and are not taken: every row is read as {}",
                  table.file, table.header_line, fmt::join(left, " "),
                  taken ? "a superellipsoid of the other columns"
                        : "a grain of its own, round or with an "
                          "outline"));
}

void Assembly::tell_columns(const ForeignTable& table, const TableColumns& columns,
                            TableKind kind) {
  if (std::string doubt = columns.require_units(); !doubt.empty())
    out_.warnings.push_back(std::move(doubt));
  if (!table.unit_remark.empty() && !columns.tells_units() && table.units.is_si() &&
      table.told_units.empty())
    out_.warnings.push_back(fmt::format(
        "{}, and no column has a unit: its numbers are read as SI (--units, or \"x (mm)\")",
        table.unit_remark));
  out_.warnings.insert(out_.warnings.end(), table.doubts.begin(), table.doubts.end());
  for (std::string& line : columns.misspelled()) out_.warnings.push_back(std::move(line));
  if (kind == TableKind::grains)
    for (const std::string& name : columns.untaken()) {
      const std::string plain = plain_column_name(name);
      for (const char* time : {"time", "t", "step", "timestep", "frame", "iteration", "cycle"})
        if (plain == time) time_columns_.try_emplace(tables_, name);
    }
  UntakenColumns untaken = untaken_columns(table, columns, kind);
  if (!untaken.note.empty()) out_.notes.push_back(std::move(untaken.note));
  for (std::string& line : untaken.warnings) out_.warnings.push_back(std::move(line));
}

bool Assembly::lie_outside() const {
  const dem::Cell<3>& cell = out_.snapshot.cell;
  return std::any_of(rows_.begin(), rows_.end(), [&](const GrainRow& row) {
    return dem::depth_outside(cell, row.grain.position) > 2 * row.grain.radius;
  });
}

std::string Assembly::images_of_files() {
  std::vector<std::string> told, untold;
  for (std::size_t a = 0; a < 3; ++a)
    if (out_.snapshot.cell.periodic[a]) (axis_told_[a] ? told : untold).emplace_back(kAxes[a]);
  if (untold.empty()) return "counted";
  if (told.empty()) return lie_outside() ? "not carried back" : "untold";
  out_.notes.push_back(fmt::format(
      "{}: images are counted along {} only: displacements along {} will be the shortest ways "
      "(i{} or {}u counts them)",
      first_file_, fmt::join(told, ", "), fmt::join(untold, ", "), untold.front(), untold.front()));
  return fmt::format("counted along {}", fmt::join(told, " "));
}

}  // namespace grainfield::coupling
