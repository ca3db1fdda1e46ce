// Tests prt relight: compares radiance of vertices with closed forms and with the library.

#include "program.h"
#include "prt/gltf/gltf.h"
#include "prt/image/image_file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt::test {
namespace {

class Relight : public testing::Test {
protected:
    void SetUp() override {
        scene_file(SceneBuilder().floor({0, 0, 0}, 1, 2).build()).write(folder / "s.glb");
        prt_once("b.glb", {"bake", at("s.glb"), "--rays", "256", "--order", "4"}, folder / "b.glb");
        prt_once("c.glb", {"compress", at("b.glb")}, folder / "c.glb");
        folder.file("sun.json",
                    R"({"prtkit_light": 1, "order": 4, "coefficients": {"red": [1.7724539, 0, 0, 0, 0,
            0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], "green": [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
            "blue": [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]},
            "suns": [{"towards": [0, 2, 0], "irradiance": [0, 1.25663706, 0], "half_angle_radians": 0.01}]})");
    }
    std::string at(const char* name) const { return (folder / name).string(); }
    /// Returns the vertex colors of the written file.
    std::vector<glm::vec3> relit(const std::vector<std::string>& arguments) const {
        std::vector<std::string> all = {"relight", "-o", at("lit.glb")};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const Outcome outcome = prt(all);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        const Scene scene = extract_scene(load_gltf(folder / "lit.glb"));
        std::vector<glm::vec3> colors;
        for (const glm::vec4& color : scene.vertex_arrays[0].colors)
            colors.emplace_back(color);
        EXPECT_EQ(colors.size(), scene.receivers());
        return colors;
    }

    TemporaryFolder folder;
};

/// A red sky of radiance 0.5 and a green sun overhead of irradiance 0.4 pi, which adds 0.4 on an open floor.
TEST_F(Relight, AddsTheSkyByTransferAndTheSunsByRays) {
    for (const char* model : {"b.glb", "c.glb"})
        for (const glm::vec3& color : relit({at(model), "--lights", at("sun.json")}))
            EXPECT_LT(glm::distance(color, glm::vec3(0.5f, 0.4f, 0)), 3e-3f) << model;
}

/// Surfaces of marble are lit by the sun once: through the medium.
TEST_F(Relight, LightsMediaBySunsOnce) {
    ASSERT_EQ(prt({"bake", at("s.glb"), "-o", at("b.glb"), "--rays", "256", "--order", "4", "--subsurface",
                   "marble"})
                  .status,
              0);
    glm::vec3 brightest(0); // in the middle, from where no light leaks out over the edge
    for (const glm::vec3& color : relit({at("b.glb"), "--lights", at("sun.json")}))
        brightest = glm::max(brightest, color);
    EXPECT_NEAR(brightest.r, 0.5f, 0.05f);
    EXPECT_NEAR(brightest.g, 0.4f, 0.05f);
}

TEST_F(Relight, MultipliesByTheBaseColorOnRequest) {
    GlbFile file = scene_file(SceneBuilder().floor({0, 0, 0}, 1, 2).build());
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "s.glb");
    ASSERT_EQ(prt({"bake", at("s.glb"), "-o", at("b.glb"), "--rays", "256", "--order", "4"}).status, 0);
    for (const glm::vec3& color : relit({at("b.glb"), "--lights", at("sun.json"), "--colors", "albedo"}))
        EXPECT_LT(glm::distance(color, glm::vec3(0.25f, 0.1f, 0)), 3e-3f);
}

/// On an open floor the sky of radiance 0.5, red, and the sun of 0.4, green, are the colors times 2^stops; a
/// mean luminance of 0.22 is the automatic exposure, base colors counted.
TEST_F(Relight, WritesUnlitMaterialsWithAnExposure) {
    GlbFile file = scene_file(SceneBuilder().floor({0, 0, 0}, 1, 2).build());
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "s.glb");
    ASSERT_EQ(prt({"bake", at("s.glb"), "-o", at("b.glb"), "--rays", "256", "--order", "4"}).status, 0);
    const auto expect = [&](const char* stops, float factor) {
        for (const glm::vec3& color :
             relit({at("b.glb"), "--lights", at("sun.json"), "--colors", "unlit", "--exposure", stops}))
            EXPECT_LT(glm::distance(color, factor * glm::vec3(0.5f, 0.4f, 0)), 3e-3f * factor) << stops;
        const GlbFile lit = read_glb(folder / "lit.glb");
        EXPECT_EQ(lit.json["materials"][0]["extensions"]["KHR_materials_unlit"],
                  nlohmann::ordered_json::object());
        EXPECT_EQ(lit.json["extensionsUsed"], nlohmann::ordered_json::array({"KHR_materials_unlit"}));
    };
    expect("0", 1);
    expect("-1", 0.5f);
    const float automatic = 0.22f / (0.2126f * 0.25f + 0.7152f * 0.1f);
    expect("auto", automatic);
    expect("auto-1", 0.5f * automatic);
    const Outcome both = prt({"relight", at("b.glb"), "--lights", at("sun.json"), "-o", at("n.glb"),
                              "--colors", "unlit", "--colors", "albedo"});
    EXPECT_EQ(both.status, 2);
    EXPECT_EQ(prt({"relight", at("b.glb"), "--lights", at("sun.json"), "-o", at("n.glb"), "--exposure", "1"})
                  .status,
              2);
}

