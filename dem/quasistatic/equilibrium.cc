#include "dem/quasistatic/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainfield::dem {
namespace {

// Newton aims below the ratio asked for by this factor: the mean contact force that scales it is
// the one before the step.
constexpr double kAim = 0.2;
// A residual that Newton cannot lower further will do when its mean meets the ratio and its largest
// entry is below this many times the ratio.
constexpr double kMostOver = 1000;
// A step that moves a grain further, in radii or radians, could jump over a contact.
constexpr double kMostStep = 0.25;
// The flow's drag, as a share of a contact's stiffness: where it begins, below which it is taken
// for none, where it gives up; its factors after success, after quick success and after failure.
constexpr double kFirstDrag = 1e-4, kLeastDrag = 1e-7, kMostDrag = 1e3;
constexpr double kEase = 0.5, kQuickEase = 0.2, kBrake = 8;
constexpr int kQuick = 5;
// Unknowns of a packing in space up to which the tangent is factorized. In the plane factors fill
// little, and it always is.
constexpr int kMostForFactors = 6000;
// Grains that hold up Newton: those with this share of the largest residual where it stopped.
constexpr double kCulprit = 0.03;
// A step of the flow, and all grains beside loose ones, are solved to this share of the residual.
constexpr double kFlowTolerance = 1e-2;
constexpr int kFlowIterations = 25, kMostFlowSteps = 300;
// Loose is a grain that a step of Newton's method moves by more than this, in radii or radians, and
// by more than so many times what it moves all but this share of the grains by.
constexpr double kLooseStep = 1e-3, kLooseTimes = 30, kLooseShare = 0.01;
// At most this share of the grains is settled apart, found in so many turns.
constexpr double kMostLoose = 0.05;
constexpr int kMostTurns = 10;
// Where steps are dear, enough is this share of what is enough elsewhere: a small load on many
// grains must not be lost in what they lack of balance.
constexpr double kDearShare = 0.1;
// At most so often loose grains are settled apart on the way to one equilibrium.
constexpr int kMostTimesApart = 20;

/// How far each grain goes in z, in radii or radians.
std::vector<double> ways_of(const Eigen::VectorXd& z, int per_grain) {
  std::vector<double> out;
  for (Eigen::Index k = 0; k < z.size(); k += per_grain)
    out.push_back(z.segment(k, per_grain).cwiseAbs().maxCoeff());
  return out;
}

/// Numbers below `all` that are not among `some`, which ascend.
std::vector<int> others(int all, const std::vector<int>& some) {
  std::vector<int> out;
  auto next = some.begin();
  for (int k = 0; k < all; ++k) {
    if (next != some.end() && *next == k) {
      ++next;
    } else {
      out.push_back(k);
    }
  }
  return out;
}

/// Its equations are solved by iteration.
bool is_large(const ContactNetwork& network) {
  return network.per_force() == 3 && network.size() > kMostForFactors;
}

}  // namespace

std::unique_ptr<LinearSolver> solver_of(const ContactNetwork& network) {
  return is_large(network) ? make_iterative_solver() : make_direct_solver();
}

Equilibrium::Equilibrium(ContactNetwork& network, const QuasistaticSettings& settings,
                         std::function<void()> go_on)
    : network_(network), settings_(settings), go_on_(std::move(go_on)) {
  large_ = is_large(network_);
  solver_ = solver_of(network_);
  if (large_) about_loose_ = Loose::apart;
  problem_.residual = [this](const Eigen::VectorXd& z, Eigen::VectorXd& r) {
    if (!network_.residual(z, r)) return false;
    r -= drag_.cwiseProduct(unit_).cwiseProduct(z);
    return true;
  };
  problem_.tangent = [this](const Eigen::VectorXd& z, const Eigen::VectorXd& r,
                            Eigen::SparseMatrix<double>& matrix) {
    network_.tangent(z, r, drag_.cwiseProduct(unit_), matrix);
  };
  reset_drag();
}

double Equilibrium::tolerance() const { return kAim * settings_.unbalanced_force_ratio; }

void Equilibrium::rescale() {
  network_.set_scale(1);
  const ContactNetwork::Balance b = network_.balance();
  const double scale = std::max(b.mean_contact_force, b.mean_unbalanced_force);
  network_.set_scale(scale > 0 && std::isfinite(scale) ? scale : 1);
  reset_drag();
}

void Equilibrium::reset_drag() {
  unit_ = network_.drag_unit();
  drag_ = Eigen::VectorXd::Zero(network_.size());
}

