#include "tests/fuzz/import.h"

#include <fmt/format.h>

#include <cmath>
#include <list>
#include <stdexcept>

#include "coupling/app/terminal.h"
#include "coupling/import/import.h"
#include "coupling/import/packing_warnings.h"
#include "dem/shared/number.h"
#include "dem/snapshot/check_snapshot.h"
#include "dem/snapshot/table_file.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void choose(const std::string& line, coupling::ImportOptions& options) {
  const std::size_t space = std::min(line.find(' '), line.size());
  const std::string name = line.substr(1, space - 1);
  const std::string value = line.substr(std::min(space + 1, line.size()));
  if (name == "wall") options.walls.push_back(coupling::parse_wall(value));
  if (name == "column") options.columns.push_back(value);
  if (name == "periodic") options.periodic.push_back(coupling::parse_periodic(value));
  if (name == "dim") options.dim = value == "3" ? 3 : 2;
  if (name == "density") options.density = parse_number(value).value_or(0);
  if (name == "fixed") {
    const std::size_t equals = std::min(value.find('='), value.size());
    options.fixed_column = value.substr(0, equals);
    options.fixed_values = {value.substr(std::min(equals + 1, value.size()))};
  }
  if (name == "units") options.units = value;
  if (name == "all") options.all_steps = true;
  if (name == "alone") options.without_contacts = true;
  if (name == "flip") options.flip_forces = true;
  if (name == "near") options.leave_out_distant = true;
}

template <class Row>
void require_finite(const std::vector<dem::Column<Row>>& columns, const std::vector<Row>& rows) {
  for (const dem::Column<Row>& column : columns) {
    if (column.may_be_nan) continue;
    std::visit(
        [&](auto member) {
          using Value = decltype(dem::table::value_type(member));
          if constexpr (dem::table::is_real<Value>) {
            for (const Row& row : rows)
              for (int k = 0; k < dem::table::width_of<Value>(); ++k)
                if (!std::isfinite(dem::table::element(row.*member, k)))
                  throw std::invalid_argument(fmt::format("{} is not finite", column.name));
          }
        },
        column.member);
  }
}

// That what is written can be read again.
void check(const coupling::ImportedSnapshot& imported) {
  const dem::Snapshot& s = imported.snapshot;
  try {
    require_finite(dem::grain_columns(s.dim), s.grains);
    require_finite(dem::contact_columns(), s.contacts);
    require_finite(dem::wall_columns(), s.walls);
    dem::check_snapshot(s, imported.group);
  } catch (const std::invalid_argument& e) {
    throw std::logic_error(fmt::format("what is imported cannot be read again: {}", e.what()));
  }
}

// What the command does with a packing before and after it writes it.
void look_at(const coupling::ImportedSnapshot& imported) {
  const dem::Snapshot& s = imported.snapshot;
  check(imported);
  coupling::cell_text(s.cell);
  coupling::strange_units(s);
  const coupling::PackingCheck check = coupling::check_packing(s);
  coupling::tension_in(check);
  coupling::warnings_of(check);
}

}  // namespace

void import_bytes(const std::string& format, std::string_view bytes) {
  attempt([&] {
    coupling::ImportOptions options;
    options.format = format;
    std::vector<std::string> texts(1);
    while (!bytes.empty()) {
      const std::size_t end = std::min(bytes.find('\n'), bytes.size() - 1) + 1;
      const std::string_view line = bytes.substr(0, end);
      bytes.remove_prefix(end);
      if (!line.starts_with('%')) {
        texts.back() += line;
      } else if (line.starts_with("%%")) {
        texts.emplace_back();
      } else {
        choose(lines_of(line).front(), options);
      }
    }
    std::list<InputFile> files;
    for (const std::string& text : texts) options.files.push_back(files.emplace_back(text).path());
    coupling::import_snapshots(options, look_at);
  });
}

}  // namespace grainfield::fuzz
