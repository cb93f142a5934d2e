// import: packings of other programs as snapshots.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "coupling/app/commands.h"
#include "coupling/app/options.h"
#include "coupling/app/progress_line.h"
#include "coupling/app/terminal.h"
#include "coupling/base/file_lock.h"
#include "coupling/import/format.h"
#include "coupling/import/import.h"
#include "coupling/import/packing_warnings.h"
#include "coupling/import/repeated_warnings.h"
#include "coupling/result/field_file.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/field_io.h"
#include "coupling/store/output_folder.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;

struct Given {
  ImportOptions options;
  std::string output, gravity, fixed, load, flip;
  std::vector<std::string> walls, steps, periodic;
  std::optional<double> friction;
  bool add = false;
};

// "1,2" or "1,2,3"
dem::Vec3 parse_vector(const std::string& text, const char* option) {
  std::vector<std::string_view> parts;
  split(text, ',', parts);
  dem::Vec3 v(0, 0, 0);
  bool good = parts.size() == 2 || parts.size() == 3;
  for (std::size_t k = 0; good && k < parts.size(); ++k) {
    const std::optional<double> number = parse_number(parts[k]);
    good = number && std::isfinite(*number);
    if (good) v[static_cast<Eigen::Index>(k)] = *number;
  }
  if (good) return v;
  throw std::invalid_argument(fmt::format("{}: found \"{}\", expected X,Y or X,Y,Z", option, text));
}

long long parse_whole(const std::string& text, const std::string& option) {
  const std::optional<long long> value = parse_integer(text);
  if (value && *value >= 0) return *value;
  throw std::invalid_argument(
      fmt::format("{}: found \"{}\", expected a whole number from 0", option, text));
}

void parse(Given& given) {
  ImportOptions& options = given.options;
  if (!given.gravity.empty()) options.gravity = parse_vector(given.gravity, "--gravity");
  for (const std::string& wall : given.walls) options.walls.push_back(parse_wall(wall));
  for (const std::string& axis : given.periodic) options.periodic.push_back(parse_periodic(axis));
  for (const std::string& step : given.steps) {
    if (step == "last") continue;
    if (step == "all") {
      options.all_steps = true;
      continue;
    }
    const std::size_t equals = step.find('=');
    StepChoice choice;
    choice.step = parse_whole(step.substr(0, equals), "--step");
    if (equals != std::string::npos) choice.group = step.substr(equals + 1);
    options.steps.push_back(choice);
  }
  if (given.steps.size() > 1 && options.steps.size() != given.steps.size())
    throw std::invalid_argument("--step: last and all stand alone");
  if (!given.fixed.empty()) {
    const std::size_t equals = given.fixed.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(fmt::format(
          "--fixed: found \"{}\", expected COLUMN=VALUE,..., such as type=2", given.fixed));
    options.fixed_column = given.fixed.substr(0, equals);
    std::vector<std::string_view> values;
    const std::string list = given.fixed.substr(equals + 1);
    split(list, ',', values);
    options.fixed_values.assign(values.begin(), values.end());
  }
  if (given.flip == "all" || given.flip == "true") {
    options.flip_forces = true;
  } else if (given.flip == "pairs") {
    options.flip_pairs = true;
  } else if (given.flip == "walls") {
    options.flip_walls = true;
  } else if (!given.flip.empty()) {
    throw std::invalid_argument(fmt::format(
        "--flip-forces={}: allowed: --flip-forces, --flip-forces=pairs, --flip-forces=walls",
        given.flip));
  }
  if (!given.load.empty()) {
    const std::size_t equals = given.load.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(
          fmt::format("--load: found \"{}\", expected ID=FX,FY[,FZ]", given.load));
    options.loaded_grain = parse_whole(given.load.substr(0, equals), "--load");
    options.applied_force = parse_vector(given.load.substr(equals + 1), "--load");
  }
  if (options.density < 0 || !std::isfinite(options.density))
    throw std::invalid_argument(
        fmt::format("--density: found {:g}, allowed: above 0", options.density));
  if (given.friction) {
    options.friction = *given.friction;
    if (std::isnan(options.friction))
      throw std::invalid_argument(
          fmt::format("--friction: found nan, allowed: 0 to {:g}", kMostFriction));
  }
}

// First letter: force, second: branch.
std::string tensor_text(const Eigen::Matrix3d& m, int dim) {
  std::string text;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b) text += fmt::format(" {}{} {:.15g}", "xyz"[a], "xyz"[b], m(a, b));
  return text;
}

