// Roul 2.74-2.76: differences of the mean displacement of neighbouring elements. With U_k and X_k
// the changes of mean displacement and mean position between two elements along axis k,
//   G [X_1 .. X_d] = [U_1 .. U_d].
// Roul puts the nominal distance for X_k (affine_exact false); the mean position of the very grains
// that are averaged makes the result exact for an affine displacement of disordered grains.
// Central differences are second order in the step, Roul's forward ones (2.76) first order. Where
// an element on one side has too few grains, the element at the point takes its place.
#include <algorithm>
#include <limits>

#include "coupling/strain/neighbourhood.h"

namespace grainfield::coupling {
namespace {

struct Element {
  Eigen::VectorXd centre;  // nominal
  Eigen::VectorXd position, displacement;
  int grains = 0;
};

class Derivative : public StrainMeasure {
 public:
  Derivative(const GrainMotion& motion, const StrainOptions& options)
      : motion_(motion),
        options_(options),
        step_(options.step > 0 ? options.step : options.width),
        grains_(motion.position, options.support, options.width) {}

  GradientFit at(const Eigen::VectorXd& point) const override {
    GradientFit fit;
    const Element here = element(point);
    fit.grains = here.grains;
    if (!enough(here)) return fit;
    Eigen::MatrixXd lengths(motion_.dim, motion_.dim), changes = lengths;
    for (int axis = 0; axis < motion_.dim; ++axis) {
      Eigen::VectorXd shift = Eigen::VectorXd::Zero(motion_.dim);
      shift[axis] = step_;
      Element ahead = element(point + shift);
      Element behind = options_.forward ? here : element(point - shift);
      if (!enough(ahead)) {
        if (options_.forward || !enough(behind)) return fit;
        ahead = here;
      } else if (!enough(behind)) {
        behind = here;
      }
      lengths.row(axis) =
          (options_.affine_exact ? ahead.position - behind.position : ahead.centre - behind.centre)
              .transpose();
      changes.row(axis) = (ahead.displacement - behind.displacement).transpose();
      fit.grains = std::min({fit.grains, ahead.grains, behind.grains});
    }
    fit_gradient(lengths, changes, options_.largest_condition, fit);
    fit.misfit = std::numeric_limits<double>::quiet_NaN();  // as many equations as unknowns
    fit.displacement = here.displacement;
    return fit;
  }

 private:
  bool enough(const Element& e) const { return e.grains > 0 && e.grains >= options_.least_grains; }

  Element element(const Eigen::VectorXd& centre) const {
    const auto grains = grains_.around(centre);
    Element e{centre, {}, {}, static_cast<int>(grains.size())};
    if (grains.empty()) return e;
    e.position = rows_of(motion_.position, grains).colwise().mean().transpose();
    e.displacement = rows_of(motion_.displacement, grains).colwise().mean().transpose();
    return e;
  }

  const GrainMotion& motion_;
  StrainOptions options_;
  double step_;
  Neighbourhood grains_;
};

}  // namespace

std::unique_ptr<StrainMeasure> make_derivative(const GrainMotion& motion,
                                               const StrainOptions& options) {
  return std::make_unique<Derivative>(motion, options);
}

}  // namespace grainfield::coupling
