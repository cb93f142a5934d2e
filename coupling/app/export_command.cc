// export: a packing or a field of ours for another program, or for the eye.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <vector>

#include "continuum/model.h"
#include "coupling/app/commands.h"
#include "coupling/app/terminal.h"
#include "coupling/case/case.h"
#include "coupling/case/shipped_cases.h"
#include "coupling/case/study.h"
#include "coupling/export/exporters.h"
#include "coupling/export/lammps_deck.h"
#include "coupling/store/added_forces.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/field_io.h"
#include "coupling/store/output_folder.h"
#include "dem/snapshot/added_forces_mark.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

constexpr std::size_t kNamed = 8;  // files, in the list of what was written

struct ExportRequest {
  std::vector<std::string> files;
  std::string to, case_file, snapshots, group, column, output;
  std::vector<std::string> sets;
  bool quick = false;
  std::vector<int> copies{1, 1};
};

/// The group asked for, or the first one that ends with "unloaded", or the first.
std::string chosen_group(const ExportRequest& given) {
  const std::vector<std::string> groups = dem::list_snapshots(given.snapshots);
  if (given.group.empty()) {
    const auto found = std::find_if(groups.begin(), groups.end(),
                                    [](const std::string& g) { return g.ends_with("unloaded"); });
    if (found != groups.end()) return *found;
    if (!groups.empty()) return groups.front();
    throw std::invalid_argument(given.snapshots +
                                ": holds no snapshot (grainfield import makes one)");
  }
  const std::string wanted = given.group.front() == '/' ? given.group : "/" + given.group;
  if (std::find(groups.begin(), groups.end(), wanted) == groups.end()) {
    throw std::invalid_argument(
        fmt::format("--group: found \"{}\", allowed: {}", given.group, fmt::join(groups, ", ")));
  }
  return wanted;
}

/// The load of the snapshot, or of the loaded one beside an unloaded one.
void take_load(const std::string& file, const std::string& group, const dem::Snapshot& packing,
               LammpsSetup& setup) {
  const auto take = [&](const dem::Snapshot& s) {
    if (s.loaded_grain < 0) return;
    setup.loaded = s.also_loaded;
    setup.loaded.insert(setup.loaded.begin(), s.loaded_grain);
    setup.force = s.applied_force;
  };
  take(packing);
  const std::string ending = "unloaded";
  if (!setup.loaded.empty() || !group.ends_with(ending)) return;
  const std::string sibling = group.substr(0, group.size() - ending.size()) + "loaded";
  const auto groups = dem::list_snapshots(file);
  if (std::find(groups.begin(), groups.end(), sibling) != groups.end()) {
    take(dem::read_snapshot(file, sibling));
  }
}

// "/realization_000/loaded" as the beginning of file names.
std::string stem_of(const std::string& group) {
  std::string out;
  for (const char ch : group) {
    const bool plain = std::isalnum(static_cast<unsigned char>(ch)) != 0 || ch == '_' || ch == '.';
    if (plain) out += ch;
    if (!plain && !out.empty() && out.back() != '-') out += '-';
  }
  return out.empty() ? "packing" : out;
}

// The names in a file, or the one asked for: with --group, or behind the file's name and a colon.
std::vector<std::string> chosen(const std::vector<std::string>& there, const std::string& wanted,
                                const std::string& file) {
  if (wanted.empty()) return there;
  for (const std::string& name : there) {
    if (name == wanted || name == "/" + wanted) return {name};
  }
  throw std::invalid_argument(fmt::format("{}: found no \"{}\", allowed: {}; did you mean {}?",
                                          file, wanted, fmt::join(there, ", "),
                                          continuum::nearest(wanted, there)));
}

// "2 files: a.vtu, b.vtu"; of many the first ones.
std::string listed(const std::vector<std::filesystem::path>& files) {
  std::string out = fmt::format("{} file{}: ", files.size(), files.size() == 1 ? "" : "s");
  for (std::size_t k = 0; k < files.size() && k < kNamed; ++k) {
    out += (k == 0 ? "" : ", ") + files[k].string();
  }
  return files.size() > kNamed ? out + ", ..." : out;
}

int export_file(const ExportRequest& given) {
  const Exporter& exporter = find_exporter(given.to);
  const auto only_of_decks = [&](const char* option, bool there) {
    if (there)
      throw std::invalid_argument(
          fmt::format("{}: found with --to {}, allowed: with --to lammps alone", option, given.to));
  };
  only_of_decks("--set", !given.sets.empty());
  only_of_decks("--quick", given.quick);
  only_of_decks("--copies", given.copies != std::vector<int>{1, 1});
  if (given.files.size() != 1) {
    throw std::invalid_argument(
        fmt::format("--to {}: found {} files, expected one, FILE.h5 or FILE.h5:NAME", given.to,
                    given.files.size()));
  }
  std::string file = given.files.front(), wanted = given.group;
  const std::size_t at = file.rfind(':');
  if (at != std::string::npos && !std::filesystem::exists(file)) {
    wanted = file.substr(at + 1);
    file = file.substr(0, at);
  }
  const std::vector<std::string> packings = dem::list_snapshots(file);
  const std::vector<std::string> fields = packings.empty() ? list_fields(file) : packings;
  if (fields.empty())
    throw std::invalid_argument(
        file + ": holds neither packings nor fields (import and import-field make them)");
  if (packings.empty() ? exporter.field == nullptr : exporter.packing == nullptr) {
    throw std::invalid_argument(fmt::format("--to {}: {} holds {}, found no form for these",
                                            given.to, file,
                                            packings.empty() ? "fields" : "packings"));
  }
  const std::vector<std::string> names = chosen(fields, wanted, file);
  OutputFolder folder(given.output, "grainfield export");
  folder.require_other_than({file});
  std::vector<std::string> done, skipped;
  for (const std::string& name : names) {
    const std::string title = std::filesystem::path(file).filename().string() + ", " + name;
    ExportTarget target{folder, stem_of(name), title, given.column, ""};
    if (packings.empty()) {
      const Field field = read_field(file, name);
      target.note = added_forces_note(field);
      try {
        exporter.field(field, target);
      } catch (const std::invalid_argument& e) {
        if (names.size() == 1) throw;
        skipped.emplace_back(e.what());
        continue;
      }
    } else {
      const dem::Snapshot packing = dem::read_snapshot(file, name);
      target.note = dem::added_forces_note(packing.attributes);
      exporter.packing(packing, target);
    }
    done.push_back(name);
  }
  if (done.empty()) throw std::invalid_argument(skipped.front());
  const auto written = folder.staged();
  note_gone(given.output, folder.publish());
  say("{} of {} as {} in {}\n{}\n",
      done.size() == 1 ? done.front() : fmt::format("{} states", done.size()), file, given.to,
      given.output, listed(written));
  for (const std::string& line : skipped) note("left out: {}", line);
  return 0;
}

