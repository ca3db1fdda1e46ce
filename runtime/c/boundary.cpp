// Argument checks and conversions of the C interface.
#include "runtime/c/boundary.h"

#include "prt/core/sh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace prt::c {

static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

void say(prt_message* message, const char* text) noexcept {
    if (!message)
        return;
    const std::size_t length = std::min(std::strlen(text), sizeof message->text - 1);
    std::memcpy(message->text, text, length);
    message->text[length] = 0;
}

std::size_t count_of(int order) {
    check_order(order);
    return static_cast<std::size_t>(coefficient_count(order));
}

/// The loop has no early exit, so that it can be vectorised.
bool within(float most, const float* values, std::size_t count) {
    bool inside = true;
    for (std::size_t i = 0; i < count; ++i)
        inside &= std::abs(values[i]) <= most; // false for NaN
    return inside;
}

bool finite(const float* values, std::size_t count) {
    return within(std::numeric_limits<float>::max(), values, count);
}

LightingView lighting_of(const LightArguments& light, std::size_t lamps) {
    const std::size_t count = count_of(light.order), strengths = light.lamps ? lamps : 0;
    if (!within(kBrightest, light.sky, 3 * count) ||
        (light.suns && !within(kBrightest, light.suns, 3 * count)) ||
        (light.lamps && !within(kBrightest, light.lamps, 3 * strengths)))
        throw Error("the coefficients of a light must be finite and at most 1e20");
    return {light_colors(light.sky, count), light_colors(light.suns, light.suns ? count : 0),
            light_colors(light.lamps, strengths)};
}

void write_text(const std::string& text, char* source, std::size_t* size) {
    const std::size_t room = source ? *size : 0;
    *size = text.size() + 1;
    if (room < *size)
        throw TooSmall("the shader needs " + std::to_string(*size) + " bytes");
    std::memcpy(source, text.c_str(), *size);
}

ShaderLanguage language_of(int language) {
    static_assert(static_cast<int>(ShaderLanguage::vulkan) == PRT_VULKAN);
    if (language < PRT_GLSL450 || language > PRT_VULKAN)
        throw Error("the shader language is unknown");
    return static_cast<ShaderLanguage>(language);
}

} // namespace prt::c
