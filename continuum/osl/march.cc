#include "continuum/osl/march.h"

#include <arkode/arkode_arkstep.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

#include "continuum/model.h"
#include "continuum/osl/flux.h"

namespace grainfield::continuum::osl {
namespace {

/// A heap is marched from this part of its depth, with hydrostatic pressure above: what is wrong
/// there moves down with the same force, but over a width that grows.
constexpr double kTip = 1e-8;
/// Step over the time a characteristic takes through a column; fourth-order Runge-Kutta with these
/// differences is stable up to about 1.7.
constexpr double kCourant = 0.8;
constexpr double kOnBorder = 1e-9;
/// Depths that differ by less than this part of the whole are one.
constexpr double kSameDepth = 1e-13;
using Gauss = boost::math::quadrature::gauss<double, 7>;

template <class Function>
auto integral(const Function& f, double a, double b) {
  const double middle = (a + b) / 2, half = (b - a) / 2;
  auto sum = decltype(f(a))(f(middle) * Gauss::weights()[0]);
  for (std::size_t i = 1; i < Gauss::abscissa().size(); ++i) {
    const double off = half * Gauss::abscissa()[i];
    sum += Gauss::weights()[i] * (f(middle - off) + f(middle + off));
  }
  return decltype(sum)(sum * half);
}

class March {
 public:
  /// Column contents (two a column), then the force that left through the sides and the weight.
  using Contents = Eigen::Map<Eigen::VectorXd>;
  using ConstContents = Eigen::Map<const Eigen::VectorXd>;

  March(const Problem& problem, const StripMesh& mesh)
      : p_(problem), mesh_(mesh), n_(mesh.columns_count()), left_(n_), right_(n_), mean_(n_) {
    first_.assign(n_, 0);
    last_.assign(n_, n_ - 1);
    for (int i = 1; i < n_; ++i) first_[i] = is_break(i) ? i : first_[i - 1];
    for (int i = n_ - 2; i >= 0; --i) last_[i] = is_break(i + 1) ? i : last_[i + 1];
  }

  int unknowns() const { return 2 * n_ + 2; }
  double border(int i, double y) const { return mesh_.x(mesh_.columns[i], y); }

  void start(double y, Contents w) const {
    w.setZero();
    for (int i = 0; i < n_; ++i) {
      const double a = border(i, y), b = border(i + 1, y);
      State content = State::Zero();
      if (mesh_.spread > 0) {
        content[0] = integral(
            [&](double x) { return p_.weight(x, y) * (y - std::abs(x) / mesh_.spread); }, a, b);
      } else if (p_.surface) {
        content = integral([&](double x) -> State { return p_.surface(x, 0); }, a, b);
      }
      w.segment<2>(2 * i) = content;
    }
  }

  void derivative(double y, ConstContents w, Contents rate) {
    reconstruct(y, w);
    rate.setZero();
    for (int i = 0; i <= n_; ++i) {
      const State flux = flux_through(i, y);
      if (i > 0) rate.segment<2>(2 * (i - 1)) -= flux;
      if (i < n_) rate.segment<2>(2 * i) += flux;
      if (i == 0) rate[2 * n_] -= flux[0];
      if (i == n_) rate[2 * n_] += flux[0];
    }
    for (int i = 0; i < n_; ++i) {
      const double a = border(i, y), b = border(i + 1, y);
      const double weight = integral([&](double x) { return p_.weight(x, y); }, a, b);
      rate[2 * i] += weight;
      rate[2 * n_ + 1] += weight;
      if (p_.side_force)
        rate[2 * i + 1] += integral([&](double x) { return p_.side_force(x, y); }, a, b);
    }
  }

