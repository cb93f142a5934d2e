// model: a continuum model at the user's points.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "continuum/cylindrical.h"
#include "continuum/model.h"
#include "continuum/settings.h"
#include "coupling/app/commands.h"
#include "coupling/app/points_csv.h"
#include "coupling/app/progress_line.h"
#include "coupling/app/terminal.h"
#include "coupling/models/fit_names.h"
#include "coupling/models/parse_choices.h"
#include "coupling/result/field_file.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/field_io.h"
#include "coupling/store/output_folder.h"

namespace grainfield::coupling {
namespace {

std::string range_of(const continuum::Parameter& p) {
  if (!p.choices.empty()) return fmt::format("{}", fmt::join(p.choices, " | "));
  if (continuum::is_text(p)) return "any text";
  // Bounds this far out mean none; the smallest positive number means "above 0".
  constexpr double kFar = 1e300;
  std::string low = p.least < -kFar ? ""
                    : p.least == std::numeric_limits<double>::min()
                        ? "above 0"
                        : fmt::format("from {:g}", p.least);
  const std::string high = p.most > kFar ? "" : fmt::format("up to {:g}", p.most);
  if (low.empty() && high.empty()) return "any";
  return low + (low.empty() || high.empty() ? "" : " ") + high;
}

void list_models() {
  for (const auto& info : continuum::registry()) {
    say("{:<24} {}  {}\n", info.name,
        info.dim == 0   ? "2D or 3D"
        : info.dim == 2 ? "2D      "
                        : "3D      ",
        info.summary);
  }
  std::vector<std::string> names;
  for (const FitName& one : fit_names()) {
    if (!one.registry.empty()) names.push_back(one.name);
  }
  say("with the names that fits give: {}\n", fmt::join(names, ", "));
  say("grainfield model NAME --list shows a model's parameters\n");
}

void list_parameters(const std::string& name, const continuum::ModelInfo& info) {
  say("{}: {}\n", name, info.summary);
  if (const FitName* known = find_fit_name(name)) {
    const auto fixed = known->fixed.begin();
    say("  it is {} with {}\n", info.name,
        known->fixed.empty() ? known->needs : fmt::format("{} = {}", fixed->first, fixed->second));
  }
  for (const auto& p : info.parameters) {
    say("  {} = {}  ({}; {})\n      {}{}\n", p.name,
        !p.choices.empty()      ? p.choices.front()
        : continuum::is_text(p) ? "\"\""
        : std::isnan(p.value)   ? "(unset)"
                                : fmt::format("{:g}", p.value),
        p.unit.empty() || p.unit == "-" ? "no unit" : p.unit, range_of(p), p.meaning,
        p.source.empty() ? "" : " [" + p.source + "]");
  }
}

}  // namespace

void add_model(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("model", "evaluate a continuum model at points");
  struct Given {
    std::string name, points, output;
    std::vector<std::string> sets;
    bool list = false, all = false, figures = false, cylindrical = false;
  };
  auto given = std::make_shared<Given>();
  command->add_option("name", given->name, "model; without it the models are listed");
  command->add_option("--set", given->sets, "parameter=value")->allow_extra_args(false);
  command->add_option("--points", given->points, "CSV with columns x,y or x,y,z (m, load at 0,0)");
  add_output(*command, given->output, "CSV of stresses; without it on the terminal");
  command->add_flag("--all", given->all,
                    "also what the model knows besides the stress, e.g. displacements");
  command->add_flag("--cylindrical", given->cylindrical,
                    "3D: components rr, tt, zz, tz, rz, rt, r away from the vertical through the "
                    "load, t along the circle");
  command->add_flag("--figures", given->figures,
                    "begin with lines '# name = value' of the evaluation, e.g. its iterations");
  command->add_flag("--list", given->list, "show the model's parameters");
  command->callback([=, &action] {
    action = [=] {
      if (given->name.empty()) {
        list_models();
        return 0;
      }
      if (given->list) {
        const FitName* known = find_fit_name(given->name);
        const bool named = known != nullptr && !known->registry.empty();
        list_parameters(given->name, continuum::find_model(named ? known->registry : given->name));
        return 0;
      }
      if (given->points.empty())
        throw std::invalid_argument(
            "model: --points is missing, a CSV with columns x,y or x,y,z (m)");
      if (!given->output.empty()) {
        require_other_file("-o", given->output, {given->points});
        require_ending("-o", given->output, {".csv", ".txt", ".dat"}, "a table as CSV");
      }
      const ModelChoice choice =
          in_registry({given->name, given->name, parse_settings(given->sets, "--set")});
      const auto& info = continuum::find_model(choice.name);
      const auto& settings = choice.settings;
      ProgressLine line(false);
      auto progress = std::make_unique<TaskProgress>(line);
      const auto model = continuum::make_model(choice.name, settings);
      const int dim = continuum::dimension(info, settings);
      if (given->cylindrical && dim != 3) {
        throw std::invalid_argument(
            fmt::format("model: --cylindrical is for models of space; {} is of the plane",
                        info.name + (info.dim == 0 ? " without --set dim=3" : "")));
      }
      const auto points = read_points_csv(given->points, dim);
      auto stresses = model->stress(points);
      if (given->cylindrical) stresses = continuum::in_cylindrical_axes(points, stresses);
      progress.reset();
      Eigen::Index outside = 0;
      for (Eigen::Index k = 0; k < stresses.rows(); ++k) outside += stresses.row(k).hasNaN();
      if (outside > 0) {
        note("{} of {} points are outside the model's domain: nan", outside, points.rows());
      }
      std::string text =
          stresses_csv(points, stresses,
                       given->all ? model->quantities(points) : std::vector<continuum::Quantity>(),
                       given->cylindrical);
      if (given->figures) {
        std::string lines;
        for (const auto& [figure, value] : model->figures())
          lines += fmt::format("# {} = {}\n", figure, value);
        text.insert(0, lines);
      }
      if (given->output.empty()) {
        say("{}", text);
      } else {
        write_text_file(given->output, text);
      }
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
