#include <algorithm>
#include <cmath>

#include "coupling/report/picture.h"
#include "coupling/report/style.h"

namespace grainfield::coupling {
namespace {

constexpr int frame_height = 330, frame_width = 480, legend_row = 24, title_height = 16;

constexpr double kFlat = 1e-3;      // a curve that varies by less is level
constexpr double kNearZero = 0.02;  // x that begins nearer to 0 begins at 0: plain tic labels

constexpr const char* kOwnLegend = "set key top left noenhanced samplen 2 noopaque\n";

struct Range {
  double low = 0, high = 0;
  bool any = false;
  void add(double v) {
    if (!std::isfinite(v)) return;
    low = any ? std::min(low, v) : v;
    high = any ? std::max(high, v) : v;
    any = true;
  }
};

bool has_band(const Series& s) {
  return s.error.size() == s.x.size() && s.error.array().isFinite().any();
}

// The colour of a series that has its own.
const char* own_colour(const Series& s) {
  return style::model[static_cast<std::size_t>(s.colour) % style::models];
}
std::string own_look(const Series& s) {
  return fmt::format("with {} lc rgb '{}' title {}",
                     s.points ? "linespoints lw 1 pt 7 ps 0.45" : "lines lw 1.8 dt 2",
                     own_colour(s), style::quoted(s.label));
}

std::string data_block(const std::string& name, const Series& s) {
  std::string text = "$" + name + " << EOD\n";
  for (Eigen::Index k = 0; k < s.x.size(); ++k)
    text += fmt::format("{} {} {}\n", style::number(s.x[k]), style::number(s.y[k]),
                        has_band(s) ? style::number(s.error[k]) : "NaN");
  return text + "EOD\n";
}

}  // namespace

Picture curves(const std::string& title, const std::string& x_label, const std::string& y_label,
               const std::vector<Frame>& frames, bool log_x) {
  Picture picture;
  picture.title = title;
  picture.curves = true;
  const int columns = frames.size() > 1 ? 2 : 1;
  const int rows = (static_cast<int>(frames.size()) + columns - 1) / columns;
  std::vector<std::string> labels, plots;
  std::string data;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::string plot;
    std::size_t model = 0;
    Range x, y;
    for (std::size_t s = 0; s < frames[f].series.size(); ++s) {
      const Series& series = frames[f].series[s];
      const std::string name = fmt::format("d{}_{}", f, s);
      data += data_block(name, series);
      for (double v : series.x) x.add(v);
      for (double v : series.y) y.add(v);
      if (has_band(series))
        for (Eigen::Index k = 0; k < series.y.size(); ++k) {
          y.add(series.y[k] - series.error[k]);
          y.add(series.y[k] + series.error[k]);
        }
      const auto part = [&](const std::string& text) { plot += (plot.empty() ? "" : ", ") + text; };
      if (series.colour >= 0) {
        // Vectors: gnuplot clears what lies under the points of its error bars.
        if (series.bars && has_band(series)) {
          part(fmt::format(
              "${} using 1:($2-$3):(0):(2*$3) with vectors nohead lw 1.4 lc rgb '{}' notitle", name,
              own_colour(series)));
        }
        part(fmt::format("${} using 1:2 {}", name, own_look(series)));
      } else if (series.simulation) {
        picture.band = picture.band || has_band(series);
        if (has_band(series))
          part(
              fmt::format("${} using 1:($2-$3):($2+$3) with filledcurves fc rgb '{}' fs solid 0.8 "
                          "noborder title 'standard error'",
                          name, style::band));
        part(fmt::format("${} using 1:2 with linespoints lw 1.6 pt 7 ps 0.35 lc rgb '{}' title {}",
                         name, style::simulation, style::quoted(series.label)));
      } else {
        const std::size_t look = model++ % style::models;
        if (series.banded && has_band(series)) {
          part(
              fmt::format("${} using 1:($2-$3):($2+$3) with filledcurves fc rgb '{}' fs "
                          "transparent solid 0.2 noborder notitle",
                          name, style::model[look]));
        }
        part(fmt::format("${} using 1:2 with lines lw 2 dt {} lc rgb '{}' title {}", name,
                         style::dash[look], style::model[look], style::quoted(series.label)));
      }
    }
    // What differs by round-off alone is drawn as one.
    const double size = std::max(std::fabs(y.low), std::fabs(y.high));
    const double room = y.high - y.low > kFlat * size ? 0.06 * (y.high - y.low) : 0.05 * size;
    if (!log_x && x.low > 0 && x.low < kNearZero * x.high) x.low = 0;
    std::string head = fmt::format("set title {} noenhanced\n", style::quoted(frames[f].title));
    // A range of its own for every frame: gnuplot would go on with that of the one before.
    head += x.any && x.high > x.low ? fmt::format("set xrange [{}:{}]\n", x.low, x.high)
                                    : std::string("set xrange [*:*]\n");
    const bool flat = !(room > 0);
    head += y.any ? fmt::format("set yrange [{}:{}]\n", flat ? -1 : y.low - room,
                                flat ? 1 : y.high + room)
                  : std::string("set yrange [*:*]\n");
    const bool own = frames[f].own_legend;
    plots.push_back((own ? kOwnLegend : "") + head + "plot " + plot +
                    (own ? "\nunset key\n" : "\n"));
  }
  const bool common = !frames.empty() && !frames.front().own_legend;
  const std::size_t entries = common ? frames.front().series.size() + 1 : 0;
  const int per_row = columns == 1 ? 2 : 3;
  const int legend_rows = (static_cast<int>(entries) + per_row - 1) / per_row;
  picture.width = columns == 1 ? 760 : columns * frame_width;
  const int legend = legend_rows * legend_row + 10;
  picture.height = rows * frame_height + legend + title_height;
  // The frames share the space above the legend, which stands in a strip of its own.
  const double below = static_cast<double>(legend) / picture.height;
  picture.program =
      data + fmt::format(
                 "set border 3 lw 1 lc rgb '#444444'\nset tics nomirror out\nset grid lc rgb "
                 "'#dddddd' lw 0.6\n"
                 "set xlabel {}\nset ylabel {}\nset xzeroaxis lc rgb '#888888' lw 0.8\nunset key\n"
                 "{}set multiplot\n",
                 style::quoted(x_label), style::quoted(y_label), log_x ? "set logscale x\n" : "");
  for (std::size_t f = 0; f < plots.size(); ++f) {
    const int column = static_cast<int>(f) % columns, row = static_cast<int>(f) / columns;
    const double height = (1 - below) / rows;
    picture.program +=
        fmt::format("set size {:.4f},{:.4f}\nset origin {:.4f},{:.4f}\n{}", 1.0 / columns, height,
                    static_cast<double>(column) / columns, 1 - height * (row + 1), plots[f]);
  }
  if (common) {
    // The legend alone: the first frame's entries drawn on an empty, invisible frame.
    std::string entries_only;
    std::size_t model = 0;
    for (const Series& series : frames.front().series) {
      const auto part = [&](const std::string& text) {
        entries_only += (entries_only.empty() ? "" : ", ") + text;
      };
      if (series.colour >= 0) {
        part("NaN " + own_look(series));
      } else if (series.simulation) {
        part(fmt::format("NaN with linespoints lw 1.6 pt 7 ps 0.5 lc rgb '{}' title {}",
                         style::simulation, style::quoted(series.label)));
        if (has_band(series))
          part(fmt::format("NaN with filledcurves fc rgb '{}' fs solid 0.8 title 'standard error'",
                           style::band));
      } else {
        const std::size_t look = model++ % style::models;
        part(fmt::format("NaN with lines lw 2 dt {} lc rgb '{}' title {}", style::dash[look],
                         style::model[look], style::quoted(series.label)));
      }
    }
    picture.program += fmt::format(
        "unset logscale\nset size 1,{0:.4f}\nset origin 0,0\nunset title\nunset border\nunset "
        "tics\nunset xlabel\n"
        "unset ylabel\nunset grid\nunset xzeroaxis\nset xrange [0:1]\nset yrange [0:1]\n"
        "set lmargin 0\nset rmargin 0\nset tmargin 0\nset bmargin 0\n"
        "set key noenhanced center center horizontal maxrows {1} samplen 3 noopaque\nplot {2}\n",
        below, legend_rows, entries_only);
  }
  picture.program += "unset multiplot\n";
  return picture;
}

