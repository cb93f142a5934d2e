// A study in a page: what it observes on its grains, what it compares that with, and what it tells.
// Its analysis and its report follow.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "coupling/case/study.h"
#include "coupling/observe/observations.h"
#include "coupling/result/figure.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// Every part may be left out.
struct Declaration {
  /// What is observed: figures of each realization, besides those that its simulation leaves.
  std::vector<Figure<Realization>> observed = {};
  /// What is compared with compare.models, from the files of the realizations.
  std::function<Observations(const Case&, const std::vector<std::string>&, int threads)> compared =
      {};
  /// In its place: may first add models that follow from the grains, and figures and files.
  std::function<Observations(StudyResult&, std::vector<ModelChoice>& models, int threads)>
      predicted = {};
  /// Figures of the run, from what precedes.
  std::vector<RunFigure<StudyResult>> found = {};
  /// Further figures, files, warnings, and charts of a sweep.
  std::function<void(StudyResult&)> more = {};
  /// What it tells, a sentence or two.
  std::function<std::string(const StudyResult&)> told = {};
  /// The page: below its title, and between its verdict and its figures.
  std::function<std::string(const StudyResult&)> subtitle = {};
  std::function<std::vector<Section>(const StudyResult&, const Realization& first)> pictures = {};
};

/// Gives the study its figures, besides those that it lists, and its analysis.
void declare(Study& study, Declaration declaration);

}  // namespace grainfield::coupling
