// Fuzz targets: readers of what comes from outside, called as the commands of the program call
// them.
//
// A target is one file in targets/ that registers itself. libfuzzer.cc feeds it what libFuzzer
// makes up, replay.cc what stands in corpus/NAME. What a reader refuses as the program would (exit
// codes 2 and 3) is as good as what it takes; anything else is a finding.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace grainfield::fuzz {

struct Target {
  std::string name;
  void (*run)(std::string_view bytes);
};

/// Every target, by name.
const std::vector<Target>& targets();
/// Throws std::invalid_argument with all names.
const Target& find_target(const std::string& name);

/// Puts a target into the list.
struct Registration {
  Registration(const char* name, void (*run)(std::string_view bytes));
};

/// Does it, and passes over what a reader may say. Throws std::logic_error for anything else, and
/// for a message that tells nothing.
void attempt(const std::function<void()>& read);

/// The bytes as a file in the folder for temporary ones; it goes with this object.
class InputFile {
 public:
  explicit InputFile(std::string_view bytes);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Lines without their ends.
std::vector<std::string> lines_of(std::string_view text);

}  // namespace grainfield::fuzz
