#include "coupling/strain/hull.h"

#include <fmt/format.h>
#include <libqhull_r/qhull_ra.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace grainfield::coupling {
namespace {

// Smallest spread over the largest: below, points count as lying in a plane.
constexpr double kFlat = 1e-9;

[[noreturn]] void refuse(Eigen::Index points, const std::string& why) {
  throw std::invalid_argument(fmt::format(
      "convex hull: found {} points{}, allowed: four or more that do not lie in a plane", points,
      why));
}

// Qhull's workspace. What it prints is kept for the message.
class Workspace {
 public:
  Workspace() : messages_(open_memstream(&text_, &size_)) { qh_zero(&qh_, messages_); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace() {
    qh_freeqhull(&qh_, !qh_ALL);
    int of_long = 0, total_of_long = 0;
    qh_memfreeshort(&qh_, &of_long, &total_of_long);
    std::fclose(messages_);
    std::free(text_);
  }

  // Qt: triangles; Pp: no warning of a narrow hull.
  bool find(int points, double* coordinates) {
    char command[] = "qhull Qt Pp";
    return qh_new_qhull(&qh_, 3, points, coordinates, False, command, nullptr, messages_) == 0;
  }
  qhT* state() { return &qh_; }

 private:
  qhT qh_{};
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* messages_;
};

// Outwards, of the length of twice the area.
Eigen::Vector3d twice_area(const std::array<int, 3>& t, const Eigen::MatrixXd& points) {
  const Eigen::Vector3d a = points.row(t[0]), b = points.row(t[1]), c = points.row(t[2]);
  return (b - a).cross(c - a);
}

}  // namespace

Hull convex_hull(const Eigen::MatrixXd& points) {
  if (points.rows() < 4) refuse(points.rows(), "");
  // About their middle, in units of their extent: Qhull's tolerances go by the coordinates' size.
  const Eigen::RowVector3d middle = points.colwise().mean();
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> local = points.rowwise() - middle;
  const double extent = local.cwiseAbs().maxCoeff();
  if (!(extent > 0)) refuse(points.rows(), " in one place");
  local /= extent;
  Workspace workspace;
  if (!workspace.find(static_cast<int>(points.rows()), local.data())) {
    refuse(points.rows(), " of which Qhull makes no hull");
  }
  Hull hull;
  qhT* qh = workspace.state();
  facetT* facet = nullptr;
  vertexT *vertex = nullptr, **vertexp = nullptr;
  FORALLfacets {
    std::array<int, 3> corners{};
    std::size_t k = 0;
    FOREACHvertex_(facet->vertices) {
      if (k < 3) corners[k] = qh_pointid(qh, vertex->point);
      ++k;
    }
    const Eigen::Vector3d outside(facet->normal[0], facet->normal[1], facet->normal[2]);
    if (twice_area(corners, points).dot(outside) < 0) std::swap(corners[1], corners[2]);
    hull.push_back(corners);
  }
  return hull;
}

double hull_volume(const Hull& hull, const Eigen::MatrixXd& points) {
  const Eigen::Vector3d middle = points.colwise().mean().transpose();
  double volume = 0;
  for (const auto& t : hull) {
    const Eigen::Vector3d corner = points.row(t[0]).transpose() - middle;
    volume += corner.dot(twice_area(t, points)) / 6;
  }
  return volume;
}

Eigen::Matrix3d hull_gradient(const Hull& hull, const Eigen::MatrixXd& points,
                              const Eigen::MatrixXd& displacements) {
  // Against the mean one: a closed surface does not feel what is common.
  const Eigen::MatrixXd local = displacements.rowwise() - displacements.colwise().mean();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const auto& t : hull) {
    const Eigen::RowVector3d mean = (local.row(t[0]) + local.row(t[1]) + local.row(t[2])) / 3;
    sum += mean.transpose() * twice_area(t, points).transpose() / 2;
  }
  return sum / hull_volume(hull, points);
}

Eigen::Matrix3d fitted_gradient(const Eigen::MatrixXd& points,
                                const Eigen::MatrixXd& displacements) {
  const Eigen::MatrixXd x = points.rowwise() - points.colwise().mean();
  const Eigen::MatrixXd u = displacements.rowwise() - displacements.colwise().mean();
  const Eigen::Matrix3d spread = x.transpose() * x;
  Eigen::FullPivLU<Eigen::Matrix3d> solver(spread);
  solver.setThreshold(kFlat);
  if (!solver.isInvertible()) refuse(points.rows(), " without a volume");
  return solver.solve(x.transpose() * u).transpose();
}

}  // namespace grainfield::coupling
