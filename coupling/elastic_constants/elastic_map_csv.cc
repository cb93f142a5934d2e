#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "coupling/elastic_constants/elastic_map.h"
#include "coupling/output/atomic_file.h"
#include "coupling/system/read_input.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

const std::string header = "x,y,young,poisson,young_error,poisson_error";

// Nodes may be off their place on the grid by this share of a step.
constexpr double grid_tolerance = 1e-6;

struct Row {
  int line = 0;
  double v[6] = {};
};

[[noreturn]] void refuse(const std::string& file, int line, const std::string& why) {
  throw std::invalid_argument(fmt::format("{}:{}: {}", file, line, why));
}

Row parse(const std::string& file, int line, const std::string& text) {
  Row row{line, {}};
  std::string_view left = text;
  for (int k = 0; k < 6; ++k) {
    const std::size_t end = k < 5 ? left.find(',') : left.size();
    const auto number =
        end == std::string_view::npos ? std::nullopt : dem::parse_number(left.substr(0, end));
    if (!number)
      refuse(file, line, fmt::format("\"{}\" is not six numbers separated by commas", text));
    row.v[k] = *number;
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  if (!std::isfinite(row.v[0]) || !std::isfinite(row.v[1]))
    refuse(file, line, "a node's place is not finite");
  if (row.v[2] <= 0 || std::isinf(row.v[2]))
    refuse(file, line, fmt::format("young is {}; it must be positive (or nan)", row.v[2]));
  if (row.v[3] <= -1 || row.v[3] >= 0.5)
    refuse(file, line,
           fmt::format("poisson is {}; it must be between -1 and 0.5 (or nan)", row.v[3]));
  return row;
}

std::vector<Row> read_rows(const std::string& file) {
  std::istringstream stream(read_input(file, "an elastic map"));
  std::vector<Row> rows;
  bool headed = false;
  int line = 0;
  for (std::string text; std::getline(stream, text);) {
    ++line;
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (text.empty() || text[0] == '#') continue;
    if (headed) {
      rows.push_back(parse(file, line, text));
    } else if (text == header) {
      headed = true;
    } else {
      refuse(file, line, fmt::format("the header is \"{}\"; it must be \"{}\"", text, header));
    }
  }
  if (!headed) refuse(file, line, fmt::format("no header \"{}\"", header));
  return rows;
}

}  // namespace

std::string elastic_map_text(const ElasticMap& map) {
  std::string text = fmt::format(
      "# grainfield elastic map, plane strain: x, y in m, young in N/m; {} x {} nodes, x fastest\n"
      "{}\n",
      map.nx, map.ny, header);
  for (Eigen::Index k = 0; k < map.young.size(); ++k)
    text += fmt::format("{},{},{},{},{},{}\n", map.x0 + static_cast<double>(k % map.nx) * map.dx,
                        map.y0 + static_cast<double>(k / map.nx) * map.dy, map.young[k],
                        map.poisson[k], map.young_error[k], map.poisson_error[k]);
  return text;
}

void write_elastic_map(const std::string& file, const ElasticMap& map) {
  write_text_file(file, elastic_map_text(map));
}

ElasticMap read_elastic_map(const std::string& file) {
  const std::vector<Row> rows = read_rows(file);
  std::size_t nx = 0;
  while (nx < rows.size() && rows[nx].v[1] == rows[0].v[1]) ++nx;
  const std::size_t ny = nx > 0 ? rows.size() / nx : 0;
  if (nx < 2 || ny < 2 || nx * ny != rows.size())
    throw std::invalid_argument(
        fmt::format("{}: {} nodes with {} in the first row form no grid of at least 2 x 2", file,
                    rows.size(), nx));
  ElasticMap map;
  map.nx = static_cast<int>(nx);
  map.ny = static_cast<int>(ny);
  map.x0 = rows[0].v[0];
  map.y0 = rows[0].v[1];
  map.dx = (rows[nx - 1].v[0] - map.x0) / static_cast<double>(nx - 1);
  map.dy = (rows.back().v[1] - map.y0) / static_cast<double>(ny - 1);
  if (!(map.dx > 0) || !(map.dy > 0))
    throw std::invalid_argument(
        fmt::format("{}: x and y of the nodes must ascend, x fastest", file));
  const auto n = static_cast<Eigen::Index>(rows.size());
  map.young = map.poisson = map.young_error = map.poisson_error = Eigen::VectorXd(n);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    const double x = map.x0 + static_cast<double>(k % nx) * map.dx,
                 y = map.y0 + static_cast<double>(k / nx) * map.dy;
    if (std::abs(row.v[0] - x) > grid_tolerance * map.dx ||
        std::abs(row.v[1] - y) > grid_tolerance * map.dy)
      refuse(file, row.line,
             fmt::format("node ({}, {}) is not on the regular grid, which has ({:.10g}, {:.10g}) "
                         "here",
                         row.v[0], row.v[1], x, y));
    const auto node = static_cast<Eigen::Index>(k);
    map.young[node] = row.v[2];
    map.poisson[node] = row.v[3];
    map.young_error[node] = row.v[4];
    map.poisson_error[node] = row.v[5];
  }
  return map;
}

}  // namespace grainfield::coupling
