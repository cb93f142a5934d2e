#include "coupling/models/model_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "coupling/result/key_pattern.h"

namespace grainfield::coupling {

Field model_field(const ModelChoice& choice, const RunFacts& facts, const Eigen::MatrixXd& points,
                  const Eigen::MatrixXd& stress, int columns, int rows) {
  Field out;
  out.points = points;
  out.nx = columns;
  out.ny = rows;
  const bool plane = stress.cols() == 3;
  const auto names = plane ? std::vector<const char*>{"sigma_xx", "sigma_yy", "sigma_xy"}
                           : std::vector<const char*>{"sigma_xx", "sigma_yy", "sigma_zz",
                                                      "sigma_yz", "sigma_xz", "sigma_xy"};
  for (std::size_t c = 0; c < names.size(); ++c) {
    out.add(names[c], plane ? "N/m" : "Pa").value = stress.col(static_cast<Eigen::Index>(c));
  }
  out.attributes["model"] = choice.name;
  for (const auto& [name, setting] : filled_settings(choice, facts)) {
    out.attributes["model." + name] = setting;
  }
  if (choice.below > 0) out.attributes["model.below"] = fmt::format("{:.9g}", choice.below);
  return out;
}

void add_model(Summary& summary, const ModelChoice& choice,
               const std::map<std::string, double>& figures, double seconds) {
  const std::string prefix = "model." + choice.label + ".";
  summary[prefix + "name"] = choice.name;
  const auto& declared = continuum::find_model(choice.name).figures;
  for (const auto& [name, figure] : figures) {
    if (std::none_of(declared.begin(), declared.end(),
                     [&name = name](const auto& f) { return matches(f.name, name); })) {
      throw std::logic_error(fmt::format("model {}: the figure {} is not declared in its ModelInfo",
                                         choice.name, name));
    }
    summary[prefix + name] = figure;
  }
  summary["time.model." + choice.label + "_s"] = seconds;
}

}  // namespace grainfield::coupling
