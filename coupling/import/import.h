// Packings of other programs as snapshots (docs/import.md).
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/import/table.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// A flat wall across an axis that the files do not describe themselves.
struct WallChoice {
  std::string name;              ///< floor, left, right, ...
  int axis = 1;                  ///< 0, 1, 2: x, y, z
  double position = 0;           ///< m
  std::vector<std::string> ids;  ///< what contacts call it; its name always counts
  std::string material;          ///< "": that of each grain
  std::string fix;  ///< LAMMPS "fix wall/gran ... contacts": columns FIX[1..7] of the grains' dump
  bool bare = false;  ///< the position was given without a unit, and is not 0
};
/// "NAME:AXIS=POSITION[:ids=3,4][:fix=f_floor][:material=M]". Throws std::invalid_argument.
WallChoice parse_wall(const std::string& text);

/// "AXIS=LOW:HIGH", such as x=0:0.1: what leaves at one comes in at the other. Throws
/// std::invalid_argument.
struct PeriodicAxis {
  int axis = 0;
  double low = 0, high = 1;  ///< m
  bool bare = false;         ///< one of them was given without a unit, and is not 0
};
PeriodicAxis parse_periodic(const std::string& text);

/// A time step to import.
struct StepChoice {
  long long step = 0;
  std::string group;  ///< of the snapshot file; empty: /step_N
};

struct ImportOptions {
  std::string format;              ///< lammps | liggghts | yade | csv | mercury | vtk
  std::vector<std::string> files;  ///< told apart by what they hold
  /// parse_unit_system: of columns without a unit of their own; "": m, and a file that says units
  /// that are none of SI is refused.
  std::string units;
  std::vector<std::string> columns;  ///< "ours=theirs", "ours=number unit", "i,j=c_id[1..2]"
  int dim = 0;                       ///< 0: 2 when there is no z or every z is the same, else 3
  std::optional<dem::Vec3> gravity;  ///< m/s2; default 9.81 down (2D: -y, 3D: -z)
  double density = 0;  ///< kg/m3 (2D: kg/m2), where there is no column mass or density
  double friction = std::numeric_limits<double>::quiet_NaN();  ///< where there is no column
  std::vector<WallChoice> walls;
  std::string fixed_column;  ///< grains with one of these values there are fixed
  std::vector<std::string> fixed_values;
  std::vector<StepChoice> steps;  ///< empty: the last, or all
  bool all_steps = false;
  double time_step = 0;  ///< s; a dump's time = step times this, where it gives no time itself
  std::string group;     ///< of a single snapshot; default /step_N, or /packing without steps
  bool without_contacts = false;  ///< grains alone are enough
  bool flip_forces = false;       ///< the files' forces act on j: all are turned
  bool flip_pairs = false;        ///< those between grains alone
  bool flip_walls = false;        ///< those with walls alone
  /// -1 where the forces between grains, or with walls, are turned; else 1.
  double sign_of(bool wall) const {
    return flip_forces || (wall ? flip_walls : flip_pairs) ? -1 : 1;
  }
  bool leave_out_distant = false;  ///< pairs across periodic boundaries are left out, and no cell
  std::string ids_file;  ///< a table of the files' ids and the grains' original ones; empty: none
  std::vector<PeriodicAxis> periodic;  ///< instead of those that a dump tells
  /// Told now and then: what is done of how many, "files looked through", "steps read".
  std::function<void(const char* phase, std::size_t done, std::size_t all)> progress = {};
  std::int64_t loaded_grain = -1;    ///< id of the grain that carries the applied force, or -1
  dem::Vec3 applied_force{0, 0, 0};  ///< N
};

struct ImportedSnapshot {
  std::string group;
  dem::Snapshot snapshot;
  UnitSystem units;         ///< of the grains' table, where a column tells none
  long long left_out = 0;   ///< distant pairs
  long long idle = 0;       ///< pairs left out that bear no force across a gap
  long long forceless = 0;  ///< contacts that bear no force and overlap: kept
  long long twice = 0;      ///< contacts that stood there in both directions, kept once
  /// What the reader has decided and may be of interest, a sentence each.
  std::vector<std::string> notes;
  /// What in the files makes the packing doubtful and does not show in the snapshot: grains far
  /// from all others, normals that were not unit vectors or contradict their wall, grains that a
  /// narrow period has laid upon each other; a sentence each.
  std::vector<std::string> warnings;
};

/// Reads step by step and hands each on: memory for one step, whatever the files' size. Units: SI,
/// but for columns of a CSV table that name theirs, "x (mm)", and for what options.units says.
/// Throws std::invalid_argument naming file, line, what was found and what is allowed: a missing
/// column (with those found and the nearest), contacts of unknown grains or with themselves or
/// twice, values that are not finite, ids that repeat, a truncated file, 2D mixed with 3D, radius
/// or mass not above 0, polygons that are not convex, steps that are not there; walls, columns and
/// periods that are named twice, walls whose contacts are not on the side of their normal, grains
/// at one place, flags other than 0 and 1, coefficients of friction outside 0 to kMostFriction,
/// numbers beyond dem::kMostNumber, a radius and a diameter, or a mass and a density, that
/// contradict; lengths of options without a unit where options.units is not m.
void import_snapshots(const ImportOptions& options,
                      const std::function<void(ImportedSnapshot&&)>& take);

