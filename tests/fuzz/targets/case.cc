// Case files, as `check` reads them; what is taken is written in full and read again, as `run`
// does.
#include "coupling/case/case.h"

#include <fmt/format.h>

#include <stdexcept>

#include "coupling/case/cost.h"
#include "tests/fuzz/target.h"

namespace grainfield::fuzz {
namespace {

// Keys without effect are written as comments.
std::string without_comments(const std::string& text) {
  std::string out;
  for (const std::string& line : lines_of(text)) {
    if (!line.starts_with('#')) out += line + '\n';
  }
  return out;
}

void fuzz_case(std::string_view bytes) {
  const InputFile file(bytes);
  attempt([&] { coupling::case_title(file.path()); });
  std::string written;
  attempt([&] {
    const coupling::Case value = coupling::read_case(file.path(), false, {});
    coupling::outlook_text(value);
    coupling::grain_keys_text(value);
    written = coupling::write_case(value);
  });
  if (bytes.find("quick") != std::string_view::npos) {
    attempt([&] { coupling::read_case(file.path(), true, {}); });
  }
  if (written.empty()) return;
  const InputFile again(written);
  std::string same;
  try {
    same = coupling::write_case(coupling::read_case(again.path(), false, {}));
  } catch (const std::exception& e) {
    throw std::logic_error(fmt::format("what was written is refused: {}\n{}", e.what(), written));
  }
  if (without_comments(same) != without_comments(written)) {
    throw std::logic_error(
        fmt::format("what was written is read as another case:\n{}\nbecomes\n{}", written, same));
  }
}

const Registration case_is_there("case", fuzz_case);

}  // namespace
}  // namespace grainfield::fuzz
