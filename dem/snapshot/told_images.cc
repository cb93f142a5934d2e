#include "dem/snapshot/told_images.h"

#include "dem/snapshot/images.h"

namespace grainfield::dem {

bool count_images(const Snapshot& a, const Snapshot& b) {
  const auto told = [](const Snapshot& s, const char* word) {
    const auto at = s.attributes.find("images");
    return at != s.attributes.end() && at->second == word;
  };
  if (told(a, "untold") && told(b, "counted")) return false;
  if (told(b, "untold") && told(a, "counted")) return false;
  return counts_images(a) || counts_images(b);
}

}  // namespace grainfield::dem
