#include "coupling/field.h"

#include <limits>

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

bool Field::is_measured() const {
  const auto method = attributes.find("method");
  return method != attributes.end() && method->second == "measured";
}

}  // namespace grainfield::coupling
