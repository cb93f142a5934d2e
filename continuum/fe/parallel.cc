#include "continuum/fe/parallel.h"

#include <deal.II/base/multithread_info.h>
#include <p4est.h>
#include <sc.h>

#include "continuum/fe/plugin.h"

namespace grainfield::continuum {
namespace {

Ranks g_ranks = Ranks::all;

/// Starts MPI if nobody has, and ends only what it started.
class MpiSession {
 public:
  MpiSession() {
    int initialized = 0;
    MPI_Initialized(&initialized);
    if (!initialized) {
      int provided = 0;
      MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
      ours_ = true;
    }
    // Silent p4est; without this it writes its statistics to standard output.
    sc_init(MPI_COMM_SELF, 0, 0, nullptr, SC_LP_SILENT);
    p4est_init(nullptr, SC_LP_SILENT);
    // One thread: sums in one order, the same bits in every run.
    dealii::MultithreadInfo::set_thread_limit(1);
  }
  ~MpiSession() {
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (ours_ && !finalized) MPI_Finalize();
  }
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

 private:
  bool ours_ = false;
};

}  // namespace

void fe::choose_ranks(Ranks ranks) { g_ranks = ranks; }

Ranks fe::chosen_ranks() { return g_ranks; }

MPI_Comm fe::communicator(Ranks ranks) {
  static const MpiSession session;
  return ranks == Ranks::all ? MPI_COMM_WORLD : MPI_COMM_SELF;
}

}  // namespace grainfield::continuum
