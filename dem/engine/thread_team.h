// A few threads that run one function together and meet at barriers.
#pragma once
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace grainfield::dem {

/// Runs a function on `size` threads (the caller is one of them). Threads are kept between runs.
class ThreadTeam {
 public:
  /// Throws std::runtime_error naming --threads when the system cannot start so many.
  explicit ThreadTeam(int size);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return size_; }
  /// Calls work(rank) for rank 0..size-1 and returns when all have. work must not throw.
  void run(const std::function<void(int)>& work);
  /// Within work: waits for all. Free when there is one thread.
  void barrier() {
    if (size_ > 1) wait_for_all(spins_);
  }
  /// Within work, by all of them: waits for all, then rank 0 does `task`, and the others only what
  /// it hands out by together(). Returns when it is done.
  template <class Task>
  void alone(int rank, Task task) {
    barrier();
    if (rank != 0) return help(rank);
    task();
    part_ = nullptr;
    barrier();
  }
  /// Within alone(), or outside of work: part(rank) on all threads; returns when all are done, and
  /// throws what one of them has thrown. Parts that may throw must not call barrier().
  void together(const std::function<void(int)>& part);

 private:
  void help(int rank);
  void serve(int rank);
  void end();
  void wait_for_all(int spins);

  int size_;
  int spins_;  // at a barrier, before it sleeps
  std::atomic<int> arrived_{0};
  std::atomic<int> round_{0};  // wraps around harmlessly
  std::mutex mutex_;
  std::condition_variable wake_, finished_;
  const std::function<void(int)>* work_ = nullptr;
  const std::function<void(int)>* part_ = nullptr;  // that rank 0 hands out
  bool works_ = false;                              // rank 0 is within work
  std::exception_ptr failure_;                      // of a part
  long generation_ = 0;
  int running_ = 0;
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

/// The part [first, last) of n items that `rank` of `size` handles.
inline std::pair<int, int> share(int n, int rank, int size) {
  const long long first = static_cast<long long>(n) * rank / size;
  const long long last = static_cast<long long>(n) * (rank + 1) / size;
  return {static_cast<int>(first), static_cast<int>(last)};
}

}  // namespace grainfield::dem
