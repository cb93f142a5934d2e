#include "coupling/import/vtk_arrays.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstring>

#include "coupling/import/synonyms.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

template <class Real, class Bits>
double real_of(std::uint64_t bits) {
  return static_cast<double>(std::bit_cast<Real>(static_cast<Bits>(bits)));
}

}  // namespace

VtkType vtk_type(const std::string& name) {
  std::string plain;
  for (const char ch : name)
    plain += static_cast<char>(std::tolower(static_cast<unsigned char>(ch)));
  if (plain.starts_with("vtktype")) plain = plain.substr(7);
  struct Known {
    const char* name;
    VtkType type;
  };
  static const Known known[] = {
      {"float64", {8, true, true}},    {"double", {8, true, true}},
      {"float32", {4, true, true}},    {"float", {4, true, true}},
      {"int64", {8, false, true}},     {"long", {8, false, true}},
      {"vtkidtype", {8, false, true}}, {"idtype", {8, false, true}},
      {"uint64", {8, false, false}},   {"unsigned_long", {8, false, false}},
      {"int32", {4, false, true}},     {"int", {4, false, true}},
      {"uint32", {4, false, false}},   {"unsigned_int", {4, false, false}},
      {"int16", {2, false, true}},     {"short", {2, false, true}},
      {"uint16", {2, false, false}},   {"unsigned_short", {2, false, false}},
      {"int8", {1, false, true}},      {"char", {1, false, true}},
      {"uint8", {1, false, false}},    {"unsigned_char", {1, false, false}},
  };
  for (const Known& one : known)
    if (plain == one.name) return one.type;
  return {};
}

void add_cells(VtkCells kind, const std::vector<std::int64_t>& points,
               const std::vector<std::int64_t>& ends, std::int64_t before, VtkData& data) {
  std::int64_t begin = 0;
  for (const std::int64_t end : ends) {
    const std::size_t row = data.cells++;
    if (begin < 0 || end <= begin || end > static_cast<std::int64_t>(points.size())) {
      begin = end;
      continue;
    }
    const std::int64_t* of_cell = points.data() + begin;
    const std::int64_t size = end - begin;
    begin = end;
    if (kind == VtkCells::vertices || (kind == VtkCells::any && size == 1)) {
      for (std::int64_t k = 0; k < size; ++k) data.vertices.push_back({before + of_cell[k], row});
    } else if (kind != VtkCells::others && size == 2) {
      data.lines.push_back({before + of_cell[0], before + of_cell[1], row});
    }
  }
}

std::string decoded_name(std::string_view name) {
  std::string out;
  for (std::size_t k = 0; k < name.size(); ++k) {
    unsigned code = 0;
    const char* two = name.data() + k + 1;
    if (name[k] == '%' && k + 2 < name.size() &&
        std::from_chars(two, two + 2, code, 16).ptr == two + 2) {
      out += static_cast<char>(code);
      k += 2;
    } else {
      out += name[k];
    }
  }
  return out;
}

void append_values(const char* from, std::size_t count, const VtkType& type, bool big,
                   VtkArray& out) {
  out.single = out.single || (type.real && type.bytes == 4);
  for (std::size_t k = 0; k < count; ++k) {
    std::uint64_t bits = 0;
    for (std::size_t b = 0; b < type.bytes; ++b) {
      const std::size_t at = k * type.bytes + (big ? b : type.bytes - 1 - b);
      bits = bits << 8 | static_cast<unsigned char>(from[at]);
    }
    if (type.real) {
      out.numbers.push_back(type.bytes == 8 ? real_of<double, std::uint64_t>(bits)
                                            : real_of<float, std::uint32_t>(bits));
      continue;
    }
    const std::size_t unused = 64 - 8 * type.bytes;
    const auto value = static_cast<std::int64_t>(bits << unused);
    out.whole.push_back(type.sign ? value >> unused : static_cast<std::int64_t>(bits));
  }
}

void take_time(const VtkArray& array, VtkData& data) {
  const std::string plain = plain_column_name(array.name);
  if (array.rows() != 1 || (plain != "timevalue" && plain != "time")) return;
  data.time =
      array.whole.empty() ? array.numbers.front() : static_cast<double>(array.whole.front());
  if (!(*data.time >= 0 && *data.time <= dem::kMostNumber)) data.time.reset();
}

}  // namespace grainfield::coupling
