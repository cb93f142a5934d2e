// Everything that is fitted to one ensemble of heaps or layers: the one path of studies and
// commands.
//
//   observations.h          places, kernel, values per realization, maps: of grains or of a field
//   registry_entry.h        a model of the registry (continuum/registry.cc) with some of its
//   numbers
//                           free; heap_models.h (heaps) and layer_models.h (layers) list named
//                           ones, open_models.h reads others
//   model.h                 the same, ready to be fitted: parameters, starts, stress
//   layer_sight.h           the model at the places, through the kernel that averaged the grains
//                           (of heaps by coupling/models/observation_operator.h alone)
//   fit.h, selection.h      constants with errors; which models the data support
//   ensemble_fit.h          all of it for one ensemble, and finite elements (finite_elements.h)
//   fit_report.h            figures, tables and pictures of the result
//
// Heaps and layers differ in frame and units, in where they are looked at (heap_*.cc, layer_*.cc),
// in their models, and in words (Specimen).
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "coupling/compare/compare.h"
#include "coupling/fit/finite_elements.h"
#include "coupling/fit/layer_sight.h"
#include "coupling/fit/selection.h"
#include "coupling/observe/observations.h"

namespace grainfield::coupling {

struct EnsembleFits {
  Observations observed;
  std::vector<std::string> asked;  ///< the models as they were named
  Weights weights;
  std::vector<FitModel> models;
  std::vector<Fit> fits;  ///< in the order of models
  Judgement judgement;
  std::vector<FitModel> absent;  ///< asked for, but there is no such field for this heap
  std::vector<FiniteElementFit> elements;
};

/// setup.models of the heaps, with slopes that a part of the realizations has alone where these are
/// measured: their spread is part of the constants' errors.
std::vector<FitModel> models_of(const FitSetup& setup, const Observations& heaps);

/// The models that these texts name, of layers of this height, m.
std::vector<FitModel> models_of_layers(const std::vector<std::string>& texts,
                                       const std::shared_ptr<const LayerSight>& sight,
                                       double height);

/// Weights, one fit per setup.models, their ranking, and the finite elements asked for. The bits do
/// not depend on threads. Throws std::invalid_argument for unknown models and what data and models
/// throw.
EnsembleFits fit_heaps(const FitSetup& setup, Observations heaps, int threads);
EnsembleFits fit_layers(const FitSetup& setup, Observations layers, int threads);

/// Fitted models at any points (n x 2, frame and units of the data), seen as at the data's own;
/// n x 3 of each.
std::vector<Eigen::MatrixXd> models_at(const EnsembleFits& fits,
                                       const std::vector<std::string>& names,
                                       const Eigen::MatrixXd& points);

/// A fitted model on the maps' points seen through the averaging's kernel; n x 3, nan where the
/// maps are.
Eigen::MatrixXd model_on_maps(const EnsembleFits& fits, const std::string& name);

/// Grains and fitted models along every height and component of heaps, in m and N/m of the mean
/// heap, with their distances: for profiles.*.
Comparison profiles_of(const EnsembleFits& fits);

}  // namespace grainfield::coupling
