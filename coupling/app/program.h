// The command-line program. Everything that parses arguments or prints is in coupling/app.
#pragma once

namespace grainfield::coupling {

/// Runs one command. Returns the exit code: 0; 2 for a mistake in what the user gave; 3 for a
/// computation that failed; 130 after an interrupt; 1 otherwise. Errors are one line on stderr.
int run_program(int argc, char** argv);

}  // namespace grainfield::coupling
