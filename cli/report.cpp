#include "report.h"

#include "prt/error.h"
#include "prt/file.h"
#include "prt/sh.h"
#include "prt/sun_fit.h"

#include <glm/geometric.hpp>

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <array>
#include <chrono>
#include <cmath>
#include <string>

namespace prt::cli {

void write_json(const Json& json, const std::filesystem::path& path, Interrupt& interrupt) {
    write_text(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", path, interrupt);
}

void write_text(const std::string& text, const std::filesystem::path& path, Interrupt& interrupt) {
    if (path.empty())
        return;
    const Interrupt::WritingScope writing(interrupt);
    OutputFile file(path);
    file.write(text);
    file.commit();
}

void publish(const Report& report, const ReportFiles& files, Interrupt& interrupt) {
    fmt::print("{}", report_text(report));
    Json json = report_json(report);
    json["version"] = PRTKIT_VERSION;
    write_json(json, files.json, interrupt);
    write_text(report_csv(report), files.csv, interrupt);
    if (files.html.empty())
        return;
    Report dated = report; // files of figures stay the same from run to run
    const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    dated.origin.emplace_back("date", fmt::format("{:%Y-%m-%d %H:%M} UTC", now));
    dated.origin.emplace_back("version", "prt " PRTKIT_VERSION);
    write_text(report_html(dated), files.html, interrupt);
}

Json bake_record_json(const BakeRecord& record) {
    return {{"method", record.method},
            {"backend", record.backend},
            {"rays_per_receiver", record.rays},
            {"bounces", record.bounces},
            {"seed", record.seed},
            {"receivers_id", record.receivers},
            {"sampling_error_relative_l2", record.sampling_error}};
}

Json light_json(const Light& light) {
    Json channels = Json::object();
    const char* names[3] = {"red", "green", "blue"};
    for (int c = 0; c < 3; ++c)
        for (const glm::vec3& coefficient : light.coefficients)
            channels[names[c]].push_back(coefficient[c]);
    return {{"prtkit_light", 1}, {"order", light.order}, {"coefficients", channels}};
}

namespace {

/// The lights that were fitted and stand apart from the coefficients.
Light lights_of(const Json& list, int order) {
    Light all = constant_light(order, glm::vec3(0));
    for (const Json& entry : list) {
        const auto towards = entry.at("towards").get<std::array<float, 3>>(),
                   irradiance = entry.at("irradiance").get<std::array<float, 3>>();
        FittedLight light;
        light.towards = {towards[0], towards[1], towards[2]};
        light.irradiance = {irradiance[0], irradiance[1], irradiance[2]};
        light.half_angle = entry.at("half_angle_radians").get<double>();
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(light.irradiance[c]))
                throw Error("the irradiance of a light is not finite");
        if (!(light.half_angle >= 0 && light.half_angle <= 0.5 * detail::kPi))
            throw Error("the half angle of a light lies in 0..pi/2 radians");
        light.towards /= glm::length(light.towards); // as_light refuses what has no direction
        all = sum(all, as_light(light, order));
    }
    return all;
}

Light coefficients_of(const Json& json) {
    Light light{json.at("order").get<int>(), {}};
    check_order(light.order);
    light.coefficients.resize(static_cast<std::size_t>(coefficient_count(light.order)));
    const char* names[3] = {"red", "green", "blue"};
    for (int c = 0; c < 3; ++c) {
        const auto values = json.at("coefficients").at(names[c]).get<std::vector<float>>();
        if (values.size() != light.coefficients.size())
            throw Error(std::string(names[c]) + " has " + std::to_string(values.size()) +
                        " coefficients, order " + std::to_string(light.order) + " needs " +
                        std::to_string(light.coefficients.size()));
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!std::isfinite(values[i]))
                throw Error("a coefficient is not finite");
            light.coefficients[i][c] = values[i];
        }
    }
    return light;
}

} // namespace

Light read_light_json(const std::filesystem::path& path) {
    const std::vector<std::byte> file = read_file(path);
    try {
        const Json json = Json::parse(reinterpret_cast<const char*>(file.data()),
                                      reinterpret_cast<const char*>(file.data()) + file.size());
        if (!json.is_object() || json.value("prtkit_light", 0) != 1)
            throw Error("is JSON, but no light of prt project");
        const Light light = coefficients_of(json);
        return json.contains("lights") ? sum(light, lights_of(json["lights"], light.order)) : light;
    } catch (const std::exception& error) { // ours and the JSON library's
        throw Error(path.string() + ": " + error.what());
    }
}

} // namespace prt::cli
