#include "coupling/specimen/heap_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace grainfield::coupling {
namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The mean of the realizations that have one; nan without any.
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

[[noreturn]] void refuse_attribute(const Field& field, const std::string& name,
                                   const std::string& where) {
  const auto at = field.attributes.find(name);
  if (at != field.attributes.end()) {
    refuse(where,
           fmt::format("attribute \"{}\": found \"{}\", expected a {}", name,
                       attribute_text(at->second), at->second.index() == 0 ? "number" : "text"));
  }
  refuse(where, fmt::format("has no attribute \"{}\"; fields come from `grainfield run` or "
                            "`grainfield average` (of heaps: --frame heap; of loads: --response)",
                            name));
}

// One number per realization; one alone is that of all.
std::vector<double> numbers(const Field& field, const std::string& name, std::size_t count,
                            const std::string& where) {
  const double mean_of_all = field_number(field, name, where);
  const auto* each = std::get_if<std::vector<double>>(&field.attributes.at(name));
  if (each == nullptr || each->size() == 1 || count == 1)
    return std::vector<double>(count, mean_of_all);
  if (each->size() != count) {
    refuse(where, fmt::format("attribute \"{}\": found {} numbers, expected {}", name, each->size(),
                              count));
  }
  return *each;
}

// The slopes of a side; a cone, which has none, has its own.
std::vector<double> slopes(const Field& field, std::string name, std::size_t count,
                           const std::string& where) {
  if (!field.has(name)) name = "repose_deg";
  if (!field.has(name)) return std::vector<double>(count, std::nan(""));
  return numbers(field, name, count, where);
}

}  // namespace

double HeapFieldFacts::mean_height() const { return mean(height); }
double HeapFieldFacts::mean_pressure() const { return mean(pressure); }

std::string field_word(const Field& field, const std::string& name, const std::string& where) {
  const auto at = field.attributes.find(name);
  if (at == field.attributes.end() || at->second.index() != 0) refuse_attribute(field, name, where);
  return field.word(name);
}

double field_number(const Field& field, const std::string& name, const std::string& where) {
  const auto at = field.attributes.find(name);
  if (at == field.attributes.end() || at->second.index() == 0) refuse_attribute(field, name, where);
  return field.number(name);
}

void say_heaps(const std::vector<PileFrame>& heaps, Field& field) {
  const auto each = [&](const char* name, const auto& number) {
    std::vector<double> all;
    for (const PileFrame& heap : heaps) all.push_back(number(heap));
    field.attributes[name] = std::move(all);
  };
  each("heap.h", [](const PileFrame& f) { return f.height; });
  each("rho_g_h", [](const PileFrame& f) { return f.pressure(); });
  each("left_deg", [](const PileFrame& f) { return f.repose_left_deg; });
  each("right_deg", [](const PileFrame& f) { return f.repose_right_deg; });
}

void require_compression(const Field& field, const std::string& where) {
  const Column* column = field.find("sigma_yy");
  if (column == nullptr) return;
  double sum = 0;
  for (const double v : column->value) sum += std::isfinite(v) ? v : 0;
  if (!(sum > 0)) return;
  if (field.is_measured()) {
    refuse(where,
           "the measured pressures are negative in the mean: a pressure is positive where "
           "the heap presses; turn their signs");
  }
  refuse(where,
         "sigma_yy is tension (positive) in the mean: the contacts of the packings pull; forces "
         "count on grain i, by j; turn their sign (import --flip-forces) and average anew");
}

HeapFieldFacts heap_field_facts(const Field& field, std::size_t count, const std::string& where) {
  if (!field.is_of_heap()) {
    refuse(where, fmt::format("found frame \"{}\", needed: that of a heap (`grainfield average "
                              "--frame heap`)",
                              field_word(field, "frame", where)));
  }
  HeapFieldFacts out;
  out.height = numbers(field, field.has("heap.h") ? "heap.h" : "h", count, where);
  out.pressure = numbers(field, "rho_g_h", count, where);
  out.left_deg = slopes(field, "left_deg", count, where);
  out.right_deg = slopes(field, "right_deg", count, where);
  for (std::size_t r = 0; r < count; ++r) {
    if (!(out.height[r] > 0 && out.pressure[r] > 0)) {
      refuse(where, "attributes \"h\" and \"rho_g_h\" must be above 0");
    }
  }
  return out;
}

Field in_mean_heap(Field field, const std::string& where) {
  const auto count = static_cast<std::size_t>(field.realizations);
  const HeapFieldFacts facts = heap_field_facts(field, count, where);
  const double h = facts.mean_height(), unit = facts.mean_pressure();
  if (field.is_over_height()) field.points *= h;
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
  field.attributes["lengths"] = "m";
  field.attributes["h"] = h;
  field.attributes["rho_g_h"] = unit;
  field.attributes["left_deg"] = mean_known(facts.left_deg);
  field.attributes["right_deg"] = mean_known(facts.right_deg);
  field.attributes.erase("heap.h");
  return field;
}

}  // namespace grainfield::coupling
