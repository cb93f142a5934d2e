// Dumps of LIGGGHTS.
#include "tests/fuzz/import.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_liggghts(std::string_view bytes) { import_bytes("liggghts", bytes); }

const Registration liggghts_is_there("liggghts", fuzz_liggghts);

}  // namespace
}  // namespace grainfield::fuzz
