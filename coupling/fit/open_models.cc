#include "coupling/fit/open_models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "continuum/open_model.h"
#include "continuum/settings.h"
#include "coupling/fit/heap_models.h"
#include "coupling/fit/layer_models.h"
#include "coupling/models/parse_choices.h"
#include "coupling/models/subject.h"

namespace grainfield::coupling {
namespace {

enum class Of { heap, layer };

constexpr const char* kFree = "free";
constexpr double kLogarithmic = 20;  // most/least of a range of moduli or ratios
constexpr int kCandidates = 64;
constexpr std::size_t kStartsPerNumber = 4;

bool in_list(const std::vector<RegistryEntry>& known, const std::string& name) {
  return std::any_of(known.begin(), known.end(),
                     [&](const RegistryEntry& entry) { return entry.name == name; });
}

bool takes_weight(const continuum::ModelInfo& info) {
  return std::any_of(info.parameters.begin(), info.parameters.end(),
                     [](const continuum::Parameter& p) { return p.name == "rho_g"; });
}

// Models of the plane, closed, and of this specimen.
bool can_be_fitted(const continuum::ModelInfo& info, Of of) {
  if (info.dim == 3 || info.name.starts_with("fe_")) return false;
  return of == Of::layer ? is_of(info, Subject::load)
                         : is_of(info, Subject::heap) && takes_weight(info);
}

std::string why_not(const continuum::ModelInfo& info, Of of) {
  if (info.name.starts_with("fe_")) {
    return "one solve takes as long as a whole search; fit a closed form, and finite_elements "
           "solves with its constants";
  }
  if (info.dim == 3)
    return "it is a model of space, and fits are of the plane; `grainfield compare` takes it";
  return of == Of::heap ? "it is no model of a heap of weight rho_g"
                        : "it is no model of a body under a load";
}

void require_fitted(const continuum::ModelInfo& info, Of of) {
  if (can_be_fitted(info, of)) return;
  std::vector<std::string> others;
  for (const continuum::ModelInfo& one : continuum::registry()) {
    if (can_be_fitted(one, of)) others.push_back(one.name);
  }
  throw std::invalid_argument(fmt::format("{} cannot be fitted here: {}; allowed: {}", info.name,
                                          why_not(info, of), fmt::join(others, ", ")));
}

// What the fit knows of its specimen is not given again.
void require_not_known(const ModelChoice& choice) {
  for (const auto& [name, value] : choice.settings) {
    for (const char* known : {"F", "h", "rho_g", "dim", "depth"}) {
      if (name == known) {
        throw std::invalid_argument(fmt::format(
            "{}: {} = {}: the fit takes it from the data; leave it out", choice.name, name, value));
      }
    }
  }
}

struct Parts {
  continuum::Settings fixed;
  std::vector<std::string> open;
};

Parts parts_of(const ModelChoice& choice) {
  Parts out;
  for (const auto& [name, value] : choice.settings) {
    if (value == kFree) {
      out.open.push_back(name);
    } else {
      out.fixed.emplace(name, value);
    }
  }
  return out;
}

// With a specimen's facts that stand for all.
void check_choice(const ModelChoice& choice, Of of) {
  require_fitted(continuum::find_model(choice.name), of);
  require_not_known(choice);
  const Parts parts = parts_of(choice);
  const RunFacts facts = of == Of::layer ? facts_of_layer() : facts_of(HeapFacts{}, choice.name);
  const ModelChoice fixed{choice.label, choice.name, parts.fixed};
  continuum::OpenModel(choice.name, filled_settings(fixed, facts), parts.open);
}

// Neither a model of the registry nor meant as one.
bool is_unknown_word(const std::string& text) {
  const auto& all = continuum::registry();
  return text.find_first_of(":=") == std::string::npos &&
         std::none_of(all.begin(), all.end(),
                      [&](const continuum::ModelInfo& info) { return info.name == text; });
}

ModelText checked(const std::string& text, const std::vector<RegistryEntry>& known, Of of) {
  if (in_list(known, text)) return {ModelText::Is::model};
  if (is_unknown_word(text)) return {ModelText::Is::no_model};
  try {
    check_choice(parse_choice(text, "model"), of);
  } catch (const std::invalid_argument& e) {
    return {ModelText::Is::refused, e.what()};
  }
  return {ModelText::Is::model};
}

FitParameter constant_of(const continuum::Parameter& p) {
  const bool length = p.unit == "m";
  return {p.name, length ? "h" : p.unit, p.meaning, p.free->least, p.free->most, p.free->floor};
}

// The k-th of well spread numbers between 0 and 1, of several series.
double spread_number(int k, std::size_t series) {
  static constexpr double kSteps[] = {0.6180339887, 0.7548776662, 0.5698402910, 0.8191725134};
  return std::fmod(0.5 + k * kSteps[series % std::size(kSteps)], 1.0);
}

double between(const FitParameter& p, double share) {
  const bool wide = p.least > 0 && p.most / p.least > kLogarithmic;
  return wide ? p.least * std::pow(p.most / p.least, share) : p.least + (p.most - p.least) * share;
}

// Points of the range that the model can take; `why`: what it says of the others.
std::vector<Eigen::VectorXd> starts_of(const std::vector<FitParameter>& constants,
                                       const continuum::OpenModel& model, std::string& why) {
  std::vector<Eigen::VectorXd> out;
  const auto n = static_cast<Eigen::Index>(constants.size());
  for (int k = 0; k < kCandidates && out.size() < kStartsPerNumber * constants.size(); ++k) {
    Eigen::VectorXd at(n);
    for (std::size_t p = 0; p < constants.size(); ++p) {
      at[static_cast<Eigen::Index>(p)] = between(constants[p], spread_number(k, p));
    }
    try {
      model.make(at);
      out.push_back(at);
    } catch (const continuum::BadParameter& e) {
      why = e.what();
    }
  }
  return out;
}

// Its friction angle, too, is at least the steeper slope.
void raise_to_slopes(const continuum::Settings& filled, std::vector<FitParameter>& constants) {
  for (FitParameter& p : constants) {
    if (p.name != "phi_deg") continue;
    for (const char* slope : {"left_deg", "right_deg"}) {
      const auto at = filled.find(slope);
      if (at != filled.end()) p.least = std::max(p.least, continuum::number_of(filled, slope));
    }
    p.most = std::max(p.most, p.least + 5);
  }
}

RegistryEntry entry_of(const ModelChoice& choice, const RunFacts& facts, double height) {
  const continuum::ModelInfo& info = continuum::find_model(choice.name);
  const Parts parts = parts_of(choice);
  RegistryEntry out{choice.label, model_label(choice), choice.name, parts.fixed, parts.open};
  out.fixed = in_units_of(height, choice.name, parts.fixed);
  for (const std::string& name : parts.open) {
    out.parameters.push_back(constant_of(continuum::free_parameter(info, name)));
  }
  const continuum::Settings filled = filled_settings({choice.label, choice.name, out.fixed}, facts);
  raise_to_slopes(filled, out.parameters);
  if (parts.open.empty()) return out;
  std::string why;
  out.starts =
      starts_of(out.parameters, continuum::OpenModel(choice.name, filled, parts.open), why);
  if (out.starts.empty()) out.absent = why;
  return out;
}

}  // namespace

ModelText check_heap_model(const std::string& text) {
  return checked(text, heap_entries({}), Of::heap);
}

ModelText check_layer_model(const std::string& text) {
  return checked(text, layer_entries(), Of::layer);
}

std::vector<RegistryEntry> chosen_entries(const std::vector<std::string>& texts,
                                          const std::vector<RegistryEntry>& known,
                                          const FactsOf& facts, double height) {
  std::set<std::string> names;
  for (const RegistryEntry& entry : known) names.insert(entry.name);
  std::vector<RegistryEntry> out;
  for (const std::string& text : texts) {
    const auto listed = std::find_if(
        known.begin(), known.end(), [&](const RegistryEntry& entry) { return entry.name == text; });
    if (listed != known.end()) {
      out.push_back(*listed);
      continue;
    }
    if (is_unknown_word(text)) {
      throw std::invalid_argument(
          fmt::format("fit: found model {}, allowed: {}", text, fmt::join(names, ", ")));
    }
    ModelChoice choice = parse_choice(text, "fit: model");
    choice.label = label_beside(names, choice.label);
    out.push_back(entry_of(choice, facts(choice.name), height));
  }
  return out;
}

}  // namespace grainfield::coupling
