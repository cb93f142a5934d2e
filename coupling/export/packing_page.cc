#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "coupling/export/forms.h"
#include "coupling/export/packing_page_script.h"
#include "coupling/store/vtu.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

// A number of six digits as JSON: nan and infinities have none.
std::string six(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null";
}

std::string point_text(const dem::Vec3& p, int dim) {
  if (dim == 2) return six(p.x()) + "," + six(p.y());
  return six(p.x()) + "," + six(p.y()) + "," + six(p.z());
}

// In space of a ball of the grain's volume.
double drawn_radius(const dem::Grain& grain) {
  if (grain.axes.isZero()) return grain.radius;
  return std::cbrt(3 * grain.volume / (4 * std::numbers::pi));
}

void add_grains(const dem::Snapshot& s, std::string& out) {
  const GrainNumbers numbers = grain_numbers(s);
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    const dem::Grain& g = s.grains[k];
    fmt::format_to(std::back_inserter(out), "{}[{},{},{},{},{},{},{},[", k > 0 ? ",\n" : "", g.id,
                   point_text(g.position, s.dim), six(drawn_radius(g)), six(numbers.mean_stress[k]),
                   numbers.contacts[k], six(g.velocity.norm()), g.fixed ? 1 : 0);
    if (s.dim == 2 && !g.outline.empty()) {
      const char* comma = "";
      for (const dem::Vec3& corner : outline(g)) {
        out += comma + six(corner.x() - g.position.x()) + "," + six(corner.y() - g.position.y());
        comma = ",";
      }
    }
    out += "]]";
  }
}

// From centre to centre, or to the contact point on a wall.
void add_contacts(const dem::Snapshot& s, std::string& out) {
  const char* comma = "";
  for (const dem::Contact& c : s.contacts) {
    const dem::Vec3 end = c.j >= 0 ? dem::second_place(s, c) : c.point;
    out += fmt::format("{}[{},{},{}]", comma,
                       point_text(s.grains[static_cast<std::size_t>(c.i)].position, s.dim),
                       point_text(end, s.dim), six(c.normal_force));
    comma = ",\n";
  }
}

}  // namespace

GrainNumbers grain_numbers(const dem::Snapshot& s) {
  GrainNumbers out{std::vector<double>(s.grains.size(), 0), std::vector<int>(s.grains.size(), 0)};
  const auto add = [&](std::int64_t grain, const dem::Vec3& arm, const dem::Vec3& force) {
    const auto k = static_cast<std::size_t>(grain);
    out.mean_stress[k] -= force.dot(arm) / s.dim / s.grains[k].volume;
    ++out.contacts[k];
  };
  for (const dem::Contact& c : s.contacts) {
    add(c.i, c.point - s.grains[static_cast<std::size_t>(c.i)].position, c.force);
    if (c.j >= 0) add(c.j, c.point - dem::second_place(s, c), -c.force);
  }
  return out;
}

std::string packing_page(const dem::Snapshot& packing, const std::string& title) {
  // "</" would end the script.
  std::string text = nlohmann::json(title).dump(-1, ' ', true);
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos;)
    text.insert(at + 1, "\\");
  std::string out = fmt::format(kPackingPageHead, fmt::arg("title", text));
  out += fmt::format("const dim = {};\nconst grains = [", packing.dim);
  add_grains(packing, out);
  out += "];\nconst contacts = [";
  add_contacts(packing, out);
  out += "];\n";
  out += kPackingPageScript;
  return out;
}

}  // namespace grainfield::coupling
