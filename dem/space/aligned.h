// Memory for numbers that are read side by side.
#pragma once
#include <cstddef>
#include <new>
#include <vector>

namespace grainfield::dem {

/// Allocates vectors that begin with a cache line: what is read eight at a time lies in one.
template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}

  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, kLine); }
  bool operator==(const LineAllocator&) const = default;
};
template <class T>
using LineVector = std::vector<T, LineAllocator<T>>;

}  // namespace grainfield::dem
