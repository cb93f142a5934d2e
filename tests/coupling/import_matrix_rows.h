// What all dialects of the matrix have in common: numbers, ids, rows of grains and contacts.
#pragma once
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "dem/space/cell.h"
#include "import_matrix_scene.h"

namespace grainfield::test {

inline bool has_polygons(const dem::Snapshot& s) {
  return std::any_of(s.grains.begin(), s.grains.end(),
                     [](const dem::Grain& g) { return !g.outline.empty(); });
}

inline bool is_dump(Dialect d) { return d == Dialect::lammps || d == Dialect::liggghts; }
inline bool is_table(Dialect d) { return d <= Dialect::numpy; }
inline bool is_vtk(Dialect d) { return d == Dialect::vtk || d == Dialect::vtp; }

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  void rename(const std::string& from, const std::string& to) {
    for (std::string& name : names)
      if (name == from) name = to;
  }
};

class MatrixRows {
 public:
  MatrixRows(Dialect d, Habit h, const Motion& m, bool after);

 protected:
  /// A row of contacts: grain or wall, and what acts on the first.
  struct Pair {
    std::int64_t i = 0, j = 0;
    dem::Vec3 force, normal, point;
  };

  std::string num(double value) const;
  std::string id(std::size_t g) const;
  std::int64_t id_of(std::size_t g) const;
  std::string told_id(std::int64_t g) const;  ///< in contacts
  /// Every other pair the other way round, or both ways, and those of no force.
  std::vector<Pair> pairs(bool both) const;
  void add_distant(std::vector<Pair>& out) const;  ///< pairs within a cutoff, of no force
  bool both() const { return h_ == Habit::both_directions; }
  std::string wall_name(std::int64_t j) const;
  std::string wall_body(std::int64_t k) const;
  /// --wall for planes across an axis.
  void options_of_walls(long first_id, int step, const std::string& fix = "");
  std::vector<std::string> axes(const std::string& stem) const;
  void put(Table& t, const std::vector<std::string>& names) const;
  void put(std::vector<std::string>& row, const dem::Vec3& v, double factor) const;
  Table grains() const;
  Table contacts(bool points) const;
  void shuffle(Table& t) const;  ///< columns in another order
  dem::Cell<3> box() const;
  /// A file, with the line ends, encoding and compression of the habit.
  void add(const std::string& name, std::string text);
  std::string packed(const std::string& text) const;

  Dialect d_;
  Habit h_;
  const dem::Snapshot& s_;
  bool space_, periodic_ = false, keeps_images_ = false, flags_ = false;
  std::int64_t shift_ = 0;
  double length_ = 1, mass_ = 1, force_ = 1;
  std::vector<dem::Vec3> places_;
  Written out_;
};

/// The dialects, by their kinds.
Written write_tables(Dialect d, Habit h, const Motion& m, bool after);
Written write_dumps(Dialect d, Habit h, const Motion& m, bool after);
Written write_yade(Dialect d, Habit h, const Motion& m, bool after);
Written write_mercury(Dialect d, Habit h, const Motion& m, bool after);
Written write_vtk(Dialect d, Habit h, const Motion& m, bool after);

}  // namespace grainfield::test
