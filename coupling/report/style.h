// Colours and small texts shared by the pictures.
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>

namespace grainfield::coupling::style {

inline constexpr const char* simulation = "#1b1b1b";
inline constexpr const char* band = "#b8b8b8";
/// Lines of the models, in order; told apart by colour-blind readers (Okabe and Ito).
inline constexpr const char* model[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                        "#e69f00", "#56b4e9", "#8a6d00", "#555555"};
inline constexpr int dash[] = {1, 2, 4, 5, 3, 1, 2, 4};
inline constexpr std::size_t models = 8;
/// Diverging blue - white - red.
inline constexpr const char* diverging =
    "set palette defined (-1 '#2166ac', -0.5 '#67a9cf', 0 '#f7f7f7', 0.5 '#ef8a62', 1 '#b2182b')\n";

/// Sequential dark - bright (viridis), "0xrrggbb" for share in [0, 1].
inline std::string sequential(double share) {
  constexpr double stops[][3] = {{68, 1, 84},    {65, 68, 135},  {42, 120, 142},
                                 {34, 168, 132}, {122, 209, 81}, {253, 231, 37}};
  const double at = 5 * (share > 0 ? (share < 1 ? share : 1) : 0);
  const int k = at < 4 ? static_cast<int>(at) : 4;
  std::string out = "0x";
  for (int c = 0; c < 3; ++c)
    out += fmt::format(
        "{:02x}", static_cast<int>(stops[k][c] + (at - k) * (stops[k + 1][c] - stops[k][c]) + 0.5));
  return out;
}
inline constexpr const char* sequential_palette =
    "set palette defined (0 '#440154', 1 '#414487', 2 '#2a788e', 3 '#22a884', 4 '#7ad151', 5 "
    "'#fde725')\n";

/// Text for gnuplot in double quotes: nothing in it can end the string or run a command (gnuplot
/// expands backquotes and backslashes there).
inline std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"' || c == '`' || c == '\\' || c == '\n' || c == '\r') continue;
    out += c;
  }
  return out + "\"";
}

/// A number gnuplot reads; NaN for what has no value.
inline std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "NaN";
}

}  // namespace grainfield::coupling::style
