#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "continuum/model.h"
#include "coupling/import/format.h"

namespace grainfield::coupling {

const std::vector<ImportFormat>& import_formats() {
  static const std::vector<ImportFormat> all{
      lammps_format(), liggghts_format(), yade_format(),
      csv_format(),    mercury_format(),  vtk_format(),
  };
  return all;
}

const ImportFormat& find_import_format(const std::string& name) {
  std::vector<std::string> names;
  for (const ImportFormat& format : import_formats()) {
    if (format.name == name) return format;
    names.push_back(format.name);
  }
  throw std::invalid_argument(fmt::format("--from: unknown format \"{}\"; nearest: {}; allowed: {}",
                                          name, continuum::nearest(name, names),
                                          fmt::join(names, ", ")));
}

}  // namespace grainfield::coupling
