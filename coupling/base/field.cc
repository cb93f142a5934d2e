#include "coupling/base/field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <numeric>

namespace grainfield::coupling {

const Column* Field::find(const std::string& name) const {
  for (const Column& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

Column& Field::add(const std::string& name, const std::string& unit) {
  Column column;
  column.name = name;
  column.unit = unit;
  column.value = Eigen::VectorXd::Constant(points.rows(), std::numeric_limits<double>::quiet_NaN());
  columns.push_back(std::move(column));
  return columns.back();
}

std::string Field::word(const std::string& attribute) const {
  const auto at = attributes.find(attribute);
  const auto* text = at == attributes.end() ? nullptr : std::get_if<std::string>(&at->second);
  return text == nullptr ? "" : *text;
}

double Field::number(const std::string& attribute) const {
  const auto at = attributes.find(attribute);
  if (at == attributes.end()) return std::numeric_limits<double>::quiet_NaN();
  if (const auto* one = std::get_if<double>(&at->second)) return *one;
  const auto* all = std::get_if<std::vector<double>>(&at->second);
  if (all == nullptr || all->empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(all->begin(), all->end(), 0.0) / static_cast<double>(all->size());
}

std::string attribute_text(const Attribute& attribute) {
  if (const auto* text = std::get_if<std::string>(&attribute)) return *text;
  if (const auto* number = std::get_if<double>(&attribute)) return fmt::format("{}", *number);
  return fmt::format("{}", fmt::join(std::get<std::vector<double>>(attribute), ","));
}

}  // namespace grainfield::coupling
