// VTK's XML files: .vtp and .vtu (docs.vtk.org, "VTK XML Formats"). Bytes lie in the elements as
// base64, or behind them all as base64 or as they are, each array with its sizes before it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>
#include <cstring>
#include <pugixml.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "coupling/import/lines.h"
#include "coupling/import/vtk_arrays.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

namespace io = boost::iostreams;

// Bytes of base64; of several encodings one after another, each padded on its own, all.
std::string from_base64(std::string_view text) {
  static const std::array<int, 256> values = [] {
    std::array<int, 256> out{};
    out.fill(-1);
    const std::string_view letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t k = 0; k < letters.size(); ++k)
      out[static_cast<unsigned char>(letters[k])] = static_cast<int>(k);
    return out;
  }();
  std::string out;
  unsigned bits = 0;
  int count = 0;
  for (const char ch : text) {
    if (ch == '=') {  // the four letters end here
      bits = 0;
      count = 0;
      continue;
    }
    const int value = values[static_cast<unsigned char>(ch)];
    if (value < 0) continue;
    bits = bits << 6 | static_cast<unsigned>(value);
    if (++count == 1) continue;
    out += static_cast<char>(bits >> (count == 2 ? 4 : count == 3 ? 2 : 0) & 0xffu);
    if (count == 4) {
      bits = 0;
      count = 0;
    }
  }
  return out;
}

std::string from_zlib(std::string_view packed) {
  io::filtering_streambuf<io::input> in;
  in.push(io::zlib_decompressor());
  in.push(io::array_source(packed.data(), packed.size()));
  std::ostringstream out;
  io::copy(in, out);
  return out.str();
}

class XmlReader {
 public:
  XmlReader(const std::string& file, std::string_view bytes) : file_(file) {
    // What is appended need not be text: it is cut out before.
    const std::size_t open = bytes.find("<AppendedData");
    std::string text(bytes.substr(0, open));
    if (open != std::string_view::npos) {
      const std::size_t begin = bytes.find('_', bytes.find('>', open));
      const std::size_t end = bytes.rfind("</AppendedData>");
      if (begin == std::string_view::npos || end == std::string_view::npos || end <= begin)
        refuse("truncated: the appended data have no end");
      const std::string_view head = bytes.substr(open, begin - open);
      raw_ = head.find("base64") == std::string_view::npos;
      appended_ = bytes.substr(begin + 1, end - begin - 1);
      text += "</VTKFile>";
    }
    const pugi::xml_parse_result done = document_.load_buffer(text.data(), text.size());
    if (!done)
      refuse(fmt::format("found no XML from byte {} on ({})", done.offset, done.description()));
  }

