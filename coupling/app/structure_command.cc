// structure: what a packing is made of - contacts, base forces, force chains, orientation.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "coupling/app/commands.h"
#include "coupling/app/terminal.h"
#include "coupling/averaging/contact_geometry.h"
#include "coupling/base/printable.h"
#include "coupling/result/csv.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/output_folder.h"
#include "coupling/structure/mean_stress.h"
#include "coupling/structure/packing_structure.h"
#include "coupling/tasks/average_task.h"

namespace grainfield::coupling {
namespace {

// One row per grain.
std::string grains_csv(const dem::Snapshot& s, const PackingStructure& made) {
  Csv out(Csv::kAllDigits);
  out.comment("angles in degrees from x; loads tension positive, N/m (3D: N/m2)");
  out.row("id", "x", "y", "z", "fixed", "contacts", "rattler", "stress_trace", "stress_deviator",
          "compression_angle", "fabric_angle", "long_angle", "chain");
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    const dem::Grain& grain = s.grains[k];
    const GrainStructure& g = made.grains[k];
    out.row(grain.id, grain.position, grain.fixed, g.contacts, g.rattler, g.stress_trace,
            g.stress_deviator, g.compression_angle, g.fabric_angle, g.long_angle, g.chain);
  }
  return out.text();
}

std::string base_csv(const BaseForces& base) {
  Csv out(Csv::kAllDigits);
  out.comment(fmt::format("mean vertical force {} N", base.mean));
  out.row("id", "x", "force", "normalised");
  for (Eigen::Index k = 0; k < base.x.size(); ++k) {
    out.row(base.ids[static_cast<std::size_t>(k)], base.x[k], base.force[k], base.normalised[k]);
  }
  return out.text();
}

std::string counts_csv(const CoordinationCounts& counts) {
  Csv out;
  out.row("contacts", "grains", "bearing_grains");
  for (std::size_t k = 0; k < counts.with.size(); ++k) {
    out.row(k, counts.with[k], k < counts.with_bearing.size() ? counts.with_bearing[k] : 0);
  }
  return out.text();
}

void show(const std::string& title, const dem::Snapshot& s, const std::string& folder) {
  const PackingStructure made = packing_structure(s);
  const CoordinationCounts& counts = made.counts;
  const ForceChains& chains = made.chains;
  say("{}: {} free grains, {} rattlers\n", printable_name(title), counts.grains, counts.rattlers);
  if (!s.contacts.empty()) {
    say("  mean stress: {}\n", mean_stress_text({mean_stress(s)}, s.dim));
  }
  say("  coordination: {:.4g}; without rattlers {:.4g}\n", counts.mean, counts.mean_bearing);
  say("  g2 = tr F/(nu c): {:.4f}; Madadi et al. 2004 for these sizes {:.4f}\n", made.size.measured,
      made.size.theory);
  if (chains.chains.empty())
    say("  force chains: none among {} bearing grains\n", chains.bearing);
  else
    say("  force chains: {} of {:.3g} grains, {} of {} bearing grains in them\n",
        chains.chains.size(), chains.mean_length, chains.in_chains, chains.bearing);
  if (made.axes) {
    if (std::isnan(made.axes->order))
      say("  orientation: none (disks)\n");
    else
      say("  orientation: order {:.3f} along {:.1f} degrees from x\n", made.axes->order,
          made.axes->director_deg);
  }
  if (made.base) {
    const ExponentialTail& tail = made.tail;
    say("  base: {} grains, mean vertical force {:.4g} N; ", made.base->force.size(),
        made.base->mean);
    if (std::isnan(tail.rate))
      say("{} of them above the mean, too few for a tail\n", tail.count);
    else
      say("P(n) for n > 1 falls as exp(-{:.3g} n) ({:.3g} to {:.3g}), p = {:.2g}\n", tail.rate,
          tail.low, tail.high, tail.p_value);
  } else {
    say("  base: {}\n", made.no_base);
  }
  if (folder.empty()) return;
  write_text_file(folder + "grains.csv", grains_csv(s, made));
  write_text_file(folder + "coordination.csv", counts_csv(counts));
  if (made.base) write_text_file(folder + "base_forces.csv", base_csv(*made.base));
}

}  // namespace

void add_structure(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("structure", "coordination, base forces, force chains, orientation");
  auto names = std::make_shared<std::vector<std::string>>();
  auto folder = std::make_shared<std::string>();
  command
      ->add_option("snapshots", *names,
                   "FILE.h5 (all in it), FILE.h5:group, or FILE.h5:state of every realization")
      ->required();
  add_output(*command, *folder,
             "folder for grains.csv, coordination.csv, base_forces.csv, one below it per "
             "snapshot where there are several");
  command->callback([=, &action] {
    action = [=] {
      const auto snapshots = parse_snapshot_names(*names);
      std::unique_ptr<OutputFolder> results;
      if (!folder->empty()) {
        results = std::make_unique<OutputFolder>(*folder, "grainfield structure " + names->front());
        std::vector<std::string> inputs;
        for (const auto& name : snapshots) inputs.push_back(name.file);
        results->require_other_than(inputs);
      }
      int number = 0;
      for (const auto& name : snapshots) {
        const std::string inner =
            snapshots.size() > 1 ? fmt::format("snapshot_{:03}/", number++) : "";
        std::size_t idle = 0;
        const auto held = snapshot_of(name, &idle);
        if (idle > 0) note("{}:{}: {}", name.file, name.group, idle_text(idle));
        show(name.file + ":" + name.group, *held,
             results ? results->staging(inner) + (inner.empty() ? "/" : "") : "");
      }
      if (results) note_gone(*folder, results->publish());
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
