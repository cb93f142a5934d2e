// The heap and the layer of oriented stress linearity on top of OslSolver.
#include "continuum/fe/osl_solver.h"
#include "continuum/fe/plugin.h"
#include "continuum/osl/models.h"

namespace grainfield::continuum {
namespace {

class OslElements : public Model {
 public:
  explicit OslElements(osl::Task task) : task_(std::move(task)) {}

  Stresses stress(const Points& points) override {
    if (!solver_) {
      auto solver = std::make_unique<fe::OslSolver>(task_.problem, task_.mesh, task_.order);
      solver->solve();
      solver_ = std::move(solver);
    }
    Stresses out(points.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const double x = points(i, 0), y = points(i, 1);
      out.row(i) = osl::in_project_axes(task_, solver_->at(x, -y), x, y);
    }
    return out;
  }
  std::map<std::string, double> figures() const override {
    auto all = solver_ ? solver_->figures() : std::map<std::string, double>();
    all.insert(task_.figures.begin(), task_.figures.end());
    return all;
  }

 private:
  osl::Task task_;
  std::unique_ptr<fe::OslSolver> solver_;
};

std::unique_ptr<Model> make(const std::string& name, const Settings& settings) {
  return std::make_unique<OslElements>(osl::make_task(name, settings));
}

const fe::ModelRow rows[] = {{"fe_osl_wedge", make}, {"fe_osl_layer", make}};

}  // namespace
}  // namespace grainfield::continuum
