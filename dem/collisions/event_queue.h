// The earliest events of all grains, as a heap of the standard library: O(log N) an event.
//
// Every grain has one event at a time. A new one gets a new ticket; the old one stays in the heap
// and is void when it comes up, because its ticket is no longer the grain's.
#pragma once
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

namespace grainfield::dem {

class EventQueue {
 public:
  struct Event {
    double time = 0;  ///< s
    std::uint32_t grain = 0, ticket = 0;

    /// Events of one time come in the order of the grains, whatever way they got into the heap.
    bool operator>(const Event& other) const {
      return time != other.time ? time > other.time : grain > other.grain;
    }
  };

  explicit EventQueue(std::size_t grains = 0) : tickets_(grains, 0) {}

  /// This is the grain's event now. Times that are infinite are none.
  void plan(std::uint32_t grain, double time) {
    const std::uint32_t ticket = ++tickets_[grain];
    if (time < std::numeric_limits<double>::infinity()) heap_.push({time, grain, ticket});
  }
  /// The earliest event, or null. It stays until its grain gets another.
  const Event* earliest() {
    while (!heap_.empty() && heap_.top().ticket != tickets_[heap_.top().grain]) heap_.pop();
    return heap_.empty() ? nullptr : &heap_.top();
  }
  /// With void ones.
  std::size_t size() const { return heap_.size(); }

 private:
  std::priority_queue<Event, std::vector<Event>, std::greater<>> heap_;
  std::vector<std::uint32_t> tickets_;
};

}  // namespace grainfield::dem