/// A table in memory.
struct ArrayTable {
  std::string name;  ///< in messages, with the row from 0: "grains:12"
  std::vector<std::pair<std::string, ArrayColumn>> columns;  ///< under our names (table.h)
};
/// The same of tables in memory, in SI units under our names: contacts and walls may be without
/// columns. Of the options only those that read no file count. Throws std::invalid_argument
/// likewise, and for a column of an unknown name or of another length than the first.
ImportedSnapshot import_arrays(const ImportOptions& options, const ArrayTable& grains,
                               const ArrayTable& contacts, const ArrayTable& walls);

/// What makes the forces fit the places where files differ in a sign or in the order of axes.
struct AxesChange {
  const char* text;
  std::array<Eigen::Index, 3> from;  ///< x, y, z of the force are these of the file's
  std::array<int, 3> sign;
};
inline constexpr std::array<AxesChange, 8> kAxesChanges{{
    {"turn the sign of fx alone", {0, 1, 2}, {-1, 1, 1}},
    {"turn the sign of fy alone", {0, 1, 2}, {1, -1, 1}},
    {"turn the sign of fz alone", {0, 1, 2}, {1, 1, -1}},
    {"exchange fx and fy (or x and y of the grains)", {1, 0, 2}, {1, 1, 1}},
    {"exchange fy and fz (or y and z of the grains)", {0, 2, 1}, {1, 1, 1}},
    {"exchange fx and fz (or x and z of the grains)", {2, 1, 0}, {1, 1, 1}},
    {"take fy, fz, fx for fx, fy, fz", {1, 2, 0}, {1, 1, 1}},
    {"take fz, fx, fy for fx, fy, fz", {2, 0, 1}, {1, 1, 1}},
}};

/// How an imported packing can be checked against the program that made it.
struct PackingCheck {
  /// Sum over grains and their contacts of F (outer) x, x from the centroid to the contact point, N
  /// m (2D: N m as well, stress in N/m times area): stress times volume, tension positive; first
  /// index the force.
  Eigen::Matrix3d pairs = Eigen::Matrix3d::Zero();  ///< contacts between grains
  Eigen::Matrix3d walls = Eigen::Matrix3d::Zero();  ///< contacts with walls
  /// Mean resultant of free grains with contacts (weight and applied force included) over the mean
  /// contact force; nan without contacts.
  double unbalanced_force_ratio = std::numeric_limits<double>::quiet_NaN();
  /// Their components along gravity, N m: below 0 compression. nan without gravity or contacts.
  double pairs_along_gravity = std::numeric_limits<double>::quiet_NaN();
  double walls_along_gravity = std::numeric_limits<double>::quiet_NaN();
  /// Force of walls and fixed grains on the free grains, against gravity, over their weight and the
  /// applied force along gravity; nan without gravity or contacts.
  double support_ratio = std::numeric_limits<double>::quiet_NaN();
  /// Its error, were the forces that are out of balance on the grains without direction: root of
  /// the sum of their squares along gravity, over the same weight.
  double support_error = std::numeric_limits<double>::quiet_NaN();
  /// Contacts whose force pulls: its part along the normal is tension, above a thousandth of the
  /// mean force. `pulling_changed`: how many would with each of kAxesChanges, and
  /// `pushing_changed` how many would push.
  int pulling = 0;
  std::array<int, kAxesChanges.size()> pulling_changed{}, pushing_changed{};
  int bearing = 0;  ///< contacts whose part along the normal, of either sign, is above it
  int pulling_walls = 0, bearing_walls = 0;  ///< of these, those with walls
  /// Pairs of unknown friction, and those of them that bear more tangential than normal force.
  int unknown_friction = 0, steep = 0;
  int pairs_along = 0;        ///< pairs whose force lies along their normal
  int loaded_pairs = 0;       ///< pairs that bear a force
  double weight = 0;          ///< of the free grains, with the applied force along gravity, N
  dem::Vec3 across{0, 0, 0};  ///< force of walls and fixed grains across gravity, N
  int wall_contacts = 0;      ///< contacts with walls
  int off_wall_contacts = 0;  ///< of them, those whose point is over two radii off the wall's plane
  int round_pairs = 0;        ///< contacts between round grains
  int odd_normals = 0;  ///< of them, those whose normal is over 60 degrees off the line of centres
  std::int64_t odd_i = 0, odd_j = 0;  ///< ids of the first such two
  int polygon_pairs = 0;              ///< contacts of polygons, with each other or with disks
  int turned_normals =
      0;  ///< of them, those whose normal is over 90 degrees off the line of centres
  std::int64_t turned_i = 0, turned_j = 0;  ///< ids of the first such two
  /// Contacts that are not marked as sliding and bear more than friction allows, and those whose
  /// friction is known.
  int beyond_friction = 0, known_friction = 0;
};
PackingCheck check_packing(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
