// Reads and writes light files.

#include "light_file.h"

#include "json_file.h"
#include "prt/check_light.h"
#include "prt/sh.h"
#include "prt/support/error.h"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

namespace prt::cli {
namespace {

constexpr const char* kChannels[3] = {"red", "green", "blue"};

SunDisc sun_of(const Json& entry) {
    SunDisc sun;
    sun.towards = direction_of(entry, "towards");
    sun.irradiance = vector_of(entry, "irradiance");
    sun.half_angle = number_in(entry, "half_angle_radians", 0, 0.5 * std::numbers::pi);
    for (int c = 0; c < 3; ++c)
        if (sun.irradiance[c] < 0)
            throw Error("\"irradiance\" is negative");
    return sun;
}

std::vector<SunDisc> suns_of(const Json& list) {
    if (!list.is_array())
        throw Error("\"suns\" is no list");
    std::vector<SunDisc> suns;
    for (std::size_t i = 0; i < list.size(); ++i)
        try {
            suns.push_back(sun_of(list[i]));
            check_light(as_light(suns.back(), 1));
        } catch (const Error& error) {
            throw Error(fmt::format("sun {} of \"suns\": {}", i, error.what()));
        }
    return suns;
}

int order_of(const Json& json) {
    const double order = number(json, "order");
    if (!(order >= 1 && order <= kMaxOrder && order == std::floor(order)))
        throw Error(fmt::format("\"order\" is {}, no whole number in 1..{}", order, kMaxOrder));
    return static_cast<int>(order);
}

Light coefficients_of(const Json& json) {
    Light light{order_of(json), {}};
    light.coefficients.resize(static_cast<std::size_t>(coefficient_count(light.order)));
    const Json& coefficients = member(json, "coefficients");
    for (int c = 0; c < 3; ++c) {
        const std::vector<float> values = numbers(coefficients, kChannels[c], light.coefficients.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            light.coefficients[i][c] = values[i];
    }
    return light;
}

} // namespace

Json light_json(const Light& light) {
    Json channels = Json::object();
    for (int c = 0; c < 3; ++c)
        for (const glm::vec3& coefficient : light.coefficients)
            channels[kChannels[c]].push_back(coefficient[c]);
    return {{"prtkit_light", 1}, {"order", light.order}, {"coefficients", channels}};
}

Light all_light(const LightFile& file) {
    Light all = file.sky;
    for (const SunDisc& sun : file.suns)
        all = sum(all, as_light(sun, all.order));
    return all;
}

LightFile read_light_file(const std::filesystem::path& path) {
    try {
        const Json json = read_json(path);
        if (!json.is_object() || !json.contains("prtkit_light") || json["prtkit_light"] != 1)
            throw Error("is JSON, but no light of prt project");
        LightFile light{coefficients_of(json), {}};
        if (json.contains("lights"))
            throw Error(
                "has its suns as \"lights\", as an older version of prt wrote them; project the image again");
        if (json.contains("suns"))
            light.suns = suns_of(json["suns"]);
        check_light(all_light(light));
        return light;
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
}

LightFile read_light_file(const std::filesystem::path& path, int order) {
    LightFile file = read_light_file(path);
    if (file.sky.order < order)
        throw Error(
            fmt::format("{}: has order {}, but order {} is needed", path.string(), file.sky.order, order));
    file.sky = truncated(file.sky, order);
    return file;
}

} // namespace prt::cli
