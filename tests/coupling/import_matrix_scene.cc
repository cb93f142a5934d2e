#include "import_matrix_rows.h"

namespace grainfield::test {

Written write_as(Dialect d, Habit h, const Motion& m, bool after) {
  if (is_table(d)) return write_tables(d, h, m, after);
  if (is_dump(d)) return write_dumps(d, h, m, after);
  if (is_vtk(d)) return write_vtk(d, h, m, after);
  return d == Dialect::yade ? write_yade(d, h, m, after) : write_mercury(d, h, m, after);
}

}  // namespace grainfield::test
