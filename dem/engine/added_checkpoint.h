// Forces of the caller's own in a checkpoint: in front of all else, and only where there are or
// have been such.
#pragma once
#include <string>
#include <vector>

#include "dem/checkpoint/checkpoint.h"
#include "dem/engine/added_loads.h"

namespace grainfield::dem {

inline const std::string kAddedMark = "grainfield: added forces";

inline bool holds_added(const std::string& checkpoint) {
  CheckpointWriter w;
  w.put(kAddedMark);
  return checkpoint.starts_with(w.bytes());
}

template <int D>
struct KeptAdded {
  PairKey key = 0;
  ContactForce<D> force;
};

template <int D>
void write_added(const AddedLoads<D>& added, CheckpointWriter& w) {
  w.put(kAddedMark);
  w.put(added.names());
  w.put(added.former.size());
  for (const std::string& name : added.former) w.put(name);
  w.put(added.changed);
  for (const auto& source : added.sources) {
    w.put(source.force->every());
    w.put(source.loads);
    std::vector<KeptAdded<D>> contacts;
    source.contacts.visit([&](PairKey key, const ContactForce<D>& f) {
      contacts.push_back({key, f});
    });
    w.put(contacts);
  }
}

/// Throws std::invalid_argument when `added` has other forces than the checkpoint, or it does not
/// fit.
template <int D>
void read_added(AddedLoads<D>& added, CheckpointReader& r) {
  std::string text;
  r.get(text);
  r.get(text);
  if (text != added.names()) refuse_without_forces(text, added.names());
  std::size_t former = 0;
  r.get(former);
  added.former.clear();
  for (std::size_t k = 0; k < former; ++k) r.get(added.former.emplace_back());
  r.get(added.changed);
  for (auto& source : added.sources) {
    long every = 0;
    r.get(every);
    if (every != source.force->every()) {
      refuse_without_forces(every_text(source.force->name(), every),
                            every_text(source.force->name(), source.force->every()));
    }
    r.get(source.loads);
    std::vector<KeptAdded<D>> contacts;
    r.get(contacts);
    source.contacts = {};
    for (const auto& c : contacts) source.contacts.add(c.key, c.force);
    source.contacts.sort();
  }
}

}  // namespace grainfield::dem
