// Lists lamps and computes their strengths.

#include "pictures/lamps.h"

#include <algorithm>
#include <utility>

namespace viewer {
namespace {

glm::vec3 strength_of(const LampSettings& settings, const LampControl& lamp) {
    return settings.on && lamp.on ? settings.strength * lamp.strength * lamp.color : glm::vec3(0);
}

} // namespace

std::vector<LampControl> lamps_of(std::span<const prt::TransferLayout* const> layouts,
                                  const std::vector<LampControl>& known) {
    std::vector<LampControl> lamps;
    for (const prt::TransferLayout* layout : layouts)
        for (const prt::TransferTerm& part : layout->lamp_terms()) {
            if (std::ranges::count(lamps, part.name, &LampControl::name) > 0)
                continue;
            const auto before = std::ranges::find(known, part.name, &LampControl::name);
            lamps.push_back(before == known.end() ? LampControl{.name = part.name} : *before);
        }
    return lamps;
}

std::vector<glm::vec3> strengths_of(const LampSettings& settings, const prt::TransferLayout& layout) {
    std::vector<glm::vec3> strengths;
    for (const prt::TransferTerm& part : layout.lamp_terms()) {
        const auto known = std::ranges::find(settings.each, part.name, &LampControl::name);
        strengths.push_back(strength_of(settings, known == settings.each.end() ? LampControl{} : *known));
    }
    return strengths;
}

bool any_shines(const LampSettings& settings) {
    return std::ranges::any_of(
        settings.each, [&](const LampControl& lamp) { return strength_of(settings, lamp) != glm::vec3(0); });
}

prt::Lighting with_lamps(prt::Lighting lighting, const LampSettings& settings,
                         const prt::TransferLayout& layout) {
    lighting.lamps = strengths_of(settings, layout);
    return lighting;
}

} // namespace viewer
