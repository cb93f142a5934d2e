#include "continuum/fe_models.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <mutex>

#include "continuum/fe/block.h"
#include "continuum/fe/plugin.h"
#include "continuum/installed.h"

namespace grainfield::continuum {
namespace {

Ranks g_ranks = Ranks::all;

// Beside the program, where an installed program or module has it, or where it was built.
void* open_library() {
  std::error_code error;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  const std::filesystem::path built = GRAINFIELD_FE_LIBRARY;
  std::vector<std::filesystem::path> files{folder / built.filename()};
  for (const auto& prefix : installed_prefixes())
    files.push_back(prefix / "lib/grainfield" / built.filename());
  files.push_back(built);
  for (const auto& file : files) {
    if (!std::filesystem::exists(file, error)) continue;
    if (void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
    throw ComputationFailed(fmt::format(
        "the finite-element library cannot be loaded: {}; install the packages of packages.txt",
        dlerror()));
  }
  throw ComputationFailed(fmt::format(
      "the finite-element library {} is neither beside the program nor in ../lib/grainfield",
      built.filename().string()));
}

void* loaded_library() {
  static std::mutex once;
  static void* library = nullptr;
  const std::lock_guard lock(once);
  if (library == nullptr) library = open_library();
  return library;
}

template <class Function>
Function function_of_library(const char* symbol) {
  void* function = dlsym(loaded_library(), symbol);
  if (function == nullptr)
    throw ComputationFailed("the finite-element library is of another version");
  return reinterpret_cast<Function>(function);
}

}  // namespace

void solve_on(Ranks ranks) { g_ranks = ranks; }

MakeModel in_fe_library(const std::string& name) {
  return [name](const Settings& settings) {
    std::unique_ptr<Model> model;
    function_of_library<fe::WatchFunction>(fe::kWatchSymbol)(progress_watcher());
    function_of_library<fe::MakeFunction>(fe::kMakeSymbol)(name.c_str(), settings, g_ranks, model);
    return model;
  };
}

std::vector<BlockState> load_block(const BlockMaterial& material,
                                   const Eigen::Matrix3d& initial_stress,
                                   const std::vector<BlockLoad>& path, int cells) {
  std::vector<BlockState> states;
  function_of_library<fe::BlockFunction>(fe::kBlockSymbol)(material, initial_stress, path, cells,
                                                           states);
  return states;
}

}  // namespace grainfield::continuum
