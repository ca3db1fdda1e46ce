#include "lamp_strengths.h"

#include "inputs.h"
#include "json_file.h"
#include "prt/support/error.h"
#include "prt/support/printable.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace prt::cli {
namespace {

constexpr double kMostStrength = 1e9;

float strength_of(const Json& value, const std::string& name) {
    const double strength = value.is_number() ? value.get<double>() : -1;
    if (!(strength >= 0 && strength <= kMostStrength))
        throw Error(fmt::format("the strength of '{}' is neither a number in 0..1e9 nor three of them",
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
    for (const TransferPart& lamp : layout.lamp_parts())
        names.push_back(lamp.name);
    return names;
}

std::vector<glm::vec3> strengths_of(const Json& file, const TransferLayout& layout) {
    if (!file.is_object())
        throw Error("is JSON, but no object of lamps and their strengths");
    const glm::vec3 others = file.contains("*") ? color_of(file["*"], "*") : glm::vec3(1);
    std::vector<glm::vec3> strengths(layout.lamps(), others);
    const std::vector<std::string> names = names_of(layout);
    for (const auto& [name, value] : file.items()) {
        if (name == "*")
            continue;
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            throw Error(fmt::format("no lamp of the model is called '{}'; there are: {}", printable(name),
                                    printable(fmt::format("{}", fmt::join(names, ", ")))));
        strengths[static_cast<std::size_t>(found - names.begin())] = color_of(value, name);
    }
    return strengths;
}

} // namespace

void add_lamps(CLI::App* command, LampChoice& lamps) {
    command
        ->add_option_function<std::string>(
            "--lamps",
            [&lamps](const std::string& given) {
                lamps.on = given != "off";
                lamps.file = given == "on" || given == "off" ? "" : given;
            },
            "lamps of the model: on, as in the scene; off; or a .json with a strength, or red, green and "
            "blue, for each name, \"*\" for the others")
        ->type_name("on|off|FILE")
        ->default_str("on");
}

std::vector<glm::vec3> lamp_strengths(const LampChoice& lamps, const TransferLayout& layout) {
    if (!lamps.file.empty())
        return about(lamps.file, [&] { return strengths_of(read_json(lamps.file), layout); });
    return std::vector<glm::vec3>(layout.lamps(), glm::vec3(lamps.on ? 1 : 0));
}

} // namespace prt::cli
