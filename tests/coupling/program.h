// Runs the real program and looks at what it leaves.
#pragma once
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>

#include "tests/paths.h"

namespace grainfield::coupling::testing {

namespace fs = std::filesystem;

/// A folder that goes with the test.
class Folder {
 public:
  Folder() {
    std::random_device device;
    do {
      path_ = fs::temp_directory_path() / ("grainfield_test_" + std::to_string(device()));
    } while (!fs::create_directory(path_));
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }

 private:
  fs::path path_;
};

inline std::string read_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

struct Output {
  int code = -1;
  std::string out, err;
};

/// `prefix grainfield arguments` in a shell; exit code and both streams.
inline Output program(const std::string& arguments, const std::string& prefix = "") {
  const Folder folder;
  const std::string command = prefix + " " + GRAINFIELD_PROGRAM + " " + arguments + " > " +
                              (folder / "out") + " 2> " + (folder / "err");
  const int status = std::system(command.c_str());
  Output result;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = read_text(folder / "out");
  result.err = read_text(folder / "err");
  return result;
}

/// A layer of a few grains that is done in a fraction of a second.
inline std::string tiny_case(const std::string& more = "") {
  return R"(title = "tiny"
[packing]
kind = "triangular"
sizes = "mono"
columns = 7
rows = 3
jitter = 0.02
[rest]
background_damping = 300
unbalanced_force_ratio = 1e-4
kinetic_to_elastic_energy = 1e-7
[load]
force = 1
ramp_time = 0.01
[ensemble]
realizations = 3
[average]
methods = ["coarse_graining"]
depths = [0.5]
points = 11
map_columns = 5
map_rows = 4
[compare]
models = ["flamant", "rough"]
[model.rough]
name = "layer"
base = "rough"
)" + more;
}

/// The text of a summary.json without what differs from run to run: times, memory and the command
/// (keys time.*, memory.*, case.command, and a model's own solve_s and assemble_s).
inline std::string figures_alone(const std::string& summary) {
  std::istringstream lines(summary);
  std::string line, kept;
  while (std::getline(lines, line)) {
    bool differs = false;
    for (const char* key :
         {"\"time.", "\"memory.", "\"case.command", ".solve_s\"", ".assemble_s\""}) {
      differs = differs || line.find(key) != std::string::npos;
    }
    if (!differs) kept += line + "\n";
  }
  return kept;
}

/// Every file below a folder by relative name; of a summary.json its figures_alone().
inline std::map<std::string, std::string> contents(const std::string& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string text = read_text(entry.path().string());
    const bool summary = entry.path().filename() == "summary.json";
    out[fs::relative(entry.path(), folder).string()] = summary ? figures_alone(text) : text;
  }
  return out;
}

}  // namespace grainfield::coupling::testing
