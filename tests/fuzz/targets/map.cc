// Maps of coefficients and of elastic constants, which models take (map = FILE.csv).
#include "continuum/elastic_field.h"
#include "continuum/osl/field_map.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_map(std::string_view bytes) {
  const InputFile file(bytes);
  attempt([&] { continuum::osl::map_columns(file.path()); });
  attempt([&] {
    const auto map = continuum::osl::read_field_map(file.path());
    for (const auto& [name, values] : map.values) map.at(name, 0.3, -0.4);
    map.require_cover("osl", 1, 1);
  });
  attempt([&] { continuum::read_elastic_field(file.path()).moduli(0.3, -0.4); });
}

const Registration map_is_there("map", fuzz_map);

}  // namespace
}  // namespace grainfield::fuzz