/// A magenta texture removes the green of the sun from the mean luminance: 0.2126 times the red of 0.5
/// remains.
TEST_F(Relight, CountsTexturesInTheAutomaticExposure) {
    GlbFile file = scene_file(SceneBuilder().floor({0, 0, 0}, 1, 2).build());
    const std::vector<glm::u8vec3> magenta(4, glm::u8vec3(255, 0, 255));
    file.json["images"] = {{{"bufferView", file.view(encode_png(2, 2, magenta))}, {"mimeType", "image/png"}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    const std::size_t count = file.json["accessors"][0]["count"];
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] =
        file.accessor(std::vector<float>(2 * count, 0.5f), kFloat, "VEC2", 2);
    primitive["material"] = 0;
    file.write(folder / "s.glb");
    ASSERT_EQ(prt({"bake", at("s.glb"), "-o", at("b.glb"), "--rays", "256", "--order", "4"}).status, 0);
    const float automatic = 0.22f / (0.2126f * 0.5f);
    for (const glm::vec3& color :
         relit({at("b.glb"), "--lights", at("sun.json"), "--colors", "unlit", "--exposure", "auto-2"}))
        EXPECT_LT(glm::distance(color, 0.25f * automatic * glm::vec3(0.5f, 0.4f, 0)), 3e-3f);
}

/// A sun of one texel is found in the image, and shadowed by rays or kept in the sky: on an open floor the
/// results are equal.
TEST_F(Relight, FindsSunsInImages) {
    Image sky{64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(0.2f))};
    sky.at(20, 3) = glm::vec3(400);
    write_exr(folder / "sky.exr", sky, EnvironmentLayout::lat_long);
    const auto separate = relit({at("b.glb"), "--lights", at("sky.exr"), "--suns", "1"}),
               together = relit({at("b.glb"), "--lights", at("sky.exr"), "--suns", "0"});
    // The cosine's own bands beyond 4 are 1 % of it.
    for (std::size_t p = 0; p < separate.size(); ++p)
        EXPECT_NEAR(separate[p].x / together[p].x, 1, 0.03f);
    EXPECT_GT(separate[0].x, 0.3f);
    EXPECT_LT(separate[0].x, 0.9f); // colors that are read end at 1
}

TEST_F(Relight, ReportsUnsupportedInput) {
    const auto refused = [&](const std::vector<std::string>& arguments, int status, const char* words) {
        std::vector<std::string> all = {"relight", "-o", at("no.glb")};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const std::size_t before = folder.files();
        const Outcome outcome = prt(all);
        EXPECT_EQ(outcome.status, status) << outcome.err;
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
        EXPECT_EQ(folder.files(), before);
    };
    refused({at("s.glb"), "--lights", at("sun.json")}, 1, "contains no transfer");
    refused({at("b.glb"), "--lights", at("sun.json"), "--suns", "17"}, 2, "17");
    refused({at("b.glb"), "--lights", at("sun.json"), "--suns", "rays=0"}, 2, "rays=0");
    ASSERT_EQ(prt({"compress", at("b.glb"), "-o", at("w.glb"), "--combine-direct"}).status, 0);
    refused({at("w.glb"), "--lights", at("sun.json"), "--suns", "1"}, 1, "no separate direct term");
    const Outcome merged = prt({"relight", at("w.glb"), "--lights", at("sun.json"), "-o", at("lit.glb")});
    EXPECT_EQ(merged.status, 0);
    EXPECT_NE(merged.err.find("no separate direct"), std::string::npos) << merged.err;
}

} // namespace
} // namespace prt::test
