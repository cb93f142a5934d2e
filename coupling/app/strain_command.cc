// strain: displacement gradient and strain between two snapshots of the same grains.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <stdexcept>

#include "coupling/app/commands.h"
#include "coupling/app/options.h"
#include "coupling/app/terminal.h"
#include "coupling/result/field_file.h"
#include "coupling/store/field_io.h"
#include "coupling/store/output_folder.h"
#include "coupling/tasks/strain_task.h"

namespace grainfield::coupling {
namespace {

SnapshotName one_snapshot(const std::string& text) {
  const std::vector<SnapshotName> names = parse_snapshot_names({text});
  if (names.size() == 1) return names.front();
  std::vector<std::string> groups;
  for (const SnapshotName& name : names) groups.push_back(name.group);
  throw std::invalid_argument(
      fmt::format("{}: holds {} snapshots, strain takes one: {}:GROUP of {}", text, names.size(),
                  text, fmt::join(groups, ", ")));
}

}  // namespace

void add_strain(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("strain", "strain between two snapshots of the same grains");
  struct Given {
    std::string before, after, output;
    PointsOptions where;
    StrainRequest request;
  };
  auto given = std::make_shared<Given>();
  StrainOptions& options = given->request.options;
  command->add_option("before", given->before, "FILE.h5:group")->required();
  command->add_option("after", given->after, "FILE.h5:group")->required();
  add_output(*command, given->output, "FIELD.h5; FIELD.xdmf comes beside it; or FIELD.csv, a table")
      ->required();
  command->add_option("--measure", options.measure,
                      fmt::format("{} (docs/strain.md)", fmt::join(strain_measures(), " | ")));
  auto* width = add_quantity(
      *command, "--width", options.width, option_length(),
      "m; radius of the support or half its side, w of a kernel; default three mean diameters");
  auto* support = command->add_option("--support", options.support,
                                      "circle | square; of measure kernel: lucy | gaussian");
  command->add_option("--least-grains", options.least_grains,
                      "fewer grains in the support: nan; default 6");
  given->where.add_to(*command);
  add_threads(*command, options.threads, "the results do not depend on it");
  command->callback([=, &action] {
    action = [=] {
      StrainRequest& request = given->request;
      require_field_ending("-o", given->output);
      settle(request, support->count() > 0, width->count() > 0);
      request.before = one_snapshot(given->before);
      request.after = one_snapshot(given->after);
      require_other_file("-o", given->output,
                         {request.before.file, request.after.file, given->where.points});
      request.points = given->where.read({request.before});
      request.frame = given->where.frame;
      request.up = given->where.up;
      request.nx = given->where.columns;
      request.ny = given->where.rows;
      request.nz = given->where.layers;
      const StrainOutcome outcome = run_strain(request);
      write_field_file(given->output, {{"strain", outcome.field}});
      say("strain: {} points, measure {}, width {} m\n", outcome.field.points.rows(),
          request.options.measure, outcome.field.number("width"));
      if (!outcome.images.empty()) note("{}", outcome.images);
      if (!outcome.doubt.empty()) note("warning: {}", outcome.doubt);
      if (!outcome.report.empty()) {
        note("{} (places in the packing)", outcome.report);
      }
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
