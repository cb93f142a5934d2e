// Grains, contacts and walls as CSV.
#include "tests/fuzz/import.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_grains(std::string_view bytes) { import_bytes("csv", bytes); }

const Registration grains_is_there("grains", fuzz_grains);

}  // namespace
}  // namespace grainfield::fuzz
