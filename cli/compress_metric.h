#pragma once

#include "options.h"
#include "prt/light_metric.h"
#include "prt/search.h"
#include "sky_errors.h"

namespace prt::cli {

enum class MetricChoice { outdoor, indoor, day, natural, plain };

/// What `prt compress` is told of the lighting to come.
struct MetricArguments {
    MetricChoice metric = MetricChoice::outdoor;
    std::vector<Path> lights; ///< to compress for, instead of `metric`
    LightOptions light_options;
};

/// What an error costs, and the lightings under which one that is asked for is promised.
struct ErrorTerms {
    LightMetric metric;
    std::vector<Lighting> promised; ///< lamps are dark in them
    std::vector<Lighting> given;    ///< those of `promised` that are `--lights`
    std::string covers;             ///< a sentence: the lightings under which promises hold
};

/// Has `budget` hold under the lightings of `terms`.
void promise(ErrorTerms& terms, Budget& budget);

void add_metric(CLI::App* command, MetricArguments& arguments);

/// The `--lights`, their suns apart where transfer knows the difference.
std::vector<NamedLighting> given_lights(const MetricArguments& arguments, const TransferLayout& layout,
                                        int threads);

ErrorTerms error_terms(const MetricArguments& arguments, const std::vector<NamedLighting>& given,
                       const TransferView& transfer, std::span<const float> areas, int threads);

} // namespace prt::cli
