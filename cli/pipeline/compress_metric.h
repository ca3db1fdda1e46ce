#pragma once

#include "cli/pipeline/model.h"
#include "cli/pipeline/sky_errors.h"
#include "prt/compress/light_metric.h"
#include "prt/compress/search.h"

namespace prt::pipeline {

enum class MetricChoice { outdoor, indoor, day, natural, plain };
/// Returns "outdoor" and so on.
const char* to_string(MetricChoice choice);

/// Arguments of `prt compress` that describe the expected lighting.
struct MetricArguments {
    MetricChoice metric = MetricChoice::outdoor;
    std::vector<Path> lights; ///< used instead of `metric`
    LightOptions light_options;
};

/// The metric, and the lightings under which a requested error is guaranteed.
struct ErrorTerms {
    LightMetric metric;
    std::vector<Lighting> promised; ///< lamps are dark in them
    std::vector<Lighting> given;    ///< lightings of `promised` that come from `--lights`
    std::string covers;             ///< a sentence about the lightings for which the guarantee holds
};

/// Makes `budget` apply to the lightings of `terms`.
void promise(ErrorTerms& terms, Budget& budget);

/// Returns the uses of the `--lights`, with separate suns if the transfer has a separate direct term.
std::vector<LightingUses> given_lights(const MetricArguments& arguments, const TransferLayout& layout,
                                       int threads);

ErrorTerms error_terms(const MetricArguments& arguments, const std::vector<LightingUses>& given,
                       const TransferView& transfer, std::span<const float> areas, int threads);

} // namespace prt::pipeline
