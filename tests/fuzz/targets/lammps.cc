// Dumps of LAMMPS.
#include "tests/fuzz/import.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_lammps(std::string_view bytes) { import_bytes("lammps", bytes); }

const Registration lammps_is_there("lammps", fuzz_lammps);

}  // namespace
}  // namespace grainfield::fuzz
