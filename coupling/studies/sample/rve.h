// Representative volume elements of a sample: their strain and stress beside the sample's own
// (Wellmann section 5).
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "continuum/constants.h"
#include "coupling/result/figure.h"
#include "coupling/result/tables.h"
#include "coupling/strain/hull.h"
#include "coupling/studies/sample/simulation/setup.h"

namespace grainfield::coupling {

/// The case keys [rve].
struct RveSetup {
  int along = 0;                          ///< points along each axis; 0: none
  std::vector<double> radii{2, 3, 5, 7};  ///< over sample.radius
};

/// Throws std::invalid_argument naming rve.radii: one that no sample of this plan has room for.
void check_rves(const RveSetup& setup, const dem::SamplePlan& plan);

/// One RVE in one state. Tensors: strains against the first state, extension positive; stresses
/// tension positive, Pa.
struct RveValue {
  Eigen::Matrix3d hull, fit;  ///< displacement gradients (strain/hull.h)
  Eigen::Matrix3d boundary;   ///< from the forces on it, over the volume of its hull (eq. 29)
  Eigen::Matrix3d inside;     ///< from its inner contacts, likewise
  Eigen::Matrix3d grains;     ///< of its grains' contacts, over the sphere's volume
  double field_zz = 0;        ///< coarse-grained, of the point that moves with the sample; or nan
  double count = 0;           ///< grains
};

/// Values of one radius and realization: by state, then by RVE.
using RveStates = std::vector<std::vector<RveValue>>;

struct RveSurface {
  Eigen::MatrixXd points, displacements;  ///< of an RVE's grains in the first state, m
  Hull hull;
};

struct RveTable {
  std::vector<double> radii;      ///< those that fit into every sample, over sample.radius
  std::vector<double> too_large;  ///< those that do not
  std::vector<int> left_out;      ///< by radius: RVEs of fewer than four grains, of all samples
  std::vector<double> strain;     ///< imposed, by state
  std::vector<std::vector<RveStates>> values;           ///< by radius, then by realization
  std::vector<std::vector<Eigen::Matrix3d>> gradients;  ///< the sample's own, by realization, state
  std::vector<std::vector<Eigen::Matrix3d>> stresses;   ///< of its contacts, Pa, likewise
  int loading = 0;                                      ///< last state of the loading
  RveSurface surface;  ///< of the first RVE of the largest radius, first realization, to `loading`
};

/// `files`: of the realizations. `along` must be above 0. The coarse-grained field (lucy, ending at
/// the radius) is taken in the first state and the last one of the loading.
RveTable rve_table(const std::vector<std::string>& files, const RveSetup& setup,
                   const dem::SamplePlan& plan);

/// What the reader must know of radii and RVEs that were left out, a sentence each.
std::vector<std::string> rve_warnings(const RveTable& table);

/// A row for each radius and state: means over the RVEs and realizations, and the error bars
/// s/sqrt(N) over the RVEs of a realization (Wellmann eq. 31), their mean over realizations.
std::string rve_csv(const RveTable& table);

/// By summary key, a number for each realization.
FigureSamples rve_figures(const RveTable& table, const std::string& deformation);

/// The largest RVEs of a simple shear where the mean of their trace/3 over the realizations is
/// least after the first state. (The least of each realization by itself would tell of contraction
/// wherever they scatter.)
struct Contraction {
  /// Values of one realization: trace/3 there and at the end of the loading.
  struct Volume {
    double there = 0, at_end = 0;
  };
  std::vector<Volume> volumes;  ///< of every realization; empty: no contraction was looked for
  double strain = kNan;         ///< shear strain xz of the samples there
  double strain_error = kNan;   ///< by the bootstrap over realizations; nan of one
};
Contraction rve_contraction(const RveTable& table);
/// Its figures, and what the others are: rve.*.
void add_contraction(const Contraction& found, Summary& summary);

/// Mean of a number over RVEs and its error bar s/sqrt(N), nan of one.
struct RveMean {
  double mean = 0, error_bar = 0;
};
RveMean mean_over(const std::vector<RveValue>& values, double (*of)(const RveValue&));

}  // namespace grainfield::coupling
