// What a topic leaves.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "coupling/output/field_io.h"
#include "coupling/output/tables.h"
#include "coupling/report/report.h"

namespace grainfield::coupling {

struct TopicResult {
  std::string sentence;                                    ///< what was found, one line
  Summary summary;                                         ///< keys declared in figures.cc
  NamedFields fields;                                      ///< for fields.h5, heap's frame, m
  std::vector<std::pair<std::string, std::string>> texts;  ///< further files: name, content
  std::vector<Section> sections;                           ///< of the report: pictures first
};

}  // namespace grainfield::coupling
