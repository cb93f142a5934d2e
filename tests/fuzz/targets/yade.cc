// Texts of YADE.
#include "tests/fuzz/import.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_yade(std::string_view bytes) { import_bytes("yade", bytes); }

const Registration yade_is_there("yade", fuzz_yade);

}  // namespace
}  // namespace grainfield::fuzz
