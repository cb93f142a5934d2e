#include "coupling/models/subject.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace grainfield::coupling {

bool is_of(const continuum::ModelInfo& info, Subject subject) {
  const auto has = [&](const char* name) {
    return std::any_of(info.parameters.begin(), info.parameters.end(),
                       [&](const continuum::Parameter& p) { return p.name == name; });
  };
  if (subject == Subject::load) return has("F");
  return !has("F") && (has("rho_g") || has("chi_g"));
}

void require_subject(const std::vector<ModelChoice>& choices, Subject subject, int dim,
                     const std::string& key) {
  for (const ModelChoice& choice : choices) {
    if (is_of(continuum::find_model(choice.name), subject)) continue;
    std::vector<std::string> fitting;
    for (const continuum::ModelInfo& info : continuum::registry()) {
      if ((info.dim == dim || info.dim == 0) && is_of(info, subject)) fitting.push_back(info.name);
    }
    throw std::invalid_argument(
        fmt::format("{}: found \"{}\", which is no model of a {}, allowed: {}", key, choice.label,
                    subject == Subject::load ? "body under a load" : "heap under its weight",
                    fmt::join(fitting, ", ")));
  }
}

}  // namespace grainfield::coupling
