#include "coupling/export/paraview_script.h"

#include <fmt/format.h>

#include <algorithm>

namespace grainfield::coupling {
namespace {

constexpr const char* kBegin =
    R"(# Opens in ParaView: paraview --script=THIS_FILE, or its menu Tools, Python Shell, Run Script.
import os

from paraview.simple import *

here = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else os.getcwd()
view = GetActiveViewOrCreate("RenderView")


def opened(name):
    return XMLUnstructuredGridReader(registrationName=name, FileName=[os.path.join(here, name)])


)";

constexpr const char* kEnd = R"(
ResetCamera()
Render()
)";

}  // namespace

std::string paraview_of_packing(const std::string& stem, const dem::Snapshot& packing) {
  const bool space = packing.dim == 3;
  const bool surfaces = std::any_of(packing.grains.begin(), packing.grains.end(),
                                    [](const dem::Grain& g) { return !g.axes.isZero(0); });
  std::string out = kBegin;
  out += fmt::format("grains = opened(\"{}-grains.vtu\")\n", stem);
  if (space && !surfaces) {
    out +=
        "balls = Glyph(registrationName=\"balls\", Input=grains, GlyphType=\"Sphere\")\n"
        "balls.ScaleArray = [\"POINTS\", \"radius\"]\n"
        "balls.ScaleFactor = 2\n"
        "balls.GlyphMode = \"All Points\"\n"
        "shown = Show(balls, view)\n";
  } else {
    out += "shown = Show(grains, view)\n";
    if (!space) out += "shown.Representation = \"Surface With Edges\"\n";
  }
  out += fmt::format(
      "ColorBy(shown, (\"{}\", \"pressure\"))\n"
      "shown.RescaleTransferFunctionToDataRange(True)\n"
      "shown.SetScalarBarVisibility(view, True)\n"
      "contacts = opened(\"{}-contacts.vtu\")\n"
      "lines = Show(contacts, view)\n"
      "lines.LineWidth = 2\n"
      "ColorBy(lines, (\"CELLS\", \"normal_force\"))\n"
      "chains = opened(\"{}-chains.vtu\")\n"
      "Hide(chains, view)\n",
      space ? "POINTS" : "CELLS", stem, stem);
  if (!space) out += "view.InteractionMode = \"2D\"\n";
  return out + kEnd;
}

std::string paraview_of_field(const std::string& stem, const Field& field,
                              const std::string& column) {
  const Column* found = field.find(column);
  if (found == nullptr && !field.columns.empty()) found = &field.columns.front();
  std::string out = kBegin;
  out += fmt::format("field = opened(\"{}.vtu\")\nshown = Show(field, view)\n", stem);
  if (field.nx < 2) out += "shown.Representation = \"Points\"\nshown.PointSize = 6\n";
  if (found != nullptr) {
    out += fmt::format("ColorBy(shown, (\"POINTS\", \"{}\"))\n", found->name);
    out +=
        "shown.RescaleTransferFunctionToDataRange(True)\nshown.SetScalarBarVisibility(view, "
        "True)\n";
  }
  if (field.points.cols() == 2) out += "view.InteractionMode = \"2D\"\n";
  return out + kEnd;
}

}  // namespace grainfield::coupling
