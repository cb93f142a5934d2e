// The bits of a state as a string, for checkpoints of this program on this machine.
#pragma once
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace grainfield::dem {

/// Numbers, and structs of numbers and of Eigen's fixed-size vectors (whose copy constructors are
/// written out, so that they do not count as trivially copyable).
template <class T>
inline constexpr bool kIsPlain = std::is_standard_layout_v<T>&& std::is_trivially_destructible_v<T>;

class CheckpointWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(kIsPlain<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <class T, class A>
  void put(const std::vector<T, A>& values) {
    static_assert(kIsPlain<T>);
    put(static_cast<std::uint64_t>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void put(const std::string& text) { put(std::vector<char>(text.begin(), text.end())); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads in the order of writing; throws std::invalid_argument when the checkpoint is too short or
/// long.
class CheckpointReader {
 public:
  explicit CheckpointReader(const std::string& bytes) : bytes_(bytes) {}

  template <class T>
  void get(T& value) {
    require(bytes_.size() - position_ >= sizeof(T));
    static_assert(kIsPlain<T>);
    std::memcpy(static_cast<void*>(&value), bytes_.data() + position_, sizeof(T));
    position_ += sizeof(T);
  }
  template <class T, class A>
  void get(std::vector<T, A>& values) {
    std::uint64_t count = 0;
    get(count);
    require(count <= (bytes_.size() - position_) / sizeof(T));
    values.resize(count);
    if (count > 0)
      std::memcpy(static_cast<void*>(values.data()), bytes_.data() + position_, count * sizeof(T));
    position_ += count * sizeof(T);
  }
  void get(std::string& text) {
    std::vector<char> characters;
    get(characters);
    text.assign(characters.begin(), characters.end());
  }
  void finish() const { require(position_ == bytes_.size()); }
  void require(bool holds) const {
    if (!holds) throw std::invalid_argument("the checkpoint is broken or of another setup");
  }

 private:
  const std::string& bytes_;
  std::size_t position_ = 0;
};

}  // namespace grainfield::dem
