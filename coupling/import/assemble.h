// Tables of one step to a snapshot.
#pragma once
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coupling/import/format.h"
#include "coupling/import/import.h"

namespace grainfield::coupling {

/// Whether two numbers differ that should be equal and are written with five digits or more.
inline bool contradict(double a, double b) { return std::abs(a - b) > 1e-4 * std::abs(a); }

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
  /// Warns where both files say their times and these are two.
  void check_time(const ForeignTable& grains, const ForeignTable& contacts);
  ImportedSnapshot finish();

 private:
  /// Values of the column of fixed grains in a message.
  static constexpr std::size_t kMostMarks = 6;
  /// Where a row stands, for messages.
  struct Source {
    const std::string* file;
    long long line;
    int table = 0;  ///< the number of the table
    std::string where() const;
  };
  /// Tables of one kind, the first of them before the second.
  using TwoTables = std::pair<int, int>;
  struct Repeats {
    long long rows = 0;    ///< of the second that are in the first, too
    long long turned = 0;  ///< of them, those that name the grains the other way round
    const std::string *first = nullptr, *second = nullptr;  ///< files
  };
  struct GrainRow {
    dem::Grain grain;
    double density = 0;           ///< 0: has its mass
    double told_density = 0;      ///< beside the mass; 0: none
    bool sphere_density = false;  ///< the density is that of a sphere in 2D, too
    bool has_inertia = false;
    int digits = 0;                     ///< of an id that was printed without its last ones
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
    bool again = false;   ///< is in a table before, too
    bool copied = false;  ///< one of the two was told by a copy's number
    int facet = 0;        ///< of the wall, as facet_of() has it
    std::optional<double> told_fn = {},
                          told_ft = {};  ///< sizes that the row gives beside the whole force
    [[noreturn]] void refuse(const std::string& what) const;
  };
  struct Tally {                                              ///< of contacts
    std::vector<std::pair<std::int64_t, std::int64_t>> idle;  ///< no force, and a gap
    long long left_out = 0;                                   ///< distant
    long long far = 0;                                        ///< forces across gaps
    long long below_digits = 0;  ///< forces across gaps that the digits of places leave open
    long long pointed = 0, off_surface = 0;  ///< round pairs with points; far off
    std::string first_off;
    std::string first_far;
    long long sized = 0, off_size = 0;  ///< rows with sizes beside the force; contradicting it
    double tangential = 0, told_tangential = 0;  ///< N, sums over these rows
    long long bearing = 0, along = 0;            ///< pairs that bear a force; along their normal
    std::string first_off_size;
    long long fn_above = 0, fn_below = 0;  ///< sizes fn beside a vector of the tangential part
    long long parts = 0,
              oblique = 0;  ///< forces in two parts; of them, those not across each other
    long long shaped = 0, off_shape = 0;  ///< points on outlines and superellipsoids; far off
    std::string first_off_shape;
    long long ft_above = 0, ft_below = 0;  ///< sizes ft without a direction, in 2D
  };

  /// A flat wall's contacts.
  struct WallSide {
    long long contacts = 0;
    long long wrong = 0;  ///< of them, those whose grain is not on the side of the normal
    long long deep = 0;   ///< of these, those on it, but with their centre too near the wall
    std::string first_deep;
    long long far = 0;   ///< contacts that bear a force across a gap
    double widest = 0;   ///< of these gaps, m
    long long sunk = 0;  ///< round grains that overlap it by much of their radius
    double deepest = 0;  ///< of these overlaps, m
    double lowest = std::numeric_limits<double>::infinity();  ///< gap of the lowest grain, m
    dem::Vec3 towards{0, 0, 0};  ///< sum of the directions from their points to their grains
  };
  /// Counts of the normals that the files give.
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
  void read_place(const PlaceColumns& columns, const ForeignRow& row, GrainRow& out);
  void read_shape(const ShapeColumns& columns, const ForeignRow& row, dem::Grain& grain) const;
  /// Warns of columns that tell a shape which is not taken.
  void warn_of_shapes(const ForeignTable& table, const TableColumns& columns, bool taken);
  /// Says what became of a table's columns, once all were looked up; throws where some of them have
  /// a unit and others of their kind none.
  void tell_columns(const ForeignTable& table, const TableColumns& columns, TableKind kind);
  /// Throws naming all columns that are missing where several are.
  void require_columns_of_grains(const TableColumns& columns) const;
  ForeignColumn find_id(const ForeignTable& table, const TableColumns& columns);
  /// A column of molecules: its values, where they are numbers above 0.
  struct Bodies {
    ForeignColumn column;
    std::set<std::string, std::less<>> met;
    bool repeated = false;
    void add(const ForeignRow& row);
    /// Whether there are several and one of them has several rows.
    bool any() const { return repeated && met.size() > 1; }
  };
  static ForeignColumn find_bodies(const ForeignTable& table, const TableColumns& columns);

