#pragma once

#include "prt/error_measures.h"
#include "prt/sweep.h"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace prt::cli {

/// What one cluster contributes, over all lights of an evaluation.
struct ClusterShare {
    std::size_t cluster = 0, receivers = 0;
    int components = 0;
    double area_share = 0;  ///< of all area
    double error_share = 0; ///< of the squared error
    double lit_rms = 0;     ///< of its receivers alone
};

struct Evaluation {
    std::string baked, shipped;
    double relative_l2 = 0;
    std::vector<std::pair<std::string, LitError>> lights;
    std::string worst_light;            ///< of the directional lights
    std::vector<ClusterShare> clusters; ///< the worst first
    std::vector<std::pair<std::string, std::string>> facts;
    std::vector<std::pair<std::string, std::vector<std::byte>>> pictures; ///< title and PNG
    std::optional<Sweep> sweep;
};

/// A page that stands alone: figures as tables, errors per light as bars, pictures, the sweep's charts.
std::string html_report(const Evaluation& evaluation);

} // namespace prt::cli
