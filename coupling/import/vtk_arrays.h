// Arrays of VTK's files of points and lines.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupling/import/table.h"

namespace grainfield::coupling {

/// Values of a data array, row by row.
struct VtkArray {
  std::string name;
  std::size_t components = 1;
  bool single = false;              ///< told as Float32: whole numbers from 2^24 on are rounded
  std::vector<double> numbers;      ///< of floating-point types
  std::vector<std::int64_t> whole;  ///< of integer types

  std::size_t rows() const { return (numbers.size() + whole.size()) / components; }
};

/// Numbers of points, and the row of the cell data that is theirs.
struct VtkVertex {
  std::int64_t point = 0;
  std::size_t row = 0;
};
struct VtkLine {
  std::int64_t first = 0, second = 0;
  std::size_t row = 0;
};

struct VtkData {
  VtkArray points;                            ///< three components
  std::vector<VtkArray> of_points, of_cells;  ///< point data, cell data
  std::vector<VtkVertex> vertices;            ///< points that are cells, alone or with others
  std::vector<VtkLine> lines;                 ///< cells of two points
  std::size_t cells = 0;                      ///< of any kind
  std::optional<double> time;                 ///< of the field data, s
};

enum class VtkCells { vertices, lines, any, others };
/// Takes an array of the field data that is the time: TimeValue, as ParaView and VTK name it.
void take_time(const VtkArray& array, VtkData& data);
/// Counts the cells whose points end at `ends` among `points` (numbers of a piece, whose first
/// point is `before` in all) and keeps vertices and lines of them. `any`: by their points.
void add_cells(VtkCells kind, const std::vector<std::int64_t>& points,
               const std::vector<std::int64_t>& ends, std::int64_t before, VtkData& data);

/// The blanks and other letters that stand as "%20" in the names of legacy files.
std::string decoded_name(std::string_view name);

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

/// Points with a radius as grains, lines and other cells with forces as contacts. Contacts that
/// name no grains lie on lines between them: by the ids of their points, by the points' numbers
/// where these have none. Throws std::invalid_argument naming the file and the array.
std::vector<ForeignTable> vtk_tables(const std::string& file, const VtkData& data,
                                     ColumnNames& names);

}  // namespace grainfield::coupling
