#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "coupling/averaging/extent.h"
#include "coupling/averaging/layer.h"
#include "coupling/report/picture.h"
#include "coupling/report/scene.h"
#include "coupling/report/style.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

// Forces above this quantile are drawn as wide as it: else the one under the load dwarfs the rest.
constexpr double width_quantile = 0.99;
constexpr double widest = 9;          // pixels; and not above
constexpr double widest_share = 1.2;  // of a mean diameter
constexpr double least_share = 0.02;  // of the widest: thinner lines are not drawn
// Displacement arrows: the 99 % quantile is drawn this many mean diameters long; of more grains
// than this every n-th has an arrow.
constexpr double arrow_diameters = 3;
constexpr std::size_t most_arrows = 1800;
constexpr int above_colours = 56;  // pixels over the packing, for a colour bar

struct Line {
  Eigen::Vector2d from, to;
  double force;
};

std::vector<Line> force_lines(const dem::Snapshot& snapshot, const dem::Snapshot* reference) {
  std::map<std::pair<std::int64_t, std::int64_t>, double> before;
  if (reference)
    for (const dem::Contact& c : reference->contacts) before[{c.i, c.j}] = c.normal_force;
  std::vector<Line> lines;
  const auto at = [](const dem::Snapshot& s, std::int64_t g) -> Eigen::Vector2d {
    return s.grains[static_cast<std::size_t>(g)].position.head<2>();
  };
  const auto end = [&](const dem::Snapshot& s, const dem::Contact& c) -> Eigen::Vector2d {
    return c.j >= 0 ? Eigen::Vector2d(dem::second_place(s, c).head<2>())
                    : Eigen::Vector2d(c.point.head<2>());
  };
  for (const dem::Contact& c : snapshot.contacts) {
    double force = c.normal_force;
    const auto old = before.find({c.i, c.j});
    if (old != before.end()) {
      force -= old->second;
      before.erase(old);
    }
    lines.push_back({at(snapshot, c.i), end(snapshot, c), force});
  }
  if (reference)  // contacts that were lost
    for (const dem::Contact& c : reference->contacts)
      if (before.count({c.i, c.j}))
        lines.push_back({at(*reference, c.i), end(*reference, c), -c.normal_force});
  return lines;
}

// 0 without values.
double quantile(std::vector<double> sizes) {
  if (sizes.empty()) return 0;
  const auto k =
      static_cast<std::ptrdiff_t>(width_quantile * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), sizes.begin() + k, sizes.end());
  return sizes[static_cast<std::size_t>(k)];
}

double force_scale(const std::vector<Line>& lines) {
  std::vector<double> sizes;
  for (const Line& line : lines)
    if (line.force != 0) sizes.push_back(std::abs(line.force));
  return sizes.empty() ? 1 : quantile(std::move(sizes));
}

// Over the packing: the colours of style::sequential from 0 to `most`.
void add_colour_bar(Picture& picture, double most, const std::string& label) {
  const double height = picture.height;
  picture.program += style::sequential_palette;
  picture.program += fmt::format(
      "set cbrange [0:{:.6g}]\nset colorbox horizontal user origin screen 0.35, screen {:.4f} size "
      "screen 0.4, screen {:.4f}\nset label 2 {} at screen 0.34, screen {:.4f} right\n",
      most, 1 - 20 / height, 10 / height, style::quoted(label), 1 - 15 / height);
}

}  // namespace

