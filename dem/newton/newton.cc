#include "dem/newton/newton.h"

#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <type_traits>

namespace grainfield {
namespace {

// KINSOL's line search gives up below this (scaled, relative) step: round-off.
constexpr double kLeastStep = 1e-15;
// Times that the line search may fail to curve enough before KINSOL stops.
constexpr long kBetaFails = 50;

struct Work {
  const NewtonProblem* problem = nullptr;
  const NewtonSettings* settings = nullptr;
  Eigen::VectorXd u, r, x;
  std::vector<double> history, sizes;  // largest |r|; 2-norm, which the line search lowers
  bool stalled = false, singular = false, enough = false;
  std::exception_ptr thrown;
};

Eigen::Map<Eigen::VectorXd> view(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<Eigen::Index>(N_VGetLength(v))};
}

// What callbacks return: 0 done, 1 try another point, -1 stop. No exception may cross C code.
template <class Body>
int guarded(Work& w, Body body) {
  try {
    return body();
  } catch (...) {
    w.thrown = std::current_exception();
    return -1;
  }
}

int residual_callback(N_Vector u, N_Vector r, void* data) {
  Work& w = *static_cast<Work*>(data);
  return guarded(w, [&] {
    w.u = view(u);
    if (!w.problem->residual(w.u, w.r)) return 1;
    view(r) = w.r;
    return w.r.allFinite() ? 0 : 1;
  });
}

int tangent_callback(N_Vector u, N_Vector r, SUNMatrix, void* data, N_Vector, N_Vector) {
  Work& w = *static_cast<Work*>(data);
  return guarded(w, [&] {
    w.u = view(u);
    w.r = view(r);
    w.history.push_back(w.r.cwiseAbs().maxCoeff());
    w.sizes.push_back(w.r.norm());
    const std::size_t k = w.sizes.size(), patience = w.settings->patience;
    w.stalled = k > patience && w.sizes[k - 1] > w.settings->progress * w.sizes[k - 1 - patience];
    if (w.stalled) return -1;
    w.enough = w.problem->enough && w.problem->enough(w.r);
    if (w.enough) return -1;
    w.singular = !w.problem->factorize(w.u, w.r);
    return w.singular ? -1 : 0;
  });
}

int factorize(SUNLinearSolver, SUNMatrix) { return 0; }  // done in tangent_callback

int substitute(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, realtype) {
  Work& w = *static_cast<Work*>(solver->content);
  return guarded(w, [&] {
    w.r = view(b);
    w.problem->solve(w.r, w.x);
    view(x) = w.x;
    return w.x.allFinite() ? 0 : -1;
  });
}

// The reason is in the report; nothing is printed.
void silence(int, const char*, const char*, char*, void*) {}

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

std::string reason(const Work& w, int flag) {
  if (w.stalled) return "the residual hardly falls";
  if (w.singular) return "the tangent is singular";
  switch (flag) {
    case KIN_MAXITER_REACHED:
      return "too many iterations";
    case KIN_LINESEARCH_NONCONV:
    case KIN_LINESEARCH_BCFAIL:
    case KIN_STEP_LT_STPTOL:
      return "no step lowers the residual";
    default:
      const std::unique_ptr<char, decltype(&std::free)> name(KINGetReturnFlagName(flag),
                                                             &std::free);
      return name ? name.get() : "?";
  }
}

void require(int flag, const char* call) {
  if (flag < 0) throw std::logic_error(std::string("KINSOL refused ") + call);
}

}  // namespace

NewtonReport newton(const NewtonProblem& problem, const NewtonSettings& settings,
                    Eigen::VectorXd& u) {
  NewtonReport report;
  report.converged = true;
  if (u.size() == 0) {
    report.history = {0};
    return report;
  }
  Work work;
  work.problem = &problem;
  work.settings = &settings;
  SUNContext raw = nullptr;
  require(SUNContext_Create(nullptr, &raw), "a context");
  const auto context = own(raw);
  const auto n = static_cast<sunindextype>(u.size());
  const auto iterate = own(N_VMake_Serial(n, u.data(), context.get()));
  const auto ones = own(N_VNew_Serial(n, context.get()));
  N_VConst(1, ones.get());
  const auto scales = own(N_VNew_Serial(n, context.get()));
  N_VConst(1 / settings.scale, scales.get());
  const auto matrix = own(SUNMatNewEmpty(context.get()));
  matrix->ops->getid = custom_matrix;
  matrix->ops->zero = zero_matrix;
  const auto linear = own(SUNLinSolNewEmpty(context.get()));
  linear->content = &work;
  linear->ops->gettype = direct_solver;
  linear->ops->getid = custom_solver;
  linear->ops->setup = factorize;
  linear->ops->solve = substitute;

  const auto kinsol = own(KINCreate(context.get()));
  void* const memory = kinsol.get();
  require(KINSetErrHandlerFn(memory, silence, nullptr), "KINSetErrHandlerFn");
  require(KINSetUserData(memory, &work), "KINSetUserData");
  require(KINInit(memory, residual_callback, iterate.get()), "KINInit");
  require(KINSetLinearSolver(memory, linear.get(), matrix.get()), "KINSetLinearSolver");
  require(KINSetJacFn(memory, tangent_callback), "KINSetJacFn");
  require(KINSetMaxSetupCalls(memory, 1), "KINSetMaxSetupCalls");
  require(KINSetNumMaxIters(memory, settings.max_iterations), "KINSetNumMaxIters");
  require(KINSetFuncNormTol(memory, settings.tolerance), "KINSetFuncNormTol");
  require(KINSetScaledStepTol(memory, kLeastStep), "KINSetScaledStepTol");
  require(KINSetMaxBetaFails(memory, kBetaFails), "KINSetMaxBetaFails");
  require(KINSetMaxNewtonStep(memory, settings.most_norm), "KINSetMaxNewtonStep");

  const int flag = KINSol(memory, iterate.get(), KIN_LINESEARCH, scales.get(), ones.get());
  if (work.thrown) std::rethrow_exception(work.thrown);
  long iterations = 0;
  KINGetNumNonlinSolvIters(memory, &iterations);
  report.iterations = static_cast<int>(iterations);
  const bool defined = problem.residual(u, work.r) && work.r.allFinite();
  const double norm =
      defined ? work.r.cwiseAbs().maxCoeff() : std::numeric_limits<double>::infinity();
  report.converged = work.enough || norm <= settings.tolerance;
  report.history = std::move(work.history);
  report.history.push_back(norm);
  if (!report.converged) report.why = reason(work, flag);
  return report;
}

}  // namespace grainfield
