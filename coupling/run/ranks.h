// MPI ranks, started only where the program runs under mpirun.
#pragma once
#include <exception>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// The ranks of this program. Without mpirun (no OMPI_COMM_WORLD_SIZE, PMI_SIZE or PMIX_RANK in the
/// environment) it is one rank and MPI is never started.
class Ranks {
 public:
  /// Starts MPI where needed; the first object of the process decides.
  Ranks();
  int rank() const { return rank_; }
  int size() const { return size_; }
  bool first() const { return rank_ == 0; }
  /// Every rank's text, in the order of ranks, on every rank.
  std::vector<std::string> gather(const std::string& text) const;

  /// Tells all others that this rank was asked to stop; stopped_elsewhere() is then true there,
  /// soon. Neither waits. Only the main thread may call them.
  void tell_stop() const;
  bool stopped_elsewhere() const;

 private:
  int rank_ = 0, size_ = 1;
};

/// Waits until every rank is here with what became of its work, null for success. Where any failed,
/// all throw what the first of them (by number) failed with; a failure counts before an
/// interruption. Throws std::invalid_argument, ComputationFailed,
/// ComputationFailed, dem::StorageFailed, Interrupted or std::runtime_error.
void throw_together(const Ranks& ranks, const std::exception_ptr& own);

/// Ends MPI if Ranks started it; the program calls it once, at its end.
void finish_ranks();
/// The same after a failure of this rank. When the others have not failed within 10 s, MPI is left
/// unfinished: mpirun then ends them as soon as this rank exits, instead of all waiting for ever.
void finish_ranks_after_failure();

}  // namespace grainfield::coupling
