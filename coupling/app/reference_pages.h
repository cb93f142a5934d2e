// Pages of docs/ that the program writes from its own declarations: commands and columns of files.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace grainfield::coupling {

/// docs/commands.md: every command that --help lists, with its arguments and options.
std::string commands_markdown(const CLI::App& app);

/// docs/columns.md: the columns of snapshots, and those that import reads.
std::string columns_markdown();

}  // namespace grainfield::coupling
