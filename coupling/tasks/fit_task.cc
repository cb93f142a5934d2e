#include "coupling/tasks/fit_task.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "continuum/model.h"
#include "coupling/base/version.h"
#include "coupling/case/apply.h"
#include "coupling/case/shipped_cases.h"
#include "coupling/fit/coverage.h"
#include "coupling/fit/ensemble_fit.h"
#include "coupling/fit/heap_result.h"
#include "coupling/models/parse_choices.h"
#include "coupling/observe/setup.h"
#include "coupling/result/judgement.h"
#include "coupling/run/summary_keys.h"
#include "coupling/store/added_forces.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/field_io.h"
#include "coupling/store/output_folder.h"
#include "coupling/tasks/average_task.h"
#include "coupling/tasks/measured_field.h"
#include "coupling/tasks/measured_share.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;

// A file or a file with the name of something in it.
struct Input {
  std::string file, name;
};

Input parse_input(const std::string& text) {
  const std::size_t at = text.rfind(':');
  if (at == std::string::npos || fs::exists(text)) return {text, ""};
  return {text.substr(0, at), text.substr(at + 1)};
}

std::string last_name(const std::string& group) { return group.substr(group.rfind('/') + 1); }

// The heaps of a file that names none of them.
std::vector<SnapshotName> heaps_of(const std::string& file) {
  std::vector<SnapshotName> all, piles;
  bool steps = true, layers = false;
  for (const std::string& group : dem::list_snapshots(file)) {
    all.push_back({file, group, {}});
    if (last_name(group) == "pile") piles.push_back(all.back());
    steps = steps && last_name(group).compare(0, 5, "step_") == 0;
    layers = layers || last_name(group) == "loaded";
  }
  if (!piles.empty()) return piles;
  if (layers) {
    throw std::invalid_argument(
        fmt::format("{}: holds loaded layers; fit takes heaps (for layers: `grainfield average "
                    "--response` and `grainfield compare`)",
                    file));
  }
  if (all.size() > 1 && steps) {
    throw std::invalid_argument(fmt::format(
        "{}: holds {} time steps of one packing, which are no independent realizations; name one: "
        "{}:{}",
        file, all.size(), file, all.back().group));
  }
  return all;
}

// Fields of heaps in a file of fields: those that hold stresses in the heap's frame.
std::vector<std::string> heap_fields(const std::string& file) {
  std::vector<std::string> out;
  for (const std::string& name : list_fields(file)) {
    const Field field = read_field(file, name);
    if (!field.is_of_heap() || field.find("sigma_xx") == nullptr || !field.has("method")) continue;
    if (field.nx > 0) out.push_back(name);
  }
  return out.empty() ? list_fields(file) : out;
}

struct Chosen {
  std::vector<SnapshotName> heaps;
  std::string field_file, field;  // or one field
};

// The name of what is in memory, if anything is.
std::string first_name(const FitRequest& request) {
  if (!request.inputs.empty()) return request.inputs.front();
  return request.heaps.empty() ? "field" : request.heaps.front().file;
}

