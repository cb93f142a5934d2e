// What fits of heaps and layers leave: summary keys, tables and pictures.
#pragma once
#include <string>
#include <vector>

#include "coupling/fit/ensemble_fit.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// The figures fit.MODEL.*, fit.*, fe.* and verdict.*, the judgement, and judgement, constants and
/// finite elements as fits.csv, fits.md and fits.tex.
void add_fits(StudyResult& result, const EnsembleFits& fits);

/// The branch of Cantelaube's theory whose core angle is nearest: "minus", "zero" or "plus".
std::string nearest_branch(double slope_deg, double beta_hat_deg);

/// Frames of one component along every level: the grains, and of heaps the best models (those of
/// one field share a line), of layers all in their order. `only`: the levels of these names; empty:
/// all.
std::vector<Frame> profile_frames(const EnsembleFits& fits, const std::string& component,
                                  const std::vector<std::string>& only = {});
/// Grains, model and residuals on a grid (stress_maps.h); of heaps also the Mohr-Coulomb expression
/// (structure/yield.h) of grains and model over (sigma_xx + sigma_yy)^2, at the friction angle of
/// the models. None without maps. `of` stands before the titles.
std::vector<Section> fit_map_sections(const EnsembleFits& fits, const std::string& model,
                                      const std::string& of = "");
/// Profiles of every component, maps, of heaps residuals along the heights, posteriors.
std::vector<Section> fit_pictures(const EnsembleFits& fits);
/// Constants and finite elements. `of` stands before the titles: "mono: "; with it the models'
/// table comes first.
std::vector<Section> fit_tables(const EnsembleFits& fits, const std::string& of = "");

}  // namespace grainfield::coupling
