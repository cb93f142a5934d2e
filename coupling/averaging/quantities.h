// The quantities an average can give. A new one is one line in quantities.cc.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/averaging/grain_facts.h"

namespace grainfield::coupling {

/// Components of a quantity and the order of their columns:
/// vector x y (z); symmetric xx yy xy (3D: xx yy zz yz xz xy); full xx yy xy yx (3D: xx yy zz yz zy
/// xz zx xy yx); antisymmetric: one column without suffix (3D: yz xz xy).
enum class Rank { scalar, vector, symmetric, full, antisymmetric };

/// What has been summed at one point: `dim` components per axis. Densities are per area (volume).
struct PointSums {
  const double* head =
      nullptr;  ///< stress (a * dim + b: force a, branch b), traction, count, basics
  const double* own = nullptr;  ///< the quantity's own sums, in the order of its columns
  int dim = 2;

  double stress(int a, int b) const { return head[a * dim + b]; }
  double traction(int a) const { return head[dim * dim + a]; }
  double count() const { return head[dim * dim + dim]; }
  double weight() const { return head[dim * dim + dim + 1]; }   ///< grains per area
  double mass() const { return head[dim * dim + dim + 2]; }     ///< kg per area
  double volume() const { return head[dim * dim + dim + 3]; }   ///< grain area per area
  double bearing() const { return head[dim * dim + dim + 4]; }  ///< grains that are no rattlers
  double momentum(int a) const { return head[dim * dim + dim + 5 + a]; }
};

struct Quantity {
  std::string name;  ///< of the columns, before _x or _xy
  Rank rank;
  std::string unit_2d, unit_3d;
  std::string meaning;  ///< for the documentation
  /// What a grain adds, times its weight, to the quantity's own sum (a, b); null: it has none.
  double (*of_grain)(const GrainFacts&, int a, int b);
  /// Value from the sums; `k` is the column among the quantity's own.
  double (*value)(const PointSums&, int a, int b, int k);
};

/// All of them, in the order of the columns.
const std::vector<Quantity>& quantities();

/// Name of a component's column: sigma_xy of sigma, 0 and 1. `axes`: the letters.
std::string column_name(const Quantity& quantity, int dim, int a, int b, const char* axes = "xyz");

/// Where the sums of the chosen quantities stand in a row.
class Layout {
 public:
  struct Component {
    std::string column, unit;
    const Quantity* quantity;
    int a, b, k;
    int own;  ///< first own sum of the quantity
  };

  /// `names` empty: all. Throws std::invalid_argument for an unknown name (says the nearest).
  Layout(int dim, const std::vector<std::string>& names);

  int dim() const { return dim_; }
  int count() const { return dim_ * dim_ + dim_; }  ///< number of grains in the support
  int carried() const { return count() + 1; }       ///< first sum that grains carry
  int size() const { return size_; }
  const std::vector<Component>& components() const { return components_; }

  /// What a grain carries, into load_size() places: first its virial (dim * dim, as
  /// PointSums::stress), then the sums from carried() on.
  void load(const GrainFacts& fact, double* row) const;
  int load_size() const { return dim_ * dim_ + size_ - carried(); }
  /// Value of one component from a row of sums.
  double value(const Component& component, const double* row) const;

 private:
  int dim_, size_;
  std::vector<Component> components_;
};

}  // namespace grainfield::coupling
