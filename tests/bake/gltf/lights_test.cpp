// Tests lights of KHR_lights_punctual and emissive materials in files.

#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "support/glb_file.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace prt {
namespace {

using test::GlbFile;
using Json = nlohmann::ordered_json;

Scene scene_with_lights(const GlbFile& file) {
    const std::string bytes = file.bytes();
    return extract_scene(parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb"));
}

/// A triangle, and a node behind it with this light.
GlbFile with_light(const Json& light, const Json& node = Json::object()) {
    GlbFile file = test::triangle_file();
    file.json["extensionsUsed"].push_back("KHR_lights_punctual");
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
    Json holder = node;
    holder["extensions"]["KHR_lights_punctual"]["light"] = 0;
    file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
    file.json["nodes"].push_back(holder);
    return file;
}

std::string error_of(const GlbFile& file) {
    try {
        scene_with_lights(file);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(PunctualLights, HaveThePositionsOfTheirNodes) {
    // A quarter rotation about +X maps -Z to +Y.
    const double half = std::sqrt(0.5);
    const Scene scene =
        scene_with_lights(with_light({{"type", "spot"},
                                      {"intensity", 20},
                                      {"color", {1, 0.5, 0.25}},
                                      {"range", 12.5},
                                      {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}},
                                     {{"name", "Torch"},
                                      {"translation", {1, 2, 3}},
                                      {"rotation", {half, 0, 0, half}},
                                      {"scale", {2, 2, 2}}}));
    ASSERT_EQ(scene.lights.size(), 1u);
    const PunctualLight& light = scene.lights[0];
    EXPECT_EQ(light.name, "Torch");
    EXPECT_EQ(light.kind, PunctualKind::spot);
    EXPECT_LT(glm::distance(light.intensity, glm::vec3(20, 10, 5)), 1e-5f);
    EXPECT_LT(glm::distance(scene.world(light.position), glm::dvec3(1, 2, 3)), 1e-6);
    EXPECT_LT(glm::distance(light.direction, glm::vec3(0, 1, 0)), 1e-6f);
    EXPECT_FLOAT_EQ(light.range, 12.5f);
    EXPECT_FLOAT_EQ(light.inner_cone, 0.2f);
    EXPECT_FLOAT_EQ(light.outer_cone, 0.5f);
}

TEST(PunctualLights, HaveTheDefaultsOfTheExtension) {
    const Scene scene =
        scene_with_lights(with_light({{"type", "spot"}, {"name", "its own"}, {"spot", Json::object()}}));
    const PunctualLight& light = scene.lights.at(0);
    EXPECT_EQ(light.name, "its own");
    EXPECT_EQ(light.intensity, glm::vec3(1));
    EXPECT_EQ(light.range, std::numeric_limits<float>::infinity());
    EXPECT_FLOAT_EQ(light.inner_cone, 0);
    EXPECT_FLOAT_EQ(light.outer_cone, static_cast<float>(std::numbers::pi / 4));
    EXPECT_EQ(light.direction, glm::vec3(0, 0, -1));
    EXPECT_EQ(scene_with_lights(with_light({{"type", "point"}})).lights.at(0).name, "light 0");
}

TEST(PunctualLights, HiddenNodesAreIgnored) {
    const Scene scene = scene_with_lights(
        with_light({{"type", "point"}}, {{"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}}));
    EXPECT_TRUE(scene.lights.empty());
}

TEST(PunctualLights, InvalidLightsAreRejected) {
    const std::pair<Json, const char*> kWrong[] = {
        {{{"type", "area"}}, "type"},
        {{{"type", "point"}, {"intensity", -1}}, "intensity"},
        {{{"type", "point"}, {"intensity", 1e300}}, "intensity"},
        {{{"type", "point"}, {"color", {-1, 0, 0}}}, "color"},
        {{{"type", "point"}, {"range", -1}}, "range"},
        {{{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}, "outerConeAngle"},
        {{{"type", "point"}, {"intensity", "bright"}}, "intensity"},
    };
    for (const auto& [light, word] : kWrong)
        EXPECT_NE(error_of(with_light(light)).find(word), std::string::npos)
            << light.dump() << ": " << error_of(with_light(light));
    GlbFile missing = with_light({{"type", "point"}});
    missing.json["nodes"].back()["extensions"]["KHR_lights_punctual"]["light"] = 7;
    EXPECT_NE(error_of(missing).find("light 7 does not exist"), std::string::npos);
    for (const Json& index : {Json(0.5), Json(-1), Json(1e30), Json("0")}) {
        missing.json["nodes"].back()["extensions"]["KHR_lights_punctual"]["light"] = index;
        EXPECT_NE(error_of(missing).find("light is " + index.dump()), std::string::npos) << error_of(missing);
    }
    EXPECT_NE(error_of(with_light({{"type", "point"}}, {{"translation", {2e9, 0, 0}}})).find("1e9"),
              std::string::npos);
}

/// A triangle of that material.
Emission emission_of(const Json& material) {
    GlbFile file = test::triangle_file();
    file.json["materials"] = Json::array({material});
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    return scene_with_lights(file).materials.at(0).emission;
}

TEST(Emission, IsFactorTimesStrength) {
    EXPECT_EQ(emission_of(Json::object()).radiance, glm::vec3(0));
    EXPECT_EQ(emission_of({{"emissiveFactor", {1, 0.5, 0}}}).radiance, glm::vec3(1, 0.5f, 0));
    const Json strong = {{"emissiveFactor", {1, 0.5, 0}},
                         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}};
    EXPECT_EQ(emission_of(strong).radiance, glm::vec3(8, 4, 0));
    Json negative = strong;
    negative["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = -1;
    EXPECT_THROW(emission_of(negative), Error);
}

} // namespace
} // namespace prt
