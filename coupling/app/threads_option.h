// --threads, the same wherever work is spread over threads.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace grainfield::coupling {

/// Adds --threads, from 1 to 1024; without it `threads` stays as it is.
void add_threads(CLI::App& command, int& threads, const std::string& meaning);

}  // namespace grainfield::coupling
