// The forms in which `export` writes a packing or a field for other programs and for the eye. A new
// form is one function and one line in exporters.cc.
#pragma once
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/store/output_folder.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Where it goes: files of this folder whose names begin with `stem`.
struct ExportTarget {
  const OutputFolder& folder;
  std::string stem;    ///< "packing", "realization_000-loaded"
  std::string title;   ///< of pages
  std::string column;  ///< of a field's picture: "sigma_yy"
  std::string note;    ///< on pages and pictures: forces of a Python function; empty: none
};

struct Exporter {
  std::string name;     ///< of --to
  std::string meaning;  ///< for --help
  /// Throw std::invalid_argument for what the form cannot hold, and dem::StorageFailed. Null: the
  /// form takes no packings, or no fields.
  void (*packing)(const dem::Snapshot&, const ExportTarget&);
  void (*field)(const Field&, const ExportTarget&);
};

const std::vector<Exporter>& exporters();
/// Throws std::invalid_argument, "--to: found ...", with the nearest name.
const Exporter& find_exporter(const std::string& name);

}  // namespace grainfield::coupling