  /// Least time that a characteristic takes through a column.
  double crossing(double y) const {
    double least = std::numeric_limits<double>::max();
    for (int i = 0; i <= n_; ++i) {
      const double x = border(i, y), turn = mesh_.spread * mesh_.columns[i];
      const double narrow =
          std::min(i > 0 ? x - border(i - 1, y) : 1e300, i < n_ ? border(i + 1, y) - x : 1e300);
      for (const int sign : {-1, 1}) {
        const Characteristics c = characteristics(p_, x, y, sign);
        const double speed = std::max(std::abs(c.upwind - turn), std::abs(c.downwind - turn));
        least = std::min(least, narrow / speed);
      }
    }
    return least;
  }

  /// At a point of this depth: the parabola of the column's content and its two border values.
  State at(double x, double y, ConstContents w) {
    const double wide = (mesh_.columns.back() - mesh_.columns.front()) * kOnBorder;
    double s = mesh_.column(x, y);
    if (!(s >= mesh_.columns.front() - wide && s <= mesh_.columns.back() + wide))
      return State::Constant(std::numeric_limits<double>::quiet_NaN());
    s = std::clamp(s, mesh_.columns.front(), mesh_.columns.back());
    const auto above = std::upper_bound(mesh_.columns.begin() + 1, mesh_.columns.end() - 1, s);
    const int i = static_cast<int>(above - mesh_.columns.begin()) - 1;
    reconstruct(y, w);
    const double part = (s - mesh_.columns[i]) / (mesh_.columns[i + 1] - mesh_.columns[i]);
    return left_[i] +
           part * (right_[i] - left_[i] + 6 * (1 - part) * (mean_[i] - (left_[i] + right_[i]) / 2));
  }

 private:
  /// Differences must not be taken across this border.
  bool is_break(int i) const {
    const double s = mesh_.columns[i];
    return (p_.mirrored && s == 0) ||
           std::find(mesh_.kinks.begin(), mesh_.kinks.end(), s) != mesh_.kinks.end();
  }

  void reconstruct(double y, ConstContents w) {
    for (int i = 0; i < n_; ++i) mean_[i] = w.segment<2>(2 * i) / (border(i + 1, y) - border(i, y));
    for (int i = 0; i < n_; ++i) {
      const int columns = last_[i] - first_[i] + 1;
      if (columns == 1) {
        left_[i] = right_[i] = mean_[i];
      } else if (columns == 2) {
        const State half = (mean_[last_[i]] - mean_[first_[i]]) / 2;
        left_[i] = mean_[i] - half;
        right_[i] = mean_[i] + half;
      } else {
        // The parabola with the contents a, b, c of three columns, the middle one as near as can
        // be.
        const int m = std::clamp(i, first_[i] + 1, last_[i] - 1);
        const State &a = mean_[m - 1], &b = mean_[m], &c = mean_[m + 1];
        if (i < m) {
          left_[i] = (11 * a - 7 * b + 2 * c) / 6;
          right_[i] = (2 * a + 5 * b - c) / 6;
        } else if (i > m) {
          left_[i] = (2 * c + 5 * b - a) / 6;
          right_[i] = (11 * c - 7 * b + 2 * a) / 6;
        } else {
          left_[i] = (2 * a + 5 * b - c) / 6;
          right_[i] = (2 * c + 5 * b - a) / 6;
        }
      }
    }
  }

  int side_of(int column) const {
    return mesh_.columns[column] + mesh_.columns[column + 1] < 0 ? -1 : 1;
  }

  /// In the direction of +x, relative to the border's motion.
  State flux_through(int i, double y) const {
    const double x = border(i, y), turn = mesh_.spread * mesh_.columns[i];
    if (i == 0 || i == n_) return border_flux(i == 0 ? -1 : 1, x, y, turn);
    if (p_.mirrored && mesh_.columns[i] == 0) {
      const Flux f = axis_flux(characteristics(p_, x, y, -1), characteristics(p_, x, y, 1));
      return f.own * right_[i - 1] + f.other * left_[i];
    }
    const Flux f = upwind_flux(characteristics(p_, x, y, side_of(i)), 1, -turn);
    return f.own * right_[i - 1] + f.other * left_[i];
  }

