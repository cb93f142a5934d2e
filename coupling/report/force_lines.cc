#include "coupling/report/force_lines.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/report/scene.h"

namespace grainfield::coupling {
namespace {

constexpr double kHorizontal = std::numbers::pi / 12;  // from the horizontal at most

}  // namespace

std::vector<std::size_t> extreme_contacts(const dem::Snapshot& snapshot, Extreme which,
                                          double alike, double least) {
  double sum = 0;
  int carrying = 0;
  for (const dem::Contact& c : snapshot.contacts) {
    if (c.j < 0 || !(c.normal_force > 0)) continue;
    sum += c.normal_force;
    ++carrying;
  }
  const double lowest = carrying > 0 ? least * sum / carrying : 0;
  const bool strongest = which == Extreme::strongest;
  const auto counts = [&](const dem::Contact& c) { return c.j >= 0 && c.normal_force > lowest; };
  // Each grain's bound; 0 or infinity: it has no contact that counts.
  std::vector<double> bound(snapshot.grains.size(),
                            strongest ? 0 : std::numeric_limits<double>::infinity());
  for (const dem::Contact& c : snapshot.contacts) {
    if (!counts(c)) continue;
    for (const std::int64_t g : {c.i, c.j}) {
      double& b = bound[static_cast<std::size_t>(g)];
      b = strongest ? std::max(b, c.normal_force) : std::min(b, c.normal_force);
    }
  }
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < snapshot.contacts.size(); ++k) {
    const dem::Contact& c = snapshot.contacts[k];
    if (!counts(c)) continue;
    for (const std::int64_t g : {c.i, c.j}) {
      const double b = bound[static_cast<std::size_t>(g)];
      if (strongest ? c.normal_force >= (1 - alike) * b : c.normal_force * (1 - alike) <= b) {
        out.push_back(k);
        break;
      }
    }
  }
  return out;
}

double horizontal_share(const dem::Snapshot& snapshot, const std::vector<std::size_t>& contacts) {
  if (contacts.empty()) return 0;
  double level = 0;
  for (const std::size_t k : contacts) {
    level += std::fabs(snapshot.contacts[k].normal.y()) < std::sin(kHorizontal) ? 1 : 0;
  }
  return level / static_cast<double>(contacts.size());
}

Picture force_lines(const std::string& title, const dem::Snapshot& snapshot, Extreme which) {
  Picture picture;
  picture.title = title;
  Scene scene(picture, snapshot);
  scene.add_grains([](const dem::Grain& g) { return g.fixed ? "0x9a9a9a" : "0xf4f1ea"; });
  const std::vector<std::size_t> contacts = extreme_contacts(snapshot, which);
  picture.program += "$lines << EOD\n";
  for (const std::size_t k : contacts) {
    const dem::Contact& c = snapshot.contacts[k];
    const dem::Vec3& from = snapshot.grains[static_cast<std::size_t>(c.i)].position;
    const dem::Vec3 way = snapshot.grains[static_cast<std::size_t>(c.j)].position - from;
    picture.program +=
        fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", from.x(), from.y(), way.x(), way.y());
  }
  picture.program += "EOD\n";
  scene.set_axes();
  scene.plot_grains("#d8d3c6");
  if (!contacts.empty()) {
    picture.program += fmt::format(", $lines using 1:2:3:4 with vectors nohead lw 1.5 lc rgb '{}'",
                                   which == Extreme::strongest ? "#7a1f1f" : "#1f4e7a");
  }
  picture.program += "\n";
  picture.caption = fmt::format(
      "Lines between the centres of grains whose contact carries the {} force of all on one of the "
      "two; {:.1f} % of {} are horizontal within 15 degrees.",
      which == Extreme::strongest ? "largest" : "smallest",
      100 * horizontal_share(snapshot, contacts), contacts.size());
  picture.caption += scene.strays();
  return picture;
}

}  // namespace grainfield::coupling
