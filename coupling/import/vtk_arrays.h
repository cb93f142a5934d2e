// Arrays of VTK's files of points and lines.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// Values of a data array, row by row.
struct VtkArray {
  std::string name;
  std::size_t components = 1;
  std::vector<double> numbers;      ///< of floating-point types
  std::vector<std::int64_t> whole;  ///< of integer types

  std::size_t rows() const { return (numbers.size() + whole.size()) / components; }
};

struct VtkData {
  VtkArray points;                               ///< three components
  std::vector<VtkArray> of_points, of_cells;     ///< point data, cell data
  std::vector<std::vector<std::int64_t>> lines;  ///< points of the cells that have two
};

/// Legacy files (.vtk, ASCII and binary) of POLYDATA and UNSTRUCTURED_GRID. Throws
/// std::invalid_argument "FILE:LINE: ..." or "FILE: ...".
VtkData read_legacy_vtk(const std::string& file, const std::string& bytes);
/// XML files (.vtp, .vtu) of one piece or several: ascii, binary and appended (raw and base64),
/// plain or packed by zlib. Throws likewise.
VtkData read_xml_vtk(const std::string& file, const std::string& bytes);

/// A number type of VTK ("Float32", "float", "vtktypeint64"), as what its values are.
struct VtkType {
  std::size_t bytes = 0;  ///< 0: unknown
  bool real = false, sign = true;
};
VtkType vtk_type(const std::string& name);
/// `count` values of `type` from the bytes at `from`; `big`: the highest byte first.
void append_values(const char* from, std::size_t count, const VtkType& type, bool big,
                   VtkArray& out);

}  // namespace grainfield::coupling
