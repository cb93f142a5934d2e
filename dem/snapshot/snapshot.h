// The state of a packing at one instant, as the rest of the project and ParaView see it.
// The HDF5 layout is documented in docs/file-formats.md.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "dem/space/cell.h"
#include "dem/space/outline.h"

namespace grainfield::dem {

using Vec3 = Eigen::Vector3d;

/// A grain. In 2D z is 0, "volume" is an area (m2), mass uses an areal density.
struct Grain {
  std::int64_t id = 0;     ///< the same grain has the same id in every snapshot of a run
  Vec3 position{0, 0, 0};  ///< centroid, m
  Vec3 velocity{0, 0, 0};  ///< m/s
  double angle = 0;        ///< rotation about z, rad
  double spin = 0;         ///< rad/s
  double radius = 0;       ///< m; of a polygon: from its centroid to the farthest corner
  double mass = 0;         ///< kg
  double inertia = 0;      ///< polar moment about the centroid, kg m2
  double volume = 0;       ///< m2 in 2D
  bool fixed = false;      ///< part of the apparatus (rough floor): takes force, does not move
  Outline outline;         ///< corners in the body frame (rotate by `angle`); empty: round
  /// In 3D; angle is not used, spin and inertia are the z component and the mean then.
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< unit quaternion w, x, y, z: body to space
  Vec3 angular_velocity{0, 0, 0};                 ///< rad/s
  Vec3 moments{0, 0, 0};                          ///< principal moments, kg m2
  std::string material{};                         ///< "": the only one, without a name
  /// Periodic: whole edges by which the grain has been carried back into the cell; without that it
  /// would be at position + cell.edges * image, with the velocity of that image.
  std::array<int, 3> image{0, 0, 0};
  bool rotates = true;  ///< false: it slides but never spins
  /// Superellipsoid: semi-axes, m, and exponents e1, e2 (dem/shapes/superellipsoid.h). All 0:
  /// it is none.
  Vec3 axes{0, 0, 0};
  std::array<double, 2> exponents{0, 0};
};

/// A rigid wall. A plane bounds a half space: the grains are on the side the normal points to.
struct Wall {
  std::string name;             ///< "floor", "left", "right"
  Vec3 point{0, 0, 0};          ///< on the wall; of a cylinder or cone: where its axis begins, m
  Vec3 normal{0, 1, 0};         ///< unit, into the grains; of a cylinder or cone: its axis
  double friction = 0;          ///< coefficient of grain against wall, where it has no material
  std::string shape = "plane";  ///< plane | cylinder | cone | mesh
  double radius = 0;            ///< cylinder, cone: at `point`, m
  double end_radius = 0;        ///< cone: at the other end of the axis, m
  double length = 0;            ///< cylinder, cone: of the axis, m; 0: a cylinder without ends
  bool inside = true;           ///< cylinder, cone: the grains are inside
  std::vector<std::array<Vec3, 3>>
      triangles{};                 ///< mesh: counter-clockwise as the grains see it, m
  std::string material{};          ///< "": the law of each grain with its like, and `friction`
  Vec3 velocity{0, 0, 0};          ///< of `point` as part of the wall, m/s
  Vec3 angular_velocity{0, 0, 0};  ///< about `point`, rad/s
  Vec3 force{0, 0, 0};             ///< of all grains on the wall, N
  Vec3 torque{0, 0, 0};            ///< about `point`, N m
};

/// A contact that transmits force. j >= 0: index of the other grain; j = -1 - w: wall w.
struct Contact {
  std::int64_t i = 0, j = 0;    ///< indices into Snapshot::grains, i < j for pairs
  Vec3 point{0, 0, 0};          ///< contact point, m
  Vec3 normal{0, 0, 0};         ///< unit, from i towards j
  Vec3 force{0, 0, 0};          ///< on grain i by j, N; on j it is the opposite
  double normal_force = 0;      ///< repulsion >= 0, N
  double tangential_force = 0;  ///< signed along (-n_y, n_x), on grain i, N
  double spring = 0;            ///< elastic part of tangential_force (the contact's memory), N
  double friction = 0;          ///< Coulomb coefficient of this contact
  bool sliding = false;         ///< |tangential| at mu * normal
  Vec3 spring_vector{0, 0, 0};  ///< in 3D: the spring on grain i, N; `spring` is its size; nan:
                                ///< another program did not tell
  /// Periodic: the grain j that i touches is the image at position + cell.edges * image.
  std::array<int, 3> image{0, 0, 0};
  /// Pseudo-force of the rolling spring and moment of the twisting spring along `normal`, on grain
  /// i (dem/laws/rolling.h): N, N m.
  Vec3 rolling_spring{0, 0, 0};
  double twisting_spring = 0;
};

/// A column of numbers that a run recorded; unit "1": pure numbers, "": not told.
struct NumberColumn {
  std::string name, unit;
  std::vector<double> values;
};
/// Equally long columns, in their order.
using NumberTable = std::vector<NumberColumn>;

struct Snapshot {
  int dim = 2;
  double time = 0;                 ///< s
  Vec3 gravity{0, 0, 0};           ///< m/s2
  std::int64_t loaded_grain = -1;  ///< id of the grain that carries the applied force, or -1
  Vec3 applied_force{0, 0, 0};     ///< on that grain, N
  std::vector<std::int64_t> also_loaded{};  ///< ids, ascending, of others that carry the same force
  Cell<3> cell;                             ///< in 2D the third axis is not periodic
  std::vector<Grain> grains;                ///< sorted by id
  std::vector<Contact> contacts;            ///< sorted by (i, j)
  std::vector<Wall> walls;
  std::map<std::string, std::string> attributes;  ///< law, parameters, seed, version, ...
  /// What the study recorded on the way to this state, by name: "settling", "pair", ...
  std::map<std::string, NumberTable> tables{};
};

/// Whether the grain of this id carries the applied force.
bool is_loaded(const Snapshot& snapshot, std::int64_t id);
/// The applied force of all grains that carry it, N.
Vec3 total_applied_force(const Snapshot& snapshot);

/// Throws std::invalid_argument saying what is allowed unless the parts of the name between "/" can
/// be groups that every command can name again: none empty, "." or "..", no ":", no control
/// characters.
void check_group_name(const std::string& name);
/// Writes the snapshot as group `group` ("/unloaded", "/realization_003/loaded") of the file,
/// creating the file or adding to it. Not atomic: the caller writes beside and renames.
/// Throws StorageFailed (dem/storage_failed.h) naming the file, std::invalid_argument for names of
/// walls or materials with commas and for what check_group_name refuses.
void write_snapshot(const std::string& file, const std::string& group, const Snapshot& snapshot);
/// Throws std::invalid_argument naming the file and what is missing or broken (not HDF5, truncated,
/// no such group or column, contacts naming unknown grains, and what check_snapshot refuses).
Snapshot read_snapshot(const std::string& file, const std::string& group);
/// Every group of the file that holds a snapshot, in the file's order of names.
std::vector<std::string> list_snapshots(const std::string& file);
/// CRC-32 of the places of the grains of each of these snapshots as the file tells it, the same for
/// copies; empty where the file tells none. Throws as list_snapshots.
std::vector<std::string> places_checksums(const std::string& file,
                                          const std::vector<std::string>& groups);

}  // namespace grainfield::dem
