#include <fmt/format.h>

#include <algorithm>

#include "coupling/export/forms.h"

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


def dressed(shown, where, name, title):
    ColorBy(shown, (where, name))
    shown.RescaleTransferFunctionToDataRange(True)
    shown.SetScalarBarVisibility(view, True)
    colours = GetColorTransferFunction(name)
    colours.NanOpacity = 0
    GetScalarBar(colours, view).Title = title


)";

constexpr const char* kEnd = R"(
view.ResetCamera(True)
Render()
)";
constexpr const char* kFlat = "view.InteractionMode = \"2D\"\n";
constexpr const char* kFromAbove = R"(view.ResetCamera()
GetActiveCamera().Azimuth(25)
GetActiveCamera().Elevation(20)
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
        "balls.GlyphType.ThetaResolution = balls.GlyphType.PhiResolution = 24\n"
        "shown = Show(balls, view)\n";
  } else {
    out += "shown = Show(grains, view)\n";
    if (!space) out += "shown.Representation = \"Surface With Edges\"\n";
  }
  out += fmt::format(
      "dressed(shown, \"{}\", \"pressure\", \"pressure ({})\")\n"
      "contacts = opened(\"{}-contacts.vtu\")\n"
      "lines = Show(contacts, view)\n"
      "lines.LineWidth = 2\n"
      "ColorBy(lines, (\"CELLS\", \"normal_force\"))\n"
      "chains = opened(\"{}-chains.vtu\")\n"
      "Hide(chains, view)\n",
      space ? "POINTS" : "CELLS", space ? "Pa" : "N/m", stem, stem);
  out += space ? kFromAbove : kFlat;
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
    out += fmt::format("dressed(shown, \"POINTS\", \"{0}\", \"{0} ({1})\")\n", found->name,
                       found->unit);
  }
  out += field.points.cols() == 2 ? kFlat : kFromAbove;
  return out + kEnd;
}

}  // namespace grainfield::coupling
