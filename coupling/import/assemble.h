// Tables of one step to a snapshot.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/import/format.h"
#include "coupling/import/import.h"

namespace grainfield::coupling {

class Assembly {
 public:
  Assembly(const ImportOptions& options, const ImportFormat& format, ColumnNames& names,
           TableReader& reader)
      : options_(options), format_(format), names_(names), reader_(reader) {}

  /// Whether tables of contacts follow: their grains must have ids.
  void expect_contacts(bool expected) { contacts_expected_ = expected; }
  /// In this order: grains and walls, settle(), contacts, finish(). All throw as
  /// import_snapshots().
  void add_grains(const ForeignTable& table);
  void add_walls(const ForeignTable& table);
  /// Decides the dimension, sorts the grains, places the walls, takes the walls' forces.
  void settle();
  void add_contacts(const ForeignTable& table);
  ImportedSnapshot finish();

 private:
  /// Where a row stands, for messages.
  struct Source {
    const std::string* file;
    long long line;
    std::string where() const;
  };
  struct GrainRow {
    dem::Grain grain;
    double density = 0;       ///< 0: has its mass
    double told_density = 0;  ///< beside the mass; 0: none
    bool has_inertia = false;
    int volume_ten = 0;                 ///< a volume is of lengths times 10 to this
    std::array<int, 3> image{0, 0, 0};  ///< told
    Source source;
  };
  struct WallForce {  ///< of a "fix wall/gran ... contacts"
    std::int64_t grain = 0;
    std::size_t choice = 0;
    dem::Vec3 force, point;
    Source source;
  };
  struct ContactRow {
    dem::Contact contact;
    Source source;
    bool turned = false;  ///< the row names the second of the two first
    bool joined = false;  ///< with a row of the other direction
    [[noreturn]] void refuse(const std::string& what) const;
  };
  struct Tally {                                              ///< of contacts
    std::vector<std::pair<std::int64_t, std::int64_t>> idle;  ///< no force, and a gap
    long long left_out = 0;                                   ///< distant
    long long far = 0;                                        ///< forces across gaps
    std::string first_far;
  };

  /// A flat wall's contacts.
  struct WallSide {
    long long contacts = 0;
    long long wrong = 0;  ///< of them, those whose grain is not on the side of the normal
    long long deep = 0;   ///< of these, those on it, but with their centre too near the wall
    std::string first_deep;
    dem::Vec3 towards{0, 0, 0};  ///< sum of the directions from their points to their grains
  };
  /// Of the normals that the files give.
  struct GivenNormals {
    long long all = 0, not_unit = 0, at_walls = 0, across = 0;
    std::string first_not_unit, first_across;
  };

  /// Where the columns tell a place, for each axis: x, or xu, or xs, or xsu.
  struct PlaceColumns {
    std::array<ForeignColumn, 3> place, image;
    std::array<bool, 3> scaled{}, carried_back{};  ///< over the box; into the cell
    const dem::Cell<3>* box = nullptr;
  };
  struct ShapeColumns {  ///< of superellipsoids
    std::array<ForeignColumn, 3> axes;
    std::array<ForeignColumn, 2> exponents;
    double axis_factor = 1;  ///< 1/2 of diameters
    bool blockiness = false;
    explicit operator bool() const { return bool(axes[0]); }
  };
  PlaceColumns place_columns(const ForeignTable& table, const TableColumns& columns) const;
  ShapeColumns shape_columns(const TableColumns& columns) const;
  void read_place(const PlaceColumns& columns, const ForeignRow& row, GrainRow& out) const;
  void read_shape(const ShapeColumns& columns, const ForeignRow& row, dem::Grain& grain) const;
  /// Warns of columns that tell a shape which is not taken.
  void warn_of_shapes(const ForeignTable& table, const TableColumns& columns,
                      const ShapeColumns& taken);
  ForeignColumn find_id(const ForeignTable& table, const TableColumns& columns);

