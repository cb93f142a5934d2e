#include "coupling/import/import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "continuum/model.h"
#include "coupling/import/assemble.h"
#include "coupling/import/ids_table.h"
#include "coupling/import/step_names.h"
#include "coupling/import/steps.h"
#include "dem/shared/number.h"
#include "dem/snapshot/check_snapshot.h"
#include "dem/snapshot/images.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

// By its columns, under any of their names.
TableKind kind_of(const ForeignTable& table, ColumnNames& names) {
  if (table.kind != TableKind::unknown) return table.kind;
  const TableColumns columns(table, names);
  const auto has = [&](const char* ours) { return columns.find(ours).index >= 0; };
  // Forces and no places: contacts, of which a column of ids is missing.
  const bool forces = has("fx") || has("fnx") || has("fn");
  const bool sized = has("radius") || has("diameter") || has("outline");
  // Beside places and sizes i and j are indices of a lattice, or moments of inertia.
  const bool placed_grains = sized && !forces && has("x") && has("y") && has("id");
  if (!placed_grains && has("i") && (has("j") || columns.find("wall"))) return TableKind::contacts;
  if (!placed_grains && columns.find("name") && columns.find("nx")) return TableKind::walls;
  if (!sized && (has("i") || forces)) return TableKind::contacts;
  return TableKind::grains;
}

// Whether a table of contacts tells its grains by their ids, not by their places alone.
bool names_grains(const ForeignTable& table, ColumnNames& names) {
  const TableColumns columns(table, names);
  const bool line = columns.has("x1") && columns.has("x2");
  return !line || columns.has("i") || columns.has("j") || columns.has("wall");
}

ForeignTable table_of(const ArrayTable& table, TableKind kind) {
  ForeignTable out;
  out.file = table.name;
  out.kind = kind;
  std::vector<std::string> known, names;
  for (const OurColumn& column : our_columns(kind)) known.push_back(column.name);
  std::vector<ArrayColumn> arrays;
  for (const auto& [name, column] : table.columns) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw std::invalid_argument(fmt::format("{}: unknown column \"{}\"; nearest: {}; allowed: {}",
                                              table.name, name, continuum::nearest(name, known),
                                              fmt::join(known, ", ")));
    if (!arrays.empty() && column.rows() != arrays.front().rows())
      throw std::invalid_argument(fmt::format("{}: {} has {} values, {} has {}", table.name, name,
                                              column.rows(), names.front(), arrays.front().rows()));
    names.push_back(name);
    arrays.push_back(column);
  }
  out.rows = arrays.empty() ? 0 : static_cast<long long>(arrays.front().rows());
  out.columns = std::make_shared<const std::vector<std::string>>(std::move(names));
  out.arrays = std::make_shared<const std::vector<ArrayColumn>>(std::move(arrays));
  return out;
}

// The units of --units.
UnitSystem units_of(const std::string& text) {
  if (const auto units = parse_unit_system(text.empty() ? "m" : text)) return *units;
  throw std::invalid_argument(
      fmt::format("--units: found \"{}\", allowed: {}", text, kUnitSystems));
}

// What stands alone; what depends on the files is told where they are read.
void check_options(const ImportOptions& options) {
  const auto refuse = [](const std::string& text) { throw std::invalid_argument(text); };
  if (options.dim != 0 && options.dim != 2 && options.dim != 3)
    refuse(fmt::format("--dim: found {}, allowed: 2, 3", options.dim));
  if (!std::isnan(options.friction) &&
      !(options.friction >= 0 && options.friction <= kMostFriction))
    refuse(
        fmt::format("--friction: found {:g}, allowed: 0 to {:g}", options.friction, kMostFriction));
  if (!(options.time_step >= 0 && options.time_step <= dem::kMostNumber))
    refuse(fmt::format("--time-step: found {:g}, allowed: a finite number of seconds from 0",
                       options.time_step));
  const auto require_size = [&](const dem::Vec3& v, const char* option) {
    const double largest = v.cwiseAbs().maxCoeff();
    if (!(largest <= dem::kMostNumber))
      refuse(fmt::format("{}: found {:g}, allowed: up to {:g}", option, largest, dem::kMostNumber));
  };
  if (options.gravity) require_size(*options.gravity, "--gravity");
  require_size(options.applied_force, "--load");
  for (std::size_t k = 0; k < options.periodic.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)
      if (options.periodic[k].axis == options.periodic[l].axis)
        refuse(fmt::format("--periodic: axis {} is given twice, allowed: once",
                           "xyz"[options.periodic[k].axis]));
  std::set<std::string> called;
  for (const WallChoice& wall : options.walls) {
    require_size(dem::Vec3::Constant(wall.position), "--wall");
    std::set<std::string> own(wall.ids.begin(), wall.ids.end());
    own.insert(wall.name);
    for (const std::string& name : own)
      if (!called.insert(name).second)
        refuse(
            fmt::format("--wall {}: a wall is called {} already, allowed: every name and id once",
                        wall.name, name));
  }
  const auto require_name = [&](const std::string& name, const char* option) {
    try {
      if (!name.empty()) dem::check_group_name(name);
    } catch (const std::invalid_argument& e) {
      refuse(fmt::format("{}: {}", option, e.what()));
    }
  };
  require_name(options.group, "--group");
  for (const StepChoice& step : options.steps) require_name(step.group, "--step");
}

