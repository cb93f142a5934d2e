// Contacts between sleepers, or of one with a wall: they keep their memory and their force at zero
// velocity until one of the two wakes.
#pragma once
#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "dem/contacts/kept.h"
#include "dem/contacts/pair_key.h"
#include "dem/space/body.h"

namespace grainfield::dem {

/// Force, torques and memory as on and seen from the grain with the lower id (torque_i: its own).
template <int D, class Memory>
struct FrozenContact {
  PairKey key = 0;
  Memory memory;
  ContactForce<D> force;
};

/// A force of two bodies as on the other one of them, when `other`.
template <int D>
ContactForce<D> seen_from(const ContactForce<D>& f, bool other) {
  if (!other) return f;
  ContactForce<D> out;
  out.force = -f.force;
  out.torque_i = f.torque_j;
  out.torque_j = f.torque_i;
  return out;
}

template <int D, class Memory>
class FrozenContacts {
 public:
  using Contact = FrozenContact<D, Memory>;

  bool empty() const { return contacts_.empty(); }
  void keep(const Contact& contact) { contacts_[contact.key] = contact; }
  bool has(PairKey key) const { return contacts_.count(key) != 0; }
  /// Takes the contact out, if it is there: true, and `out` is it.
  bool take(PairKey key, Contact& out) {
    const auto at = contacts_.find(key);
    if (at == contacts_.end()) return false;
    out = at->second;
    contacts_.erase(at);
    return true;
  }
  /// By keys: an order that no hash decides.
  std::vector<Contact> sorted() const {
    std::vector<Contact> list;
    list.reserve(contacts_.size());
    for (const auto& [key, contact] : contacts_) list.push_back(contact);
    std::sort(list.begin(), list.end(),
              [](const Contact& a, const Contact& b) { return a.key < b.key; });
    return list;
  }
  void assign(const std::vector<Contact>& list) {
    contacts_.clear();
    for (const Contact& c : list) contacts_[c.key] = c;
  }

 private:
  std::unordered_map<PairKey, Contact> contacts_;
};

}  // namespace grainfield::dem
