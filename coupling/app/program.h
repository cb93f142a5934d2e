// The command-line program. Everything that parses arguments or prints is in coupling/app.
#pragma once

namespace grainfield::coupling {

/// Runs one command. Returns the exit code: 0; 2 for a mistake in what the user gave; 3 for a
/// computation that failed; 74 when an output cannot be written; 130 after an interrupt; 141 when
/// the reader of standard output has gone; 1 otherwise. Errors are one line on stderr.
int run_program(int argc, char** argv);

}  // namespace grainfield::coupling
