// Reads lamp strengths, and detects lamps that are far brighter than the sky.

#include "cli/pipeline/lamp_strengths.h"

#include "cli/pipeline/model.h"
#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "prt/core/sh_basis.h"
#include "runtime/core/support/printable.h"
#include "runtime/load/json_file.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace prt::pipeline {
namespace {

constexpr double kMaxStrength = 1e9;

float strength_of(const Json& value, const std::string& name) {
    const double strength = value.is_number() ? value.get<double>() : -1;
    if (!(strength >= 0 && strength <= kMaxStrength))
        throw Error(fmt::format("the strength of '{}' must be a number in 0..1e9, or a list of three",
                                printable(name)));
    return static_cast<float>(strength);
}

glm::vec3 color_of(const Json& value, const std::string& name) {
    if (!value.is_array() || value.size() != 3)
        return glm::vec3(strength_of(value, name));
    return {strength_of(value[0], name), strength_of(value[1], name), strength_of(value[2], name)};
}

std::vector<std::string> names_of(const TransferLayout& layout) {
    std::vector<std::string> names;
    for (const TransferTerm& lamp : layout.lamp_terms())
        names.push_back(lamp.name);
    return names;
}

/// Whether each lamp of `layout` has a light of `scene` in it: [layout.lamps()].
std::vector<bool> punctual_lamps(const Scene& scene, const TransferLayout& layout) {
    std::vector<bool> punctual;
    for (const TransferTerm& lamp : layout.lamp_terms())
        punctual.push_back(std::ranges::any_of(
            scene.lights, [&](const PunctualLight& light) { return lamp.has_member(light.name); }));
    return punctual;
}

double mean_luminance(const Relit& model, const Lighting& lighting) {
    const std::vector<glm::vec3> radiance = model.radiance(lighting);
    double sum = 0, area = 0;
    for (std::size_t p = 0; p < radiance.size(); ++p) {
        sum += static_cast<double>(model.areas[p]) * std::max(0.0, luminance(glm::dvec3(radiance[p])));
        area += static_cast<double>(model.areas[p]);
    }
    return area > 0 ? sum / area : 0;
}

} // namespace

void scale_lights(const Scene& scene, const TransferLayout& layout, double scale,
                  std::span<glm::vec3> strengths) {
    const std::vector<bool> punctual = punctual_lamps(scene, layout);
    for (std::size_t k = 0; k < strengths.size(); ++k)
        if (punctual[k])
            strengths[k] *= static_cast<float>(scale);
}

Relit relit_by(const Transfer& transfer, std::span<const float> areas, int threads) {
    return {
        transfer.layout,
        [&transfer, threads](const Lighting& lighting) { return exit_radiance(transfer, lighting, threads); },
        areas};
}

std::optional<std::string> photometric_notice(const Scene& scene, const Relit& model,
                                              const Lighting& lighting) {
    constexpr double kLumensPerWatt = 683, kOutshines = 10; // lights in watts are rarely as bright
    const std::vector<bool> punctual = punctual_lamps(scene, model.layout);
    if (std::ranges::count(punctual, true) == 0)
        return std::nullopt;
    // Compares with the unoccluded sky, because in closed rooms any lamp is many times brighter than the sky.
    glm::dvec3 sky = glm::dvec3(lighting.sky.coefficients[0]);
    if (lighting.suns)
        sky += glm::dvec3(lighting.suns->coefficients[0]);
    Lighting lights = lighting;
    lights.sky = constant_light(lighting.sky.order, glm::vec3(0));
    lights.suns.reset();
    for (std::size_t k = 0; k < punctual.size(); ++k)
        if (!punctual[k])
            lights.lamps[k] = glm::vec3(0);
    const double of_sky = kY00 * luminance(sky), of_lights = mean_luminance(model, lights);
    if (!(of_sky > 0) || of_lights < kOutshines * of_sky)
        return std::nullopt;
    const double ratio = of_lights / of_sky;
    return fmt::format(
        "the lights of the scene are {:.3g} times as bright as the open sky; they probably have photometric "
        "units (candela and lux, 683 lm/W, as Blender exports them): --lamp-scale {:.3g} reduces this to "
        "{:.2g} times",
        ratio, 1 / kLumensPerWatt, ratio / kLumensPerWatt);
}

std::vector<glm::vec3> lamp_strengths_of(const Json& file, const TransferLayout& layout) {
    if (!file.is_object())
        throw Error("must contain a JSON object with a strength for each lamp");
    const glm::vec3 others = file.contains("*") ? color_of(file["*"], "*") : glm::vec3(1);
    std::vector<glm::vec3> strengths(layout.lamps(), others);
    const std::vector<std::string> names = names_of(layout);
    for (const auto& [name, value] : file.items()) {
        if (name == "*")
            continue;
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            throw Error(fmt::format("the model has no lamp '{}'; its lamps are: {}", printable(name),
                                    printable(fmt::format("{}", fmt::join(names, ", ")))));
        strengths[static_cast<std::size_t>(found - names.begin())] = color_of(value, name);
    }
    return strengths;
}

std::vector<glm::vec3> lamp_strengths(const LampChoice& lamps, const TransferLayout& layout) {
    if (!lamps.file.empty())
        return about(lamps.file, [&] { return lamp_strengths_of(json::read_json(lamps.file), layout); });
    return std::vector<glm::vec3>(layout.lamps(), glm::vec3(lamps.on ? 1 : 0));
}

} // namespace prt::pipeline
