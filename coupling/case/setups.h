// Setups of several types in one value: what each part of a case holds, known only to those who
// declare its keys and read it.
#pragma once
#include <map>
#include <memory>
#include <typeindex>
#include <typeinfo>
#include <utility>

namespace grainfield::coupling {

/// At most one setup of every type; copied by value.
class Setups {
 public:
  Setups() = default;
  Setups(const Setups& other) { *this = other; }
  Setups(Setups&&) noexcept = default;
  Setups& operator=(const Setups& other) {
    if (this == &other) return *this;
    held_.clear();
    for (const auto& [type, setup] : other.held_) held_.emplace(type, setup->copy());
    return *this;
  }
  Setups& operator=(Setups&&) noexcept = default;
  ~Setups() = default;

  /// The setup of this type; one with its defaults where there was none.
  template <class T>
  T& get() {
    auto& at = held_[typeid(T)];
    if (at == nullptr) at = std::make_unique<Held<T>>();
    return static_cast<Held<T>&>(*at).value;
  }
  /// The same, unchanged: its defaults where there is none.
  template <class T>
  const T& get() const {
    static const T kDefaults{};
    const auto at = held_.find(typeid(T));
    return at == held_.end() ? kDefaults : static_cast<const Held<T>&>(*at->second).value;
  }

 private:
  struct Any {
    virtual ~Any() = default;
    virtual std::unique_ptr<Any> copy() const = 0;
  };
  template <class T>
  struct Held final : Any {
    T value{};
    std::unique_ptr<Any> copy() const override {
      auto out = std::make_unique<Held>();
      out->value = value;
      return out;
    }
  };
  // Keys reach a setup by reference also where they only read it, and so make it with its defaults.
  mutable std::map<std::type_index, std::unique_ptr<Any>> held_;
};

}  // namespace grainfield::coupling
