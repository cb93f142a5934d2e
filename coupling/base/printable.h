// Text that comes from outside, as a terminal may show it.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace grainfield::coupling {

/// The text with everything that could steer a terminal or hide other text written out: control
/// characters but for new line and tab as \xNN, likewise bytes that are no UTF-8; the marks of
/// writing direction and the other line ends of Unicode as \u{NNNN}.
std::string printable(std::string_view text);

/// A name, of a folder for example, within a line: likewise, and new line and tab as \xNN too.
std::string printable_name(std::string_view name);

/// At most about `most` bytes of it in one line, whole characters: of a longer one the beginning
/// and the end, and between them how much is left out.
std::string one_line(std::string_view text, std::size_t most);

}  // namespace grainfield::coupling
