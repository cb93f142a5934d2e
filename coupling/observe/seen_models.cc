#include "coupling/observe/seen_models.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "continuum/progress.h"
#include "coupling/models/model_record.h"
#include "coupling/run/comparison_page.h"

namespace grainfield::coupling {
namespace {

// The places of every line, of the map, and of lines with few places again through kDrawnPlaces.
struct Sets {
  std::vector<PointSet> all;
  std::vector<std::size_t> drawn;  // lines
};

Sets sets_of(const Observations& observed) {
  Sets out;
  const auto add = [&](PointSet set) {
    set.points.rightCols<1>().array() -= observed.apex;
    out.all.push_back(std::move(set));
  };
  for (const ObservedLine& line : observed.lines) add(line.places);
  if (observed.map.points.size() > 0) {
    add({observed.map.points, Smoothing::none, nullptr, observed.specimen == Specimen::heap});
  }
  for (std::size_t l = 0; l < observed.lines.size(); ++l) {
    const ObservedLine& line = observed.lines[l];
    if (line.both_sides || line.places.points.rows() >= kFewPlaces) continue;
    PointSet set = line.places;
    set.points = drawn_places(set.points);
    add(std::move(set));
    out.drawn.push_back(l);
  }
  return out;
}

Eigen::VectorXd along(const ObservedLine& line, const Eigen::MatrixXd& stresses) {
  const Eigen::VectorXd values = line.sign * stresses.col(line.component);
  if (!line.both_sides) return values;
  return both_sides(Eigen::VectorXd(values.head((line.profile.x.size() + 1) / 2)));
}

// Place of a component among the models' stresses; of rings r and t stand for x and y.
int component_of(std::string component, bool space) {
  for (std::size_t k = component.size() - 2; k < component.size(); ++k) {
    if (component[k] == 'r') component[k] = 'x';
    if (component[k] == 't') component[k] = 'y';
  }
  if (component == "sigma_zx") component = "sigma_xz";
  const auto& names = space ? kSpaceStress : kPlaneStress;
  return static_cast<int>(std::find(names.begin(), names.end(), component) - names.begin());
}

}  // namespace

ObservedLine observed_line(const Field& field, const LineOf& line,
                           std::shared_ptr<const Kernel> kernel,
                           const std::vector<Eigen::Index>& at) {
  std::vector<Eigen::Index> rows = at;
  if (rows.empty()) {
    rows.resize(static_cast<std::size_t>(field.points.rows()));
    std::iota(rows.begin(), rows.end(), 0);
  }
  const bool space = field.points.cols() == 3;
  const Column& column = *field.find(line.component);
  const std::string axes = line.component.substr(line.component.size() - 2);
  ObservedLine out;
  out.sign = axes[0] == axes[1] ? -1 : 1;
  out.component = component_of(line.component, space);
  out.kernel = std::move(kernel);
  out.places = {field.points(rows, Eigen::all), line.smoothing, out.kernel.get(),
                field.is_of_heap()};
  out.both_sides = line.both_sides;
  Profile& p = out.profile;
  p.name = line.name;
  p.key = line.key;
  p.depth = -out.places.points(0, space ? 2 : 1);
  p.quantity = (out.sign < 0 ? "-" : "") + line.component;
  if (space) p.unit = "Pa";
  p.measured = field.is_measured();
  p.x = out.places.points.col(0);
  p.mean = out.sign * column.value(rows);
  if (column.error.size() == column.value.size()) p.error = column.error(rows);
  if (column.samples.rows() == column.value.size())
    p.samples = out.sign * column.samples(rows, Eigen::all);
  p.independent_length = p.measured ? 0 : out.kernel->independent_length();
  if (!line.both_sides) return out;
  p.x = coupling::both_sides(p.x);
  p.x.head(p.x.size() / 2) *= -1;
  p.mean = coupling::both_sides(p.mean);
  if (p.error.size() > 0) p.error = coupling::both_sides(p.error);
  if (p.samples.size() > 0) p.samples = coupling::both_sides(p.samples);
  p.independent_length *= 2;  // either side says the same
  return out;
}

ObservedLine pressure_line(const std::string& name, double depth, const Eigen::VectorXd& x,
                           const Eigen::MatrixXd& samples) {
  ObservedLine out;
  out.profile.name = out.profile.key = name;
  out.profile.depth = depth;
  out.profile.x = x;
  out.profile.samples = samples;
  out.profile.mean = samples.rowwise().mean();
  out.places.points.resize(x.size(), 2);
  out.places.points << x, Eigen::VectorXd::Constant(x.size(), -depth);
  return out;
}

std::vector<SeenModel> see_models(const Observations& observed,
                                  const std::vector<ModelChoice>& choices,
                                  const ModelEvaluator& evaluate,
                                  const std::function<RunFacts(const ModelChoice&)>& told) {
  const Sets sets = sets_of(observed);
  const std::size_t lines = observed.lines.size();
  std::vector<SeenModel> out;
  const auto tell = [&] {
    const auto count = static_cast<double>(choices.size());
    continuum::tell_progress("models", static_cast<double>(out.size()) / count);
  };
  for (const ModelChoice& choice : choices) {
    tell();
    SeenModel seen;
    seen.choice = choice;
    seen.told = told ? told(choice) : observed.told;
    Evaluation e = evaluate(choice, seen.told, sets.all);
    ModelProfiles& p = seen.profiles;
    p = {choice.label, model_label(choice), family_of(choice.name), {}};
    for (std::size_t l = 0; l < lines; ++l) {
      p.values.push_back(along(observed.lines[l], e.stresses[l]));
    }
    p.line_x.resize(lines);
    p.line.resize(lines);
    const std::size_t first = sets.all.size() - sets.drawn.size();
    for (std::size_t k = 0; k < sets.drawn.size(); ++k) {
      const std::size_t l = sets.drawn[k];
      p.line_x[l] = sets.all[first + k].points.col(0);
      p.line[l] = along(observed.lines[l], e.stresses[first + k]);
    }
    if (first > lines) seen.map = std::move(e.stresses[lines]);
    e.stresses.resize(lines);
    seen.stresses = std::move(e.stresses);
    seen.figures = over_grains_height(std::move(e.figures), observed.spanned());
    seen.seconds = e.seconds;
    out.push_back(std::move(seen));
  }
  tell();
  return out;
}

Comparison compared(const Observations& observed, const std::vector<SeenModel>& models) {
  std::vector<Profile> profiles;
  for (const ObservedLine& line : observed.lines) profiles.push_back(line.profile);
  std::vector<ModelProfiles> beside;
  for (const SeenModel& model : models) beside.push_back(model.profiles);
  Comparison out =
      models.empty()
          ? without_models(std::move(profiles), observed.scale, observed.realizations)
          : compare(std::move(profiles), std::move(beside), observed.scale, observed.realizations);
  out.dim = observed.told.dim;
  if (observed.specimen == Specimen::layer) out.judgement.noun = "layer";
  if (observed.specimen == Specimen::heap) out.judgement.noun = out.dim == 3 ? "cone" : "pile";
  if (!observed.note.empty()) out.judgement.notes.push_back(observed.note);
  return out;
}

void add_compared(Summary& summary, const Observations& observed, const Comparison& comparison,
                  std::size_t main) {
  if (observed.specimen == Specimen::layer) {
    add_comparison(summary, comparison, main);
    return;
  }
  for (const auto& [key, figure] : summary_figures(comparison, main)) {
    if (!key.starts_with("response.")) summary[key] = figure;  // they speak of a load
  }
}

void add_models(StudyResult& out, const Observations& observed,
                const std::vector<SeenModel>& models) {
  const Field& map = observed.map;
  double seconds = 0;
  for (const SeenModel& model : models) {
    seconds += model.seconds;
    if (map.points.size() > 0) {
      Field field = model_field(model.choice, model.told, map.points, model.map, map.nx, map.ny);
      field.nz = map.nz;
      if (observed.apex != 0) field.attributes["apex_z"] = observed.apex;
      out.fields.emplace_back("model_" + model.choice.label, std::move(field));
    }
    if (map.points.cols() == 2) {
      out.model_maps.push_back({model.profiles.label, model.map.col(1)});
    }
    add_model(out.summary, model.choice, model.figures, model.seconds);
  }
  out.summary["time.continuum_s"] = seconds;
}

}  // namespace grainfield::coupling
