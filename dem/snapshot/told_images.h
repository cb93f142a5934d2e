// Whether the images of two states can be compared.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Whether displacement(images.h) between the two goes by their images: one counts them, and none
/// is without beside one from a file that tells them. States that an import has read say in the
/// attribute `images` what their file told: "counted" (flags, or places that were not carried
/// back), "not carried back" (grains lie far out of the cell), "untold" (none of this: images are
/// counted from the places, and hold beside a state that was not carried back).
bool count_images(const Snapshot& a, const Snapshot& b);

}  // namespace grainfield::dem
