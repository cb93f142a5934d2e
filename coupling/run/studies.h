// The kinds of study, declared once: which keys mean something to each, what it simulates and how
// it is analysed. A new study is one file with its Study and one line in studies.cc.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "dem/study/outlook.h"
#include "dem/study/run.h"

namespace grainfield::coupling {

struct StudyResult;

struct Study {
  std::string name;     ///< the word of the case key `study`
  std::string meaning;  ///< for people, one line
  /// Sections of a case file that mean something to it, besides [compare] [output] [sweep].
  std::vector<std::string> sections;
  /// Keys of these sections that do not, by path.
  std::vector<std::string> without;
  /// Parameters of models that the run fills in where the user does not set them.
  std::vector<std::string> fills;
  /// Whether compare.models may be empty.
  bool models_optional = false;
  /// The realization of grains of this number, from 0; null: a study without grains. Throws
  /// std::invalid_argument beginning with the key that does not hold.
  std::unique_ptr<dem::Run> (*make_run)(const Case&, std::int64_t number, int threads) = nullptr;
  /// What a realization will take, from the case alone; set where make_run is. Throws what make_run
  /// would for any of the realizations; draws at most so many grains (dem/study/outlook.h).
  dem::Outlook (*foresee)(const Case&, std::int64_t draws) = nullptr;
  /// The number of dimensions of a case's grains, 2 or 3, and the key that decides it; null: 2.
  int (*dimension)(const Case&) = nullptr;
  std::string dimension_key;
  /// What only the study knows of its keys and models; null: nothing. Throws std::invalid_argument
  /// beginning with the key that does not hold.
  void (*check)(const Case&) = nullptr;
  /// Everything the study leaves, from the files of its realizations in order (none without
  /// grains). The bits do not depend on threads.
  StudyResult (*analyse)(const Case&, const std::vector<std::string>& realizations,
                         int threads) = nullptr;

  bool has_grains() const { return make_run != nullptr; }
};

/// In the order of the documentation.
const std::vector<Study>& studies();
/// The study of that name, or null.
const Study* find_study(const std::string& name);
/// The case's study; throws std::logic_error when the case was not validated.
const Study& study_of(const Case& value);

}  // namespace grainfield::coupling
