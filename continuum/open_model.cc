#include "continuum/open_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "continuum/settings.h"
#include "continuum/size.h"
#include "continuum/without_effect.h"

namespace grainfield::continuum {

const Parameter& free_parameter(const ModelInfo& info, const std::string& name) {
  std::vector<std::string> free;
  for (const Parameter& p : info.parameters) {
    if (!p.free) continue;
    if (p.name == name) return p;
    free.push_back(p.name);
  }
  if (free.empty()) {
    throw BadParameter(fmt::format("model {}: {} cannot be free; allowed: none of its parameters",
                                   info.name, name));
  }
  throw BadParameter(fmt::format("model {}: {} cannot be free; allowed: {}; did you mean {}?",
                                 info.name, name, fmt::join(free, ", "), nearest(name, free)));
}

OpenModel::OpenModel(const std::string& name, Settings settings,
                     const std::vector<std::string>& open)
    : info_(&find_model(name)) {
  for (const std::string& one : open) {
    open_.push_back(&free_parameter(*info_, one));
    const SearchRange& range = *open_.back()->free;
    settings[one] = fmt::format("{}", (range.least + range.most) / 2);
  }
  if (const auto found = find_without_effect(*info_, settings)) throw BadParameter(found->refusal);
  settings_ = complete(*info_, settings);
  require_possible(*info_, settings_);
}

Settings OpenModel::at(const Eigen::VectorXd& values) const {
  Settings out = settings_;
  for (std::size_t k = 0; k < open_.size(); ++k) {
    const Parameter& p = *open_[k];
    const double value = values[static_cast<Eigen::Index>(k)];
    if (!(value >= p.least && value <= p.most))
      throw BadParameter(fmt::format("model {}: {} = {} is out of range; allowed: {}", info_->name,
                                     p.name, value, allowed(p)));
    out[p.name] = fmt::format("{}", value);
  }
  return out;
}

}  // namespace grainfield::continuum
