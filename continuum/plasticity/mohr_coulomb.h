// Elastic, perfectly plastic Mohr-Coulomb material in plane strain: the stress after an increment
// of strain (implicit return mapping) and its exact derivative (consistent tangent).
//
// Six planes bound the elastic domain in the space of principal stresses s1 >= s2 >= s3 (tension
// positive), of which three can be active: f(si, sj) = (si - sj) + (si + sj) sin(phi)
// - 2 c cos(phi) <= 0 for (1,3), (2,3), (1,2). The plastic strain grows along the derivative of the
// same expression with the dilation angle psi <= phi in place of phi. The material is isotropic, so
// the return keeps the principal directions of the trial stress, the out-of-plane one included, and
// each case is a small linear problem (de Souza Neto, Peric and Owen 2008, section 8.2):
//   plane    s = t - l D b,                    l from f = 0;
//   edge     s = t - D (l1 b1 + l2 b2),        s1 = s2 or s2 = s3, l1, l2 >= 0;
//   apex     s1 = s2 = s3 = c cot(phi): all trial stresses that no plane and no edge takes.
// What reaches the apex when psi < phi asks for more growth of volume than dilation gives: there
// the material opens. A cohesionless one then carries no stress at all and keeps no strain energy.
#pragma once
#include <Eigen/Core>

namespace grainfield::continuum::plasticity {

/// Components xx, yy, zz, xy; a strain's xy is the engineering shear, twice the tensor's.
using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;

struct MohrCoulomb {
  double E = 1e7;           ///< Young's modulus, above 0, N/m (2D)
  double nu = 0.3;          ///< Poisson's ratio, at least 0 and below 0.5
  double friction_deg = 0;  ///< friction angle phi, 0 to below 90 degrees
  double dilation_deg = 0;  ///< dilation angle psi, 0 to phi; psi = phi: associated flow
  double cohesion = 0;      ///< c, at least 0, in the unit of E; above 0 when phi = 0
};

/// Which part of the yield surface the stress lies on.
enum class Regime { elastic, plane, edge_12, edge_23, apex };

struct Returned {
  Vector4 stress = Vector4::Zero();          ///< admissible: yield() <= 0 up to round-off
  Vector4 elastic_strain = Vector4::Zero();  ///< of this stress; trial minus this: plastic strain
  Matrix4 tangent = Matrix4::Zero();         ///< d stress / d trial strain; exact
  Regime regime = Regime::elastic;
};

/// Principal stresses in descending order.
Eigen::Vector3d principal(const Vector4& stress);

class MohrCoulombLaw {
 public:
  /// Throws BadParameter naming the constant, the value found and what is allowed.
  explicit MohrCoulombLaw(const MohrCoulomb& constants);

  /// The stress for this trial elastic strain (the elastic strain before the increment plus the
  /// increment).
  Returned operator()(const Vector4& trial_strain) const;

  /// The largest of the planes' f; above 0: outside the elastic domain.
  double yield(const Vector4& stress) const;
  /// Hooke's law in plane strain, all four components.
  const Matrix4& elasticity() const { return elastic_; }
  /// Elastic strain of a stress.
  Vector4 elastic_strain(const Vector4& stress) const;
  const MohrCoulomb& constants() const { return constants_; }

  /// The return among principal values: the tangent is d stress / d principal trial strain.
  struct Principal {
    Eigen::Vector3d stress;
    Eigen::Matrix3d tangent;
    Regime regime;
  };
  /// Returns principal trial stresses, in descending order.
  Principal principal_return(const Eigen::Vector3d& trial) const;
  double shear_modulus() const { return shear_; }

 private:
  Principal to_plane(const Eigen::Vector3d& trial) const;
  bool to_edge(const Eigen::Vector3d& trial, Regime edge, Principal& found) const;
  Eigen::Vector3d gradient(int i, int j, double sine) const;

  MohrCoulomb constants_;
  double shear_, sin_friction_, sin_dilation_, strength_;  ///< strength_ = 2 c cos(phi)
  Eigen::Matrix3d stiffness_;                              ///< of principal strains
  Matrix4 elastic_;
};

}  // namespace grainfield::continuum::plasticity