// A number without a unit; 0 needs none.
bool is_bare(std::string_view length) { return parse_number(length).value_or(0) != 0; }

// Beside another unit of the files' lengths a bare one of an option is in doubt.
void require_unit(bool bare, const std::string& option, const std::string& units) {
  if (!bare) return;
  throw std::invalid_argument(
      fmt::format("{0}: found a length without a unit beside --units {1}, expected one behind a "
                  "blank, \"... {1}\" or \"... m\"",
                  option, units));
}

// The table's numbers are in `units` (`given`: by --units), those of its cell too.
void set_units(const UnitSystem& units, bool given, ForeignTable& table) {
  const UnitSystem told = table.units;
  if (!table.unknown_units.empty() && !given)
    throw std::invalid_argument(
        table.unknown_units +
        ", allowed: si, cgs, micro, nano; --units m reads the numbers as they are, in m, kg, s");
  if (!table.told_units.empty() && !units.is_si() &&
      (units.lengths_only || units.name != told.name))
    throw std::invalid_argument(
        fmt::format("{}: the file says that it is in {} units, and --units {}", table.told_units,
                    told.name == "SI" ? "si" : told.name, units.name));
  if (table.told_units.empty()) table.units = units;
  const int length = table.units.length;
  const auto scale = [](double& number, int ten) {
    const double factor = std::pow(10.0, std::abs(ten));
    number = ten < 0 ? number / factor : number * factor;
  };
  if (table.box && length != 0) {
    dem::Cell<3> box = *table.box;
    for (double& number : box.low) scale(number, length);
    for (double& number : box.edges.reshaped()) scale(number, length);
    table.box = std::make_shared<const dem::Cell<3>>(box);
  }
  if (table.time && !table.units.lengths_only) scale(*table.time, table.units.time);
}

// What one file says of its units holds for those that say nothing; returns that, a sentence.
std::string settle_units(const UnitSystem& chosen, bool given, StepList& steps) {
  std::string where;  // the first file that says them
  UnitSystem told;
  steps.for_each([&](const ForeignTable& table) {
    if (table.told_units.empty()) return;
    if (!where.empty() && table.units.name != told.name)
      throw std::invalid_argument(
          fmt::format("{}: the file says that it is in {} units, {} says {}", table.told_units,
                      table.units.name, where, told.name));
    if (where.empty()) where = table.told_units;
    told = table.units;
  });
  const bool for_all = !where.empty() && chosen.is_si();
  std::string out;
  steps.for_each([&](ForeignTable& table) {
    const bool says = !table.told_units.empty();
    if (!says && for_all && !told.is_si() && out.empty())
      out =
          fmt::format("{}: says no units, those of {} are taken: {}", table.file, where, told.name);
    set_units(!says && for_all ? told : chosen, given, table);
  });
  return out;
}

std::string list_of(const ImportOptions& options) {
  constexpr std::size_t most = 20;
  if (options.files.size() <= most) return fmt::format("{}", fmt::join(options.files, ", "));
  return fmt::format("{}, ..., {} ({} files)", options.files.front(), options.files.back(),
                     options.files.size());
}

