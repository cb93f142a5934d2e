#include "coupling/run/ranks.h"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "continuum/model.h"
#include "coupling/base/signals.h"
#include "dem/run/run.h"
#include "dem/storage_failed.h"

namespace grainfield::coupling {
namespace {

bool under_mpirun() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}

bool started_here = false;
MPI_Comm at_the_end = MPI_COMM_NULL;  // of its own: the others may wait in a collective call
MPI_Comm stops = MPI_COMM_NULL;       // carries nothing but empty messages: "I was asked to stop"
constexpr std::chrono::seconds kPatience{10};

}  // namespace

Ranks::Ranks() {
  if (!under_mpirun()) return;
  int running = 0;
  MPI_Initialized(&running);
  if (running == 0) {
    // Only the main thread calls MPI; the realizations' threads do not.
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    started_here = true;
    MPI_Comm_dup(MPI_COMM_WORLD, &at_the_end);
    MPI_Comm_dup(MPI_COMM_WORLD, &stops);
  }
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

std::vector<std::string> Ranks::gather(const std::string& text) const {
  if (size_ == 1) return {text};
  const int mine = static_cast<int>(text.size());
  const auto n = static_cast<std::size_t>(size_);
  std::vector<int> sizes(n), starts(n);
  MPI_Allgather(&mine, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
  int total = 0;
  for (std::size_t r = 0; r < n; ++r) {
    starts[r] = total;
    total += sizes[r];
  }
  std::string all(static_cast<std::size_t>(total), '\0');
  MPI_Allgatherv(text.data(), mine, MPI_CHAR, all.data(), sizes.data(), starts.data(), MPI_CHAR,
                 MPI_COMM_WORLD);
  std::vector<std::string> out(n);
  for (std::size_t r = 0; r < n; ++r) {
    out[r] = all.substr(static_cast<std::size_t>(starts[r]), static_cast<std::size_t>(sizes[r]));
  }
  return out;
}

void Ranks::tell_stop() const {
  for (int other = 0; other < size_; ++other) {
    if (other == rank_) continue;
    MPI_Request sent = MPI_REQUEST_NULL;
    MPI_Isend(nullptr, 0, MPI_CHAR, other, 0, stops, &sent);
    MPI_Request_free(&sent);
  }
}

bool Ranks::stopped_elsewhere() const {
  if (size_ == 1) return false;
  bool stopped = false;
  for (int there = 1; there != 0;) {
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, 0, stops, &there, &status);
    if (there == 0) break;
    MPI_Recv(nullptr, 0, MPI_CHAR, status.MPI_SOURCE, 0, stops, MPI_STATUS_IGNORE);
    stopped = true;
  }
  return stopped;
}

namespace {

// What became of a rank's work as a text: its kind in the first letter, then what it says.
std::string described(const std::exception_ptr& error) {
  if (!error) return "+";
  try {
    std::rethrow_exception(error);
  } catch (const Interrupted& e) {
    return std::string("i") + e.what();
  } catch (const std::invalid_argument& e) {
    return std::string("2") + e.what();
  } catch (const ComputationFailed& e) {
    return std::string("d") + e.what();
  } catch (const dem::StorageFailed& e) {
    return std::string("s") + e.what();
  } catch (const std::system_error& e) {
    return (dem::means_storage_failed(e.code()) ? "s" : "1") + std::string(e.what());
  } catch (const std::exception& e) {
    return std::string("1") + e.what();
  }
}

[[noreturn]] void throw_described(const std::string& text) {
  const std::string what = text.substr(1);
  switch (text[0]) {
    case 'i':
      throw Interrupted(what);
    case '2':
      throw std::invalid_argument(what);
    case 'd':
      throw ComputationFailed(what);
    case 's':
      throw dem::StorageFailed(what);
    default:
      throw std::runtime_error(what);
  }
}

}  // namespace

void throw_together(const Ranks& ranks, const std::exception_ptr& own) {
  const std::vector<std::string> all = ranks.gather(described(own));
  const auto find = [&](bool interruption) {
    return std::find_if(all.begin(), all.end(), [&](const std::string& text) {
      return text[0] != '+' && (text[0] == 'i') == interruption;
    });
  };
  auto first = find(false);
  if (first == all.end()) first = find(true);
  if (first == all.end()) return;
  if (own && ranks.rank() == static_cast<int>(first - all.begin())) std::rethrow_exception(own);
  throw_described(*first);
}

void finish_ranks() {
  if (!started_here) return;
  started_here = false;
  int ended = 0;
  MPI_Finalized(&ended);
  if (ended == 0) MPI_Finalize();
}

void finish_ranks_after_failure() {
  if (!started_here) return;
  MPI_Request all_here = MPI_REQUEST_NULL;
  MPI_Ibarrier(at_the_end, &all_here);
  const auto start = std::chrono::steady_clock::now();
  int arrived = 0;
  while (MPI_Test(&all_here, &arrived, MPI_STATUS_IGNORE), arrived == 0) {
    if (std::chrono::steady_clock::now() - start > kPatience) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  finish_ranks();
}

}  // namespace grainfield::coupling
