// VTK's legacy files: words in lines, arrays as ASCII or big-endian behind them
// (docs.vtk.org, "VTK File Formats", legacy).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "coupling/import/vtk_arrays.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

class LegacyReader {
  struct Cells {
    std::vector<std::int64_t> points, ends;
  };
  static constexpr std::array kKinds{VtkCells::vertices, VtkCells::lines, VtkCells::any,
                                     VtkCells::others};

 public:
  LegacyReader(const std::string& file, std::string_view bytes) : file_(file), rest_(bytes) {}

  VtkData read() {
    line();
    line();  // a title
    const std::string form(word());
    if (form != "ASCII" && form != "BINARY") refuse(form, "ASCII or BINARY");
    binary_ = form == "BINARY";
    require("DATASET");
    const std::string dataset(word());
    if (dataset != "POLYDATA" && dataset != "UNSTRUCTURED_GRID")
      refuse(dataset, "POLYDATA or UNSTRUCTURED_GRID: points with a radius each");
    while (true) {
      const std::string key(word());
      if (key.empty()) break;
      section(key);
    }
    // Vertices come first in the rows of the cell data, wherever they stand in the file.
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind)
      add_cells(kKinds[kind], cells_[kind].points, cells_[kind].ends, 0, data_);
    return std::move(data_);
  }

 private:
  [[noreturn]] void refuse(std::string_view found, const std::string& wanted) const {
    throw std::invalid_argument(
        fmt::format("{}:{}: found \"{}\", expected {}", file_, line_, found.substr(0, 60), wanted));
  }

  std::string_view line() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view out = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    return out.ends_with('\r') ? out.substr(0, out.size() - 1) : out;
  }
  // "" at the end.
  std::string_view word() {
    while (!rest_.empty() && std::string_view(" \t\r\n").find(rest_.front()) != rest_.npos) {
      line_ += rest_.front() == '\n' ? 1 : 0;
      rest_.remove_prefix(1);
    }
    const std::size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
    const std::string_view out = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return out;
  }
  void require(const std::string& wanted) {
    const std::string_view found = word();
    if (found != wanted) refuse(found, wanted);
  }
  std::size_t count() {
    const std::string_view found = word();
    const auto value = parse_integer(found);
    // As many bytes at least are to come.
    if (!value || *value < 0 || static_cast<std::size_t>(*value) > rest_.size())
      refuse(found, "a number of values that the file has");
    return static_cast<std::size_t>(*value);
  }

  VtkArray array(const std::string& name, std::size_t components, std::size_t rows,
                 const std::string& type_name) {
    VtkArray out;
    out.name = name;
    out.components = components;
    const VtkType type = vtk_type(type_name);
    if (type.bytes == 0) refuse(type_name, "a type of numbers, such as float, double, int, long");
    const std::size_t values = components * rows;
    out.single = type.real && type.bytes == 4;
    if (binary_) {
      line();  // the rest of this one
      if (rest_.size() < values * type.bytes)
        throw std::invalid_argument(fmt::format("{}: truncated: {} needs {} bytes, {} are there",
                                                file_, name, values * type.bytes, rest_.size()));
      append_values(rest_.data(), values, type, true, out);
      rest_.remove_prefix(values * type.bytes);
      return out;
    }
    for (std::size_t k = 0; k < values; ++k) {
      const std::string_view found = word();
      const auto number = parse_number(found);
      if (!number) refuse(found, fmt::format("number {} of {} of {}", k + 1, values, name));
      if (type.real) {
        out.numbers.push_back(*number);
      } else {
        const auto whole = parse_integer(found);
        if (!whole) refuse(found, fmt::format("whole number {} of {} of {}", k + 1, values, name));
        out.whole.push_back(*whole);
      }
    }
    return out;
  }

  void section(const std::string& key) {
    if (key == "POINTS") {
      const std::size_t rows = count();
      data_.points = array("points", 3, rows, std::string(word()));
    } else if (key == "VERTICES") {
      cells(0);
    } else if (key == "LINES") {
      cells(1);
    } else if (key == "CELLS") {
      cells(2);
    } else if (key == "POLYGONS" || key == "TRIANGLE_STRIPS") {
      cells(3);
    } else if (key == "CELL_TYPES") {
      const std::size_t rows = count();
      array("types", 1, rows, "int");
    } else if (key == "POINT_DATA" || key == "CELL_DATA") {
      rows_ = count();
      into_ = key == "POINT_DATA" ? &data_.of_points : &data_.of_cells;
    } else if (key == "FIELD") {
      field();
    } else if (key == "METADATA") {
      while (!rest_.empty() && !line().empty()) {
      }
      while (!rest_.empty() && !line().empty()) {
      }
    } else {
      attribute(key);
    }
  }

  void cells(std::size_t kind) {
    Cells& out = cells_[kind];
    const std::size_t rows = count(), values = count();
    const std::string_view before = rest_;
    const long long line_before = line_;
    if (word() != "OFFSETS") {
      rest_ = before;
      line_ = line_before;
      const VtkArray all = array("cells", 1, values, "int");
      for (std::size_t k = 0; k < all.whole.size();) {
        const auto size = static_cast<std::size_t>(std::max<std::int64_t>(all.whole[k], 0));
        for (std::size_t p = k + 1; p <= k + size && p < all.whole.size(); ++p)
          out.points.push_back(all.whole[p]);
        out.ends.push_back(static_cast<std::int64_t>(out.points.size()));
        k += 1 + size;
      }
      return;
    }
    // Version 5: where each cell begins among the points of all.
    VtkArray offsets = array("offsets", 1, rows, std::string(word()));
    require("CONNECTIVITY");
    out.points = array("connectivity", 1, values, std::string(word())).whole;
    if (!offsets.whole.empty()) out.ends.assign(offsets.whole.begin() + 1, offsets.whole.end());
  }

  void field() {
    word();  // its name
    const std::size_t arrays = count();
    for (std::size_t k = 0; k < arrays; ++k) {
      std::string name = decoded_name(word());
      if (name == "METADATA") {  // behind the array before
        section(name);
        name = decoded_name(word());
      }
      const std::size_t components = count(), rows = count();
      VtkArray made = array(name, components, rows, std::string(word()));
      if (into_ == nullptr) take_time(made, data_);
      if (into_ != nullptr && rows == rows_) into_->push_back(std::move(made));
    }
  }

  void attribute(const std::string& key) {
    const std::string name = decoded_name(word());
    const std::string type(word());
    std::size_t components = 0;
    if (key == "SCALARS") {
      components = 1;
      std::string_view next = word();
      if (next != "LOOKUP_TABLE") {
        components = static_cast<std::size_t>(parse_integer(next).value_or(0));
        require("LOOKUP_TABLE");
      }
      word();
    } else if (key == "VECTORS" || key == "NORMALS") {
      components = 3;
    } else if (key == "TENSORS") {
      components = 9;
    }
    if (components == 0 || components > 9 || into_ == nullptr)
      refuse(key, "POINT_DATA, CELL_DATA, SCALARS, VECTORS, NORMALS, TENSORS or FIELD");
    into_->push_back(array(name, components, rows_, type));
  }

  const std::string& file_;
  std::string_view rest_;
  long long line_ = 0;
  bool binary_ = false;
  std::size_t rows_ = 0;
  std::vector<VtkArray>* into_ = nullptr;
  std::array<Cells, kKinds.size()> cells_;
  VtkData data_;
};

}  // namespace

VtkData read_legacy_vtk(const std::string& file, const std::string& bytes) {
  return LegacyReader(file, bytes).read();
}

}  // namespace grainfield::coupling
