// `--set key.path=value`, one a line, over a case that names a study alone.
#include "coupling/case/case.h"
#include "coupling/case/cost.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_set(std::string_view bytes) {
  static const InputFile file("study = \"point-load\"\n");
  attempt(
      [&] { coupling::outlook_text(coupling::read_case(file.path(), false, lines_of(bytes))); });
}

const Registration set_is_there("set", fuzz_set);

}  // namespace
}  // namespace grainfield::fuzz
