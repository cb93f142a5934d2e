#include "dem/walls/stl.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "dem/shared/refuse.h"
#include "dem/space/space3.h"

namespace grainfield::dem {
namespace {

// Binary: 80 characters, the number of facets, and 50 bytes a facet: normal, corners, 2 bytes.
constexpr std::size_t kHead = 84, kFacet = 50;
static_assert(std::endian::native == std::endian::little);

struct Facets {
  Triangles corners;
  std::vector<Vec3> normals;  // as the file gives them
};

void check_count(const std::string& file, std::size_t count) {
  if (count > kMostFacets) {
    refuse(file, fmt::format("found {} facets, allowed: up to {}; coarsen it", count, kMostFacets));
  }
}

Facets read_binary(const std::string& file, const std::string& bytes, std::size_t count) {
  check_count(file, count);
  Facets out;
  const auto vector_at = [&](std::size_t at) {
    float v[3];
    std::memcpy(v, bytes.data() + at, sizeof v);
    return Vec3(v[0], v[1], v[2]);
  };
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = kHead + k * kFacet;
    out.normals.push_back(vector_at(at));
    out.corners.push_back({vector_at(at + 12), vector_at(at + 24), vector_at(at + 36)});
  }
  return out;
}

class AsciiReader {
 public:
  AsciiReader(const std::string& file, std::string_view text) : file_(file), text_(text) {}

  Facets read() {
    Facets out;
    expect("solid");
    skip_line();  // its name
    for (std::string_view word = next();; word = next()) {
      if (word == "endsolid") {  // another may follow
        skip_line();
        word = next();
        if (word.empty()) break;
        if (word != "solid") wrong("solid or the end of the file", word);
        skip_line();
        continue;
      }
      if (word != "facet") wrong("facet or endsolid", word);
      check_count(file_, out.corners.size() + 1);
      expect("normal");
      out.normals.push_back(vector());
      expect("outer");
      expect("loop");
      auto& corners = out.corners.emplace_back();
      for (Vec3& corner : corners) {
        expect("vertex");
        corner = vector();
      }
      expect("endloop");
      expect("endfacet");
    }
    return out;
  }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  void expect(std::string_view word) {
    const std::string_view found = next();
    if (found != word) wrong(word, found);
  }
  Vec3 vector() {
    Vec3 v;
    for (double& x : v) {
      const std::string_view word = next();
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
      if (error != std::errc() || end != word.data() + word.size()) wrong("a number", word);
    }
    return v;
  }
  [[noreturn]] void wrong(std::string_view wanted, std::string_view found) const {
    refuse(file_, fmt::format("line {}: found \"{}\", expected {} of an ASCII STL file", line_,
                              found.substr(0, 40), wanted));
  }

  const std::string& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

Facets read_facets(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(file, "cannot be read");
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  std::uint32_t count = 0;
  if (bytes.size() >= kHead) std::memcpy(&count, bytes.data() + 80, sizeof count);
  // ASCII files begin with "solid", and so do some binary ones.
  const bool fits = bytes.size() >= kHead && bytes.size() == kHead + kFacet * count;
  if (fits) return read_binary(file, bytes, count);
  if (bytes.starts_with("solid")) return AsciiReader(file, bytes).read();
  refuse(file, fmt::format("found {} bytes, expected {} of a binary STL file with {} facets, or an "
                           "ASCII one that begins with \"solid\"",
                           bytes.size(), kHead + kFacet * count, count));
}

/// Facet with an edge that no other shares, from 1.
std::size_t first_open(const MeshTopology& mesh) {
  for (std::size_t t = 0; t < mesh.beyond.size(); ++t) {
    for (const int other : mesh.beyond[t]) {
      if (other < 0) return t + 1;
    }
  }
  return 0;
}

}  // namespace

Triangles read_stl(const std::string& file, const StlOptions& options) {
  if (!(options.unit > 0) || !std::isfinite(options.unit)) {
    refuse(file, fmt::format("unit: found {:g}, allowed: above 0 m", options.unit));
  }
  Facets facets = read_facets(file);
  for (auto& triangle : facets.corners) {
    for (Vec3& corner : triangle) corner *= options.unit;
  }
  const MeshTopology mesh = topology_of(facets.corners, file);
  for (std::size_t k = 0; k < facets.corners.size(); ++k) {
    const auto& [a, b, c] = facets.corners[k];
    if ((b - a).cross(c - a).dot(facets.normals[k]) < 0) {
      refuse(file, fmt::format("facet {}: its corners run against its normal; write the file anew "
                               "with consistent facets",
                               k + 1));
    }
  }
  if (!mesh.closed && !options.open) {
    refuse(file,
           fmt::format("facet {} has an edge without a neighbour: the surface is open; close it, "
                       "or say that a thin open sheet is meant (open)",
                       first_open(mesh)));
  }
  if (mesh.closed && mesh.volume < 0) {
    refuse(file, fmt::format("is inside out (its facets enclose {:.4g} m3); turn its facets round, "
                             "counter-clockwise seen from outside",
                             mesh.volume));
  }
  if (options.inside) {
    for (auto& triangle : facets.corners) std::swap(triangle[1], triangle[2]);
  }
  return facets.corners;
}

}  // namespace grainfield::dem
