// A model of the registry with some of its numbers open, for searches that ask for many of them.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "continuum/model.h"

namespace grainfield::continuum {

/// What make_model() checks of the settings is checked once, and of the open numbers their ranges
/// every time.
class OpenModel {
 public:
  /// Each of `open` may be free (Parameter::free); settings of these are left aside. Throws
  /// BadParameter as make_model(), and for a number that may not be free.
  OpenModel(const std::string& name, Settings settings, const std::vector<std::string>& open);

  /// Every setting, with the open numbers at these values. Throws BadParameter out of range.
  Settings at(const Eigen::VectorXd& values) const;
  /// Throws BadParameter for values that the model cannot take.
  std::unique_ptr<Model> make(const Eigen::VectorXd& values) const {
    return info_->make(at(values));
  }

 private:
  const ModelInfo* info_;
  Settings settings_;
  std::vector<const Parameter*> open_;
};

/// The model's parameter that may be free. Throws BadParameter for another name, with those that
/// may be and the nearest.
const Parameter& free_parameter(const ModelInfo& info, const std::string& name);

}  // namespace grainfield::continuum
