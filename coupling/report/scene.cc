#include "coupling/report/scene.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "coupling/averaging/extent.h"
#include "coupling/averaging/layer.h"
#include "coupling/report/style.h"
#include "coupling/store/vtu.h"

namespace grainfield::coupling {
namespace {

constexpr std::size_t most_in_svg = 200;  // grains; beyond, a bitmap is smaller
constexpr int picture_width = 980, below = 80, side = 96, right_side = 20;  // pixels
constexpr double most_slender = 1.1;  // height of the plot over its width; beyond it is narrower
constexpr double label_height = 30;   // pixels of a mark on the y axis
constexpr double stray_gap = 3;       // largest diameters

// A round step (1, 2 or 5 times a power of ten) that gives at most so many marks on a span.
double round_step(double span, double marks) {
  const double least = span / std::max(marks, 1.0);
  const double unit = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * unit >= least) return factor * unit;
  }
  return 10 * unit;
}

bool any_outline(const dem::Snapshot& snapshot) {
  return std::any_of(snapshot.grains.begin(), snapshot.grains.end(),
                     [](const dem::Grain& g) { return !g.outline.empty(); });
}

}  // namespace

Scene::Scene(Picture& picture, const dem::Snapshot& snapshot, int above, double headroom)
    : picture_(picture), snapshot_(snapshot), above_(above) {
  std::vector<double> lefts;
  double bottom = 0, top = 1, diameter = 0;
  // A funnel's plates hang above the picture.
  const bool free = std::any_of(snapshot.grains.begin(), snapshot.grains.end(),
                                [](const dem::Grain& g) { return !g.fixed; });
  bool any = false;
  for (const dem::Grain& g : snapshot.grains) {
    bottom = lefts.empty() ? bottom_of(g) : std::min(bottom, bottom_of(g));
    lefts.push_back(left_of(g));
    if (free && g.fixed) continue;
    top = any ? std::max(top, top_of(g)) : top_of(g);
    diameter = std::max(diameter, 2 * g.radius);
    any = true;
  }
  if (!lefts.empty()) find_bulk(stray_gap * diameter);
  if (snapshot.cell.periodic[0] && snapshot.cell.periodic[1]) {
    for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      const dem::Vec3 corner = snapshot.cell.low + snapshot.cell.edges * dem::Vec3(a, b, 0);
      left_ = std::min(left_, corner.x());
      right_ = std::max(right_, corner.x());
      bottom = std::min(bottom, corner.y());
      top = std::max(top, corner.y());
    }
  }
  const double margin = 0.01 * (right_ - left_);
  left_ -= margin;
  right_ += margin;
  bottom_ = bottom - margin;
  top_ = top + margin + headroom;
  picture.bitmap = snapshot.grains.size() > most_in_svg;
  picture.width = picture_width;
  plot_width_ = picture_width - side - right_side;
  const double slender = (top_ - bottom_) / (right_ - left_);
  if (slender > most_slender) {
    plot_width_ = static_cast<int>(plot_width_ * most_slender / slender);
    picture.width = plot_width_ + side + right_side;
  }
  plot_height_ = static_cast<int>(plot_width_ * (top_ - bottom_) / (right_ - left_));
  picture.height = plot_height_ + above + below;
}

// The largest group of grains without a gap in x. Fixed ones (a rough floor) do not count where
// others are.
void Scene::find_bulk(double gap) {
  std::vector<std::pair<double, double>> spans;
  const bool all_fixed = std::all_of(snapshot_.grains.begin(), snapshot_.grains.end(),
                                     [](const dem::Grain& g) { return g.fixed; });
  for (const dem::Grain& g : snapshot_.grains) {
    if (all_fixed || !g.fixed) spans.emplace_back(left_of(g), right_of(g));
  }
  std::sort(spans.begin(), spans.end());
  std::size_t best = 0, begin = 0;
  double right = spans.front().second;
  for (std::size_t k = 0; k <= spans.size(); ++k) {
    const bool ends = k == spans.size() || spans[k].first > right + gap;
    if (ends && k - begin > best) {
      best = k - begin;
      left_ = spans[begin].first;
      right_ = right;
    }
    if (k == spans.size()) break;
    if (ends) begin = k;
    right = std::max(right, spans[k].second);
  }
  strays_ = static_cast<int>(spans.size() - best);
}

std::string Scene::strays() const {
  if (strays_ == 0) return "";
  return fmt::format(" {} grain{} that rolled off {} outside the picture.", strays_,
                     strays_ == 1 ? "" : "s", strays_ == 1 ? "lies" : "lie");
}

void Scene::add_grains(const std::function<std::string(const dem::Grain&)>& colour) {
  std::string& p = picture_.program;
  p += "$grains << EOD\n";
  const bool outlines = any_outline(snapshot_);
  for (const dem::Grain& g : snapshot_.grains) {
    const std::string rgb = colour(g);
    if (!outlines) {
      p += fmt::format("{:.6g} {:.6g} {:.6g} {}\n", g.position.x(), g.position.y(), g.radius, rgb);
      continue;
    }
    const auto corners = outline(g, 24);
    for (std::size_t k = 0; k <= corners.size(); ++k) {
      const dem::Vec3& c = corners[k % corners.size()];
      p += fmt::format("{:.6g} {:.6g} {}\n", c.x(), c.y(), rgb);
    }
    p += "\n";
  }
  p += "EOD\n";
}

void Scene::set_axes(const std::string& vertical) {
  const double width = picture_.width, height = picture_.height;
  picture_.program += fmt::format(
      "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n"
      "set tmargin at screen {:.4f}\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
      "set border 3 lw 1 lc rgb '#444444'\nset tics out nomirror\nset ytics {:g}\nunset key\n"
      "set xlabel 'x (m)'\nset ylabel '{} (m)' offset 1,0\n",
      side / width, 1 - right_side / width, below / height, 1 - above_ / height, left_, right_,
      bottom_, top_, round_step(top_ - bottom_, plot_height_ / label_height), vertical);
}

void Scene::plot_grains(const char* edge) {
  picture_.program += fmt::format("set style fill solid 1 border rgb '{}'\n", edge);
  if (any_outline(snapshot_)) {
    picture_.program += fmt::format(
        "plot $grains using 1:2:3 with filledcurves closed fc rgb variable, "
        "$grains using 1:2 with lines lw 0.3 lc rgb '{}'",
        edge);
  } else {
    picture_.program += "plot $grains using 1:2:3:4 with circles fc rgb variable lw 0.5";
  }
}

void Scene::plot_cell() {
  const dem::Cell<3>& cell = snapshot_.cell;
  if (!cell.periodic[0] || !cell.periodic[1]) return;
  picture_.program += ", '-' using 1:2 with lines lw 1.2 dt 2 lc rgb '#333333'\n";
  for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}) {
    const dem::Vec3 corner = cell.low + cell.edges * dem::Vec3(a, b, 0);
    picture_.program += fmt::format("{:.6g} {:.6g}\n", corner.x(), corner.y());
  }
  picture_.program += "e";
}

}  // namespace grainfield::coupling
