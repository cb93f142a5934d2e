#include "coupling/reproduce/record.h"

#include <fmt/format.h>

#include <boost/beast/core/detail/base64.hpp>
#include <filesystem>
#include <stdexcept>

#include "coupling/output/atomic_file.h"
#include "coupling/output/tables.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;

struct Kept {
  const char* title;  // of the picture in the report
  const char* name;
};
constexpr Kept kKept[] = {{"Vertical pressure on the base", "base-pressure"},
                          {"Volume fraction", "volume-fraction"}};

std::string decoded(const std::string& text) {
  namespace codec = boost::beast::detail::base64;
  std::string out(codec::decoded_size(text.size()), '\0');
  out.resize(codec::decode(out.data(), text.data(), text.size()).first);
  return out;
}

}  // namespace

std::vector<std::string> record_run(const std::string& run, const std::string& results) {
  const fs::path from(run), to(results);
  if (!fs::exists(from / "summary.json")) {
    throw std::invalid_argument(run + ": no summary.json; name the folder of a finished run");
  }
  const Summary summary = read_summary((from / "summary.json").string());
  const auto at = summary.find("case.name");
  const auto* name = at == summary.end() ? nullptr : std::get_if<std::string>(&at->second);
  if (name == nullptr) throw std::invalid_argument(run + "/summary.json: no case.name");
  if (name->empty() || name->front() == '.' || fs::path(*name).filename() != *name) {
    throw std::invalid_argument(fmt::format(
        "{}/summary.json: case.name: found \"{}\", which is no name of a file", run, *name));
  }
  std::vector<std::pair<std::string, std::string>> files;
  const auto write = [&](const std::string& suffix, const std::string& text) {
    files.emplace_back((to / fmt::format("{}{}", *name, suffix)).string(), text);
  };
  write(".json", read_text_file(from / "summary.json"));
  if (fs::exists(from / "profiles.md")) write(".profiles.md", read_text_file(from / "profiles.md"));
  const std::string report = read_text_file(from / "report.html");
  for (const Kept& kept : kKept) {
    const std::string before = fmt::format("alt=\"{}\" src=\"data:image/", kept.title);
    const std::size_t begin = report.find(before);
    if (begin == std::string::npos) continue;
    const std::size_t kind = begin + before.size(), data = report.find(";base64,", kind) + 8,
                      end = report.find('"', data);
    if (end == std::string::npos) continue;
    const bool svg = report.compare(kind, 3, "svg") == 0;
    write(fmt::format(".{}.{}", kept.name, svg ? "svg" : "png"),
          decoded(report.substr(data, end - data)));
  }
  write_text_files(files);
  std::vector<std::string> written;
  for (const auto& [file, text] : files) written.push_back(file);
  return written;
}

}  // namespace grainfield::coupling
