#include "coupling/reproduce/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <vector>

namespace grainfield::coupling {

namespace fs = std::filesystem;

Results::Results(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw std::invalid_argument(folder + ": no such folder; it holds the summaries (CASE.json)");
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") {
      files.push_back(entry.path());
    } else {
      others_.push_back(entry.path().filename().string());
    }
  }
  std::sort(others_.begin(), others_.end());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) all_[file.stem().string()] = read_summary(file.string());
}

std::vector<std::string> Results::beside(const std::string& name) const {
  std::vector<std::string> out;
  std::copy_if(others_.begin(), others_.end(), std::back_inserter(out),
               [&](const std::string& file) { return file.starts_with(name + "."); });
  return out;
}

std::optional<double> Results::plain(const std::string& name, const std::string& key) const {
  const auto study = all_.find(name);
  if (study == all_.end()) return std::nullopt;
  const auto at = study->second.find(key);
  if (at == study->second.end()) return std::nullopt;
  if (const auto* number = std::get_if<double>(&at->second)) return *number;
  if (const auto* count = std::get_if<std::int64_t>(&at->second)) {
    return static_cast<double>(*count);
  }
  return std::nullopt;
}

std::optional<Measured> Results::number(const std::string& name, const std::string& key) const {
  const auto value = plain(name, key);
  if (!value || std::isnan(*value)) return std::nullopt;
  // dip.difference has its error beside it.
  const std::string sibling = key.substr(0, key.rfind('.') + 1) + "standard_error";
  auto error = plain(name, key + ".standard_error");
  if (!error && key == "dip.difference") error = plain(name, sibling);
  return Measured{*value, error.value_or(std::numeric_limits<double>::quiet_NaN())};
}

std::optional<std::string> Results::text(const std::string& name, const std::string& key) const {
  const auto study = all_.find(name);
  if (study == all_.end()) return std::nullopt;
  const auto at = study->second.find(key);
  if (at == study->second.end()) return std::nullopt;
  if (const auto* found = std::get_if<std::string>(&at->second)) return *found;
  return std::nullopt;
}

}  // namespace grainfield::coupling
