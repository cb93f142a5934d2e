#include "dem/engine/thread_team.h"

#include <fmt/format.h>

#include <stdexcept>
#include <system_error>
#include <utility>

namespace grainfield::dem {

ThreadTeam::ThreadTeam(int size)
    : size_(size < 1 ? 1 : size),
      spins_(size_ <= static_cast<int>(std::thread::hardware_concurrency()) ? 60000 : 1000) {
  threads_.reserve(static_cast<std::size_t>(size_ - 1));
  try {
    for (int rank = 1; rank < size_; ++rank) threads_.emplace_back([this, rank] { serve(rank); });
  } catch (const std::system_error& error) {
    const std::size_t started = threads_.size() + 1;
    end();
    throw std::runtime_error(fmt::format("--threads: only {} of {} threads can be started here: {}",
                                         started, size_, error.code().message()));
  }
}

ThreadTeam::~ThreadTeam() { end(); }

void ThreadTeam::end() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void ThreadTeam::run(const std::function<void(int)>& work) {
  if (size_ > 1) {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    running_ = size_ - 1;
    ++generation_;
  }
  wake_.notify_all();
  works_ = true;
  try {
    work(0);
  } catch (...) {
    works_ = false;
    throw;
  }
  works_ = false;
  if (size_ > 1) {
    std::unique_lock lock(mutex_);
    finished_.wait(lock, [this] { return running_ == 0; });
  }
}

// A step of a few thousand grains takes some 100 us. Waiting threads spin for about as long as the
// others may lag, some 50 us, and only then sleep (a busy machine): to be woken takes as long
// again. With 4,000 spins two threads made 1.58 times the steps of one with 5,000 heptagons, with
// 60,000 1.82 times. More threads than cores must not spin away what the others need.
void ThreadTeam::wait_for_all(int spins) {
  const int round = round_.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) == size_ - 1) {
    arrived_.store(0, std::memory_order_relaxed);
    round_.fetch_add(1, std::memory_order_release);
    round_.notify_all();
    return;
  }
  for (int spin = 0; spin < spins; ++spin) {
    if (round_.load(std::memory_order_acquire) != round) return;
  }
  round_.wait(round, std::memory_order_acquire);
}

// Between the parts that are handed out rank 0 does some 100 us of its own.
void ThreadTeam::help(int rank) {
  while (true) {
    wait_for_all(4 * spins_);
    if (part_ == nullptr) return;
    (*part_)(rank);
    wait_for_all(spins_);
  }
}

void ThreadTeam::together(const std::function<void(int)>& part) {
  const std::function<void(int)> guarded = [&](int rank) {
    try {
      part(rank);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
  };
  if (works_) {
    part_ = &guarded;
    barrier();
    guarded(0);
    barrier();
  } else {
    run(guarded);
  }
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ThreadTeam::serve(int rank) {
  long seen = 0;
  while (true) {
    const std::function<void(int)>* work = nullptr;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return stop_ || generation_ != seen; });
      if (stop_) return;
      seen = generation_;
      work = work_;
    }
    (*work)(rank);
    {
      const std::lock_guard lock(mutex_);
      --running_;
    }
    finished_.notify_one();
  }
}

}  // namespace grainfield::dem