// The time of a step, s. Warns where the file's own time is another than --time-step makes it.
double time_of(const ForeignTable& grains, const StepChoice& choice, const ImportOptions& options,
               std::vector<std::string>& warnings) {
  const double made = static_cast<double>(choice.step) * options.time_step;
  const double time = grains.time ? *grains.time : made;
  if (!(time <= dem::kMostNumber))
    throw std::invalid_argument(
        fmt::format("--time-step {:g}: the time of step {} becomes {:g} s, allowed: up to {:g}",
                    options.time_step, choice.step, time, dem::kMostNumber));
  if (grains.time && options.time_step > 0 &&
      std::abs(made - time) > 1e-4 * std::max(std::abs(time), std::abs(made)))
    warnings.push_back(
        fmt::format("{}: step {} says that its time is {:g} s, --time-step {:g} makes it {:g} s: "
                    "the file's counts",
                    grains.file, choice.step, time, options.time_step, made));
  return time;
}

}  // namespace

WallChoice parse_wall(const std::string& text) {
  std::vector<std::string_view> parts;
  split(text, ':', parts);
  WallChoice wall;
  bool good = parts.size() >= 2 && !parts[0].empty() && parts[1].size() > 2 && parts[1][1] == '=' &&
              parts[1][0] >= 'x' && parts[1][0] <= 'z';
  if (good) {
    wall.name = std::string(parts[0]);
    wall.axis = parts[1][0] - 'x';
    const std::optional<double> position = parse_length(std::string(parts[1].substr(2)));
    good = position.has_value();
    wall.bare = is_bare(parts[1].substr(2));
    if (good) wall.position = *position;
  }
  for (std::size_t k = 2; good && k < parts.size(); ++k) {
    const std::string_view part = parts[k];
    if (part.starts_with("ids=")) {
      std::vector<std::string_view> ids;
      split(part.substr(4), ',', ids);
      wall.ids.assign(ids.begin(), ids.end());
    } else if (part.starts_with("fix=")) {
      wall.fix = std::string(part.substr(4));
    } else if (part.starts_with("material=")) {
      wall.material = std::string(part.substr(9));
    } else {
      good = false;
    }
  }
  if (!good)
    throw std::invalid_argument(
        fmt::format("--wall: found \"{}\", expected "
                    "NAME:AXIS=POSITION[:ids=A,B][:fix=f_ID][:material=M], such as "
                    "floor:y=0",
                    text));
  return wall;
}

PeriodicAxis parse_periodic(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (text.size() > 2 && text[1] == '=' && text[0] >= 'x' && text[0] <= 'z' &&
      colon != std::string::npos) {
    const auto low = parse_length(text.substr(2, colon - 2));
    const auto high = parse_length(text.substr(colon + 1));
    const bool bare = is_bare(text.substr(2, colon - 2)) || is_bare(text.substr(colon + 1));
    if (low && high && *low < *high) return {text[0] - 'x', *low, *high, bare};
  }
  throw std::invalid_argument(fmt::format(
      "--periodic: found \"{}\", expected AXIS=LOW:HIGH with LOW below HIGH, such as x=0:0.1",
      text));
}

