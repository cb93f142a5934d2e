// Stress fields of heaps whose size does not matter: sigma(x, y) grows in proportion along every
// ray from the apex, and regions are sectors between two rays.
//
// Axes of the project: apex at (0, 0), y up, inside is y < 0; tension positive. A ray has the angle
// theta from the downward vertical, positive to the right, direction (sin theta, -cos theta); its
// normal (cos theta, sin theta) points to larger theta. There is no base: the fields go on below.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "continuum/model.h"

namespace grainfield::continuum {

/// Stress coefficients of a linear field: rows xx, yy, xy, columns x, y; sigma = field * (x, y).
using LinearStress = Eigen::Matrix<double, 3, 2>;

/// One sector of a heap, rays in rad.
struct HeapRegion {
  std::string name;         ///< "left flank", "core", ...
  double from = 0, to = 0;  ///< theta of its left and right ray
};

class HeapField {
 public:
  /// `regions` from left to right, each beginning where the last one ends; `rho_g` weight of a unit
  /// volume (area in 2D), `phi` friction angle in rad.
  HeapField(std::vector<HeapRegion> regions, double rho_g, double phi);
  virtual ~HeapField() = default;

  /// Stress xx, yy, xy at a point; nan outside (boundaries belong to the heap).
  Eigen::Vector3d stress(double x, double y) const;
  /// The same for n x 2 points; n x 3.
  Stresses stress(const Points& points) const;
  /// Derivatives of the stress in region k (0 from the left) at a point inside it or on its rays.
  virtual LinearStress gradient(std::size_t region, double x, double y) const = 0;

  const std::vector<HeapRegion>& regions() const { return regions_; }
  /// Index of the region at a point, -1 outside. A shared ray belongs to the region on its right.
  int region_of(double x, double y) const;
  /// The rays between regions and the two slopes, rad, from the left: regions().size() + 1.
  std::vector<double> rays() const;
  double rho_g() const { return rho_g_; }
  double phi() const { return phi_; }

  /// div sigma - (0, rho g) at a point of region k from the field's exact derivatives: 0 in
  /// equilibrium, N/m3.
  Eigen::Vector2d equilibrium_residual(std::size_t region, double x, double y) const;
  /// Largest |stress of the region on the right - stress of the one on the left| on ray k = 1 ..
  /// regions().size() - 1 at unit distance from the apex.
  double jump(std::size_t ray) const;
  /// Largest mobilised friction over all directions, sin(mobilised angle) / sin(phi): 1 at yield,
  /// above 1 where Mohr and Coulomb's limit is violated, infinite where the mean stress is no
  /// compression. Exact for linear fields, whose extremes are on the rays that bound regions (both
  /// sides are looked at; on a slope, which is free of stress, the limit from inside); of samples
  /// for others.
  double largest_mobilised() const;

  /// Largest |equilibrium_residual| over rho g, of samples inside of every region.
  double largest_imbalance() const;
  /// Largest |sin(mobilised angle) / sin(phi) - 1|, of samples inside of these regions and on both
  /// sides of these rays (as jump() counts them).
  double off_yield(const std::vector<std::size_t>& in, const std::vector<std::size_t>& on) const;

 private:
  /// Stress of the region at unit distance from the apex, at a share of the way from its left to
  /// its right ray; on a slope its derivative inwards.
  Eigen::Vector3d inside(std::size_t region, double share) const;

  std::vector<HeapRegion> regions_;
  std::vector<Eigen::Vector2d> normals_;  // of rays()
  double rho_g_, phi_;
};

/// A field that is linear in every region.
class SectorField : public HeapField {
 public:
  /// One coefficient matrix per region.
  SectorField(std::vector<HeapRegion> regions, std::vector<LinearStress> fields, double rho_g,
              double phi);
  LinearStress gradient(std::size_t region, double x, double y) const override;
  const LinearStress& linear(std::size_t region) const { return fields_[region]; }

 private:
  std::vector<LinearStress> fields_;
};

/// Heap and field reflected at x = 0: the coefficients in the mirrored region.
LinearStress mirrored(const LinearStress& field);

/// Mohr and Coulomb's limit without cohesion, as a residual that is quadratic in stress:
/// (xx - yy)^2 + 4 xy^2 - sin(phi)^2 (xx + yy)^2; 0 at yield, below inside.
double yield_residual(const Eigen::Vector3d& stress, double phi);
/// Radius over |centre| of Mohr's circle, sin(mobilised friction angle); nan without stress.
double mobilised_sine(const Eigen::Vector3d& stress);

/// A model of the registry that is such a field.
class HeapModel : public Model {
 public:
  using Figures = std::map<std::string, double>;
  /// `own`: figures besides those that all have, worked out when asked for.
  HeapModel(std::unique_ptr<HeapField> field, std::function<Figures(const HeapField&)> own);
  Stresses stress(const Points& points) override { return field_->stress(points); }
  /// Its own, `equilibrium_residual`, `mobilised_sine_ratio`, and `ray_K_deg` of the rays
  /// between regions, from the left.
  Figures figures() const override;
  const HeapField& field() const { return *field_; }

 private:
  std::unique_ptr<HeapField> field_;
  std::function<Figures(const HeapField&)> own_;
};

/// The declaration of `yield_residual`; `where` the field is to yield.
Figure yield_figure(const std::string& where);
/// The figures of a HeapModel: `own` and those that all have.
std::vector<Figure> heap_figures(std::vector<Figure> own);

}  // namespace grainfield::continuum
