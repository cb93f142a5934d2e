// Feeds every file of corpus/NAME to its target: fuzz_replay [NAME...] [FILE]. Ends at the first
// that is a finding, also by a signal or after kMostSeconds, and names it.
#include <fmt/format.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/target.h"
#include "tests/paths.h"

#ifdef __SANITIZE_ADDRESS__
// The library keeps a little of every file that it gives up.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
#endif

namespace grainfield::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr int kMostSeconds = 10;  // of processor time
constexpr int kMostClock = 100;   // s, for what waits; the machine may be busy

std::string now;  // what is being read

void say_and_end(int signal) {
  const char* what =
      signal == SIGPROF || signal == SIGALRM ? "does not come to an end: " : "ends with a signal: ";
  for (const std::string& text : {std::string("fuzz: "), std::string(what), now}) {
    if (write(STDERR_FILENO, text.data(), text.size()) < 0) break;
  }
  if (write(STDERR_FILENO, "\n", 1) < 0) _exit(2);
  _exit(1);
}

void watch() {
  for (const int s : {SIGPROF, SIGALRM}) std::signal(s, say_and_end);
#ifndef __SANITIZE_ADDRESS__  // which tells more
  for (const int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(s, say_and_end);
#endif
}

void allow(int seconds, unsigned clock) {
  itimerval timer{};
  timer.it_value.tv_sec = seconds;
  setitimer(ITIMER_PROF, &timer, nullptr);
  alarm(clock);
}

bool passes(const Target& target, const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  now = file.string();
  allow(kMostSeconds, kMostClock);
  try {
    target.run(bytes);
  } catch (const std::exception& e) {
    fmt::print(stderr, "fuzz: {}: {}\n", now, e.what());
    return false;
  }
  allow(0, 0);
  return true;
}

bool replay(const Target& target) {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(fs::path(GRAINFIELD_SOURCES) / "tests/fuzz/corpus" / target.name)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  bool good = !files.empty();
  for (const fs::path& file : files) good = passes(target, file) && good;
  fmt::print("{}: {} files{}\n", target.name, files.size(), good ? "" : ", NOT GOOD");
  return good;
}

int run(const std::vector<std::string>& words) {
  watch();
  if (words.size() == 2 && fs::is_regular_file(words[1])) {
    return passes(find_target(words[0]), words[1]) ? 0 : 1;
  }
  bool good = true;
  for (const Target& target : targets()) {
    const bool wanted =
        words.empty() || std::find(words.begin(), words.end(), target.name) != words.end();
    if (wanted) good = replay(target) && good;
  }
  for (const std::string& word : words) find_target(word);
  return good ? 0 : 1;
}

}  // namespace
}  // namespace grainfield::fuzz

int main(int argc, char** argv) {
  try {
    return grainfield::fuzz::run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fuzz_replay: %s\n", e.what());
    return 2;
  }
}
