// What fits of layers leave: summary keys, tables and pictures.
#pragma once
#include <string>
#include <vector>

#include "coupling/fit/finite_elements.h"
#include "coupling/fit/layer_data.h"
#include "coupling/fit/layer_maps.h"
#include "coupling/fit/layer_verdict.h"
#include "coupling/output/tables.h"
#include "coupling/report/report.h"

namespace grainfield::coupling {

/// Everything that was fitted to one ensemble of layers.
struct LayerFits {
  LayerData layers;
  Weights weights;
  std::vector<FitModel> models;
  std::vector<Fit> fits;  ///< in the order of models
  Selection selection;
  LayerVerdict verdict;
  std::vector<FiniteElementFit> elements;
  StressMaps maps;
};

/// fit.*, fe.* and verdict.*: see figures.cc.
void add_layer_fits(Summary& summary, const LayerFits& fits);

/// Parameters and ranking, as a Markdown document and as LaTeX tables.
std::string layer_fits_markdown(const LayerFits& fits);
std::string layer_fits_tex(const LayerFits& fits);

/// Frames of one component along every level, grains beside all models in their order. `only`: the
/// levels of these names; empty: all.
std::vector<Frame> layer_frames(const LayerFits& fits, const std::string& component,
                                const std::vector<std::string>& only = {});
/// Grains, model and residuals on a grid (stress_maps.h). `of` stands before the titles.
std::vector<Section> layer_map_sections(const LayerFits& fits, const std::string& model,
                                        const std::string& of = "");
/// Profiles of every component, maps, posteriors.
std::vector<Section> layer_pictures(const LayerFits& fits);
/// Ranking, constants, finite elements. `of` stands before the titles: "mono: ".
std::vector<Section> layer_tables(const LayerFits& fits, const std::string& of = "");

}  // namespace grainfield::coupling