  /// Remembers a unit that is one of the plane or one of space.
  void remember_unit(const ForeignTable& table, const ForeignColumn& column);
  void settle_dimension();
  void settle_cell();
  void settle_walls();
  /// No two at one place, none far from all others, some that are fixed where they are named.
  void check_places();
  void check_fixed() const;
  void check_vectors() const;
  /// Throws for a wall whose normal does not point to the grains that touch it.
  void check_sides();
  void check_wall_side(const dem::Contact& contact, bool has_point);
  void check_given_normal(const dem::Contact& contact);
  void warn_of_normals();
  void complete(GrainRow& row) const;
  void place(GrainRow& row) const;
  /// Whether grains lie so far out of the cell that their places have not been carried back.
  bool lie_outside() const;
  /// The snapshot's attribute `images` (displacements.h). Says where flags are there along some
  /// axes only.
  std::string images_of_files();
  /// Mass, volume and moments of a superellipsoid.
  double complete_superellipsoid(dem::Grain& grain) const;
  std::int64_t index_of(std::int64_t id) const;       ///< -1: unknown
  std::int64_t wall_of(std::string_view text) const;  ///< -1 - w; 0: unknown
  /// nan where the file tells no spring.
  void set_spring(const std::optional<dem::Vec3>& spring, dem::Contact& contact) const;
  /// What a row of contacts tells.
  struct ContactColumns;
  ContactColumns contact_columns(const TableColumns& columns) const;
  void read_contact(const ContactColumns& columns, const ForeignRow& row, int digits);
  /// The grains or the grain and the wall of a row; swapped where the wall stands first.
  struct Ends {
    std::int64_t i = 0, j = 0;
    bool swapped = false;
  };
  Ends ends_of(const ContactColumns& columns, const ForeignRow& row, int digits) const;
  /// A grain's index or a wall, of one column; 0-based, -1 - w.
  std::optional<std::int64_t> body_of(const ForeignRow& row, const ForeignColumn& column,
                                      int digits) const;
  std::optional<std::int64_t> grain_of(const ForeignRow& row, const ForeignColumn& column,
                                       int digits) const;
  [[noreturn]] void refuse_unknown(const ForeignRow& row, const ForeignColumn& column) const;
  /// A force of normal and tangential size, on the first grain.
  dem::Vec3 force_of_sizes(const ContactColumns& columns, const ForeignRow& row,
                           const dem::Contact& contact) const;

  void add_contact(ContactRow row, bool has_normal, bool has_point, bool tell_sliding);
  /// Image, normal and point; false: it is none, or left out.
  bool settle_pair(ContactRow& row, bool has_normal, bool has_point);
  void set_image(ContactRow& row, bool has_point) const;
  bool check_pair_distance(const ContactRow& row, bool has_point);
  bool settle_wall_contact(ContactRow& row, bool has_point);
  void check_wall_distance(const ContactRow& row, bool has_point) const;
  void check_periods(const ContactRow& row) const;
  /// Keeps one of the rows of a contact that stands there in both directions; throws for any other
  /// that is there twice.
  void join_directions();
  [[noreturn]] void refuse_twice(const ContactRow& row, const ContactRow& other,
                                 bool same_force) const;
  void tell_tally();
  std::string known_grains() const;

  const ImportOptions& options_;
  const ImportFormat& format_;
  ColumnNames& names_;
  TableReader& reader_;
  std::vector<GrainRow> rows_;
  std::vector<WallForce> wall_forces_;
  std::vector<ContactRow> contacts_;
  std::vector<std::string> plane_units_, space_units_;  // told by headers, for messages
  std::vector<Source> wall_sources_;                    // of the walls from tables
  std::vector<WallSide> sides_;                         // of all walls
  GivenNormals given_;
  std::vector<std::string> marks_;  // some that the column of fixed grains holds
  bool some_marked_ = false;
  bool has_z_ = false;
  bool contacts_expected_ = true;
  std::array<bool, 3> axis_told_{true, true, true};  // images
  Tally tally_;
  std::string first_file_;  // of grains
  dem::Cell<3> cell_;       // of the files
  ImportedSnapshot out_;
};

}  // namespace grainfield::coupling
