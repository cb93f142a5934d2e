// HDF5 can crash on a damaged file. So a child process reads a file first.
#pragma once
#include <string>

namespace grainfield::dem::hdf5 {

/// Reads all of the file in a child process whose time and memory are bounded; once per process
/// and state of the file. Throws std::invalid_argument naming the file when the child does not
/// come to its end. Like all calls of HDF5 by one thread at a time.
void probe(const std::string& file);
/// This process has written the file as it is now: it needs no look.
void trust(const std::string& file);

}  // namespace grainfield::dem::hdf5
