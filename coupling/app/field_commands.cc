// average and compare: the steps of a run on their own.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <sstream>
#include <vector>

#include "coupling/app/commands.h"
#include "coupling/app/options.h"
#include "coupling/app/progress_line.h"
#include "coupling/app/terminal.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/upright.h"
#include "coupling/base/printable.h"
#include "coupling/result/field_file.h"
#include "coupling/result/judgement.h"
#include "coupling/store/field_io.h"
#include "coupling/store/output_folder.h"
#include "coupling/structure/mean_stress.h"
#include "coupling/tasks/average_task.h"
#include "coupling/tasks/compare_task.h"
#include "coupling/tasks/placement.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

// Warns of points without a value; they are nan in the file.
void print_gaps(const Gaps& gaps, const Field& field) {
  std::istringstream lines(gaps.text(field.points));
  for (std::string line; std::getline(lines, line);) note("{}", line);
}

// Before a balance says how far it is.
constexpr std::chrono::seconds kBalancePatience{2};

// Every averaging on each snapshot, side by side.
void print_balance(const AverageRequest& request) {
  AverageOptions options = request.options;
  const double width = options.width;
  for (const auto& name : request.snapshots) {
    const auto read = snapshot_of(name);
    const dem::Vec3 up = up_of(*read, request.up);
    const auto held = up.isZero() ? read : upright(read, up);
    const dem::Snapshot& snapshot = *held;
    const double diameter = mean_diameter(snapshot);
    options.width = width > 0 ? width / diameter : 1;
    ProgressLine line(false);
    const auto begin = std::chrono::steady_clock::now();
    const auto rows = balance_table(snapshot, options, [&](double share) {
      if (std::chrono::steady_clock::now() - begin < kBalancePatience) return;
      line.show([&] {
        return fmt::format("balance of {}  {:.0f} %", printable_name(name.group), 100 * share);
      });
    });
    line.end();
    say("{}:{}: {} grains, {} contacts, mean diameter {:.4g} m; residual of div sigma + rho "
        "g over rho g\n{}",
        printable_name(name.file), name.group, snapshot.grains.size(), snapshot.contacts.size(),
        diameter, balance_markdown(rows));
  }
}

// The mean stress of the packings in the frame of the field, which is their own where none is up.
void print_mean_stress(const AverageRequest& request) {
  std::vector<Eigen::Matrix3d> stresses;
  int dim = 2;
  for (const auto& name : request.snapshots) {
    const auto read = snapshot_of(name);
    const dem::Vec3 up = request.frame == "packing" ? dem::Vec3(0, 0, 0) : up_of(*read, request.up);
    const auto held = up.isZero() ? read : upright(read, up);
    if (held->contacts.empty()) return;
    stresses.push_back(mean_stress(*held));
    dim = held->dim;
  }
  say("mean stress: {}\n", mean_stress_text(stresses, dim));
}

}  // namespace

