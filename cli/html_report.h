#pragma once

#include "prt/error_measures.h"

#include <string>
#include <utility>
#include <vector>

namespace prt::cli {

struct Evaluation {
    std::string baked, shipped;
    double relative_l2 = 0;
    std::vector<std::pair<std::string, LitError>> lights;
    std::vector<std::pair<std::string, std::string>> facts;
};

/// A page that stands alone: figures as tables, errors per light as bars.
std::string html_report(const Evaluation& evaluation);

} // namespace prt::cli
