#include "coupling/run/compare_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "coupling/averaging/kernel.h"
#include "coupling/compare/compare.h"
#include "coupling/output/field_io.h"
#include "coupling/output/tables.h"
#include "coupling/report/point_load.h"
#include "coupling/run/models.h"
#include "coupling/run/study_result.h"
#include "coupling/run/summary_keys.h"

namespace grainfield::coupling {
namespace {

// One horizontal line of a field.
struct Line {
  Profile profile;
  Eigen::MatrixXd points;
  bool base = false;
};

std::string attribute(const Field& field, const std::string& name, const std::string& where) {
  const auto at = field.attributes.find(name);
  if (at == field.attributes.end()) {
    throw std::invalid_argument(fmt::format(
        "{}: has no attribute \"{}\"; fields come from `grainfield run` or `grainfield average "
        "--response`",
        where, name));
  }
  return at->second;
}

double number(const Field& field, const std::string& name, const std::string& where) {
  return std::stod(attribute(field, name, where));
}

Line line_of(const Field& field, Eigen::Index first, Eigen::Index count, const std::string& name,
             const std::string& key, const std::string& where) {
  const Column* column = field.find("sigma_yy");
  if (column == nullptr || field.points.cols() != 2) {
    throw std::invalid_argument(where + ": has no column \"sigma_yy\" in two dimensions");
  }
  Line out;
  out.points = field.points.middleRows(first, count);
  if ((out.points.col(1).array() != out.points(0, 1)).any()) {
    throw std::invalid_argument(where + ": its points are neither a horizontal line nor a grid");
  }
  out.profile.name = name;
  out.profile.key = key;
  out.profile.depth = -out.points(0, 1);
  out.profile.x = out.points.col(0);
  out.profile.mean = -column->value.segment(first, count);
  if (column->error.size() == column->value.size()) {
    out.profile.error = column->error.segment(first, count);
  }
  out.base = name.compare(0, 4, "base") == 0;
  return out;
}

// The whole field where it is a line; of a grid the rows nearest to 1/4, 1/2 and 3/4 of the depth.
std::vector<Line> lines_of(const Field& field, const std::string& name, const std::string& where) {
  if (field.nx == 0) return {line_of(field, 0, field.points.rows(), name, name, where)};
  std::vector<Line> out;
  for (const double share : {0.25, 0.5, 0.75}) {
    const auto row = static_cast<Eigen::Index>(std::lround((1 - share) * (field.ny - 1)));
    out.push_back(line_of(field, row * field.nx, field.nx,
                          fmt::format("{} at depth {:g} h", name, share),
                          fmt::format("depth_{:g}", share), where));
  }
  return out;
}

std::vector<std::string> chosen(const CompareRequest& request) {
  if (!request.fields.empty()) return request.fields;
  std::vector<std::string> lines, maps;
  for (const auto& name : list_fields(request.file)) {
    const Field field = read_field(request.file, name);
    if (field.find("sigma_yy") == nullptr || field.attributes.count("F") == 0) continue;
    if (name == "base_unloaded" || name.compare(0, 6, "model_") == 0) continue;
    if (name.find("_unloaded") != std::string::npos) continue;
    if (name.compare(0, 15, "particle_centre") == 0) continue;
    (field.nx == 0 ? lines : maps).push_back(name);
  }
  // A file of a run holds lines at its depths; one of `average` a map and the base.
  if (lines.empty() || (lines.size() == 1 && lines.front() == "base_response")) {
    lines.insert(lines.begin(), maps.begin(), maps.end());
  }
  if (lines.empty()) {
    throw std::invalid_argument(request.file +
                                ": holds no response to compare (made with --response?)");
  }
  return lines;
}

}  // namespace

std::string compare_field(const CompareRequest& request) {
  std::vector<Line> lines;
  RunFacts facts;
  std::unique_ptr<Kernel> kernel;
  Field map;
  int realizations = 1;
  for (const auto& name : chosen(request)) {
    const Field field = read_field(request.file, name);
    const std::string where = request.file + ":" + name;
    facts.force = number(field, "F", where);
    facts.height = number(field, "h", where);
    realizations = field.realizations;
    const bool kernel_known = attribute(field, "method", where) == "coarse_graining";
    kernel = make_kernel(kernel_known ? attribute(field, "kernel", where) : "heaviside",
                         number(field, "width", where));
    for (auto& line : lines_of(field, name, where)) {
      const double depth = line.profile.depth;
      facts.depth = facts.depth > 0 ? std::min(facts.depth, depth) : depth;
      lines.push_back(std::move(line));
    }
    if (field.nx > 0) map = field;
  }
  std::vector<PointSet> sets;
  std::vector<Profile> profiles;
  std::size_t main = lines.size() - 1;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    sets.push_back({lines[l].points, lines[l].base ? Seen::along_x : Seen::in_plane, kernel.get()});
    lines[l].profile.independent_length = kernel->independent_length();
    profiles.push_back(lines[l].profile);
    if (lines[l].base) main = l;
  }
  if (map.nx > 0) sets.push_back({map.points, Seen::exactly, nullptr});

  StudyResult result;
  result.value.name = std::filesystem::path(request.file).filename().string();
  std::vector<ModelProfiles> models;
  for (const auto& choice : request.models) {
    const Evaluation e = evaluate_model(choice, facts, sets);
    ModelProfiles m{choice.label, model_label(choice), family_of(choice.name), {}};
    for (std::size_t l = 0; l < lines.size(); ++l) m.values.emplace_back(-e.stresses[l].col(1));
    models.push_back(std::move(m));
    if (map.nx > 0) result.model_maps.push_back({model_label(choice), e.stresses.back().col(1)});
    result.summary["model." + choice.label + ".name"] = choice.name;
    for (const auto& [key, figure] : e.figures) {
      result.summary["model." + choice.label + "." + key] = figure;
    }
  }
  const Comparison comparison =
      compare(std::move(profiles), std::move(models), facts.force, facts.height, realizations);
  result.summary["version"] = std::string(GRAINFIELD_VERSION);
  result.summary["ensemble.realizations"] = static_cast<std::int64_t>(realizations);
  result.summary["layer.depth"] = facts.height;
  result.summary["layer.F_over_h"] = facts.force / facts.height;
  add_comparison(result.summary, comparison, main);
  require_documented(result.summary);

  std::error_code error;
  std::filesystem::create_directories(request.folder, error);
  if (error) {
    throw std::invalid_argument(
        fmt::format("{}: cannot write there: {}", request.folder, error.message()));
  }
  PointLoadReport page;
  page.title = "Comparison of " + request.file;
  page.comparison = comparison;
  page.map = map;
  page.models = result.model_maps;
  page.made = {{"fields", request.file}, {"version", GRAINFIELD_VERSION}};
  write_profiles(request.folder, comparison);
  write_report(request.folder + "/report.html", point_load_report(page));
  write_summary(request.folder + "/summary.json", result.summary);
  return comparison.verdict.sentence;
}

}  // namespace grainfield::coupling
