// One meaning of lists on the command line, for every option that takes one.
//
// "--set a=1 --set b=2", "--set a=1 b=2" and "--set a=1,b=2" are the same, and so for --model and
// the others. A word that may be a file is never an entry: fit --model osl bcc heap.h5.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// The arguments behind the command's name with one option for each entry of a list; the command's
/// lists take no further words from now on.
std::vector<std::string> spread_lists(CLI::App& command, const std::vector<std::string>& arguments);

/// "a=1,b=[2, 3]" at the commas behind which another NAME= begins, outside of brackets and quotes.
std::vector<std::string> split_settings(const std::string& text);

}  // namespace grainfield::coupling
