// STL files of walls, and the surface that the grains would feel.
#include "dem/walls/stl.h"

#include "dem/walls/mesh.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_stl(std::string_view bytes) {
  const InputFile file(bytes);
  for (const bool inside : {false, true}) {
    for (const bool open : {false, true}) {
      attempt([&] {
        const auto triangles = dem::read_stl(file.path(), {1e-3, inside, open});
        dem::mesh_surface(triangles, file.path());
      });
    }
  }
}

const Registration stl_is_there("stl", fuzz_stl);

}  // namespace
}  // namespace grainfield::fuzz
