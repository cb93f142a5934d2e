// Synthetic responses of layers to a point load: known models and correlated noise. Lengths in h,
// stresses in F/h.
#pragma once
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "coupling/fit/finite_elements.h"
#include "coupling/fit/heap_models.h"
#include "coupling/fit/layer_models.h"
#include "coupling/fit/layer_sight.h"
#include "coupling/fit/selection.h"
#include "dem/random/random.h"

namespace grainfield::coupling {

inline Eigen::VectorXd vector(std::initializer_list<double> v) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(v.size()));
  std::copy(v.begin(), v.end(), out.data());
  return out;
}

// Three depths with all components, the base with two, `per` points each; the sight's points.
struct LayerScene {
  FitData data;
  std::shared_ptr<const LayerSight> sight;
  std::vector<FitModel> models;
  Eigen::MatrixXd root;  // of the noise's correlation
};

inline LayerScene layer_scene(int per = 13, double width = 0.1, double length = 0.2) {
  LayerScene out;
  FitData& data = out.data;
  data.components = {"sigma_xx", "sigma_yy", "sigma_xy"};
  data.levels = {"0.3", "0.5", "0.75", "base"};
  const std::vector<double> depths{0.3, 0.5, 0.75, 1};
  std::vector<Eigen::RowVector2d> points, once;
  for (int level = 0; level < 4; ++level) {
    for (int c = 0; c < 3; ++c) {
      if (level == 3 && c == 0) continue;
      for (int k = 0; k < per; ++k) {
        points.emplace_back(-1.5 + 3.0 * k / (per - 1), -depths[level]);
        if (c == 1) once.push_back(points.back());
        data.component.push_back(c);
        data.level.push_back(level);
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(points.size());
  data.points.resize(n, 2);
  for (Eigen::Index k = 0; k < n; ++k) data.points.row(k) = points[k];
  Eigen::MatrixXd places(once.size(), 2);
  for (std::size_t k = 0; k < once.size(); ++k) places.row(k) = once[k];
  out.sight = std::make_shared<const LayerSight>(places, *make_kernel("lucy", width));
  out.models = layer_models(out.sight);
  Eigen::MatrixXd correlation(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double d = (data.points.row(i) - data.points.row(j)).norm() / length;
      correlation(i, j) = data.component[i] != data.component[j] ? 0 : std::exp(-0.5 * d * d);
    }
    correlation(i, i) += 1e-6;
  }
  out.root = Eigen::LLT<Eigen::MatrixXd>(correlation).matrixL();
  data.samples.resize(n, 1);
  return out;
}

// The truth and `realizations` of noise; its size of one realization in F/h.
inline FitData with_noise(const LayerScene& scene, const std::string& model,
                          const Eigen::VectorXd& parameters, int realizations, double noise,
                          dem::Random& random) {
  FitData data = scene.data;
  const Eigen::VectorXd truth = predict(data, find_fit_model(scene.models, model), parameters);
  data.samples.resize(data.points.rows(), realizations);
  for (int r = 0; r < realizations; ++r) {
    Eigen::VectorXd z(data.points.rows());
    for (double& v : z) {
      v = -6;  // twelve uniform numbers: variance 1, to 3 deviations close to normal
      for (int k = 0; k < 12; ++k) v += random.uniform();
    }
    data.samples.col(r) = truth + noise * (scene.root * z);
  }
  return data;
}

struct LayerTruth {
  std::string model;
  Eigen::VectorXd parameters;
};

inline std::vector<LayerTruth> layer_truths() {
  return {{"flamant", vector({})},
          {"layer_smooth", vector({})},
          {"layer_rough", vector({0.3})},
          {"orthotropic_half_plane", vector({-0.3, 0.6})},
          {"orthotropic_layer_smooth", vector({0.3, 2})},
          {"orthotropic_layer_rough", vector({0.6, 0.6, 0.4})},
          {"osl_layer_absorbing", vector({0.5, 0.1, 0.6})},
          {"osl_layer_reflecting", vector({0.3, -0.1, 0.5})}};
}

}  // namespace grainfield::coupling
