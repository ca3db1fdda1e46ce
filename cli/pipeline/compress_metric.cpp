// Chooses the metric of compression: that of a light family, or of given lights.

#include "cli/pipeline/compress_metric.h"

#include "cli/pipeline/loaded_light.h"
#include "runtime/core/support/counted.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

namespace prt::pipeline {
namespace {

/// Returns no family for plain.
std::optional<LightFamily> family_of(MetricChoice choice) {
    switch (choice) {
    case MetricChoice::outdoor:
        return LightFamily::outdoor;
    case MetricChoice::indoor:
        return LightFamily::indoor;
    case MetricChoice::day:
        return LightFamily::day;
    case MetricChoice::natural:
        return LightFamily::natural;
    case MetricChoice::plain:
        break;
    }
    return std::nullopt;
}

/// Returns all lightings of all uses.
std::vector<Lighting> as_used(const std::vector<LightingUses>& lights) {
    std::vector<Lighting> all;
    for (const LightingUses& uses : lights)
        for (const LightingUse& use : uses)
            all.push_back(use.lighting);
    return all;
}

/// Returns no lighting if the transfer has no distant light.
std::vector<Lighting> skies_to_promise(const std::vector<Lighting>& given, std::optional<LightFamily> family,
                                       const TransferLayout& layout) {
    if (layout.distant_terms().empty())
        return {};
    std::vector<Lighting> skies =
        given.empty() && family ? as_used(uses_of(members_of_family(*family, layout.order), layout)) : given;
    for (Lighting& sky : skies)
        sky.lamps.assign(layout.lamps(), glm::vec3(0));
    return skies;
}

std::string coverage(const MetricArguments& arguments, const TransferLayout& layout, std::size_t promised) {
    if (layout.distant_terms().empty())
        return "the limits hold on average over the lamps, with one lamp lit at a time; the error of a "
               "single lamp "
               "may be larger";
    if (!arguments.lights.empty())
        return fmt::format(
            "the limits hold under {} (--lights) at every rotation about +Y, with suns in the sky or "
            "separate; the errors under other skies may be larger",
            counted(arguments.lights.size(), "given light"));
    if (promised == 0)
        return fmt::format(
            "the limits hold on average over the metric '{}'; the errors under a single sky may be larger: "
            "pass that sky with --lights FILE",
            to_string(arguments.metric));
    return fmt::format(
        "the error limit holds under {} of the family '{}' at every rotation about +Y, the limit of jumps "
        "on average over the family; the errors under other skies may be larger: pass them with --lights "
        "FILE",
        counted(promised, "sky", "skies"), to_string(arguments.metric));
}

} // namespace

const char* to_string(MetricChoice choice) {
    switch (choice) {
    case MetricChoice::outdoor:
        return "outdoor";
    case MetricChoice::indoor:
        return "indoor";
    case MetricChoice::day:
        return "day";
    case MetricChoice::natural:
        return "natural";
    case MetricChoice::plain:
        break;
    }
    return "plain";
}

void promise(ErrorTerms& terms, Budget& budget) {
    if (budget.max_error)
        budget.skies = std::move(terms.promised);
    if (budget.max_jump)
        budget.skies_of_jumps = std::move(terms.given);
}

std::vector<LightingUses> given_lights(const MetricArguments& arguments, const TransferLayout& layout,
                                       int threads) {
    const SunCount suns = layout.distant_terms().size() < 2 ? SunCount{0} : SunCount{std::nullopt};
    std::vector<LightingUses> lights;
    for (const Path& path : arguments.lights) {
        LoadedLight light = load_light(path, layout.order, suns, arguments.light_options, threads);
        Lighting lighting = lighting_of(light);
        lighting.name = path.filename().string();
        lights.push_back(uses_of(lighting, std::move(light.combined), layout));
    }
    return lights;
}

ErrorTerms error_terms(const MetricArguments& arguments, const std::vector<LightingUses>& given,
                       const TransferView& transfer, std::span<const float> areas, int threads) {
    const TransferLayout& layout = transfer.layout();
    const std::vector<Lighting> lightings = as_used(given);
    const auto family = family_of(arguments.metric);
    ErrorTerms terms{{}, skies_to_promise(lightings, family, layout), {}, {}};
    terms.covers = coverage(arguments, layout, terms.promised.size());
    if (!lightings.empty())
        terms.given = terms.promised;
    if (lightings.empty() && !family)
        terms.metric = plain_metric(layout);
    else
        terms.metric = balanced(lightings.empty() ? metric_of_family(*family, layout)
                                                  : metric_of_lights(lightings, layout),
                                transfer, areas, threads);
    return terms;
}

} // namespace prt::pipeline
