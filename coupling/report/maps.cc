#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "coupling/report/picture.h"
#include "coupling/report/style.h"

namespace grainfield::coupling {
namespace {

// The colour scale ends at these quantiles over all maps: the few points under a load would
// otherwise bleach everything else.
constexpr double low_quantile = 0.02, high_quantile = 0.99;

double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

std::pair<double, double> colour_range(const std::vector<Map>& maps, bool diverging) {
  std::vector<double> values;
  for (const Map& map : maps)
    for (double v : map.value)
      if (std::isfinite(v)) values.push_back(diverging ? std::abs(v) : v);
  if (values.empty()) return {diverging ? -1 : 0, 1};
  const double high = quantile(values, high_quantile);
  if (diverging) return high > 0 ? std::pair(-high, high) : std::pair(-1.0, 1.0);
  const double low = quantile(values, low_quantile);
  return high > low ? std::pair(low, high) : std::pair(low - 0.5, low + 0.5);
}

// Half a cell beyond the first and the last points: each stands in the middle of its cell.
struct Edges {
  Eigen::RowVector2d low, high;
};

Edges edges_of(const Map& map) {
  Edges out{map.points.colwise().minCoeff(), map.points.colwise().maxCoeff()};
  const Eigen::RowVector2d cells(std::max(map.nx - 1, 1), std::max(map.ny - 1, 1));
  const Eigen::RowVector2d half = 0.5 * (out.high - out.low).cwiseQuotient(cells);
  out.low -= half;
  out.high += half;
  return out;
}

// Pixels: the y axis with its label, the space between maps, and the colour box with its label.
constexpr double left_side = 96, between = 70, right_side = 85;
// Above a map, for one line of its title, and for each further one; the lowest colour box with room
// for its numbers.
constexpr double above_map = 36, title_line = 20, lowest_bar = 140;
// Pixels of a letter of a title.
constexpr double letter = 8.5;

// Breaks a title behind blanks and '=' so that its lines have at most `most` letters where they
// can.
std::vector<std::string> in_lines(const std::string& title, std::size_t most) {
  std::vector<std::string> out{""};
  std::size_t from = 0;
  while (from < title.size()) {
    const std::size_t end = std::min(title.find_first_of(" =", from), title.size() - 1) + 1;
    const std::string part = title.substr(from, end - from);
    if (!out.back().empty() && out.back().size() + part.size() > most) out.emplace_back();
    out.back() += part;
    from = end;
  }
  return out;
}

std::string title_command(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    const std::string quoted = style::quoted(line);
    text += (text.empty() ? "" : "\\n") + quoted.substr(1, quoted.size() - 2);
  }
  return fmt::format("set title \"{}\" offset 0,-0.5 noenhanced\n", text);
}

}  // namespace

Picture maps(const std::string& title, const std::string& x_label, const std::string& y_label,
             const std::string& value_label, const std::vector<Map>& all, bool diverging) {
  Picture picture;
  picture.title = title;
  picture.bitmap = true;
  picture.width = 980;
  double aspect = 0.3;  // height over width of a map
  if (!all.empty() && all.front().points.rows() > 1) {
    const Edges edges = edges_of(all.front());
    const Eigen::RowVector2d size = edges.high - edges.low;
    if (size.x() > 0 && size.y() > 0) aspect = std::clamp(size.y() / size.x(), 0.1, 1.2);
  }
  const int columns = aspect > 0.6 ? std::min<int>(3, static_cast<int>(all.size())) : 1;
  const int rows = (static_cast<int>(all.size()) + columns - 1) / std::max(1, columns);
  const double plot_width =
      (picture.width - right_side - left_side) / std::max(1, columns) - between;
  std::vector<std::vector<std::string>> titles;
  std::size_t most_lines = 1;
  for (const Map& map : all) {
    titles.push_back(
        in_lines(map.title, static_cast<std::size_t>((plot_width + between) / letter)));
    most_lines = std::max(most_lines, titles.back().size());
  }
  const double above = above_map + title_line * static_cast<double>(most_lines - 1);
  const int row_height = static_cast<int>(plot_width * aspect + above - above_map) + 112;
  picture.height = std::max(1, rows) * row_height + 10;
  std::string& p = picture.program;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Map& map = all[k];
    p += fmt::format("$m{} << EOD\n", k);
    for (int iy = 0; iy < map.ny; ++iy) {
      for (int ix = 0; ix < map.nx; ++ix) {
        const Eigen::Index row = ix + static_cast<Eigen::Index>(map.nx) * iy;
        p += fmt::format("{:.6g} {:.6g} {}\n", map.points(row, 0), map.points(row, 1),
                         style::number(map.value[row]));
      }
      p += "\n";
    }
    p += "EOD\n";
    for (std::size_t l = 0; l < map.lines.size(); ++l) {
      p += fmt::format("$m{}_{} << EOD\n", k, l);
      for (const auto& at : map.lines[l].points.rowwise()) {
        p += at.allFinite() ? fmt::format("{:.6g} {:.6g}\n", at[0], at[1]) : "\n";
      }
      p += "EOD\n";
    }
  }
  const auto [low_limit, high_limit] = colour_range(all, diverging);
  p += diverging ? style::diverging : style::sequential_palette;
  p += fmt::format(
      "set cbrange [{}:{}]\nset border lw 1 lc rgb '#444444'\nset tics out nomirror\nunset key\n"
      "set xlabel {} offset 0,0.2\nset cblabel {}\nset multiplot\n",
      low_limit, high_limit, style::quoted(x_label), style::quoted(value_label));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
    const double left = left_side + column * (plot_width + between);
    const double top = row * static_cast<double>(row_height) + above;
    const double w = picture.width, h = picture.height;
    const bool last = k + 1 == all.size();
    // One colour box for all the maps, to their right, beside the first and as high.
    const double box = std::max(plot_width * aspect, lowest_bar);
    p += fmt::format(
        "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\nset tmargin at screen {:.4f}\n"
        "set bmargin at screen {:.4f}\n",
        left / w, (left + plot_width) / w, 1 - top / h, 1 - (top + plot_width * aspect) / h);
    p += title_command(titles[k]);
    // Between two maps there is room for the numbers alone.
    p += column == 0 ? fmt::format("set ylabel {} offset 1,0\n", style::quoted(y_label))
                     : "unset ylabel\n";
    p += last ? fmt::format(
                    "set colorbox user origin screen {:.4f}, screen {:.4f} size screen 0.018, "
                    "screen {:.4f}\n",
                    (left_side + columns * (plot_width + between) - 45) / w, 1 - (above + box) / h,
                    box / h)
              : "unset colorbox\n";
    const Edges edges = edges_of(all[k]);
    p += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", edges.low.x(), edges.high.x(),
                     edges.low.y(), edges.high.y());
    p += fmt::format("plot $m{} using 1:2:3 with image", k);
    for (std::size_t l = 0; l < all[k].lines.size(); ++l)
      p += fmt::format(", $m{}_{} using 1:2 with lines {}", k, l, all[k].lines[l].look);
    p += "\n";
  }
  p += "unset multiplot\n";
  return picture;
}

}  // namespace grainfield::coupling