Picture Chart::picture() const {
  Picture out = curves(title, x_label, y_label, frames, log_x);
  out.caption = caption;
  return out;
}

std::vector<Picture> side_by_side(const std::vector<std::string>& members,
                                  const std::vector<std::vector<Chart>>& charts) {
  std::vector<Chart> all;
  const auto named = [](auto& list, const std::string& title) -> decltype(list.front())& {
    for (auto& entry : list) {
      if (entry.title == title) return entry;
    }
    list.push_back({});
    list.back().title = title;
    return list.back();
  };
  for (std::size_t m = 0; m < charts.size(); ++m) {
    for (const Chart& chart : charts[m]) {
      Chart& shared = named(all, chart.title);
      if (shared.frames.empty()) {
        shared = chart;
        shared.frames.clear();
      }
      for (const Frame& frame : chart.frames) {
        Frame& place = named(shared.frames, frame.title);
        for (Series s : frame.series) {
          const bool alone = s.points || frame.series.size() == 1;
          s.label = alone ? members[m] : members[m] + ": " + s.label;
          s.colour = static_cast<int>(m);
          place.series.push_back(std::move(s));
        }
      }
    }
  }
  std::vector<Picture> out;
  for (const Chart& chart : all) out.push_back(chart.picture());
  return out;
}

}  // namespace grainfield::coupling