void show(const ImportedSnapshot& imported, bool default_gravity, RepeatedWarnings& repeated,
          RepeatedWarnings& notes) {
  const dem::Snapshot& s = imported.snapshot;
  std::size_t fixed = 0, at_walls = 0;
  for (const auto& g : s.grains) fixed += g.fixed ? 1 : 0;
  for (const auto& c : s.contacts) at_walls += c.j < 0 ? 1 : 0;
  say("{}: {}D, {} grains ({} fixed), {} contacts ({} with walls), {} walls\n", imported.group,
      s.dim, s.grains.size(), fixed, s.contacts.size(), at_walls, s.walls.size());
  if (s.cell.is_periodic()) say("  {}\n", cell_text(s.cell));
  const GrainSizes sizes = grain_sizes(s);
  const std::string read_as = imported.units.is_si() ? "SI"
                              : imported.units.lengths_only
                                  ? "SI, lengths, velocities and volumes of " + imported.units.name
                                  : imported.units.name;
  say("  mean diameter {:.4g} m, density {:.4g} {} (the files are read as {})\n", sizes.diameter,
      sizes.density, s.dim == 2 ? "kg/m2" : "kg/m3", read_as);
  const auto warn = [&](const std::string& text) {
    if (repeated.is_first(imported.group, text)) note("warning: {}: {}", imported.group, text);
  };
  if (const std::string text = strange_units(s); !text.empty()) warn(text);
  for (const std::string& text : imported.warnings) warn(text);
  for (const std::string& text : imported.notes)
    if (notes.is_first(imported.group, text)) say("  {}\n", text);
  if (imported.left_out > 0)
    say("  left out: {} contacts across periodic boundaries\n", imported.left_out);
  if (imported.idle > 0)
    say("  left out: {} pairs that bear no force and do not touch (gaps)\n", imported.idle);
  if (imported.twice > 0)
    say("  {} contacts stand there in both directions: each is kept once\n", imported.twice);
  if (imported.forceless > 0)
    say("  {} contacts overlap and bear no force: kept\n", imported.forceless);
  say("  gravity: {:g} {:g} {:g} m/s2{}\n", s.gravity.x(), s.gravity.y(), s.gravity.z(),
      default_gravity ? " (default; --gravity changes it)" : "");
  if (s.contacts.empty()) return;
  const PackingCheck check = check_packing(s);
  say("  stress x volume (N m, tension positive), pairs:{}\n", tensor_text(check.pairs, s.dim));
  if (at_walls > 0)
    say("  stress x volume (N m, tension positive), walls:{}\n", tensor_text(check.walls, s.dim));
  say("  unbalanced force ratio: {:.3g}\n", check.unbalanced_force_ratio);
  if (std::isfinite(check.support_ratio))
    say("  weight carried by walls and fixed grains: {:.3g}\n", check.support_ratio);
  std::vector<std::string> warnings;
  if (const std::string text = tension_in(check); !text.empty()) {
    warnings = {text};  // all else follows from it
  } else {
    warnings = warnings_of(check);
  }
  for (const std::string& text : warnings) warn(text);
}

std::unique_ptr<FileLock> lock_for_adding(const std::string& output) {
  std::error_code error;
  const fs::path path = fs::weakly_canonical(output, error);
  return std::make_unique<FileLock>(
      (path.parent_path() / ("." + path.filename().string() + ".lock")).string(), output,
      "wait for it", "grainfield import --add");
}

}  // namespace

