#include "coupling/base/unknown_name.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dem/words/nearest.h"

namespace grainfield::coupling {

std::string unknown_name(const std::string& what, const std::string& found,
                         const std::vector<std::string>& known) {
  std::string text = fmt::format("unknown {} \"{}\"", what, found);
  if (known.empty()) return text + "; there is none";
  return text + fmt::format("; known: {}; did you mean \"{}\"?", fmt::join(known, ", "),
                            dem::nearest_of(found, known));
}

}  // namespace grainfield::coupling
