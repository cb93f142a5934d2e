#include <pugixml.hpp>
#include <sstream>
#include <string>

#include "coupling/store/added_forces.h"
#include "coupling/store/field_io.h"

namespace grainfield::coupling {
namespace {

void put(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(value.c_str());
}

void add_data(pugi::xml_node parent, const std::string& dimensions, const std::string& reference) {
  pugi::xml_node item = parent.append_child("DataItem");
  put(item, "Dimensions", dimensions);
  put(item, "NumberType", "Float");
  put(item, "Precision", "8");
  put(item, "Format", "HDF");
  item.text().set(reference.c_str());
}

void add_column(pugi::xml_node grid, const std::string& name, const std::string& dimensions,
                const std::string& reference) {
  pugi::xml_node attribute = grid.append_child("Attribute");
  put(attribute, "Name", name);
  put(attribute, "AttributeType", "Scalar");
  put(attribute, "Center", "Node");
  add_data(attribute, dimensions, reference);
}

}  // namespace

std::string xdmf(const std::string& h5_name, const NamedFields& fields) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("Xdmf");
  put(root, "Version", "3.0");
  pugi::xml_node all = root.append_child("Domain").append_child("Grid");
  put(all, "Name", "fields");
  put(all, "GridType", "Collection");
  put(all, "CollectionType", "Spatial");
  for (const auto& [name, field] : fields) {
    const std::string base = h5_name + ":/" + name + "/";
    const std::string count = std::to_string(field.points.rows());
    const bool space = field.points.cols() == 3;
    const bool structured = field.nx > 1 && field.ny > 1 && (space ? field.nz > 0 : field.nz == 0);
    std::string shape = std::to_string(field.ny) + " " + std::to_string(field.nx);
    if (space) shape = std::to_string(field.nz) + " " + shape;
    pugi::xml_node grid = all.append_child("Grid");
    put(grid, "Name", name);
    put(grid, "GridType", "Uniform");
    for (const auto& [mark, forces] : added_forces_of(field)) {
      pugi::xml_node information = grid.append_child("Information");
      put(information, "Name", mark);
      put(information, "Value", forces);
    }
    pugi::xml_node topology = grid.append_child("Topology");
    if (structured) {
      put(topology, "TopologyType", space ? "3DSMesh" : "2DSMesh");
      put(topology, "Dimensions", shape);
    } else {
      put(topology, "TopologyType", "Polyvertex");
      put(topology, "NumberOfElements", count);
      put(topology, "NodesPerElement", "1");
    }
    pugi::xml_node geometry = grid.append_child("Geometry");
    put(geometry, "GeometryType", space ? "XYZ" : "XY");
    add_data(geometry, count + " " + std::to_string(field.points.cols()), base + "points");
    const std::string& dimensions = structured ? shape : count;
    for (const Column& column : field.columns) {
      add_column(grid, column.name, dimensions, base + "value/" + column.name);
      if (column.error.size())
        add_column(grid, column.name + "_error", dimensions, base + "error/" + column.name);
    }
  }
  std::ostringstream text;
  document.save(text, "  ");
  return text.str();
}

}  // namespace grainfield::coupling
