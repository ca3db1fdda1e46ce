// Reads and writes light files of prt project (docs/format.md).

#include "prt/load/light_file.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/light/check_light.h"
#include "runtime/load/json_file.h"

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

namespace prt {
namespace {

constexpr const char* kChannels[3] = {"red", "green", "blue"};

Sun sun_of(const Json& entry) {
    Sun sun;
    sun.towards = json::direction_of(entry, "towards");
    sun.irradiance = json::vector_of(entry, "irradiance");
    sun.half_angle = json::number_in(entry, "half_angle_radians", 0, 0.5 * std::numbers::pi);
    for (int c = 0; c < 3; ++c)
        if (sun.irradiance[c] < 0)
            throw Error("\"irradiance\" is negative");
    return sun;
}

std::vector<Sun> suns_of(const Json& list) {
    if (!list.is_array())
        throw Error("\"suns\" is not a list");
    std::vector<Sun> suns;
    for (std::size_t i = 0; i < list.size(); ++i)
        try {
            suns.push_back(sun_of(list[i]));
            check_light(as_light(suns.back(), 1));
        } catch (const Error& error) {
            throw Error("sun " + std::to_string(i) + " of \"suns\": " + error.what());
        }
    return suns;
}

int order_of(const Json& file) {
    const double order = json::number(file, "order");
    if (order >= 1 && order <= kMaxOrder && order == std::floor(order))
        return static_cast<int>(order);
    std::ostringstream text;
    text << "\"order\" is " << order << ", but must be an integer in 1.." << kMaxOrder;
    throw Error(text.str());
}

Light coefficients_of(const Json& file) {
    Light light{order_of(file), {}};
    light.coefficients.resize(static_cast<std::size_t>(coefficient_count(light.order)));
    const Json& coefficients = json::member(file, "coefficients");
    for (int c = 0; c < 3; ++c) {
        const std::vector<float> values =
            json::numbers(coefficients, kChannels[c], light.coefficients.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            light.coefficients[i][c] = values[i];
    }
    return light;
}

} // namespace

Light all_light(const LightFile& file) {
    Light all = file.sky;
    for (const Sun& sun : file.suns)
        all = sum(all, as_light(sun, all.order));
    return all;
}

LightFile read_light_file(const std::filesystem::path& path) {
    try {
        const Json file = json::read_json(path);
        if (!file.is_object() || !file.contains("prtkit_light") || file["prtkit_light"] != 1)
            throw Error("is JSON, but not a light file; create one with prt project");
        LightFile light{coefficients_of(file), {}};
        if (file.contains("lights"))
            throw Error(
                "is from an older version of prt, which wrote suns as \"lights\"; run prt project again");
        if (file.contains("suns"))
            light.suns = suns_of(file["suns"]);
        check_light(all_light(light));
        return light;
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
}

LightFile read_light_file(const std::filesystem::path& path, int order) {
    LightFile file = read_light_file(path);
    if (file.sky.order < order)
        throw Error(path.string() + ": has order " + std::to_string(file.sky.order) + ", but order " +
                    std::to_string(order) + " is needed");
    file.sky = truncated(file.sky, order);
    return file;
}

} // namespace prt
