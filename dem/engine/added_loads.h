// What forces of the caller's own (added_forces.h) do to a world: by grain and by contact, from one
// call of their functions to the next.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dem/contacts/kept.h"
#include "dem/engine/added_forces.h"
#include "dem/space/body.h"

namespace grainfield::dem {

template <int D>
struct AddedLoads {
  struct Load {
    VectorOf<D> force = zero<VectorOf<D>>();
    SpinOf<D> torque = zero<SpinOf<D>>();
  };
  struct Source {
    std::shared_ptr<AddedForce> force;
    std::vector<Load> loads;         ///< by id, what acts in contacts too
    Kept<ContactForce<D>> contacts;  ///< seen from the grain with the lower id
  };

  std::vector<Source> sources;
  std::vector<Load> sum;  ///< of the sources, by id
  bool changed = false;   ///< sources, since the last step
  std::vector<std::string> former;

  bool on() const { return !sources.empty(); }
  bool in_contacts() const {
    for (const Source& source : sources) {
      if (source.force->in_contacts()) return true;
    }
    return false;
  }
  Load of(std::int64_t id) const {
    return static_cast<std::size_t>(id) < sum.size() ? sum[id] : Load{};
  }
  /// In a contact; `turned`: seen from the grain with the higher id.
  ContactForce<D> at(PairKey key, bool turned) const {
    ContactForce<D> all;
    for (const Source& source : sources) {
      if (const ContactForce<D>* f = source.contacts.find(key)) add(*f, turned, all);
    }
    return all;
  }
  /// Names of the sources, between commas.
  std::string names() const {
    std::string out;
    for (const Source& source : sources) {
      out += (out.empty() ? "" : ", ") + source.force->name();
    }
    return out;
  }

  static void add(const ContactForce<D>& f, bool turned, ContactForce<D>& sum) {
    sum.force += turned ? VectorOf<D>(-f.force) : f.force;
    sum.torque_i += turned ? f.torque_j : f.torque_i;
    sum.torque_j += turned ? f.torque_i : f.torque_j;
  }
};

}  // namespace grainfield::dem