void add_import(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "import", "packings of LAMMPS, LIGGGHTS, YADE, MercuryDPM, VTK or CSV as snapshots");
  auto given = std::make_shared<Given>();
  ImportOptions& o = given->options;
  command->add_option("files", o.files, "grains and contacts (walls): told apart by what they hold")
      ->required();
  command->add_option("--from", o.format, "lammps | liggghts | yade | csv | mercury | vtk")
      ->required();
  add_output(*command, given->output, "SNAPSHOT.h5")->required();
  command->add_option("--units", o.units,
                      "m (default) | cm | mm | um: of the files' lengths, with velocities and "
                      "volumes; cgs | micro | nano: of all numbers (LAMMPS' sets); a column of a "
                      "CSV table may name its own, \"x (mm)\"");
  command->add_flag("--add", given->add, "add to SNAPSHOT.h5 instead of replacing it");
  command
      ->add_option(
          "--column", o.columns,
          "OURS=THEIRS, OURS=NUMBER, OURS=\"NUMBER UNIT\", or lists such as \"i,j=c_id[1..2]\"")
      ->allow_extra_args(false);
  command->add_option("--dim", o.dim, "2 | 3; default 2 where every z is the same");
  command->add_option("--gravity", given->gravity, "X,Y[,Z] in m/s2; default 9.81 down");
  add_quantity(*command, "--density", o.density, mass_per_volume(),
               "kg/m3 (2D: kg/m2) or \"2.5 g/cm3\", without a column mass or density");
  command->add_option("--friction", given->friction,
                      "Coulomb coefficient, without a column friction");
  command
      ->add_option("--wall", given->walls,
                   "NAME:AXIS=POSITION[:ids=A,B][:fix=f_ID][:material=M], such as floor:y=0")
      ->allow_extra_args(false);
  command
      ->add_option("--periodic", given->periodic,
                   "AXIS=LOW:HIGH, such as x=0:0.1; default: as a dump tells")
      ->allow_extra_args(false);
  command->add_option("--fixed", given->fixed, "COLUMN=VALUE,...: those grains are apparatus");
  command->add_option("--step", given->steps, "last (default) | all | N | N=GROUP, repeatable")
      ->allow_extra_args(false);
  add_quantity(*command, "--time-step", o.time_step, option_time(),
               "s or \"2 us\"; time of a dump = step times this");
  command->add_option("--group", o.group, "of the snapshot; default /step_N or /packing");
  command->add_option(
      "--load", given->load,
      "ID=FX,FY[,FZ]: the force applied to a grain, N; of several steps on the latest");
  command->add_option("--ids", o.ids_file,
                      "table id,original: grains get the original ids (of `export --to lammps`)");
  command->add_flag("--without-contacts", o.without_contacts, "grains alone are enough");
  command->add_flag("--flip-forces{all}", given->flip,
                    "the files' forces act on j: turn them all; --flip-forces=pairs, =walls turns "
                    "those between grains, or with walls, alone");
  command->add_flag("--leave-out-distant", o.leave_out_distant,
                    "leave out contacts across periodic boundaries, and the cell");
  command->callback([=, &action] {
    action = [=] {
      parse(*given);
      ImportOptions& options = given->options;
      require_other_file("-o", given->output, options.files);
      if (!options.ids_file.empty()) require_other_file("-o", given->output, {options.ids_file});
      require_ending("-o", given->output, {".h5", ".hdf5"}, "HDF5");
      // Who adds reads first what is there: two of them at once would each lose the other's.
      std::unique_ptr<FileLock> lock;
      if (given->add) lock = lock_for_adding(given->output);
      AtomicFile file(given->output);
      if (given->add && fs::exists(given->output)) {
        dem::list_snapshots(given->output);  // an HDF5 file of ours, or a clear refusal
        file.write_with(
            [&](const std::string& temporary) { fs::copy_file(given->output, temporary); });
      }
      std::set<std::string> groups;
      if (given->add && fs::exists(given->output))
        for (const auto& group : dem::list_snapshots(given->output)) groups.insert(group);
      ProgressLine progress(false);
      const auto start = std::chrono::steady_clock::now();
      options.progress = [&](const char* phase, std::size_t done, std::size_t all) {
        // What is done at once needs no word.
        const auto patience = std::chrono::seconds(2);
        if (all > 1 && std::chrono::steady_clock::now() - start > patience)
          progress.show([&] { return fmt::format("{}: {} of {}", phase, done, all); });
      };
      RepeatedWarnings repeated, notes;
      import_snapshots(options, [&](ImportedSnapshot&& imported) {
        progress.end();
        std::string& group = imported.group;
        if (group.front() != '/') group.insert(group.begin(), '/');
        for (const std::string& there : groups)
          if (group.starts_with(there + "/") || there.starts_with(group + "/"))
            throw std::invalid_argument(fmt::format(
                "{}: holds a snapshot {}, and {} would be one within the other; --group or --step "
                "N=GROUP names another",
                given->output, there, group));
        if (!groups.insert(group).second)
          throw std::invalid_argument(fmt::format(
              "{}: holds a snapshot {} already; --group or --step N=GROUP names another",
              given->output, group));
        file.write_with([&](const std::string& temporary) {
          dem::write_snapshot(temporary, group, imported.snapshot);
        });
        show(imported, !options.gravity, repeated, notes);
      });
      for (const std::string& line : repeated.lines()) note("warning: {}", line);
      file.commit();
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