void add_average(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("average", "average snapshots into a field");
  struct Given {
    std::vector<std::string> snapshots;
    std::string output;
    PointsOptions where;
    bool balance = false, end_at_walls = false;
    AverageRequest request;
  };
  auto given = std::make_shared<Given>();
  AverageRequest& wanted = given->request;
  AverageOptions& options = wanted.options;
  command
      ->add_option("snapshots", given->snapshots,
                   "FILE.h5 (all in it), FILE.h5:group, or FILE.h5:state of every realization")
      ->required();
  add_output(*command, given->output,
             "FIELD.h5; FIELD.xdmf comes beside it; or FIELD.csv, a table");
  command->add_flag("--response", wanted.response, "loaded - unloaded of the snapshots so named");
  command->add_option("--method", options.method, "coarse_graining | particle_centre | area_exact");
  auto* kernel = command->add_option(
      "--kernel", options.kernel,
      "lucy | gaussian | heaviside; of particle_centre and area_exact: circle | square");
  auto* width = add_quantity(
      *command, "--width", options.width, option_length(),
      "m; w of the kernel (lucy ends at 2 w, gaussian at 3 w, heaviside at w), of particle_centre "
      "and area_exact the circle's radius or half the square's side; default one mean diameter "
      "(particle_centre, area_exact: 2.5)");
  given->where.add_to(*command);
  command->add_flag("--rings", given->where.rings,
                    "3D: averages over rings about the frame's vertical axis; points are r,z");
  add_quantities(*command, "--axis", wanted.axis, option_length(),
                 "X,Y of the rings' axis in frame packing, m or \"80 mm\"")
      ->expected(2);
  command
      ->add_option("--cuts", wanted.cuts,
                   "horizontal cuts instead of a grid: shares of the height, 0 floor, 1 surface")
      ->delimiter(',');
  command->add_option("--quantities", options.quantities, "only these (docs/averaging.md)")
      ->delimiter(',');
  command->add_option("--free-surface", options.free_surface,
                      "coarse_graining: open | normalised (docs/averaging.md)");
  command->add_flag("--end-at-walls", given->end_at_walls,
                    "coarse_graining: branches end at walls, whose forces are in traction_*, "
                    "instead of going on into them");
  command->add_option("--least-grains", options.least_grains,
                      "fewer grains in the averaging volume: nan; default 3");
  command->add_flag("--balance", given->balance,
                    "print how well every averaging carries the weight; --width is the kernels', "
                    "RVEs take 2.5 times as much");
  add_threads(*command, options.threads, "the results do not depend on it");
  command->callback([=, &action] {
    action = [=] {
      AverageRequest& request = given->request;
      settle(request, kernel->count() > 0, width->count() > 0);
      request.options.extend_into_walls = !given->end_at_walls;
      if (given->output.empty() && !given->balance) {
        throw std::invalid_argument("average: give -o FIELD.h5, or --balance, or both");
      }
      if (!given->output.empty()) require_field_ending("-o", given->output);
      request.snapshots = parse_snapshot_names(given->snapshots);
      std::vector<std::string> inputs{given->where.points};
      for (const SnapshotName& name : request.snapshots) inputs.push_back(name.file);
      require_other_file("-o", given->output, inputs);
      request.points = given->where.read(request.snapshots);
      request.frame = given->where.frame;
      request.up = given->where.up;
      request.nx = given->where.columns;
      request.ny = given->where.rows;
      request.nz = given->where.layers;
      request.rings = given->where.rings;
      if (given->balance) {
        print_balance(request);
      }
      if (given->output.empty()) return 0;
      Gaps gaps;
      std::vector<std::string> warnings;
      const NamedFields fields = run_average(request, &gaps, &warnings);
      for (const std::string& warning : warnings) note("warning: {}", warning);
      const std::string left_out = write_field_file(given->output, fields);
      if (!left_out.empty()) note("{}", left_out);
      for (const auto& [name, field] : fields) {
        say("{}: {} points, {} realization{}\n", name, field.points.rows(), field.realizations,
            field.realizations == 1 ? "" : "s");
      }
      if (!request.response) print_mean_stress(request);
      print_gaps(gaps, fields.front().second);
      return 0;
    };
  });
}

void add_compare(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("compare", "compare averaged fields with continuum models");
  auto request = std::make_shared<CompareRequest>();
  command->add_option("fields", request->file, "FIELD.h5 of run or average")->required();
  command
      ->add_option("--model", request->models,
                   "NAME, NAME:p=v,... or LABEL=NAME:p=v,...; what the file knows is filled in: F, "
                   "h; of heaps rho_g, phi_deg, left_deg, right_deg, h")
      ->required()
      ->allow_extra_args(false);
  command->add_option("--field", request->fields, "only these fields of the file")
      ->allow_extra_args(false);
  command
      ->add_option("--components", request->lines.components,
                   "of sigma_xx, sigma_yy, sigma_xy; default sigma_yy; 3D also sigma_zz (default), "
                   "sigma_yz, sigma_xz; of rings sigma_rr, sigma_tt, sigma_zz, sigma_rz")
      ->delimiter(',')
      ->check(CLI::IsMember({"sigma_xx", "sigma_yy", "sigma_xy", "sigma_zz", "sigma_yz", "sigma_xz",
                             "sigma_rr", "sigma_tt", "sigma_rz"}));
  command
      ->add_option("--heights", request->lines.heights,
                   "rows of a map: shares of the height, 0 (the base) to 1; default 0.1,0.25,0.4 "
                   "(layers 0.75,0.5,0.25)")
      ->delimiter(',');
  add_quantities(
      *command, "--origin", request->lines.origin, option_length(),
      "X,Y (3D: X,Y,Z) of the models' origin in a field of frame packing, m or \"80 mm\"")
      ->expected(2, 3);
  add_output(*command, request->folder, "folder; default results/compare-FIELD");
  command->callback([=, &action] {
    action = [=] {
      if (request->folder.empty()) {
        request->folder = "results/compare-" + std::filesystem::path(request->file).stem().string();
      }
      const CompareOutcome outcome = [&] {
        ProgressLine line(false);
        const TaskProgress tasks(line);
        return run_compare(*request);
      }();
      if (!outcome.gone.empty()) note("{}", outcome.gone);
      if (!outcome.lacks.empty()) note("warning: {}", outcome.lacks);
      for (const std::string& line : outcome.carried) say("{}\n", line);
      say("{}\nreport: {}/report.html\n", judgement_text(outcome.comparison.judgement),
          printable_name(request->folder));
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