  /// Throws where lengths of options have no unit beside columns that have one.
  void require_units_of_options(const ForeignTable& table, const PlaceColumns& columns) const;
  /// Throws where the rows are of several times or steps; warns where another table is of another.
  void check_states(const ForeignTable& table, const TableColumns& columns, TableKind kind);
  /// Remembers a unit that is one of the plane or one of space.
  void remember_unit(const ForeignTable& table, const ForeignColumn& column);
  void settle_dimension();
  void settle_cell();
  void settle_walls();
  /// No two at one place, none far from all others, some that are fixed where they are named.
  void check_places();
  /// Warns of periods that are much wider than what lies in them.
  void check_widths();
  void check_fixed() const;
  void check_vectors() const;
  /// Throws for a wall whose normal does not point to the grains that touch it.
  void check_sides();
  void check_wall_side(const dem::Contact& contact, bool has_point);
  /// Counts a grain that bears a force across a gap to its wall, or lies deep in it.
  void check_wall_gap(const dem::Contact& contact);
  void warn_of_wall_gaps();
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
  /// Drops the tables of grains that an earlier file has, too; throws for any other id that is
  /// there twice.
  void join_repeated_grains();
  /// What to do about ids that are there again, by the table's number.
  std::string several_times(int table) const;
  /// What two rows of one grain say differently: "x = 1 and 2"; "": nothing.
  std::string difference_of(const GrainRow& a, const GrainRow& b) const;
  /// Throws unless the second table has the rows of the first and no other.
  void require_repeated(const TwoTables& tables, const Repeats& repeats, long long rows_of_first,
                        long long rows_of_second, const char* kind) const;
  void tell_repeated(const Repeats& repeats, const char* kind);
  std::int64_t index_of(std::int64_t id) const;       ///< -1: unknown
  std::int64_t wall_of(std::string_view text) const;  ///< -1 - w; 0: unknown
  /// Which of the ids of the wall a row names, from 1; 0: its name.
  int facet_of(std::int64_t wall, std::string_view text) const;
  /// nan where the file tells no spring.
  void set_spring(const std::optional<dem::Vec3>& spring, dem::Contact& contact) const;
  /// What a row of contacts tells.
  struct ContactColumns;
  /// The force ft of a table that tells ids and normal forces alone: 0, with a warning; throws
  /// where other columns may be the tangential force.
  ForeignColumn no_friction(const ForeignTable& table, const TableColumns& columns);
  ContactColumns contact_columns(const ForeignTable& table, const TableColumns& columns);
  /// Columns beside a force that tell its parts, too: they are compared, or in doubt.
  void find_parts_beside(const ForeignTable& table, const TableColumns& columns, ContactColumns& c);
  /// Counts a row whose sizes contradict its force.
  void check_sizes(const ContactRow& row);
  void tell_sizes();
  /// Remembers the vectors that a table has beside its force and nobody takes.
  void find_vectors_beside(const ForeignTable& table, const TableColumns& columns,
                           const ContactColumns& c);
  /// Warns where all forces lie along the normals and all of such a vector across them.
  void tell_vectors_beside(const ForeignTable& table, const ContactColumns& c);
  void read_contact(const ContactColumns& columns, const ForeignRow& row, int digits);
  /// The grains or the grain and the wall of a row; swapped where the wall stands first.
  struct Ends {
    std::int64_t i = 0, j = 0;
    bool swapped = false;
    int facet = 0;
    bool copied = false;  ///< one of them was told by a copy's number
  };
  Ends ends_of(const ContactColumns& columns, const ForeignRow& row, int digits) const;
  /// A grain's index or a wall, of one column; 0-based, -1 - w.
  std::optional<std::int64_t> body_of(const ForeignRow& row, const ForeignColumn& column,
                                      int digits) const;
  std::optional<std::int64_t> grain_of(const ForeignRow& row, const ForeignColumn& column,
                                       int digits) const;
  /// Columns that tell the centre of a copy.
  struct CopyColumns {
    std::array<ForeignColumn, 3> point, normal;
    ForeignColumn overlap;
  };
  /// The grain whose copy has the number `copy`, the first or the second of a row. Throws where
  /// none or several fit.
  std::int64_t original_of(const ForeignRow& row, const CopyColumns& columns, std::int64_t copy,
                           bool copy_is_first) const;
  /// Grains with a copy, but not themselves, whose surface passes `point`, `outwards` to the
  /// centre.
  std::vector<std::int64_t> originals_of(const dem::Vec3& point, const dem::Vec3& outwards,
                                         double overlap) const;
  void sort_for_copies();
  /// The grain whose centre, or that of whose image, is at a place.
  std::optional<std::int64_t> grain_at(const dem::Vec3& place) const;
  /// -1 - w of the flat wall through a place; 0: none.
  std::int64_t wall_at(const dem::Vec3& place, double radius) const;
  std::array<std::optional<std::int64_t>, 2> grains_of_line(const ContactColumns& columns,
                                                            const ForeignRow& row) const;
  /// Decides whether ids or the places of both ends tell the bodies of a table's contacts.
  void settle_lines(const ForeignTable& table, ContactColumns& columns);
  Ends ends_of_line(const ContactColumns& columns, const ForeignRow& row) const;
  /// Whether a normal of a round pair, or at a wall, points from j to i.
  bool points_backwards(const dem::Contact& c, const dem::Vec3& normal) const;
  void count_parts(const ContactColumns& columns, const ForeignRow& row);
  bool names_other_grain(const ContactColumns& c, const ForeignRow& row, int digits) const;
  /// Throws where the id of a row is that of a grain and of a wall.
  void refuse_two_meanings(const ForeignRow& row, const ForeignColumn& column) const;
  [[noreturn]] void refuse_unknown(const ForeignRow& row, const ForeignColumn& column) const;
  /// A force of normal and tangential size, on the first grain.
  /// `side`: -1 where a wall is first.
  dem::Vec3 force_of_sizes(const ContactColumns& columns, const ForeignRow& row,
                           const dem::Contact& contact, double side) const;
  /// From the first body to the second: of round grains along the line of centres, of a wall its
  /// own.
  dem::Vec3 normal_of_shapes(const ForeignRow& row, const dem::Contact& contact) const;
  /// Throws where the parts of a force do not add up to it.
  static void check_parts(const ContactColumns& columns, const ForeignRow& row);
  /// Throws unless it is a direction across the normal; makes it one to the last digit.
  static void check_tangent(const ForeignRow& row, const dem::Vec3& normal, dem::Vec3& tangent);

