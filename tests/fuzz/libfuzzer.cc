// libFuzzer's side: --target=NAME chooses what it attacks (libFuzzer passes over such options).
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "tests/fuzz/target.h"

namespace {

const grainfield::fuzz::Target* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const std::string option = "--target=";
  std::string name;
  for (int k = 1; k < *argc; ++k) {
    const std::string word = (*argv)[k];
    if (word.starts_with(option)) name = word.substr(option.size());
  }
  try {
    chosen = &grainfield::fuzz::find_target(name);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fuzz: --%s\n", e.what());
    std::exit(2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    chosen->run({reinterpret_cast<const char*>(data), size});
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fuzz: %s: finding: %s\n", chosen->name.c_str(), e.what());
    std::abort();
  }
  return 0;
}
