// What a shape must have: the store of what the engine keeps of all grains of that shape.
//
// The store answers by index, in the order of the bodies: how heavy a grain is, where its points
// are, and how two of them, or one and a half space, overlap. What a pair remembers for the shapes'
// own sake is its Feature, which must not change a result, only its cost; where it may (of several
// normals the remembered one), it can be told from nothing by empty(), and is carried on by ids.
#pragma once
#include <concepts>
#include <vector>

#include "dem/checkpoint/checkpoint.h"
#include "dem/shapes/solid.h"
#include "dem/space/body.h"
#include "dem/space/overlap.h"
#include "dem/space/plane.h"

namespace grainfield::dem {

/// A shape that keeps places of its own beside the bodies' also has overlap_image
/// (polygon_store.h): a body that is an image of j tells nothing of them.
///
/// A shape with overlaps of several pairs side by side also has a Batch, put, finish, overlap_of,
/// ways, start_ways and apart_until (superellipsoid_store.h, engine/batch.h; what is needed:
/// space/lane_width.h).
///
/// `outlines`: has corners and may be slender. `central`: its contact points lie on the line of
/// centres. `keeps_places`: it keeps places of its own, or how grains are turned.
/// `offers(measures)`: that laws may read these of its overlaps. overlap and overlap_plane get the
/// measures wanted (here those without any cost) at compile time.
template <class S>
concept Shape = std::default_initializable<typename S::Feature> && std::default_initializable<S> &&
    requires(S& store, const S& same, const ShapeInput& input, int i, const Body<S::dim>& body,
             const RotationOf<S::dim>& rotation, const Plane<S::dim>& plane,
             const std::vector<int>& order, typename S::Feature& feature,
             typename S::Overlap& overlap, CheckpointWriter& writer, CheckpointReader& reader) {
  { S::outlines } -> std::convertible_to<bool>;
  { S::central } -> std::convertible_to<bool>;
  { S::keeps_places } -> std::convertible_to<bool>;
  { S::offers(Measures::depth) } -> std::same_as<bool>;
  requires std::same_as<typename S::Overlap, OverlapIn<S::dim>>;
  { store.add(input) } -> std::same_as<Solid<S::dim>>;  // throws std::invalid_argument
  store.place(i, body, rotation);                       // after the body has moved
  store.swap(i, i);
  store.sort(order);  // the first order.size() grains in this order
  { same.outline(i) } -> std::same_as<Outline>;
  {
    same.template overlap<Measures::depth>(i, body, i, body, feature, overlap)
    } -> std::same_as<bool>;
  { same.template overlap_plane<Measures::depth>(i, body, plane, overlap) } -> std::same_as<bool>;
  same.write(writer);
  store.read(reader, std::size_t{});
};

}  // namespace grainfield::dem