Picture packing(const std::string& title, const dem::Snapshot& snapshot,
                const dem::Snapshot* reference, const std::string& vertical) {
  Picture picture;
  picture.title = title;
  std::string& p = picture.program;
  const bool arrow = snapshot.loaded_grain >= 0;
  Scene scene(picture, snapshot, arrow ? 66 : 24);
  scene.add_grains([](const dem::Grain& g) { return g.fixed ? "0x9a9a9a" : "0xe9e4d8"; });
  const std::vector<Line> lines = force_lines(snapshot, reference);
  const double scale = force_scale(lines);
  p += "$lines << EOD\n";
  for (const Line& line : lines) {
    const double share = std::min(1.0, std::abs(line.force) / scale);
    if (share < least_share) continue;
    const char* colour = !reference ? "0x7a1f1f" : line.force > 0 ? "0xb2182b" : "0x2166ac";
    // A vector of width share; one line per vector, its width a column.
    p += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.3f} {}\n", line.from.x(), line.from.y(),
                     line.to.x() - line.from.x(), line.to.y() - line.from.y(), share, colour);
  }
  p += "EOD\n";
  scene.set_axes(vertical);
  if (arrow)
    for (const dem::Grain& g : snapshot.grains)
      if (g.id == snapshot.loaded_grain) {
        p += fmt::format(
            "set arrow 1 from first {0:.6g}, graph {1:.4f} to first {0:.6g}, first {2:.6g} lw 3 lc "
            "rgb '#000000' head size screen 0.012,22 filled front\n",
            g.position.x(), 1 + 46.0 / scene.plot_height(), top_of(g));
        p += fmt::format("set label 1 {} at first {:.6g}, graph {:.4f} left offset 1,0 front\n",
                         style::quoted(fmt::format("F = {:.4g} N", snapshot.applied_force.norm())),
                         g.position.x(), 1 + 34.0 / scene.plot_height());
      }
  scene.plot_grains("#b9b2a0");
  // gnuplot takes one width per plot: forces go into classes of equal width.
  const double pixels = std::min(
      widest, widest_share * scene.pixels(snapshot.grains.empty() ? 1 : mean_diameter(snapshot)));
  constexpr int classes = 12;
  for (int k = 0; k < classes; ++k)
    p += fmt::format(
        ", $lines using ($5>{0:.4f}&&$5<={1:.4f}?$1:NaN):2:3:4:6 with vectors nohead lw {2:.2f} lc "
        "rgb variable",
        static_cast<double>(k) / classes, (k + 1.0) / classes, pixels * (k + 0.5) / classes);
  scene.plot_cell();
  p += "\n";
  picture.caption =
      reference ? fmt::format(
                      "Change of the normal forces by the load: red grows, blue shrinks; the "
                      "widest lines stand for {:.3g} N and more.",
                      scale)
                : fmt::format(
                      "Normal forces as lines between centres; the widest stand for {:.3g} N and "
                      "more.",
                      scale);
  picture.caption += scene.strays();
  return picture;
}

Picture grains_by_age(const std::string& title, const dem::Snapshot& snapshot) {
  Picture picture;
  picture.title = title;
  Scene scene(picture, snapshot, above_colours);
  double oldest = 0, youngest = 0;
  bool first = true;
  for (const dem::Grain& g : snapshot.grains) {
    if (g.fixed) continue;
    const auto id = static_cast<double>(g.id);
    oldest = first ? id : std::min(oldest, id);
    youngest = first ? id : std::max(youngest, id);
    first = false;
  }
  const double span = std::max(1.0, youngest - oldest);
  scene.add_grains([&](const dem::Grain& g) -> std::string {
    return g.fixed ? "0x9a9a9a" : style::sequential((static_cast<double>(g.id) - oldest) / span);
  });
  scene.set_axes();
  add_colour_bar(picture, span, "grains dropped before");
  scene.plot_grains("#666666");
  // A plot without points: gnuplot draws the bar where something has its colours.
  picture.program += ", NaN with lines palette\n";
  picture.caption =
      "Colour by the order in which the grains were dropped: dark first, bright last.";
  picture.caption += scene.strays();
  return picture;
}

Picture displacements(const std::string& title, const dem::Snapshot& before,
                      const dem::Snapshot& after) {
  if (before.grains.size() != after.grains.size())
    throw std::invalid_argument(
        fmt::format("snapshots do not belong together: {} grains and {} in the reference",
                    after.grains.size(), before.grains.size()));
  Picture picture;
  picture.title = title;
  Scene scene(picture, before, 24, arrow_diameters * mean_diameter(before));
  scene.add_grains([](const dem::Grain& g) { return g.fixed ? "0x9a9a9a" : "0xe9e4d8"; });
  std::vector<double> lengths;
  for (std::size_t g = 0; g < before.grains.size(); ++g)
    if (!before.grains[g].fixed)
      lengths.push_back((after.grains[g].position - before.grains[g].position).norm());
  const double longest = quantile(lengths);
  const double factor = longest > 0 ? arrow_diameters * mean_diameter(before) / longest : 0;
  const std::size_t every = 1 + lengths.size() / most_arrows;
  std::string& p = picture.program;
  p += "$arrows << EOD\n";
  std::size_t count = 0;
  for (std::size_t g = 0; g < before.grains.size(); ++g) {
    if (before.grains[g].fixed || count++ % every != 0) continue;
    const dem::Vec3& x = before.grains[g].position;
    dem::Vec3 u = factor * (after.grains[g].position - x);
    // The few longest are cut to the quantile's length.
    const double most = arrow_diameters * mean_diameter(before);
    if (u.norm() > most) u *= most / u.norm();
    p += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", x.x(), x.y(), u.x(), u.y());
  }
  p += "EOD\n";
  scene.set_axes();
  scene.plot_grains("#d0cabb");
  p += ", $arrows using 1:2:3:4 with vectors head size screen 0.004,20 filled lw 0.9 lc rgb "
       "'#0b3c6f'\n";
  picture.caption = fmt::format(
      "Displacements, drawn {:.3g} times as long; the longest arrows stand for {:.3g} m and more"
      "{}.",
      factor, longest, every > 1 ? fmt::format("; one grain in {}", every) : "");
  picture.caption += scene.strays();
  return picture;
}

}  // namespace grainfield::coupling
