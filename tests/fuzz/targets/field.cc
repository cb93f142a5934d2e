// Fields in HDF5, up to the lines that `compare` and `fit` take from them.
#include "coupling/observe/field_observations.h"
#include "coupling/store/field_io.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_field(std::string_view bytes) {
  const InputFile file(bytes);
  std::vector<std::string> names;
  attempt([&] { names = coupling::list_fields(file.path()); });
  for (const std::string& name : names) {
    attempt([&] {
      const std::string where = file.path() + ":/" + name;
      const coupling::Field field = coupling::read_field(file.path(), name);
      const coupling::LineOptions lines;
      coupling::observe_fields({{name, field}}, lines, where);
    });
  }
}

const Registration field_is_there("field", fuzz_field);

}  // namespace
}  // namespace grainfield::fuzz