void import_snapshots(const ImportOptions& options,
                      const std::function<void(ImportedSnapshot&&)>& take) {
  const ImportFormat& format = find_import_format(options.format);
  check_options(options);
  const UnitSystem units = units_of(options.units);
  if (units.length != 0) {
    for (const WallChoice& wall : options.walls)
      require_unit(wall.bare, "--wall " + wall.name, options.units);
    for (const PeriodicAxis& axis : options.periodic)
      require_unit(axis.bare, fmt::format("--periodic {}", "xyz"[axis.axis]), options.units);
  }
  ColumnNames names(format.columns);
  names.choose(options.columns);
  StepList steps;
  const auto tell = [&](const char* phase, std::size_t done, std::size_t all) {
    if (options.progress) options.progress(phase, done, all);
  };
  TableReader reader;
  const ReadKeys read_keys = [&](const ForeignTable& table, TableKind kind) {
    return row_keys(table, kind, names, reader);
  };
  std::vector<std::vector<ForeignTable>> found;
  std::vector<NamedFile> named;
  for (std::size_t k = 0; k < options.files.size(); ++k) {
    tell("files looked through", k, options.files.size());
    found.push_back(format.scan(options.files[k], names));
    if (!format.steps_by_name) continue;
    const auto& tables = found.back();
    const auto grains = std::find_if(tables.begin(), tables.end(), [&](const ForeignTable& table) {
      return kind_of(table, names) == TableKind::grains;
    });
    const bool any = grains != tables.end();
    named.push_back(
        {options.files[k], any,
         [&, k, at = grains - tables.begin(), any] {
           return any ? read_keys(found[k][static_cast<std::size_t>(at)], TableKind::grains)
                      : RowKeys{};
         },
         [&, k, at = grains - tables.begin(), any] {
           return any ? place_keys(found[k][static_cast<std::size_t>(at)], names, reader)
                      : RowKeys{};
         }});
  }
  const NamedSteps by_name = steps_of_names(named);
  for (std::size_t k = 0; k < found.size(); ++k)
    for (ForeignTable& table : found[k]) {
      if (format.steps_by_name) table.step = by_name.steps[k];
      const TableKind kind = kind_of(table, names);
      steps.add(std::move(table), kind);
    }
  found.clear();
  const std::string other_units = settle_units(units, !options.units.empty(), steps);
  steps.settle(format.steps_by_time, read_keys);
  names.take_taken();  // of the tables that are read it is told below
  const bool stepped = steps.stepped();
  if (!stepped && (options.all_steps || !options.steps.empty()))
    throw std::invalid_argument("--step: the files of " + format.name + " hold no time steps");
  const std::vector<StepChoice> chosen = steps.choose(options);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const StepChoice& choice = chosen[k];
    tell("steps read", k, chosen.size());
    steps.require_whole(choice.step, options);
    const StepTables& tables = steps.at(choice.step);
    Assembly assembly(options, format, names, reader);
    assembly.expect_contacts(
        std::any_of(tables.contacts.begin(), tables.contacts.end(),
                    [&](const ForeignTable& table) { return names_grains(table, names); }));
    for (const ForeignTable& table : tables.grains) assembly.add_grains(table);
    for (const ForeignTable& table : tables.walls) assembly.add_walls(table);
    assembly.settle();
    for (const ForeignTable& table : tables.contacts) {
      assembly.check_time(tables.grains.front(), table);
      assembly.add_contacts(table);
    }
    ImportedSnapshot done = assembly.finish();
    if (!options.ids_file.empty()) restore_ids(options.ids_file, done.snapshot);
    // The latest of several states is the loaded one: the others are what the load has changed.
    if (std::any_of(chosen.begin(), chosen.end(),
                    [&](const StepChoice& other) { return other.step > choice.step; })) {
      done.snapshot.applied_force.setZero();
    }
    names.require_all_used();
    const std::string plain = stepped ? fmt::format("/step_{}", choice.step) : "/packing";
    done.group =
        choice.group.empty() ? (options.group.empty() ? plain : options.group) : choice.group;
    // A time that a column tells counts where the file and --time-step tell none.
    const double of_column = done.snapshot.time;
    done.snapshot.time = time_of(tables.grains.front(), choice, options, done.warnings);
    if (!tables.grains.front().time && options.time_step == 0) done.snapshot.time = of_column;
    for (std::string& text : steps.take_warnings()) done.warnings.push_back(std::move(text));
    for (std::string& text : steps.take_notes()) done.notes.push_back(std::move(text));
    if (k == 0) {
      done.notes.insert(done.notes.end(), by_name.notes.begin(), by_name.notes.end());
      done.warnings.insert(done.warnings.end(), by_name.warnings.begin(), by_name.warnings.end());
    }
    for (std::string& text : names.take_taken()) done.notes.push_back(std::move(text));
    if (!other_units.empty()) done.notes.push_back(other_units);
    done.units = tables.grains.front().units;
    auto& attributes = done.snapshot.attributes;
    attributes["imported_from"] = format.name;
    attributes["imported_files"] = list_of(options);
    if (stepped) attributes["imported_step"] = fmt::format("{}", choice.step);
    take(std::move(done));
  }
}

ImportedSnapshot import_arrays(const ImportOptions& options, const ArrayTable& grains,
                               const ArrayTable& contacts, const ArrayTable& walls) {
  check_options(options);
  const ImportFormat format = csv_format();
  ColumnNames names(format.columns);
  TableReader reader;
  Assembly assembly(options, format, names, reader);
  const ForeignTable of_grains = table_of(grains, TableKind::grains);
  const ForeignTable of_contacts = table_of(contacts, TableKind::contacts);
  const ForeignTable of_walls = table_of(walls, TableKind::walls);
  assembly.expect_contacts(of_contacts.rows > 0);
  assembly.add_grains(of_grains);
  if (of_walls.rows > 0) assembly.add_walls(of_walls);
  assembly.settle();
  if (of_contacts.rows > 0) assembly.add_contacts(of_contacts);
  ImportedSnapshot out = assembly.finish();
  out.snapshot.attributes["imported_from"] = "arrays";
  dem::check_snapshot(out.snapshot, grains.name);
  return out;
}

}  // namespace grainfield::coupling
