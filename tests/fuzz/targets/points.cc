// Points and rings of --points.
#include "coupling/app/points_csv.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_points(std::string_view bytes) {
  const InputFile file(bytes);
  attempt([&] { coupling::read_points_csv(file.path(), 2); });
  attempt([&] { coupling::read_points_csv(file.path(), 3); });
  attempt([&] { coupling::read_rings_csv(file.path()); });
}

const Registration points_is_there("points", fuzz_points);

}  // namespace
}  // namespace grainfield::fuzz
