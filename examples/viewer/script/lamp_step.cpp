// Sets lamp strengths from the JSON of a script.

#include "script/lamp_step.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace viewer {
namespace {

float strength_of(const nlohmann::json& value, const std::string& name) {
    const float strength = value.is_number() ? value.get<float>() : -1;
    if (!(strength >= 0 && strength <= kMaxLampStrength))
        throw prt::Error(fmt::format("the strength of '{}' is not a number or three numbers in 0..1e9",
                                     prt::printable(name)));
    return strength;
}

/// Switches `lamp` on with this strength. The slider shows the largest channel.
void set_strength(LampControl& lamp, const glm::vec3& strength) {
    lamp.on = true;
    lamp.strength = std::max({strength.r, strength.g, strength.b});
    lamp.color = lamp.strength > 0 ? strength / lamp.strength : glm::vec3(1);
}

glm::vec3 color_of(const nlohmann::json& value, const std::string& name) {
    if (!value.is_array() || value.size() != 3)
        return glm::vec3(strength_of(value, name));
    return {strength_of(value[0], name), strength_of(value[1], name), strength_of(value[2], name)};
}

std::string names_of(const std::vector<LampControl>& lamps) {
    std::string names;
    for (const LampControl& lamp : lamps)
        names += (names.empty() ? "" : ", ") + prt::printable(lamp.name);
    return names.empty() ? "none" : names;
}

} // namespace

void set_strengths(std::vector<LampControl>& lamps, const nlohmann::json& json) {
    if (!json.is_object())
        throw prt::Error("lamps must be an object of names and strengths");
    std::vector<LampControl> changed = lamps;
    if (json.contains("*"))
        for (LampControl& lamp : changed)
            set_strength(lamp, color_of(json["*"], "*"));
    for (const auto& [name, value] : json.items()) {
        if (name == "*")
            continue;
        const auto lamp = std::ranges::find(changed, name, &LampControl::name);
        if (lamp == changed.end())
            throw prt::Error(fmt::format("the model has no lamp '{}'; its lamps: {}", prt::printable(name),
                                         names_of(changed)));
        set_strength(*lamp, color_of(value, name));
    }
    lamps = std::move(changed);
}

} // namespace viewer
