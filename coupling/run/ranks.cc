#include "coupling/run/ranks.h"

#include <mpi.h>

#include <chrono>
#include <cstdlib>
#include <thread>

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
  }
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

void Ranks::barrier() const {
  if (size_ > 1) MPI_Barrier(MPI_COMM_WORLD);
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
