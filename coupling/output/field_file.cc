#include "coupling/output/field_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <filesystem>
#include <stdexcept>

#include "coupling/output/field_csv.h"

namespace grainfield::coupling {
namespace {

std::string ending_of(const std::string& file) {
  return boost::algorithm::to_lower_copy(std::filesystem::path(file).extension().string());
}

}  // namespace

void require_ending(const std::string& option, const std::string& file,
                    const std::vector<std::string>& endings, const std::string& what) {
  const std::string ending = ending_of(file);
  if (ending.empty() || std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  throw std::invalid_argument(fmt::format("{}: found {}, whose ending is \"{}\"; allowed: {} ({})",
                                          option, file, ending, fmt::join(endings, ", "), what));
}

void require_field_ending(const std::string& option, const std::string& file) {
  require_ending(option, file, {".h5", ".hdf5", ".csv"}, "HDF5, or a table as CSV");
}

std::string write_field_file(const std::string& file, const NamedFields& fields) {
  require_field_ending("-o", file);
  if (ending_of(file) != ".csv") {
    write_fields(file, fields);
    return "";
  }
  write_field_csv(file, fields.front().second);
  if (fields.size() < 2) return "";
  std::vector<std::string> others;
  for (std::size_t k = 1; k < fields.size(); ++k) others.push_back(fields[k].first);
  return fmt::format("{} holds {}; a file .h5 would hold {}, too", file, fields.front().first,
                     fmt::join(others, ", "));
}

}  // namespace grainfield::coupling
