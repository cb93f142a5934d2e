#include "coupling/store/field_attributes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <utility>

#include "coupling/store/field_io.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

namespace h5 = dem::hdf5;

const std::string kAttribute = "attribute.";      // prefix of Field::attributes in the file
constexpr const char* kEach = "per_realization";  // names of the lists, and the group they are in
// What is a number wherever it comes from.
constexpr std::array kNumbers{"F",        "h",         "width",      "heap.h",     "rho_g_h",
                              "left_deg", "right_deg", "repose_deg", "apex_height"};

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

// The numbers that a text lists; nothing where one is none.
std::optional<std::vector<double>> numbers_in(const std::string& text) {
  std::vector<double> out;
  std::istringstream items(text);
  for (std::string item; std::getline(items, item, ',');) {
    const std::size_t first = std::min(item.find_first_not_of(' '), item.size());
    const std::optional<double> number = parse_number(item.substr(first));
    if (!number) return std::nullopt;
    out.push_back(*number);
  }
  return out.empty() ? std::nullopt : std::optional(std::move(out));
}

std::string unit_of(const std::string& name, const Field& field) {
  if (name == "heap.h") return "m";
  if (name == "rho_g_h") return field.points.cols() == 3 ? "Pa" : "N/m";
  return name.ends_with("_deg") ? "deg" : "1";
}

}  // namespace

void type_attributes(Attributes& attributes) {
  for (const char* name : kNumbers) {
    const auto at = attributes.find(name);
    if (at == attributes.end() || !std::holds_alternative<std::string>(at->second)) continue;
    const auto numbers = numbers_in(std::get<std::string>(at->second));
    if (!numbers) continue;
    at->second = numbers->size() == 1 ? Attribute(numbers->front()) : Attribute(*numbers);
  }
  const auto frame = attributes.find("frame");
  if (frame == attributes.end() || !std::holds_alternative<std::string>(frame->second)) return;
  const std::string text = std::get<std::string>(frame->second);
  for (const auto& [start, name] :
       {std::pair{"heap", "heap"}, {"models", "layer"}, {"packing", "packing"}}) {
    if (text.starts_with(start)) frame->second = name;
  }
  if (contains(text, "= -h")) attributes["lengths"] = "m";
  if (contains(text, "rings")) attributes["rings"] = 1.0;
}

void write_attributes(hid_t group, const Field& field) {
  std::vector<std::string> lists;
  std::optional<h5::Handle> each;
  for (const auto& [name, value] : field.attributes) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      h5::write_attribute(group, kAttribute + name, *text);
    } else if (const auto* number = std::get_if<double>(&value)) {
      h5::write_attribute(group, kAttribute + name, *number);
    } else {
      if (!each) each.emplace(h5::create_group(group, kEach));
      h5::write(*each, name, std::get<std::vector<double>>(value), 1, unit_of(name, field));
      lists.push_back(name);
    }
  }
  if (each) h5::write_attribute(group, kEach, fmt::format("{}", fmt::join(lists, ",")));
}

Attributes read_attributes(hid_t group, const std::string& where) {
  Attributes out;
  const auto each_named = [](const std::vector<std::string>& names, const auto& act) {
    for (const std::string& name : names) {
      if (name.starts_with(kAttribute)) act(name, name.substr(kAttribute.size()));
    }
  };
  each_named(h5::text_attributes(group), [&](const std::string& name, const std::string& key) {
    out[key] = h5::read_text_attribute(group, name);
  });
  each_named(h5::number_attributes(group), [&](const std::string& name, const std::string& key) {
    out[key] = h5::read_number_attribute(group, name);
  });
  if (h5::has_attribute(group, kEach)) {
    const h5::Handle each = h5::open_group(group, kEach);
    std::istringstream names(h5::read_text_attribute(group, kEach));
    for (std::string name; std::getline(names, name, ',');) {
      out[name] = h5::read_doubles(each, name, 1, where + "/" + kEach);
    }
  }
  type_attributes(out);
  return out;
}

}  // namespace grainfield::coupling