  VtkData read() {
    const pugi::xml_node top = document_.child("VTKFile");
    const std::string kind = top.attribute("type").as_string();
    refuse_list(top);
    if (kind != "PolyData" && kind != "UnstructuredGrid")
      refuse(
          fmt::format("found the type \"{}\", expected PolyData or UnstructuredGrid: points with "
                      "a radius each",
                      kind));
    big_ = std::string(top.attribute("byte_order").as_string()) == "BigEndian";
    header_bytes_ = vtk_type(top.attribute("header_type").as_string("UInt32")).bytes;
    compressor_ = top.attribute("compressor").as_string();
    if (!compressor_.empty() && compressor_ != "vtkZLibDataCompressor")
      refuse(fmt::format("is packed by {}, allowed: vtkZLibDataCompressor, or none", compressor_));
    const pugi::xml_node data = top.child(kind.c_str());
    for (const pugi::xml_node one : data.child("FieldData").children("DataArray"))
      if (std::string(one.attribute("type").as_string()) != "String") take_time(array(one), data_);
    for (const pugi::xml_node piece : data.children("Piece")) add(piece);
    return std::move(data_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(file_ + ": " + what);
  }

  // A file that only names others: of times, blocks or pieces.
  void refuse_list(const pugi::xml_node& top) const {
    std::vector<std::string> files;
    for (const auto& one : top.select_nodes(".//DataSet/@file | .//Piece/@Source"))
      files.emplace_back(one.attribute().value());
    if (files.empty()) return;
    const std::size_t all = files.size();
    if (all > 5) files.resize(5);
    refuse(fmt::format("only lists the files that hold the points; give these: {}{}",
                       fmt::join(files, " "), all > 5 ? fmt::format(" ... ({})", all) : ""));
  }

  void add(const pugi::xml_node& piece) {
    const auto before = static_cast<std::int64_t>(data_.points.rows());
    append(array(piece.child("Points").child("DataArray")), data_.points);
    const auto add_data = [&](const char* name, std::vector<VtkArray>& all) {
      for (const pugi::xml_node one : piece.child(name).children("DataArray"))
        if (std::string(one.attribute("type").as_string()) != "String")
          append(array(one), named(all, one));
    };
    add_data("PointData", data_.of_points);
    add_data("CellData", data_.of_cells);
    // In the order in which the rows of the cell data are theirs.
    struct Kind {
      const char* name;
      VtkCells cells;
    };
    for (const auto& [name, cells] :
         {Kind{"Verts", VtkCells::vertices}, Kind{"Lines", VtkCells::lines},
          Kind{"Polys", VtkCells::others}, Kind{"Strips", VtkCells::others},
          Kind{"Cells", VtkCells::any}}) {
      VtkArray points, ends;
      for (const pugi::xml_node one : piece.child(name).children("DataArray")) {
        const std::string part = one.attribute("Name").as_string();
        if (part == "connectivity") points = array(one);
        if (part == "offsets") ends = array(one);
      }
      add_cells(cells, points.whole, ends.whole, before, data_);
    }
  }

  static VtkArray& named(std::vector<VtkArray>& all, const pugi::xml_node& node) {
    const std::string name = node.attribute("Name").as_string();
    for (VtkArray& one : all)
      if (one.name == name) return one;
    return all.emplace_back();
  }

  static void append(VtkArray&& from, VtkArray& to) {
    if (to.rows() == 0) {
      to = std::move(from);
      return;
    }
    to.numbers.insert(to.numbers.end(), from.numbers.begin(), from.numbers.end());
    to.whole.insert(to.whole.end(), from.whole.begin(), from.whole.end());
    to.single = to.single || from.single;
  }

  VtkArray array(const pugi::xml_node& node) const {
    VtkArray out;
    out.name = node.attribute("Name").as_string();
    out.components = std::max<std::size_t>(1, node.attribute("NumberOfComponents").as_uint(1));
    const std::string type_name = node.attribute("type").as_string(),
                      form = node.attribute("format").as_string("ascii");
    const VtkType type = vtk_type(type_name);
    if (type.bytes == 0) {
      if (node.empty()) return out;
      refuse(fmt::format("array {}: found the type \"{}\", expected numbers", out.name, type_name));
    }
    out.single = type.real && type.bytes == 4;
    if (form == "ascii") {
      std::vector<std::string_view> lines, words;
      split(node.child_value(), '\n', lines);
      for (const std::string_view line : lines) {
        split(line, ' ', words);
        for (const std::string_view word : words) {
          const auto number = parse_number(word);
          const auto whole = parse_integer(word);
          if (!number || (!type.real && !whole))
            refuse(fmt::format("array {}: found \"{}\", expected numbers", out.name,
                               word.substr(0, 40)));
          if (type.real)
            out.numbers.push_back(*number);
          else
            out.whole.push_back(*whole);
        }
      }
      return out;
    }
    const std::string bytes = bytes_of(node, form, out.name);
    append_values(bytes.data(), bytes.size() / type.bytes, type, big_, out);
    return out;
  }

  std::uint64_t header(std::string_view bytes, std::size_t k) const {
    if (bytes.size() < (k + 1) * header_bytes_) refuse("truncated: an array has no sizes");
    VtkArray value;
    append_values(bytes.data() + k * header_bytes_, 1, {header_bytes_, false, false}, big_, value);
    return static_cast<std::uint64_t>(value.whole.front());
  }

  // The array's values as they lie in memory.
  std::string bytes_of(const pugi::xml_node& node, const std::string& form,
                       const std::string& name) const {
    std::string_view stored;
    std::string letters_only;
    bool base64 = true;
    if (form == "appended") {
      const std::size_t offset = node.attribute("offset").as_ullong();
      if (offset > appended_.size())
        refuse(fmt::format("truncated: array {} begins behind the end", name));
      stored = appended_.substr(offset);
      base64 = !raw_;
    } else {
      for (const char ch : std::string_view(node.child_value()))
        if (ch != ' ' && ch != '\n' && ch != '\r' && ch != '\t') letters_only += ch;
      stored = letters_only;
    }
    try {
      return compressor_.empty() ? plain(stored, base64) : unpacked(stored, base64);
    } catch (const std::ios_base::failure&) {
      refuse(fmt::format("array {}: its packing (zlib) is damaged", name));
    }
  }

  static std::size_t letters(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

  // `count` bytes that are stored from the byte `at` of one encoding on.
  std::string part(std::string_view stored, std::size_t count, bool base64) const {
    const std::size_t needed = base64 ? letters(count) : count;
    if (stored.size() < needed) refuse("truncated: an array is longer than the file");
    if (!base64) return std::string(stored.substr(0, count));
    std::string out = from_base64(stored.substr(0, needed));
    out.resize(count);
    return out;
  }

  // The size, then the bytes: one encoding of both.
  std::string plain(std::string_view stored, bool base64) const {
    const std::size_t size = header(part(stored, header_bytes_, base64), 0);
    if (size > stored.size()) refuse("truncated: an array is longer than the file");
    return part(stored, header_bytes_ + size, base64).substr(header_bytes_);
  }

  // Numbers of blocks, sizes, then the blocks: the sizes are an encoding of their own.
  std::string unpacked(std::string_view stored, bool base64) const {
    const std::string head = part(stored, 3 * header_bytes_, base64);
    const std::size_t blocks = header(head, 0), sizes = (3 + blocks) * header_bytes_;
    if (blocks > stored.size()) refuse("truncated: an array is longer than the file");
    const std::string all = part(stored, sizes, base64);
    std::size_t total = 0;
    for (std::size_t k = 0; k < blocks; ++k) total += header(all, 3 + k);
    stored.remove_prefix(base64 ? letters(sizes) : sizes);
    const std::string packed = part(stored, total, base64);
    std::string out;
    std::size_t at = 0;
    for (std::size_t k = 0; k < blocks; ++k) {
      const std::size_t size = header(all, 3 + k);
      out += from_zlib(std::string_view(packed).substr(at, size));
      at += size;
    }
    return out;
  }

  const std::string& file_;
  pugi::xml_document document_;
  std::string_view appended_;
  bool raw_ = false, big_ = false;
  std::size_t header_bytes_ = 4;
  std::string compressor_;
  VtkData data_;
};

}  // namespace

VtkData read_xml_vtk(const std::string& file, const std::string& bytes) {
  return XmlReader(file, bytes).read();
}

}  // namespace grainfield::coupling
