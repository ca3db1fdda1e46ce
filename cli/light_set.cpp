#include "light_set.h"

#include "json_file.h"
#include "options.h"
#include "prt/light_set.h"
#include "prt/sun_arc.h"
#include "prt/support/error.h"
#include "prt/support/printable.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <chrono>
#include <cstdio>
#include <initializer_list>
#include <numbers>
#include <span>

namespace prt::cli {
namespace {

const std::map<std::string, SunShadows> kSunShadows = {{"sharp", SunShadows::sharp},
                                                       {"baked", SunShadows::baked}};

/// A name that is misspelt would otherwise be left out in silence.
void check_known(const Json& object, std::initializer_list<const char*> keys) {
    if (!object.is_object())
        throw Error("is no object");
    for (const auto& [key, value] : object.items())
        if (std::find(keys.begin(), keys.end(), key) == keys.end())
            throw Error(fmt::format("\"{}\" is no member of it", printable(key)));
}

double half_angle_of(const Json& object, double otherwise) {
    return object.contains("half_angle_radians")
               ? number_in(object, "half_angle_radians", 0, 0.5 * std::numbers::pi)
               : otherwise;
}

/// The day of the year of a date, 1..366.
int day_of_year(const Json& date) {
    int year = 0, used = 0;
    unsigned month = 0, day = 0;
    const std::string text = date.is_string() ? date.get<std::string>() : "";
    const bool read = text.find_first_not_of("0123456789-") == std::string::npos && text.size() == 10 &&
                      std::sscanf(text.c_str(), "%4d-%2u-%2u%n", &year, &month, &day, &used) == 3 &&
                      static_cast<std::size_t>(used) == text.size();
    const std::chrono::year first{year};
    const std::chrono::year_month_day when{first, std::chrono::month{month}, std::chrono::day{day}};
    if (!read || !when.ok())
        throw Error("\"date\" is no date YYYY-MM-DD");
    const auto since = std::chrono::sys_days{when} - std::chrono::sys_days{first / 1 / 1};
    return 1 + static_cast<int>(since.count());
}

std::vector<PunctualLight> keys_of_arc(const Json& json) {
    check_known(json, {"latitude_degrees", "date", "keys", "north", "half_angle_radians"});
    SunArc arc;
    arc.latitude = glm::radians(number_in(json, "latitude_degrees", -90, 90));
    arc.day = day_of_year(member(json, "date"));
    const double keys = number_in(json, "keys", 1, kMostLamps);
    arc.keys = static_cast<int>(keys);
    if (keys != arc.keys)
        throw Error("\"keys\" is no whole number");
    arc.half_angle = half_angle_of(json, arc.half_angle);
    if (json.contains("north")) {
        const glm::dvec3 north(direction_of(json, "north"));
        const glm::dvec3 level(north.x, 0, north.z);
        if (glm::length(level) < 1e-3)
            throw Error("\"north\" is up or down");
        arc.north = glm::normalize(level);
    }
    return keys_of(arc);
}

PunctualLight key_of(const Json& json) {
    check_known(json, {"name", "towards", "half_angle_radians"});
    PunctualLight key;
    key.kind = PunctualKind::directional;
    key.key = true;
    const Json& name = member(json, "name");
    key.name = name.is_string() ? name.get<std::string>() : "";
    if (key.name.empty())
        throw Error("\"name\" is no name");
    key.direction = -direction_of(json, "towards");
    key.half_angle = static_cast<float>(half_angle_of(json, 0));
    return key;
}

std::vector<PunctualLight> keys_of_list(const Json& list) {
    if (!list.is_array() || list.empty())
        throw Error("\"lights\" is no list of lights");
    if (list.size() > kMostLamps)
        throw Error(fmt::format("has {} lights, and a model holds at most {}", list.size(), kMostLamps));
    std::vector<PunctualLight> keys;
    for (std::size_t i = 0; i < list.size(); ++i)
        try {
            keys.push_back(key_of(list[i]));
        } catch (const Error& error) {
            throw Error(fmt::format("light {}: {}", i, error.what()));
        }
    return keys;
}

std::vector<PunctualLight> keys_of_file(const Json& json) {
    if (!json.is_object() || !json.contains("prtkit_light_set") || json["prtkit_light_set"] != 1)
        throw Error("is JSON, but no light set");
    check_known(json, {"prtkit_light_set", "arc", "lights"});
    if (json.contains("arc") == json.contains("lights"))
        throw Error("has \"arc\" and \"lights\", or neither: a light set is one of them");
    return json.contains("arc") ? keys_of_arc(json["arc"]) : keys_of_list(json["lights"]);
}

void shine_by_keys(const Path& model, const TransferLayout& layout, SplitLight& light,
                   std::span<glm::vec3> strengths) {
    if (!has_light_set(layout))
        throw Error(model.string() + ": has no light set for --sun-shadows baked; bake it with --light-set");
    constexpr double kFar = 3.0 / 180 * std::numbers::pi;
    for (const SunDisc& sun : light.split.suns)
        if (const double away = add_sun(layout, sun, strengths); away > kFar)
            print_notices(model.string(),
                          {fmt::format("a sun stands {:.1f} degrees from the keys of its light "
                                       "set, and shines from the nearest place of theirs",
                                       glm::degrees(away))});
    light.whole = light.sky.light;
    light.split.suns.clear();
}

} // namespace

std::vector<PunctualLight> read_light_set(const std::filesystem::path& path) {
    return about(path, [&] { return keys_of_file(read_json(path)); });
}

void add_sun_shadows(CLI::App* command, SunShadows& shadows) {
    choice(command, "--sun-shadows", shadows, kSunShadows,
           "of suns apart: sharp ones, found here; or those that were baked for the keys of the model's "
           "light set, between which suns are interpolated",
           "sharp");
}

std::vector<glm::vec3> strengths_under(const Path& model, const TransferLayout& layout,
                                       const LampChoice& lamps, SunShadows shadows, SplitLight& light) {
    std::vector<glm::vec3> strengths = lamp_strengths(lamps, layout);
    if (shadows == SunShadows::baked)
        shine_by_keys(model, layout, light, strengths);
    return strengths;
}

} // namespace prt::cli
