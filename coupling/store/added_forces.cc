#include "coupling/store/added_forces.h"

#include <fmt/format.h>

#include <pugixml.hpp>
#include <sstream>

#include "dem/snapshot/added_forces_mark.h"

namespace grainfield::coupling {

void copy_added_forces(const dem::Snapshot& from, Attributes& to) {
  const auto names = added_forces_of(from);
  to.insert(names.begin(), names.end());
}

std::map<std::string, std::string> added_forces_of(const dem::Snapshot& packing) {
  std::map<std::string, std::string> out;
  dem::copy_added_forces(packing.attributes, out);
  return out;
}

std::map<std::string, std::string> added_forces_of(const Field& field) {
  std::map<std::string, std::string> out;
  for (const char* name : {dem::kAddedForces, dem::kFormerAddedForces}) {
    if (const std::string names = field.word(name); !names.empty()) out.emplace(name, names);
  }
  return out;
}

std::string added_forces_note(const Field& field) {
  return dem::added_forces_note(added_forces_of(field));
}

template <class Held>
std::string added_forces_comment(const Held& held) {
  const std::string note = dem::added_forces_note(added_forces_of(held));
  return note.empty() ? "" : fmt::format("# {}\n", note);
}

template <class Held>
std::string added_forces_in_vtk(const Held& held) {
  const auto names = added_forces_of(held);
  if (names.empty()) return "";
  pugi::xml_document document;
  pugi::xml_node data = document.append_child("FieldData");
  for (const auto& [name, forces] : names) {
    pugi::xml_node array = data.append_child("DataArray");
    array.append_attribute("type").set_value("Int64");
    array.append_attribute("Name").set_value(fmt::format("{}: {}", name, forces).c_str());
    array.append_attribute("NumberOfTuples").set_value(1);
    array.append_attribute("format").set_value("ascii");
    array.text().set(1);
  }
  std::ostringstream text;
  data.print(text, "", pugi::format_raw);
  return text.str() + "\n";
}

template std::string added_forces_comment(const dem::Snapshot& held);
template std::string added_forces_comment(const Field& held);
template std::string added_forces_in_vtk(const dem::Snapshot& held);
template std::string added_forces_in_vtk(const Field& held);

}  // namespace grainfield::coupling
