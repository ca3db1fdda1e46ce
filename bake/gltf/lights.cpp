// Reads KHR_lights_punctual from the JSON, because tinygltf does not distinguish a range of 0 from a missing
// one.
#include "bake/gltf/lights.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/transfer_json.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace prt {
namespace {

constexpr const char* kPunctual = "KHR_lights_punctual";

/// Returns the number `key`, or `otherwise` if it is missing; throws if it is out of bounds.
double number(const Json& light, const char* key, double otherwise, double least, double most) {
    if (!light.contains(key))
        return otherwise;
    const double value = light[key].is_number() ? light[key].get<double>() : NAN;
    if (!(value >= least && value <= most))
        throw Error(std::string(key) + " is " +
                    light[key].dump(-1, ' ', true, Json::error_handler_t::replace) +
                    ", which is not in the valid range");
    return value;
}

PunctualKind kind_of(const std::string& word) {
    if (word == "point")
        return PunctualKind::point;
    if (word == "spot")
        return PunctualKind::spot;
    if (word == "directional")
        return PunctualKind::directional;
    throw Error("its type is not point, spot or directional");
}

glm::vec3 color_of(const Json& light) {
    glm::vec3 color(1);
    if (!light.contains("color"))
        return color;
    for (int c = 0; c < 3; ++c) {
        color[c] = light["color"].at(static_cast<std::size_t>(c)).get<float>();
        if (!(color[c] >= 0 && color[c] <= kMaxIntensity))
            throw Error("its color is not in 0..1e9");
    }
    return color;
}

/// Numbers of lights that deviate from the extension.
struct LightDeviations {
    int endless_ranges = 0, hard_cones = 0;
};

/// Reads the range. Babylon's exporter for 3ds Max writes the largest float for "no attenuation"; three.js
/// interprets 0 the same way.
float read_range(const Json& light, LightDeviations& deviations) {
    constexpr float kNoLimit = std::numeric_limits<float>::infinity();
    if (!light.contains("range"))
        return kNoLimit;
    constexpr double kMaxRange = 1e30; // metres; its inverse is a normal float
    const double range = number(light, "range", 0, 0, std::numeric_limits<double>::max());
    if (range >= 1e-30 && range <= kMaxRange)
        return static_cast<float>(range);
    ++deviations.endless_ranges;
    return kNoLimit;
}

/// Reads the cone angles. Blender writes equal angles for a blend of 0.
void read_cone(const Json& light, PunctualLight& to, LightDeviations& deviations) {
    const Json spot = light.value("spot", Json::object());
    const double limit = std::numbers::pi / 2 + 1e-6;
    const double inner = number(spot, "innerConeAngle", 0, 0, limit),
                 outer = number(spot, "outerConeAngle", std::numbers::pi / 4, 0, limit);
    deviations.hard_cones += inner < outer ? 0 : 1;
    to.inner_cone = static_cast<float>(std::min(inner, outer));
    to.outer_cone = static_cast<float>(outer);
}

PunctualLight read_light(const Json& light, LightDeviations& deviations) {
    PunctualLight result;
    result.name = light.value("name", "");
    result.kind = kind_of(light.at("type").get<std::string>());
    result.intensity = color_of(light) * static_cast<float>(number(light, "intensity", 1, 0, kMaxIntensity));
    result.range = read_range(light, deviations);
    if (result.kind == PunctualKind::spot)
        read_cone(light, result, deviations);
    return result;
}

/// Returns the light of a node; null if it has none.
const Json* light_of(const GltfContents& contents, const Json& node, std::size_t& index) {
    const Json* use = extension_of(node, kPunctual);
    if (!use)
        return nullptr;
    index =
        static_cast<std::size_t>(whole_number(use->at("light"), "light", 0, std::numeric_limits<int>::max()));
    const Json* list = extension_of(contents.json, kPunctual);
    if (!list || !list->contains("lights") || index >= list->at("lights").size())
        throw Error("light " + std::to_string(index) + " does not exist");
    return &list->at("lights").at(index);
}

void add_notices(const LightDeviations& deviations, std::vector<std::string>& notices) {
    if (deviations.endless_ranges > 0)
        notices.push_back(counted(deviations.endless_ranges, "light has", "lights have") +
                          " a range of 0 or more than 1e30 m; the range is ignored");
    if (deviations.hard_cones > 0)
        notices.push_back(counted(deviations.hard_cones, "spot light has", "spot lights have") +
                          " an inner cone that is not inside the outer cone; its edge becomes hard");
}

} // namespace

bool complete_spots(Json& json) {
    if (!extension_of(json, kPunctual))
        return false;
    Json& extension = json["extensions"][kPunctual];
    if (!extension.is_object() || !extension.contains("lights") || !extension["lights"].is_array())
        return false;
    bool changed = false;
    for (Json& light : extension["lights"])
        if (light.is_object() && light.contains("type") && light["type"] == "spot" &&
            !light.contains("spot")) {
            light["spot"] = Json::object();
            changed = true;
        }
    return changed;
}

void scale_lights(Json& json, double factor) {
    if (factor == 1 || !extension_of(json, kPunctual))
        return;
    Json& extension = json["extensions"][kPunctual];
    if (!extension.contains("lights") || !extension["lights"].is_array())
        return;
    for (Json& light : extension["lights"])
        if (light.is_object() && (!light.contains("intensity") || light["intensity"].is_number()))
            light["intensity"] = factor * light.value("intensity", 1.0);
}

std::vector<PunctualLight> read_lights(const GltfContents& contents, const std::vector<NodeTransform>& nodes,
                                       const glm::dvec3& origin, std::vector<std::string>& notices) {
    std::vector<PunctualLight> lights;
    LightDeviations deviations;
    if (!contents.json.contains("nodes"))
        return lights;
    for (const NodeTransform& transform : nodes) {
        const Json& node = contents.json["nodes"].at(static_cast<std::size_t>(transform.node));
        std::size_t index = 0;
        const Json* json = light_of(contents, node, index);
        if (!json || !transform.visible)
            continue;
        const std::string numbered = "light " + std::to_string(index);
        try {
            PunctualLight light = read_light(*json, deviations);
            light.name = node.value("name", "").empty() ? light.name : node.value("name", "");
            if (light.name.empty())
                light.name = numbered;
            const glm::dvec3 along = -glm::dvec3(transform.world[2]),
                             world_position = glm::dvec3(transform.world[3]);
            const double length = glm::length(along);
            const bool aimed = light.kind != PunctualKind::point;
            if (aimed && !(length > 0 && std::isfinite(length)))
                throw Error("the transform of its node gives no direction");
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(world_position[axis]) <= kFarthestVertex))
                    throw Error("its position is more than 1e9 m from the origin of the scene");
            if (aimed)
                light.direction = glm::vec3(along / length);
            light.position = glm::vec3(world_position - origin);
            lights.push_back(std::move(light));
        } catch (const Error& error) {
            throw Error(numbered + ": " + error.what());
        }
    }
    add_notices(deviations, notices);
    return lights;
}

} // namespace prt
