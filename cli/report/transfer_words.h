#pragma once

// Figures and words about transfer and its record.

#include "cli/report/report.h"
#include "prt/core/baked_transfer.h"
#include "prt/core/clustered_bases.h"

#include <string>
#include <vector>

namespace prt::pipeline {

/// The terms of a transfer vector: [{"kind": "direct", "channels": 1}, ...], and "1 channel of direct light,
/// 3 of indirect".
Json terms_figures(const TransferLayout& layout);
std::string terms_in_words(const TransferLayout& layout);

/// Returns the names of the predictors of clusters.
std::vector<std::string> predictor_names(const ClusteredBases& bases);

/// How a bake was made.
Json bake_record_json(const BakeRecord& record);

} // namespace prt::pipeline