  State border_flux(int sign, double x, double y, double turn) const {
    const int column = sign < 0 ? 0 : n_ - 1;
    const Characteristics c = characteristics(p_, x, y, side_of(column));
    const State inside = sign < 0 ? left_[0] : right_[n_ - 1];
    if (mesh_.spread > 0) {
      const Flux f = upwind_flux(c, sign, -sign * turn);
      require_entering(p_, c, f, mesh_.spread, x, y);
      return p_.surface ? State(sign * (f.other * p_.surface(x, y))) : State(State::Zero());
    }
    if (p_.sides == Sides::walls) return sign * (wall_flux(c, p_.wall_friction, sign).own * inside);
    const Flux f = upwind_flux(c, sign, 0);
    State out = f.own * inside;
    if (p_.beyond) out += f.other * p_.beyond(x, y);
    return sign * out;
  }

  const Problem& p_;
  const StripMesh& mesh_;
  int n_;
  std::vector<int> first_, last_;           ///< columns that differences may reach, by column
  std::vector<State> left_, right_, mean_;  ///< states at a column's borders, and its mean
};

/// What ARKode's callbacks see. Exceptions must not pass through its C code.
struct Callbacks {
  March* march;
  std::exception_ptr thrown = nullptr;
  std::string message;

  template <class Function>
  int guarded(const Function& call) {
    try {
      call();
      return 0;
    } catch (...) {
      thrown = std::current_exception();
      return -1;
    }
  }
};

March::Contents contents(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<Eigen::Index>(N_VGetLength(v))};
}

int right_side(realtype y, N_Vector w, N_Vector rate, void* user) {
  auto& callbacks = *static_cast<Callbacks*>(user);
  return callbacks.guarded([&] {
    const March::ConstContents values(N_VGetArrayPointer(w), N_VGetLength(w));
    callbacks.march->derivative(y, values, contents(rate));
  });
}

int stable_step(N_Vector, realtype y, realtype* step, void* user) {
  auto& callbacks = *static_cast<Callbacks*>(user);
  return callbacks.guarded([&] { *step = callbacks.march->crossing(y); });
}

void keep_message(int, const char*, const char*, char* message, void* user) {
  static_cast<Callbacks*>(user)->message = message;
}

/// ARKode's memory, freed whatever happens.
class Integrator {
 public:
  Integrator(const Problem& problem, March& scheme, double from, double first_step,
             const MarchSettings& settings, double floor)
      : problem_(problem), settings_(settings), callbacks_{&scheme, nullptr, {}} {
    require(SUNContext_Create(nullptr, &context_));
    state_ = N_VNew_Serial(scheme.unknowns(), context_);
    scheme.start(from, contents(state_));
    memory_ = ARKStepCreate(right_side, nullptr, from, state_, context_);
    require(ARKStepSetErrHandlerFn(memory_, keep_message, &callbacks_));
    require(ARKStepSetUserData(memory_, &callbacks_));
    require(ARKStepSStolerances(memory_, settings.tolerance, floor));
    require(ARKStepSetOrder(memory_, 4));
    require(ARKStepSetStabilityFn(memory_, stable_step, &callbacks_));
    require(ARKStepSetCFLFraction(memory_, kCourant));
    require(ARKStepSetInitStep(memory_, first_step));
  }
  ~Integrator() {
    if (memory_ != nullptr) ARKStepFree(&memory_);
    if (state_ != nullptr) N_VDestroy(state_);
    SUNContext_Free(&context_);
  }
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  void advance(double y) {
    const long left = settings_.most_steps - steps();
    require(ARKStepSetMaxNumSteps(memory_, std::max(left, 1L)));
    require(ARKStepSetStopTime(memory_, y));
    realtype reached = 0;
    const int flag = ARKStepEvolve(memory_, y, state_, &reached, ARK_NORMAL);
    if (callbacks_.thrown) std::rethrow_exception(callbacks_.thrown);
    if (flag < 0)
      throw ComputationFailed(fmt::format(
          "model {}: marching stopped at depth {:.6g} after {} steps ({}); raise steps (now {}) or "
          "lower columns",
          problem_.name, reached, steps(),
          flag == ARK_TOO_MUCH_WORK ? "too many" : callbacks_.message, settings_.most_steps));
  }
  March::ConstContents state() const {
    return {N_VGetArrayPointer(state_), static_cast<Eigen::Index>(N_VGetLength(state_))};
  }
  long steps() const {
    long count = 0;
    ARKStepGetNumSteps(memory_, &count);
    return count;
  }

