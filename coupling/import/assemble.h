// Tables of one step to a snapshot.
#pragma once
#include <string>
#include <vector>

#include "coupling/import/format.h"
#include "coupling/import/import.h"

namespace grainfield::coupling {

class Assembly {
 public:
  Assembly(const ImportOptions& options, const ImportFormat& format, ColumnNames& names,
           TableReader& reader)
      : options_(options), format_(format), names_(names), reader_(reader) {}

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
    int volume_ten = 0;  ///< a volume is of lengths times 10 to this
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
  std::int64_t index_of(std::int64_t id) const;       ///< -1: unknown
  std::int64_t wall_of(std::string_view text) const;  ///< -1 - w; 0: unknown
  /// nan where the file tells no spring.
  void set_spring(const std::optional<dem::Vec3>& spring, dem::Contact& contact) const;
  void add_contact(ContactRow row, bool has_normal, bool has_point, bool tell_sliding);
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
  dem::Cell<3> cell_;  // of the files
  ImportedSnapshot out_;
};

}  // namespace grainfield::coupling