std::string quoted_list(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  for (const std::string& word : words) quoted.push_back("\"" + word + "\"");
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

Chosen choose(const std::vector<std::string>& inputs) {
  Chosen out;
  for (const std::string& text : inputs) {
    const Input input = parse_input(text);
    const std::vector<std::string> groups = dem::list_snapshots(input.file);
    const std::vector<std::string> fields = list_fields(input.file);
    if (groups.empty() && fields.empty()) {
      throw std::invalid_argument(
          input.file +
          ": holds neither snapshots nor fields (`grainfield import`, `average` and "
          "`import-field` make them)");
    }
    if (!fields.empty()) {
      if (inputs.size() > 1) {
        throw std::invalid_argument(
            fmt::format("{}: a field is fitted alone; average all packings into one (`grainfield "
                        "average --frame heap`)",
                        input.file));
      }
      out.field_file = input.file;
      const auto candidates =
          input.name.empty() ? heap_fields(input.file) : std::vector<std::string>{input.name};
      out.field = candidates.front();
      continue;
    }
    if (input.name.empty()) {
      for (SnapshotName& one : heaps_of(input.file)) out.heaps.push_back(std::move(one));
    } else {
      out.heaps.push_back({input.file, input.name, {}});
    }
  }
  require_each_once(out.heaps);
  return out;
}

HeapReader reader_of(std::vector<SnapshotName> heaps) {
  const std::size_t count = heaps.size();
  const auto name = [heaps](std::size_t k) { return heaps[k].file + ":" + heaps[k].group; };
  return {count, [heaps](std::size_t k) { return *snapshot_of(heaps[k]); }, name};
}

// The settings as TOML that --case reads back.
std::string fit_text(const Case& value, const std::vector<std::string>& packings) {
  std::string out = "# grainfield fit of\n";
  for (const std::string& name : packings) out += fmt::format("#   {}\n", name);
  out += "\n[fit]\n";
  for (const Key& key : keys()) {
    if (key.section != "fit") continue;
    out += fmt::format("# {}{}\n{} = {}\n", key.unit == "-" ? "" : key.unit + "; ", key.meaning,
                       key.name, value_text(key, value));
  }
  return out;
}

std::string coverage_of_heaps(const FitSetup& setup, const Observations& heaps,
                              const FitRequest& request) {
  std::vector<FitModel> models;
  for (const FitModel& model : models_of(setup, heaps)) {
    if (model.absent.empty()) models.push_back(model);
  }
  CoverageOptions options;
  options.sizes = request.coverage;
  options.draws = request.draws;
  options.huber = setup.huber;
  options.bootstrap = static_cast<int>(setup.bootstrap);
  options.threads = request.threads;
  return coverage_text(coverage_of(heaps.data, models, options), heaps.data.realizations());
}

// All that the user chooses of [fit], as overrides of it.
Overrides overrides_of(const FitRequest& request) {
  Overrides set = request.overrides;
  std::vector<std::string> choices;
  for (const std::string& text : request.models) {
    for (std::string& one : split_choices(text)) choices.push_back(std::move(one));
  }
  if (!choices.empty()) set.push_back("fit.models=" + quoted_list(choices));
  if (!request.heights.empty()) {
    set.push_back(fmt::format("fit.heights=[{}]", fmt::join(request.heights, ", ")));
  }
  if (!request.components.empty()) {
    set.push_back("fit.components=" + quoted_list(request.components));
  }
  if (request.width_diameters) {
    set.push_back(fmt::format("fit.width_diameters={}", *request.width_diameters));
  }
  return set;
}

// The option of fit that sets a key: fit.width_diameters has --width-diameters.
std::string option_of(const std::string& path) {
  if (path == "fit.models") return "--model";
  std::string name = path.substr(path.find('.') + 1);
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

// The first `of_set` are of --set; the others have options of their own, which their mistakes name.
std::vector<Assignment> assignments_of(const Overrides& overrides, std::size_t of_set) {
  std::vector<Assignment> out = parse_overrides(overrides);
  for (std::size_t k = of_set; k < out.size(); ++k) out[k].origin = option_of(out[k].path);
  return out;
}

// Section [fit] of a case file (other sections do not count) with overrides. Throws
// std::invalid_argument "FILE:LINE: fit.KEY: ...".
FitSetup read_fit_setup(const std::string& case_file, const Overrides& overrides,
                        std::size_t of_set) {
  Draft draft;
  draft.file = case_file;
  draft.value.study = "pile";
  MistakeList mistakes;
  if (!case_file.empty()) {
    for (const Assignment& a : read_document(case_file)) {
      if (a.path != "fit" && a.path.compare(0, 4, "fit.") != 0) continue;
      mistakes.attempt([&] { apply(draft, a); });
    }
  }
  for (const Assignment& a : assignments_of(overrides, of_set)) {
    mistakes.attempt([&] {
      if (a.path.compare(0, 4, "fit.") != 0) {
        reject(a, a.path, "found another section, allowed: fit");
      }
      apply(draft, a);
    });
  }
  mistakes.require_none();
  check_section(draft, "fit");
  FitSetup setup = draft.value.get<FitSetup>();
  if (setup.models.empty()) setup.models = kUsualHeapModels;
  return setup;
}

// What nobody has chosen follows what there is: the components, and the base where all places are
// on it.
void take_what_was_measured(const Field& field, bool of_case, const Overrides& overrides,
                            FitSetup& setup) {
  const auto chosen = [&](const std::string& key) {
    return of_case || std::any_of(overrides.begin(), overrides.end(), [&](const std::string& o) {
             return parse_override(o).path == key;
           });
  };
  if (!chosen("fit.components")) {
    std::vector<std::string> there;
    for (const std::string& name : kPlaneStress) {
      if (field.find(name) != nullptr) there.push_back(name);
    }
    if (!there.empty()) setup.components = there;
  }
  if (!chosen("fit.heights") && name_of_measured(field) == "base") setup.heights = {0};
}

// A field was averaged before.
void require_no_width(const Overrides& overrides, std::size_t of_set) {
  for (const Assignment& a : assignments_of(overrides, of_set)) {
    if (a.path != "fit.width_diameters" && a.path != "fit.kernel") continue;
    reject(a, a.path, "found a width, but the input is a field, which was averaged over its own");
  }
}

}  // namespace

FitOutcome run_fit(const FitRequest& request) {
  Case value;
  value.study = "pile";
  const Overrides overrides = overrides_of(request);
  value.get<FitSetup>() =
      read_fit_setup(request.case_file.empty() ? "" : find_case(request.case_file), overrides,
                     request.overrides.size());
  Chosen chosen = choose(request.inputs);
  if (request.field || !chosen.field.empty()) require_no_width(overrides, request.overrides.size());
  chosen.heaps.insert(chosen.heaps.end(), request.heaps.begin(), request.heaps.end());
  const std::string first = first_name(request);
  std::vector<std::string> inputs{chosen.field_file};
  for (const SnapshotName& heap : chosen.heaps)
    if (!heap.held) inputs.push_back(heap.file);
  std::optional<OutputFolder> results;
  if (!request.folder.empty()) {
    results.emplace(request.folder, "grainfield fit " + first);
    results->require_other_than(inputs);
  }
  FitOutcome out;
  Observations data;
  std::function<dem::Snapshot()> drawn;
  if (request.field || !chosen.field.empty()) {
    out.packings = {request.field ? first : chosen.field_file + ":" + chosen.field};
    const Field field =
        request.field ? *request.field : read_field(chosen.field_file, chosen.field);
    const bool measured = out.measured = field.is_measured();
    if (measured) {
      take_what_was_measured(field, !request.case_file.empty(), overrides, value.get<FitSetup>());
    }
    data = observe_heap_field(value.get<FitSetup>(), field, out.packings.front());
    if (const std::string note = added_forces_note(field); !note.empty()) {
      data.warnings.push_back(fmt::format("{}: {}", out.packings.front(), note));
      data.scale.note += "; " + note;
    }
    if (measured) {
      if (const auto share = carried_share(field)) out.carried = share_text(*share);
      const std::vector<std::string> doubts = measured_doubts(field);
      data.warnings.insert(data.warnings.end(), doubts.begin(), doubts.end());
    }
  } else {
    const HeapReader heaps = reader_of(chosen.heaps);
    for (std::size_t k = 0; k < heaps.count; ++k) out.packings.push_back(heaps.name(k));
    data = observe_heaps(value.get<FitSetup>(), heaps, request.threads);
    drawn = [heaps] { return heaps.read(0); };
  }
  value.name = fs::path(first).stem().string();
  value.title = "Fit of " + fs::path(first).filename().string();
  out.warnings = data.warnings;
  if (!request.coverage.empty()) {
    out.coverage = coverage_of_heaps(value.get<FitSetup>(), data, request);
    if (results) write_text_file(results->staging("coverage.md"), out.coverage);
  }
  const auto observe = [&](const FitSetup& setup) {
    return observe_heaps(setup, reader_of(chosen.heaps), request.threads);
  };
  HeapResult made = heap_result(value, std::move(data), request.threads, observe, drawn);
  StudyResult& result = made.study;
  out.note = std::get<std::string>(result.summary.at("fit.weights"));
  result.summary["version"] = version_and_commit();
  result.summary["ensemble.realizations"] =
      static_cast<std::int64_t>(result.comparison.realizations);
  add_judgement(result.summary, result.comparison.judgement);
  require_documented(result.summary);
  const std::string settings = fit_text(value, out.packings);
  result.summary["case.hash"] = hash_text(settings);
  if (results) {
    write_profiles(results->staging(), result.comparison);
    write_judgement(results->staging(), result.comparison.judgement);
    for (const auto& [name, text] : result.texts) write_text_file(results->staging(name), text);
    write_text_file(results->staging("fit.toml"), settings);
    out.lacks =
        write_report(results->staging("report.html"), result.page(result, nullptr)).complaint();
    write_summary(results->staging("summary.json"), result.summary);
    out.gone = gone_note(request.folder, results->publish());
  }
  out.constants = std::move(result.constants);
  out.comparison = std::move(result.comparison);
  out.summary = std::move(result.summary);
  out.fits = std::move(made.fits);
  return out;
}

}  // namespace grainfield::coupling
