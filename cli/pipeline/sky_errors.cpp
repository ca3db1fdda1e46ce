// Evaluates errors over all rotations of skies.

#include "cli/pipeline/sky_errors.h"

#include <fmt/core.h>
#include <glm/trigonometric.hpp>

namespace prt::pipeline {

std::vector<LightingUse> uses_of(const Lighting& lighting, const TransferLayout& layout) {
    if (!lighting.suns)
        return {{lighting}};
    std::vector<LightingUse> uses = {
        {{sum(lighting.sky, *lighting.suns), {}, lighting.lamps, lighting.name}}};
    if (layout.distant_terms().size() > 1)
        uses.push_back({lighting, true});
    return uses;
}

void add_sky_errors(const ErrorMoments& moments, const std::vector<Lighting>& skies, Report& report) {
    if (moments.layout.distant_terms().empty())
        return;
    Table table{"skies",
                "Errors under skies at all rotations about +Y",
                "",
                {{"name", "sky"},
                 {"separate_suns", "separate suns"},
                 {"lit_rms_mean", "mean of all rotations", Unit::percent},
                 {"lit_rms_worst", "worst rotation", Unit::percent},
                 {"worst_rotation_degrees", "angle of the worst, degrees"}},
                {}};
    const std::vector<glm::vec3> dark(moments.layout.lamps(), glm::vec3(0));
    for (const Lighting& sky : skies) {
        std::string sentence = fmt::format("under {{skies/{}/name}}: ", table.rows.size());
        for (LightingUse& use : uses_of(sky, moments.layout)) {
            use.lighting.lamps = dark;
            const LitRmsOverRotations error = lit_rms_over_rotations(moments, use.lighting);
            sentence += fmt::format("{1}mean error {{skies/{0}/lit_rms_mean:.3f%}}, at the worst rotation "
                                    "{{skies/{0}/lit_rms_worst:.3f%}}",
                                    table.rows.size(), use.separate_suns ? "; with a separate sun: " : "");
            table.rows.push_back(
                {sky.name, use.separate_suns, error.mean, error.worst, glm::degrees(error.worst_angle)});
        }
        report.sentences.push_back(sentence);
    }
    report.tables.push_back(std::move(table));
}

} // namespace prt::pipeline
