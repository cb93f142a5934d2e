// Options that are little languages of their own, one a line: walls, periodic axes, columns, grids.
#include "coupling/import/format.h"
#include "coupling/import/import.h"
#include "coupling/tasks/placement.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_texts(std::string_view bytes) {
  for (const std::string& line : lines_of(bytes)) {
    attempt([&] { coupling::parse_wall(line); });
    attempt([&] { coupling::parse_periodic(line); });
    attempt([&] { coupling::parse_grid(line); });
    attempt([&] { coupling::ColumnNames(coupling::csv_format().columns).choose({line}); });
  }
}

const Registration texts_is_there("texts", fuzz_texts);

}  // namespace
}  // namespace grainfield::fuzz
