#pragma once

// Checks of a model before it is baked: what reading leaves out or replaces, and what a bake would refuse.

#include "cli/pipeline/model.h"
#include "cli/report/report.h"

#include <string>
#include <vector>

namespace prt::pipeline {

struct Finding {
    std::string what, remedy;
};

/// One for each deviation, those of reading first.
std::vector<Finding> check_model(const SceneFile& model);

/// Adds the findings, and what was checked.
void add_findings(const std::vector<Finding>& findings, Report& report);

} // namespace prt::pipeline