/// What the case says of law, damping and time step; without a case the deck asks for them.
LammpsSetup deck_setup(const ExportRequest& given) {
  LammpsSetup setup;
  setup.copies = {given.copies.front(), given.copies.back()};
  if (given.case_file.empty()) {
    setup.known = false;
    return setup;
  }
  Case value = read_case(find_case(given.case_file), given.quick, given.sets);
  const Study& study = study_of(value);
  if (study.material == nullptr || study.motion == nullptr || study.foresee == nullptr) {
    throw std::invalid_argument(
        fmt::format("study: found \"{}\", allowed: one with grains of a [material]", study.name));
  }
  setup.material = study.material(value);
  if (study.rest != nullptr) {
    setup.background_damping = study.rest(value).background_damping;
    setup.kinetic_to_elastic_energy = study.rest(value).kinetic_to_elastic_energy;
  }
  setup.local_damping = study.motion(value).local_damping;
  constexpr std::int64_t kDraws = 1000;
  setup.time_step = study.foresee(value, kDraws).time_step;
  return setup;
}

int export_deck(ExportRequest given) {
  if (given.files.size() == 2) given.case_file = given.files.front();
  given.snapshots = given.files.back();
  if (given.case_file.empty() && (given.quick || !given.sets.empty())) {
    throw std::invalid_argument(
        "--set, --quick: found without a case, allowed: with CASE.toml before the packing");
  }
  const std::size_t colon = given.snapshots.rfind(':');
  if (colon != std::string::npos && !std::filesystem::exists(given.snapshots)) {
    given.group = given.snapshots.substr(colon + 1);
    given.snapshots.resize(colon);
  }
  const std::string group = chosen_group(given);
  const dem::Snapshot packing = dem::read_snapshot(given.snapshots, group);
  LammpsSetup setup = deck_setup(given);
  take_load(given.snapshots, group, packing, setup);
  const LammpsDeck deck = lammps_deck(packing, setup);
  OutputFolder folder(given.output, "grainfield export");
  std::vector<std::string> inputs{given.snapshots};
  if (!given.case_file.empty()) inputs.push_back(given.case_file);
  folder.require_other_than(inputs);
  write_text_file(folder.staging("packing.data"), deck.data);
  write_text_file(folder.staging("in.lammps"), deck.input);
  if (!deck.ids.empty()) write_text_file(folder.staging("ids.csv"), deck.ids);
  const auto written = folder.staged();
  note_gone(given.output, folder.publish());
  say("{} of {}: {} {}, {} walls{}\n", group, given.snapshots,
      static_cast<std::size_t>(setup.copies[0] * setup.copies[1]) * packing.grains.size(),
      packing.dim == 2 ? "disks" : "spheres", packing.walls.size(),
      setup.loaded.empty() ? "" : fmt::format(", load on {}", setup.loaded.size()));
  for (const std::string& line : deck.notes) note("note: {}", line);
  say("{}\nin {}: lmp -in in.lammps; its first lines say what it needs and how to come back\n",
      listed(written), given.output);
  return 0;
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "export",
      "packings and fields for ParaView, as tables, pictures or pages; a deck for LAMMPS");
  auto given = std::make_shared<ExportRequest>();
  command
      ->add_option("files", given->files,
                   "FILE.h5 (all in it) or FILE.h5:NAME; for lammps: CASE.toml FILE.h5, "
                   "or FILE.h5 alone where the deck may ask for the law")
      ->required()
      ->expected(1, 2);
  std::string forms = "lammps: packing and input deck";
  for (const Exporter& one : exporters()) forms += fmt::format("; {}: {}", one.name, one.meaning);
  command->add_option("--to", given->to, forms)->required();
  command->add_option("--group", given->group,
                      "the one of this name; default: all, for lammps the first unloaded one");
  command->add_option("--column", given->column,
                      "of a field's picture; default: the vertical stress, of profiles every one");
  command->add_option("--set", given->sets, "lammps: override of the case: key.path=value")
      ->allow_extra_args(false);
  command->add_flag("--quick", given->quick, "lammps: with the case's quick setting");
  command
      ->add_option("--copies", given->copies,
                   "lammps: NX NY, the packing that many times along x and y, where it repeats")
      ->expected(2)
      ->check(CLI::Range(1, 1000));
  add_output(*command, given->output, "folder")->required();
  command->callback([=, &action] {
    action = [=] { return given->to == "lammps" ? export_deck(*given) : export_file(*given); };
  });
}

}  // namespace grainfield::coupling
