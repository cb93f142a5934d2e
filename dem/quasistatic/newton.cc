#include "dem/quasistatic/newton.h"

#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseLU>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>

namespace grainfield::dem {
namespace {

// A pivot off the diagonal is taken only when the diagonal one is this much smaller: the tangent is
// dominated by its symmetric, definite part, and diagonal pivots keep the factors sparse.
constexpr double kPivotThreshold = 0.01;
// KINSOL's line search gives up below this (scaled, relative) step: round-off.
constexpr double kLeastStep = 1e-15;
// Times that the line search may fail to curve enough before KINSOL stops.
constexpr long kBetaFails = 50;
// Newton stalls, at a corner between two branches, when so many iterations have not brought the
// residual's 2-norm below this share.
constexpr std::size_t kPatience = 6;
constexpr double kProgress = 0.9;
// Slow convergence: an iteration that leaves more than this share of the residual.
constexpr double kSlow = 0.1;

/// What KINSOL's callbacks share: the problem, its matrix and factors, and what a callback threw.
struct Work {
  using Vector = NewtonProblem::Vector;
  using Matrix = NewtonProblem::Matrix;
  const NewtonProblem* problem = nullptr;
  const NewtonSettings* settings = nullptr;
  Matrix matrix;
  Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> factors;
  Vector z, r;
  std::vector<double> history, sizes;  // largest |r|; 2-norm, which the line search lowers
  std::string message;
  bool enough = false;
  std::exception_ptr thrown;
};

Eigen::Map<Eigen::VectorXd> view(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<Eigen::Index>(N_VGetLength(v))};
}

// Of the callbacks: 0 done, 1 try another point, -1 stop. No exception may cross C code.
template <class Body>
int guarded(Work& w, Body body) {
  try {
    return body();
  } catch (...) {
    w.thrown = std::current_exception();
    return -1;
  }
}

int residual_callback(N_Vector z, N_Vector r, void* data) {
  Work& w = *static_cast<Work*>(data);
  return guarded(w, [&] {
    w.z = view(z);
    if (!w.problem->residual(w.z, w.r)) return 1;
    view(r) = w.r;
    return 0;
  });
}

int tangent_callback(N_Vector z, N_Vector r, SUNMatrix, void* data, N_Vector, N_Vector) {
  Work& w = *static_cast<Work*>(data);
  return guarded(w, [&] {
    w.z = view(z);
    w.r = view(r);
    w.history.push_back(w.r.cwiseAbs().maxCoeff());
    w.sizes.push_back(w.r.norm());
    const std::size_t k = w.sizes.size();
    if (k > kPatience && w.sizes[k - 1] > kProgress * w.sizes[k - 1 - kPatience]) return -1;
    w.enough = k > 1 && w.sizes[k - 1] > kSlow * w.sizes[k - 2] && w.problem->enough &&
               w.problem->enough(w.r);
    if (w.enough) return -1;
    w.problem->tangent(w.z, w.r, w.matrix);
    return 0;
  });
}

int factorize(SUNLinearSolver solver, SUNMatrix) {
  Work& w = *static_cast<Work*>(solver->content);
  return guarded(w, [&] {
    w.factors.setPivotThreshold(kPivotThreshold);
    w.factors.compute(w.matrix);
    return w.factors.info() == Eigen::Success ? 0 : 1;
  });
}

int substitute(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, realtype) {
  Work& w = *static_cast<Work*>(solver->content);
  return guarded(w, [&] {
    w.r = view(b);
    w.z = w.factors.solve(w.r);
    if (!w.z.allFinite()) return 1;
    const double longest = w.z.cwiseAbs().maxCoeff();
    if (longest > w.settings->most_step) w.z *= w.settings->most_step / longest;
    view(x) = w.z;
    return 0;
  });
}

void keep_message(int, const char*, const char*, char* text, void* data) {
  static_cast<Work*>(data)->message = text;
}

int zero_matrix(SUNMatrix) { return 0; }
SUNMatrix_ID custom_matrix(SUNMatrix) { return SUNMATRIX_CUSTOM; }
SUNLinearSolver_Type direct_solver(SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; }
SUNLinearSolver_ID custom_solver(SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; }

struct Freer {
  void operator()(SUNContext c) const { SUNContext_Free(&c); }
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNMatrix m) const { SUNMatFreeEmpty(m); }
  void operator()(SUNLinearSolver s) const { SUNLinSolFreeEmpty(s); }
  void operator()(void* memory) const { KINFree(&memory); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Freer>;

template <class Handle>
Owned<Handle> own(Handle handle) {
  if (!handle) throw std::bad_alloc();
  return Owned<Handle>(handle);
}

void require(int flag, const char* call) {
  if (flag < 0) throw std::logic_error(std::string("KINSOL refused ") + call);
}

}  // namespace

NewtonReport solve(const NewtonProblem& problem, const NewtonSettings& settings,
                   Eigen::VectorXd& z) {
  NewtonReport report;
  report.converged = true;
  if (z.size() == 0) return report;
  auto work = std::make_unique<Work>();
  work->problem = &problem;
  work->settings = &settings;

  SUNContext raw = nullptr;
  require(SUNContext_Create(nullptr, &raw), "a context");
  const auto context = own(raw);
  const auto n = static_cast<sunindextype>(z.size());
  const auto iterate = own(N_VMake_Serial(n, z.data(), context.get()));
  const auto ones = own(N_VNew_Serial(n, context.get()));
  N_VConst(1, ones.get());
  const auto matrix = own(SUNMatNewEmpty(context.get()));
  matrix->ops->getid = custom_matrix;
  matrix->ops->zero = zero_matrix;
  const auto linear = own(SUNLinSolNewEmpty(context.get()));
  linear->content = work.get();
  linear->ops->gettype = direct_solver;
  linear->ops->getid = custom_solver;
  linear->ops->setup = factorize;
  linear->ops->solve = substitute;

  const auto kinsol = own(KINCreate(context.get()));
  void* const memory = kinsol.get();
  require(KINSetErrHandlerFn(memory, keep_message, work.get()), "KINSetErrHandlerFn");
  require(KINSetUserData(memory, work.get()), "KINSetUserData");
  require(KINInit(memory, residual_callback, iterate.get()), "KINInit");
  require(KINSetLinearSolver(memory, linear.get(), matrix.get()), "KINSetLinearSolver");
  require(KINSetJacFn(memory, tangent_callback), "KINSetJacFn");
  require(KINSetMaxSetupCalls(memory, 1), "KINSetMaxSetupCalls");
  require(KINSetNumMaxIters(memory, settings.max_iterations), "KINSetNumMaxIters");
  require(KINSetFuncNormTol(memory, settings.tolerance), "KINSetFuncNormTol");
  require(KINSetScaledStepTol(memory, kLeastStep), "KINSetScaledStepTol");
  require(KINSetMaxBetaFails(memory, kBetaFails), "KINSetMaxBetaFails");
  // The step's length is bounded per unknown in substitute(), not as a sum over the packing.
  require(KINSetMaxNewtonStep(memory, settings.most_step * std::sqrt(static_cast<double>(n)) + 1),
          "KINSetMaxNewtonStep");

  const int flag = KINSol(memory, iterate.get(), KIN_LINESEARCH, ones.get(), ones.get());
  linear->content = nullptr;
  if (work->thrown) std::rethrow_exception(work->thrown);
  long iterations = 0;
  KINGetNumNonlinSolvIters(memory, &iterations);
  report.iterations = static_cast<int>(iterations);
  report.norm = std::numeric_limits<double>::infinity();
  if (problem.residual(z, work->r)) report.norm = work->r.cwiseAbs().maxCoeff();
  report.converged = work->enough || report.norm <= settings.tolerance;
  report.history = std::move(work->history);
  report.history.push_back(report.norm);
  if (!report.converged) {
    const std::unique_ptr<char, decltype(&std::free)> name(KINGetReturnFlagName(flag), &std::free);
    report.why = name ? name.get() : "?";
  }
  return report;
}

}  // namespace grainfield::dem
