// A smooth field about a vertical axis at many places, from few values of it.
//
// What the base of a layer adds to the stress under a point load is analytic in the radius r and
// the depth t, both over the layer's depth: its nearest singularity is the load's mirror image
// below the base, where r^2 + (2 - t)^2 = 0, stretched by the material's anisotropy. So the error
// of Chebyshev interpolation falls geometrically with the number of nodes (Trefethen, Approximation
// Theory and Approximation Practice, 2013, theorem 8.2), and on panels as wide as the singularity
// is far the nodes here reach round-off.
#pragma once
#include <Eigen/Core>
#include <functional>

namespace grainfield::continuum {

/// Stress rr, tt, zz, rz (n x 4) at n radii >= 0 and as many depths in [0, 1].
using FieldAboutAxis =
    std::function<Eigen::ArrayX4d(const Eigen::ArrayXd& radius, const Eigen::ArrayXd& depth)>;

/// The field at these places: of itself where they are fewer than the nodes would be, else
/// interpolated. `panel`: width of the radii that one set of nodes resolves, at most the distance
/// of the nearest singularity from the real radii.
Eigen::ArrayX4d about_axis(const FieldAboutAxis& field, double panel, const Eigen::ArrayXd& radius,
                           const Eigen::ArrayXd& depth);

}  // namespace grainfield::continuum
