// export: a packing of ours as the input of another program.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "coupling/app/commands.h"
#include "coupling/app/terminal.h"
#include "coupling/case/case.h"
#include "coupling/case/shipped_cases.h"
#include "coupling/case/study.h"
#include "coupling/export/lammps_deck.h"
#include "coupling/output/atomic_file.h"
#include "coupling/output/output_folder.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

struct ExportRequest {
  std::string to, case_file, snapshots, group, output;
  std::vector<std::string> sets;
  bool quick = false;
};

/// The group asked for, or the first one that ends with "unloaded", or the first.
std::string chosen_group(const ExportRequest& given) {
  const std::vector<std::string> groups = dem::list_snapshots(given.snapshots);
  if (given.group.empty()) {
    const auto found = std::find_if(groups.begin(), groups.end(),
                                    [](const std::string& g) { return g.ends_with("unloaded"); });
    if (found != groups.end()) return *found;
    if (!groups.empty()) return groups.front();
    throw std::invalid_argument(given.snapshots + ": holds no snapshot");
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

int export_packing(const ExportRequest& given) {
  if (given.to != "lammps") {
    throw std::invalid_argument(fmt::format("--to: found \"{}\", allowed: lammps", given.to));
  }
  Case value = read_case(find_case(given.case_file), given.quick, given.sets);
  const Study& study = study_of(value);
  if (study.material == nullptr || study.motion == nullptr || study.foresee == nullptr) {
    throw std::invalid_argument(
        fmt::format("study: found \"{}\", allowed: one with grains of a [material]", study.name));
  }
  const std::string group = chosen_group(given);
  const dem::Snapshot packing = dem::read_snapshot(given.snapshots, group);
  LammpsSetup setup;
  setup.material = study.material(value);
  if (study.rest != nullptr) setup.background_damping = study.rest(value).background_damping;
  constexpr std::int64_t kDraws = 1000;
  setup.time_step = study.foresee(value, kDraws).time_step;
  take_load(given.snapshots, group, packing, setup);
  const LammpsDeck deck = lammps_deck(packing, setup);
  OutputFolder folder(given.output, "grainfield export");
  folder.require_other_than({given.case_file, given.snapshots});
  write_text_file(folder.staging("packing.data"), deck.data);
  write_text_file(folder.staging("in.lammps"), deck.input);
  folder.publish();
  say("{} of {}: {} spheres, {} walls{}\n", group, given.snapshots, packing.grains.size(),
      packing.walls.size(),
      setup.loaded.empty() ? "" : fmt::format(", load on {}", setup.loaded.size()));
  for (const std::string& line : deck.notes) note("note: {}", line);
  say("in {}: lmp -in in.lammps; its first lines say how to come back\n", given.output);
  return 0;
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("export", "a packing of spheres as LAMMPS' data and input deck");
  auto given = std::make_shared<ExportRequest>();
  command->add_option("case", given->case_file, "case file with law, friction and damping")
      ->required();
  command->add_option("snapshots", given->snapshots, "HDF5 file of ours")->required();
  command->add_option("--to", given->to, "lammps")->required();
  command->add_option("--group", given->group, "snapshot; default: the first unloaded one");
  command->add_option("--set", given->sets, "override of the case: key.path=value")
      ->allow_extra_args(false);
  command->add_flag("--quick", given->quick, "with the case's quick setting");
  add_output(*command, given->output, "folder")->required();
  command->callback([=, &action] { action = [=] { return export_packing(*given); }; });
}

}  // namespace grainfield::coupling
