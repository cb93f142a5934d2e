#include "coupling/heap/heap_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

constexpr const char *kMetres = "floor y = -h", *kMetresInSpace = "floor z = -h";

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Of the realizations that have one; nan without any.
double mean_known(const std::vector<double>& values) {
  double sum = 0;
  int count = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    sum += v;
    ++count;
  }
  return count > 0 ? sum / count : std::nan("");
}

std::string from_first(const std::string& text) {
  return text.substr(std::min(text.find_first_not_of(' '), text.size()));
}

double number_in(const std::string& text, const std::string& name, const std::string& where) {
  if (const std::optional<double> value = dem::parse_number(from_first(text))) return *value;
  refuse_field(where, fmt::format("attribute \"{}\": found \"{}\", expected a number", name, text));
}

// One number per realization, separated by commas; one alone holds for all.
std::vector<double> numbers(const Field& field, const std::string& name, std::size_t count,
                            const std::string& where) {
  std::vector<double> out;
  std::istringstream text(field_attribute(field, name, where));
  for (std::string item; std::getline(text, item, ',');) {
    out.push_back(number_in(item, name, where));
  }
  if (out.empty()) refuse_field(where, fmt::format("attribute \"{}\" is empty", name));
  if (out.size() == 1) out.resize(count, out.front());
  if (count == 1 && out.size() > 1) out = {mean(out)};
  if (out.size() != count) {
    refuse_field(where, fmt::format("attribute \"{}\": found {} numbers, expected {}", name,
                                    out.size(), count));
  }
  return out;
}

// Of a side; of a cone, which has none, its own.
std::vector<double> slopes(const Field& field, std::string name, std::size_t count,
                           const std::string& where) {
  if (field.attributes.count(name) == 0) name = "repose_deg";
  if (field.attributes.count(name) == 0) return std::vector<double>(count, std::nan(""));
  return numbers(field, name, count, where);
}

}  // namespace

double HeapFieldFacts::mean_height() const { return mean(height); }
double HeapFieldFacts::mean_pressure() const { return mean(pressure); }

std::string field_attribute(const Field& field, const std::string& name, const std::string& where) {
  const auto at = field.attributes.find(name);
  if (at != field.attributes.end()) return at->second;
  refuse_field(where,
               fmt::format("has no attribute \"{}\"; fields come from `grainfield run` or "
                           "`grainfield average` (of heaps: --frame heap; of loads: --response)",
                           name));
}

double field_number(const Field& field, const std::string& name, const std::string& where) {
  return number_in(field_attribute(field, name, where), name, where);
}

bool is_heap_field(const Field& field) {
  const auto at = field.attributes.find("frame");
  return at != field.attributes.end() && at->second.compare(0, 4, "heap") == 0;
}

void require_compression(const Field& field, const std::string& where) {
  const Column* column = field.find("sigma_yy");
  if (column == nullptr) return;
  double sum = 0;
  for (const double v : column->value) sum += std::isfinite(v) ? v : 0;
  if (!(sum > 0)) return;
  const auto method = field.attributes.find("method");
  if (method != field.attributes.end() && method->second == "measured") {
    refuse_field(where,
                 "the measured pressures are negative in the mean: a pressure is positive where "
                 "the heap presses; turn their signs");
  }
  refuse_field(
      where,
      "sigma_yy is tension (positive) in the mean: the contacts of the packings pull; forces "
      "count on grain i, by j; turn their sign (import --flip-forces) and average anew");
}

HeapFieldFacts heap_field_facts(const Field& field, std::size_t count, const std::string& where) {
  const std::string frame = field_attribute(field, "frame", where);
  if (!is_heap_field(field)) {
    refuse_field(where,
                 fmt::format("found frame \"{}\", needed: that of a heap (`grainfield average "
                             "--frame heap`)",
                             frame));
  }
  HeapFieldFacts out;
  out.in_metres =
      frame.find(kMetres) != std::string::npos || frame.find(kMetresInSpace) != std::string::npos;
  out.height = numbers(field, field.attributes.count("heap.h") > 0 ? "heap.h" : "h", count, where);
  out.pressure = numbers(field, "rho_g_h", count, where);
  out.left_deg = slopes(field, "left_deg", count, where);
  out.right_deg = slopes(field, "right_deg", count, where);
  for (std::size_t r = 0; r < count; ++r) {
    if (!(out.height[r] > 0 && out.pressure[r] > 0)) {
      refuse_field(where, "attributes \"h\" and \"rho_g_h\" must be above 0");
    }
  }
  return out;
}

Field in_mean_heap(Field field, const std::string& where) {
  const auto count = static_cast<std::size_t>(field.realizations);
  const HeapFieldFacts facts = heap_field_facts(field, count, where);
  const double h = facts.mean_height(), unit = facts.mean_pressure();
  if (!facts.in_metres) field.points *= h;
  for (Column& column : field.columns) {
    if (column.name.compare(0, 6, "sigma_") != 0 || column.samples.size() == 0) continue;
    for (std::size_t r = 0; r < count; ++r) {
      column.samples.col(static_cast<Eigen::Index>(r)) *= unit / facts.pressure[r];
    }
    column.value = column.samples.rowwise().mean();
    const double n = static_cast<double>(count);
    column.error = ((column.samples.colwise() - column.value).rowwise().squaredNorm() / (n - 1) / n)
                       .cwiseSqrt();
  }
  field.attributes["frame"] = std::string("heap: apex at (0, 0), ") + kMetres;
  field.attributes["h"] = fmt::format("{}", h);
  field.attributes["rho_g_h"] = fmt::format("{}", unit);
  field.attributes["left_deg"] = fmt::format("{}", mean_known(facts.left_deg));
  field.attributes["right_deg"] = fmt::format("{}", mean_known(facts.right_deg));
  field.attributes.erase("heap.h");
  return field;
}

}  // namespace grainfield::coupling
