// import-field: stresses measured in a laboratory as a field.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>

#include "coupling/app/commands.h"
#include "coupling/app/options.h"
#include "coupling/app/terminal.h"
#include "coupling/result/field_file.h"
#include "coupling/store/field_io.h"
#include "coupling/store/output_folder.h"
#include "coupling/tasks/measured_field.h"
#include "coupling/tasks/measured_share.h"

namespace grainfield::coupling {

void add_import_field(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("import-field", "measured stresses as a field");
  struct Given {
    MeasuredRequest request;
    std::string output, name, rho_g;
    double slope = 0;
  };
  auto given = std::make_shared<Given>();
  MeasuredRequest& r = given->request;
  command
      ->add_option("file", r.file,
                   fmt::format("CSV with columns x (UNIT), or r (UNIT) of a cone, component, value "
                               "(UNIT), error (UNIT) and, off the base, y (UNIT), in 3D z (UNIT), "
                               "up; lengths in {}; "
                               "stresses in {}; components pressure, shear or sigma_xx ...",
                               fmt::join(length_units(), " "), fmt::join(stress_units(), " ")))
      ->required();
  add_output(*command, given->output, "FIELD.h5; FIELD.xdmf comes beside it; or FIELD.csv, a table")
      ->required();
  command->add_option("--geometry", r.geometry, "heap (apex at 0, 0) | layer (load at 0, 0)");
  command->add_option("--dim", r.dim,
                      "2 | 3; default 2 without a column z or r, where 1 Pa counts as 1 N/m");
  add_quantity(*command, "--height", r.height, option_length(),
               "of the heap or layer, m or \"80 mm\"");
  auto* slope = add_quantity(*command, "--slope", given->slope, option_angle(),
                             "of both sides of a heap, degrees or \"0.5 rad\"");
  add_quantity(*command, "--left-deg", r.left_deg, option_angle(), "of the left side");
  add_quantity(*command, "--right-deg", r.right_deg, option_angle(), "of the right side");
  command->add_option("--rho-g", given->rho_g,
                      "weight per volume of a heap, N/m3 (2D: N/m2) or \"15 kN/m3\"");
  add_quantity(*command, "--load", r.load, option_force(),
               "on a layer, down, N or \"2 kN\": the values are its response");
  add_quantity(*command, "--width", r.width, option_length(),
               "radius of the measuring cells, m or \"2 mm\": models are averaged over it");
  command->add_option("--name", given->name,
                      "of the field; default base, or measured where not all is there");
  command->callback([=, &action] {
    action = [=] {
      MeasuredRequest request = given->request;
      if (slope->count() > 0) {
        if (std::isnan(request.left_deg)) request.left_deg = given->slope;
        if (std::isnan(request.right_deg)) request.right_deg = given->slope;
      }
      if (!given->rho_g.empty()) {
        request.rho_g = quantity_of("--rho-g", given->rho_g, weight_per_volume(request.dim));
      }
      require_other_file("-o", given->output, {request.file});
      require_field_ending("-o", given->output);
      const std::string assumed = settle(request);
      const Field field = measured_field(request);
      const std::string name = given->name.empty() ? name_of_measured(field) : given->name;
      write_field_file(given->output, {{name, field}});
      say("{}: {} points{}, h = {} m\n", name, field.points.rows(),
          field.points.cols() == 3 ? " in space" : "", field.number("h"));
      for (const Column& column : field.columns) {
        say("  {}: {} values, {} with errors ({})\n", column.name,
            column.value.array().isFinite().count(), column.error.array().isFinite().count(),
            column.unit);
      }
      if (!assumed.empty()) say("  {}\n", assumed);
      if (const auto share = carried_share(field)) say("  {}\n", share_text(*share));
      for (const std::string& doubt : measured_doubts(field)) note("warning: {}: {}", name, doubt);
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
