#include <algorithm>
#include <stdexcept>

#include "coupling/report/scene.h"

namespace grainfield::coupling {

Picture marked_grains(const std::string& title, const dem::Snapshot& snapshot,
                      const std::vector<char>& marked, const std::string& caption) {
  if (marked.size() != snapshot.grains.size()) {
    throw std::invalid_argument(title + ": needs one value a grain");
  }
  Picture picture;
  picture.title = title;
  Scene scene(picture, snapshot);
  scene.add_grains([&](const dem::Grain& g) {
    return marked[static_cast<std::size_t>(&g - snapshot.grains.data())] != 0 ? "0x2c7fb8"
                                                                              : "0xf4f1ea";
  });
  scene.set_axes();
  scene.plot_grains("#666666");
  scene.plot_cell();
  picture.program += "\n";
  picture.caption = caption + scene.strays();
  return picture;
}

}  // namespace grainfield::coupling