 private:
  void require(int flag) const {
    if (flag < 0)
      throw ComputationFailed(fmt::format("model {}: ARKode refuses its settings: {}",
                                          problem_.name, callbacks_.message));
  }

  const Problem& problem_;
  MarchSettings settings_;
  Callbacks callbacks_;
  SUNContext context_ = nullptr;
  N_Vector state_ = nullptr;
  void* memory_ = nullptr;
};

}  // namespace

MarchResult march(const Problem& problem, const StripMesh& mesh, const Eigen::MatrixXd& points,
                  const MarchSettings& settings) {
  check_mesh(problem, mesh);
  const auto begun = std::chrono::steady_clock::now();
  const double depth = mesh.rows.back(), tall = depth * kOnBorder;
  const double from = mesh.spread > 0 ? kTip * depth : 0;
  March scheme(problem, mesh);
  // Errors of columns this small do not matter.
  const double typical = std::abs(problem.weight(0, depth)) * depth +
                         (problem.surface ? problem.surface(0, 0).norm() : 0);
  const double floor = std::max(1e-3 * settings.tolerance * typical *
                                    (mesh.x(mesh.columns.back(), depth) / mesh.columns_count()),
                                std::numeric_limits<double>::min());
  const double first_step = kCourant * scheme.crossing(from) / 2;
  Integrator integrator(problem, scheme, from, first_step, settings, floor);
  const auto total = [&] {
    double sum = 0;
    for (int i = 0; i < mesh.columns_count(); ++i) sum += integrator.state()[2 * i];
    return sum;
  };
  const double initial = total();

  MarchResult out;
  out.states.assign(points.rows(), State::Constant(std::numeric_limits<double>::quiet_NaN()));
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points(i, 1) >= -tall && points(i, 1) <= depth + tall) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return points(a, 1) < points(b, 1); });
  double reached = from;
  for (const Eigen::Index i : order) {
    const double y = std::clamp(points(i, 1), 0., depth);
    if (y > reached + kSameDepth * depth) {
      integrator.advance(y);
      reached = y;
    }
    if (y >= from) {
      out.states[i] = scheme.at(points(i, 0), y, integrator.state());
    } else if (std::abs(points(i, 0)) <= mesh.spread * y + tall) {
      out.states[i] = State::Zero();  // the tip
    }
  }
  if (reached + kSameDepth * depth < depth) integrator.advance(depth);
  auto& f = out.figures;
  f["unknowns"] = 2 * mesh.columns_count();
  f["steps"] = static_cast<double>(integrator.steps());
  f["base_force"] = total();
  f["side_force"] = integrator.state()[2 * mesh.columns_count()];
  f["weight"] = integrator.state()[2 * mesh.columns_count() + 1];
  // The march of a heap starts with the weight of the tip.
  (mesh.spread > 0 ? f["weight"] : f["load"]) += initial;
  const double largest = std::max({std::abs(f["base_force"]), std::abs(f["weight"]),
                                   std::abs(f["load"]), std::numeric_limits<double>::min()});
  f["force_balance"] =
      std::abs(f["base_force"] + f["side_force"] - f["weight"] - f["load"]) / largest;
  f["solve_s"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return out;
}

}  // namespace grainfield::continuum::osl
