#include "coupling/strain/branch_fit.h"

namespace grainfield::coupling {

BranchFit::BranchFit(const GrainMotion& motion, const Eigen::MatrixXd& changes,
                     const StrainOptions& options)
    : motion_(motion),
      changes_(changes),
      options_(options),
      grains_(motion.position, options.support, options.width),
      contacts_(motion.contact_point, options.support, options.width) {}

GradientFit BranchFit::at(const Eigen::VectorXd& point) const {
  GradientFit fit;
  const auto grains = grains_.around(point), contacts = contacts_.around(point);
  fit.grains = static_cast<int>(grains.size());
  fit.contacts = static_cast<int>(contacts.size());
  if (fit.grains < options_.least_grains || fit.contacts < motion_.dim) return fit;
  fit.displacement = rows_of(motion_.displacement, grains).colwise().mean().transpose();
  fit_gradient(rows_of(motion_.branch, contacts), rows_of(changes_, contacts),
               options_.largest_condition, fit);
  return fit;
}

}  // namespace grainfield::coupling
