// Measured stresses, as `import-field` reads them: of heaps and layers, in two and three
// dimensions.
#include "coupling/tasks/measured_field.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

void fuzz_measurement(std::string_view bytes) {
  const InputFile file(bytes);
  for (const char* geometry : {"heap", "layer"}) {
    for (const int dim : {2, 3}) {
      attempt([&] {
        coupling::MeasuredRequest request;
        request.file = file.path();
        request.geometry = geometry;
        request.dim = dim;
        request.height = 0.3;
        request.left_deg = request.right_deg = 30;
        request.rho_g = 1.5e4;
        request.load = 10;
        const coupling::Field field = coupling::measured_field(request);
        coupling::name_of_measured(field);
        coupling::measured_doubts(field);
      });
    }
  }
}

const Registration measurement_is_there("measurement", fuzz_measurement);

}  // namespace
}  // namespace grainfield::fuzz
