// Evaluates errors over all rotations of skies.

#include "cli/pipeline/sky_errors.h"

#include <fmt/core.h>
#include <glm/trigonometric.hpp>

#include <utility>

namespace prt::pipeline {

LightingUses uses_of(const Lighting& lighting, Light together, const TransferLayout& layout) {
    LightingUses uses = {{{std::move(together), {}, lighting.lamps, lighting.name}}};
    if (lighting.suns && layout.distant_terms().size() > 1)
        uses.push_back({lighting, true});
    return uses;
}

std::vector<LightingUses> uses_of(const std::vector<Lighting>& lightings, const TransferLayout& layout) {
    std::vector<LightingUses> all;
    for (const Lighting& l : lightings)
        all.push_back(uses_of(l, l.suns ? sum(l.sky, *l.suns) : l.sky, layout));
    return all;
}

void add_sky_errors(const ErrorMoments& moments, const std::vector<LightingUses>& skies, Report& report) {
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
    for (const LightingUses& sky : skies) {
        std::string sentence = fmt::format("under {{skies/{}/name}}: ", table.rows.size());
        for (LightingUse use : sky) {
            use.lighting.lamps = dark;
            const LitRmsOverRotations error = lit_rms_over_rotations(moments, use.lighting);
            sentence += fmt::format("{1}mean error {{skies/{0}/lit_rms_mean:.3f%}}, at the worst rotation "
                                    "{{skies/{0}/lit_rms_worst:.3f%}}",
                                    table.rows.size(), use.separate_suns ? "; with a separate sun: " : "");
            table.rows.push_back({use.lighting.name, use.separate_suns, error.mean, error.worst,
                                  glm::degrees(error.worst_angle)});
        }
        report.sentences.push_back(sentence);
    }
    report.tables.push_back(std::move(table));
}

} // namespace prt::pipeline
