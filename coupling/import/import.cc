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
#include "dem/snapshot/check_snapshot.h"
#include "dem/snapshot/images.h"
#include "dem/snapshot/limits.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

// A contact point farther than this many radii from its wall's plane is on another wall.
constexpr double kOddNormal = 0.5;  // cosine of the angle to the line of centres
constexpr double kOffWall = 2;
constexpr double kPulling = 1e-3;  // of the mean force: a pull below it is rounding
// Of the Coulomb limit and of the whole force: digits that files round away, and what moves slowly.
constexpr double kBeyondFriction = 1e-3, kBeyondForce = 1e-6;

// By its columns, under any of their names.
TableKind kind_of(const ForeignTable& table, ColumnNames& names) {
  if (table.kind != TableKind::unknown) return table.kind;
  const TableColumns columns(table, names);
  const auto has = [&](const char* ours) { return columns.find(ours).index >= 0; };
  if (has("i") && (has("j") || columns.find("wall"))) return TableKind::contacts;
  if (columns.find("name") && columns.find("nx")) return TableKind::walls;
  // Forces and no places: contacts, of which a column of ids is missing.
  const bool forces = has("fx") || has("fnx") || has("fn");
  const bool sized = has("radius") || has("diameter") || has("outline");
  if (!sized && (has("i") || forces)) return TableKind::contacts;
  return TableKind::grains;
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
      throw std::invalid_argument(
          fmt::format("{}: unknown column \"{}\"; allowed: {}; did you mean {}?", table.name, name,
                      fmt::join(known, ", "), continuum::nearest(name, known)));
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

// Of --units.
UnitSystem units_of(const std::string& text) {
  if (const auto units = parse_unit_system(text)) return *units;
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
bool is_bare(std::string_view length) { return dem::parse_number(length).value_or(0) != 0; }

// Beside another unit of the files' lengths a bare one of an option is in doubt.
void require_unit(bool bare, const std::string& option, const std::string& units) {
  if (!bare) return;
  throw std::invalid_argument(
      fmt::format("{0}: found a length without a unit beside --units {1}, expected one behind a "
                  "blank, \"... {1}\" or \"... m\"",
                  option, units));
}

// The table's numbers are in `units` (of --units), those of its cell too.
void set_units(const UnitSystem& units, ForeignTable& table) {
  const UnitSystem told = table.units;
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
std::string settle_units(const UnitSystem& chosen, StepList& steps) {
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
    set_units(!says && for_all ? told : chosen, table);
  });
  return out;
}

std::string list_of(const ImportOptions& options) {
  constexpr std::size_t most = 20;
  if (options.files.size() <= most) return fmt::format("{}", fmt::join(options.files, ", "));
  return fmt::format("{}, ..., {} ({} files)", options.files.front(), options.files.back(),
                     options.files.size());
}

// Of a step, s. Warns where the file's own time is another than --time-step makes it.
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
  for (const std::string& text : options.columns) names.choose(text);
  StepList steps;
  const auto tell = [&](const char* phase, std::size_t done, std::size_t all) {
    if (options.progress) options.progress(phase, done, all);
  };
  const auto steps_by_name = steps_of_names(options.files);
  for (std::size_t k = 0; k < options.files.size(); ++k) {
    tell("files looked through", k, options.files.size());
    for (ForeignTable& table : format.scan(options.files[k], names)) {
      if (format.steps_by_name) table.step = steps_by_name[k];
      const TableKind kind = kind_of(table, names);
      steps.add(std::move(table), kind);
    }
  }
  const std::string other_units = settle_units(units, steps);
  names.take_taken();  // of the tables that are read it is told below
  steps.settle(format.steps_by_time);
  const bool stepped = steps.stepped();
  if (!stepped && (options.all_steps || !options.steps.empty()))
    throw std::invalid_argument("--step: the files of " + format.name + " hold no time steps");
  TableReader reader;
  const std::vector<StepChoice> chosen = steps.choose(options);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const StepChoice& choice = chosen[k];
    tell("steps read", k, chosen.size());
    steps.require_whole(choice.step, options);
    const StepTables& tables = steps.at(choice.step);
    Assembly assembly(options, format, names, reader);
    assembly.expect_contacts(!tables.contacts.empty());
    for (const ForeignTable& table : tables.grains) assembly.add_grains(table);
    for (const ForeignTable& table : tables.walls) assembly.add_walls(table);
    assembly.settle();
    for (const ForeignTable& table : tables.contacts) assembly.add_contacts(table);
    ImportedSnapshot done = assembly.finish();
    if (!options.ids_file.empty()) restore_ids(options.ids_file, done.snapshot);
    // Of several states the latest is the loaded one: the others are what the load has changed.
    if (std::any_of(chosen.begin(), chosen.end(),
                    [&](const StepChoice& other) { return other.step > choice.step; })) {
      done.snapshot.applied_force.setZero();
    }
    names.require_all_used();
    const std::string plain = stepped ? fmt::format("/step_{}", choice.step) : "/packing";
    done.group =
        choice.group.empty() ? (options.group.empty() ? plain : options.group) : choice.group;
    done.snapshot.time = time_of(tables.grains.front(), choice, options, done.warnings);
    for (std::string& text : steps.take_warnings()) done.warnings.push_back(std::move(text));
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

dem::Snapshot import_arrays(const ImportOptions& options, const ArrayTable& grains,
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
  dem::Snapshot out = assembly.finish().snapshot;
  out.attributes["imported_from"] = "arrays";
  dem::check_snapshot(out, grains.name);
  return out;
}

namespace {

void check_coulomb_limit(const dem::Contact& c, PackingCheck& check) {
  if (!std::isfinite(c.friction)) return;
  ++check.known_friction;
  const double most = c.friction * std::max(c.normal_force, 0.0) * (1 + kBeyondFriction);
  check.beyond_friction +=
      !c.sliding && std::fabs(c.tangential_force) > most + kBeyondForce * c.force.norm();
}

// Counts a contact of two disks or spheres, whose normal is along the line of centres, or of
// polygons, whose normal is less than a right angle off it.
void check_contact_normal(const dem::Snapshot& s, const dem::Contact& c, PackingCheck& check) {
  const dem::Grain& i = s.grains[static_cast<std::size_t>(c.i)];
  const dem::Grain& j = s.grains[static_cast<std::size_t>(c.j)];
  const auto round = [](const dem::Grain& g) { return g.outline.empty() && g.axes.isZero(); };
  if (!i.outline.empty() || !j.outline.empty()) {
    ++check.polygon_pairs;
    if (c.normal.dot(dem::second_place(s, c) - i.position) >= 0) return;
    if (check.turned_normals++ > 0) return;
    check.turned_i = i.id;
    check.turned_j = j.id;
    return;
  }
  if (!round(i) || !round(j)) return;
  ++check.round_pairs;
  const dem::Vec3 branch = dem::second_place(s, c) - i.position;
  if (c.normal.dot(branch) >= kOddNormal * c.normal.norm() * branch.norm()) return;
  if (check.odd_normals++ > 0) return;
  check.odd_i = i.id;
  check.odd_j = j.id;
}

// From grain i outwards through the contact: along the centres of round grains, whatever the file's
// normal is.
dem::Vec3 outwards(const dem::Snapshot& s, const dem::Contact& c) {
  const dem::Grain& i = s.grains[static_cast<std::size_t>(c.i)];
  const auto round = [](const dem::Grain& g) { return g.outline.empty() && g.axes.isZero(); };
  if (c.j < 0 || !round(i) || !round(s.grains[static_cast<std::size_t>(c.j)])) return c.normal;
  return dem::second_place(s, c) - i.position;
}

// Counts the contacts that pull, as they are and with one component of all forces turned.
void count_pulling(const dem::Snapshot& s, double mean_force, PackingCheck& check) {
  for (const dem::Contact& c : s.contacts) {
    const dem::Vec3 parts = c.force.cwiseProduct(outwards(s, c).normalized());
    const double along = parts.sum(), least = kPulling * mean_force;
    check.bearing += std::fabs(along) > least;
    check.pulling += along > least;
    for (int axis = 0; axis < 3; ++axis) {
      check.pulling_turned[static_cast<std::size_t>(axis)] += along - 2 * parts[axis] > least;
    }
  }
}

}  // namespace

PackingCheck check_packing(const dem::Snapshot& s) {
  PackingCheck check;
  std::vector<dem::Vec3> resultant(s.grains.size(), dem::Vec3::Zero());
  std::vector<bool> touched(s.grains.size(), false);
  double force = 0;
  dem::Vec3 support = dem::Vec3::Zero(), weight = dem::Vec3::Zero();
  const auto free = [&](std::int64_t g) {
    return g >= 0 && !s.grains[static_cast<std::size_t>(g)].fixed;
  };
  const auto add = [&](Eigen::Matrix3d& sum, std::int64_t grain, const dem::Vec3& arm,
                       const dem::Vec3& f) {
    const auto g = static_cast<std::size_t>(grain);
    sum += f * arm.transpose();
    resultant[g] += f;
    touched[g] = true;
  };
  for (const dem::Contact& c : s.contacts) {
    Eigen::Matrix3d& sum = c.j >= 0 ? check.pairs : check.walls;
    add(sum, c.i, c.point - s.grains[static_cast<std::size_t>(c.i)].position, c.force);
    if (c.j >= 0) add(sum, c.j, c.point - dem::second_place(s, c), -c.force);
    if (c.j >= 0) check_contact_normal(s, c, check);
    check_coulomb_limit(c, check);
    force += c.force.norm() / static_cast<double>(s.contacts.size());
    if (free(c.i) && !free(c.j)) support += c.force;
    if (c.j < 0) {
      const dem::Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
      ++check.wall_contacts;
      if (wall.shape != "plane") continue;
      const double off = std::abs((c.point - wall.point).dot(wall.normal));
      check.off_wall_contacts += off > kOffWall * s.grains[static_cast<std::size_t>(c.i)].radius;
    }
    if (!free(c.i) && free(c.j)) support -= c.force;
  }
  count_pulling(s, force, check);
  const dem::Vec3 up = -s.gravity.normalized();  // zero without gravity
  double total = 0, squares = 0;
  int count = 0;
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    if (s.grains[g].fixed) continue;
    dem::Vec3 load = s.grains[g].mass * s.gravity;
    if (s.grains[g].id == s.loaded_grain) load += s.applied_force;
    weight += load;
    const dem::Vec3 f = resultant[g] + load;
    squares += std::pow(f.dot(up), 2);
    if (!touched[g]) continue;
    total += f.norm();
    ++count;
  }
  if (force > 0 && count > 0) check.unbalanced_force_ratio = total / count / force;
  const double g = s.gravity.norm();
  if (g > 0 && !s.contacts.empty()) {
    const dem::Vec3 down = s.gravity / g;
    check.pairs_along_gravity = down.dot(check.pairs * down);
    check.walls_along_gravity = down.dot(check.walls * down);
    // 0 - 0 is +0 where -0 would be printed.
    if (weight.dot(down) > 0) {
      check.support_ratio = (0 - support.dot(down)) / weight.dot(down);
      check.support_error = std::sqrt(squares) / weight.dot(down);
    }
  }
  return check;
}

}  // namespace grainfield::coupling
