#include <stdexcept>

#include "coupling/base/unknown_name.h"
#include "coupling/strain/measure.h"

namespace grainfield::coupling {
namespace {

const std::vector<std::string> sharp{"circle", "square"};
const std::vector<std::string> smooth{"lucy", "gaussian"};

}  // namespace

const std::vector<MeasureEntry>& strain_registry() {
  static const std::vector<MeasureEntry> all{
      {"cambou", "relative centre displacements at contacts against branches", sharp, make_cambou},
      {"cundall", "centre displacements against centre positions, means removed", sharp,
       make_cundall},
      {"liao", "relative displacements at contacts with spins against branches", sharp, make_liao},
      {"derivative", "differences of the mean displacement of neighbouring elements", sharp,
       make_derivative},
      {"kernel", "gradient of the coarse-grained displacement", smooth, make_kernel_gradient},
  };
  return all;
}

const std::vector<std::string>& strain_measures() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const MeasureEntry& entry : strain_registry()) list.push_back(entry.name);
    return list;
  }();
  return names;
}

const MeasureEntry& find_measure(const std::string& name) {
  for (const MeasureEntry& entry : strain_registry())
    if (entry.name == name) return entry;
  throw std::invalid_argument(unknown_name("strain measure", name, strain_measures()));
}

}  // namespace grainfield::coupling