bool Equilibrium::settle(bool at_once) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(network_.size());
  Eigen::VectorXd r;
  int times_apart = 0;
  bool ignores = about_loose_ == Loose::ignored;
  for (int k = 0; k < kMostFlowSteps; ++k) {
    if (go_on_) go_on_();
    const bool free = drag_.maxCoeff() == 0;
    if (!network_.residual(zero, r)) return false;
    const double now = r.cwiseAbs().maxCoeff();
    if (!network_.strains() && (now <= tolerance() || (k > 0 && enough(r)))) return true;
    const bool fully = free && about_loose_ != Loose::reported;
    const double wanted = fully ? tolerance() : std::max(tolerance(), kFlowTolerance * now);
    const int limit = free ? settings_.max_iterations : kFlowIterations;
    Eigen::VectorXd z = zero;
    loose_.clear();
    problem_.enough = nullptr;
    problem_.stop = nullptr;
    if (free) {
      problem_.enough = [this](const Eigen::VectorXd& q) { return enough(q); };
      if (!ignores) {
        problem_.stop = [this](const Eigen::VectorXd& step) {
          loose_ = loose_in(step);
          return !loose_.empty();
        };
      }
    }
    const NewtonReport report = newton(problem_, {wanted, limit, kMostStep, large_}, *solver_, z);
    iterations_ += report.iterations;
    const bool done = report.converged || (large_ && free && report.iterations > 0 &&
                                           problem_.residual(z, r) && r.allFinite() && enough(r));
    const bool good = done && z.cwiseAbs().maxCoeff() <= kMostStep;
    if (good) {
      network_.commit(z);
      ++steps_;
      loose_.clear();
      if (free) return true;
      drag_ *= report.iterations <= kQuick ? kQuickEase : kEase;
      drag_ = (drag_.array() < kLeastDrag).select(0.0, drag_);
      continue;
    }
    if (!loose_.empty()) {
      if (about_loose_ == Loose::reported) return false;
      ignores = times_apart++ == kMostTimesApart || !settle_apart();
      continue;
    }
    if (at_once) return false;
    brake(z);
    if (drag_.maxCoeff() > kMostDrag) return false;
  }
  return false;
}

/// Those that a step of Newton's method moves far while nearly all others stay.
std::vector<int> Equilibrium::loose_in(const Eigen::VectorXd& step) const {
  const std::vector<double> ways = ways_of(step, network_.per_grain());
  std::vector<double> sorted = ways;
  const auto all_but_few =
      sorted.begin() +
      static_cast<std::ptrdiff_t>((1 - kLooseShare) * static_cast<double>(ways.size()));
  std::nth_element(sorted.begin(), all_but_few, sorted.end());
  const double far = std::max(kLooseStep, kLooseTimes * *all_but_few);
  std::vector<int> out;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    if (ways[k] > far) out.push_back(static_cast<int>(k));
  }
  return out;
}

/// First all others while the loose grains are held, then these between the others; what comes to
/// rest is committed. Afterwards the loose ones may be firm, and all are for Newton's method again.
bool Equilibrium::settle_apart() {
  ++times_apart_;
  std::vector<int> loose = loose_;
  bool all_known = false;
  for (int turn = 0; !all_known; ++turn) {
    const auto most = static_cast<std::size_t>(kMostLoose * network_.free_grains());
    if (turn == kMostTurns || loose.size() > most) return false;
    const std::vector<int> firm = others(network_.free_grains(), loose);
    const auto bulk = network_.part(firm);
    Equilibrium of_bulk(*bulk, settings_, go_on_);
    of_bulk.about_loose_ = Loose::reported;
    const bool rests = settle_part(*bulk, of_bulk, true);
    all_known = of_bulk.loose_.empty();
    if (all_known && !rests) return false;
    for (const int number : of_bulk.loose_) loose.push_back(firm[static_cast<std::size_t>(number)]);
    std::sort(loose.begin(), loose.end());
  }
  const auto few = network_.part(loose);
  Equilibrium of_few(*few, settings_, go_on_);
  of_few.about_loose_ = Loose::ignored;
  return settle_part(*few, of_few, false);
}

bool Equilibrium::settle_part(ContactNetwork& part, Equilibrium& of_part, bool at_once) {
  const bool rests = of_part.settle(at_once);
  if (rests) network_.adopt(part);
  steps_ += of_part.steps();
  iterations_ += of_part.iterations();
  return rests;
}

/// The mean resultant meets the ratio asked for, and no grain is far above it. Newton aims lower,
/// but disks that form a roller bearing creep on the last digits and never get there.
bool Equilibrium::enough(const Eigen::VectorXd& r) const {
  const double ratio = (large_ ? kDearShare : 1) * settings_.unbalanced_force_ratio;
  return network_.mean_resultant(r) <= 0.5 * ratio && network_.mean_moment(r) <= ratio &&
         r.cwiseAbs().maxCoeff() <= kMostOver * ratio;
}

/// More drag on the grains that hold up Newton's method, which stopped at z.
void Equilibrium::brake(const Eigen::VectorXd& z) {
  Eigen::VectorXd r;
  const bool known = problem_.residual(z, r);
  const double most = known ? r.cwiseAbs().maxCoeff() : 0;
  const double far = z.cwiseAbs().maxCoeff();
  bool any = false;
  const int per = network_.per_grain();
  for (int k = 0; k < network_.size(); k += per) {
    const bool holds = (known && r.segment(k, per).cwiseAbs().maxCoeff() >= kCulprit * most) ||
                       (far > kMostStep && z.segment(k, per).cwiseAbs().maxCoeff() >= 0.5 * far);
    if (!holds) continue;
    drag_.segment(k, per).setConstant(std::max(drag_[k] * kBrake, kFirstDrag));
    any = true;
  }
  if (!any) drag_ = (drag_ * kBrake).cwiseMax(kFirstDrag);
}

}  // namespace grainfield::dem