  void add_contact(ContactRow row, bool has_normal, bool has_point, bool tell_sliding);
  /// Image, normal and point; false: it is none, or left out.
  bool settle_pair(ContactRow& row, bool has_normal, bool has_point);
  /// What the digits of the places and radii leave open of the gap between two grains, m.
  double rounding_of_gap(const dem::Grain& a, const dem::Grain& b) const;
  /// Counts a contact whose point is far off the surface of one of its bodies that is not round.
  void check_point_of_shapes(const dem::Contact& contact);
  void set_image(ContactRow& row, bool has_normal, bool has_point) const;
  /// The touching image of a pair towards which `direction` points; the nearest
  /// where none does.
  std::array<int, 3> image_towards(const dem::Contact& contact, const dem::Vec3& direction) const;
  bool check_pair_distance(const ContactRow& row, bool has_point);
  bool settle_wall_contact(ContactRow& row, bool has_point);
  void check_wall_distance(const ContactRow& row, bool has_point) const;
  void check_periods(const ContactRow& row) const;
  /// Keeps one of the rows of a contact that stands there in both directions; throws for any other
  /// that is there twice.
  void join_directions();
  /// Drops the tables of contacts that an earlier file has, too.
  void join_repeated_contacts(std::vector<ContactRow>& rows,
                              const std::map<TwoTables, Repeats>& repeats);
  bool of_polygons(const dem::Contact& contact) const;
  [[noreturn]] void refuse_twice(const ContactRow& row, const ContactRow& other,
                                 bool same_force) const;
  void tell_tally();
  std::string known_grains() const;

  const ImportOptions& options_;
  const ImportFormat& format_;
  ColumnNames& names_;
  TableReader& reader_;
  int tables_ = 0;  // that were added
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
  struct VectorBeside {  ///< three columns (two in the plane) beside the force of a table
    std::vector<std::string> names;
    std::vector<ForeignColumn> columns;
    long long rows = 0, across = 0, unit = 0;  ///< that are not zero; across the force; directions
    void add(const ForeignRow& row, const dem::Vec3& force);
  };
  std::vector<VectorBeside> beside_;
  int place_digits_ = 0;  // most that a coordinate of the files has
  struct State {          ///< a time or step that all rows of a table tell
    std::string file, name, value;
  };
  std::vector<State> states_;
  std::map<int, std::string> time_columns_;  // names, by table of grains
  std::string first_file_;                   // of grains
  std::vector<std::int64_t> by_x_;           // of grains, where copies have numbers
  double least_radius_ = 0, largest_radius_ = 0;
  dem::Cell<3> cell_;  // of the files
  ImportedSnapshot out_;
};

}  // namespace grainfield::coupling
