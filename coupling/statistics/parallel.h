// Work shared among a few threads, errors carried back.
#pragma once
#include <algorithm>
#include <exception>
#include <thread>
#include <vector>

namespace grainfield::coupling {

/// Calls work(first, last) for consecutive parts of [0, n), on `threads` threads (the caller is one
/// of them), and throws again the first error in the order of the parts. Whatever a part writes
/// must depend on its items only, so that the bits do not depend on the number of threads.
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
  for (Index part = 1; part < parts; ++part) others.emplace_back(run, part);
  run(0);
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace grainfield::coupling
