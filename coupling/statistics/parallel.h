// Work shared among a few threads, errors carried back.
#pragma once
#include <algorithm>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace grainfield::coupling {

/// Calls work(first, last) for consecutive parts of [0, n), on `threads` threads (the caller is one
/// of them, and does what no thread can be started for), and throws again the first error in the
/// order of the parts. Whatever a part writes must depend on its items only, so that the bits do
/// not depend on the number of threads.
template <class Index, class Work>
void in_parts(Index n, int threads, const Work& work) {
  const Index parts = std::max<Index>(1, std::min<Index>(static_cast<Index>(threads), n));
  std::vector<std::exception_ptr> errors(static_cast<std::size_t>(parts));
  const auto run = [&](Index part) {
    try {
      work(n * part / parts, n * (part + 1) / parts);
    } catch (...) {
      errors[static_cast<std::size_t>(part)] = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  others.reserve(static_cast<std::size_t>(parts));
  Index started = 1;
  try {
    for (; started < parts; ++started) others.emplace_back(run, started);
  } catch (const std::system_error&) {
    // The system has no more threads now: the caller does the rest.
  }
  run(0);
  for (Index part = started; part < parts; ++part) run(part);
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace grainfield::coupling
