// Tests lightmaps through the program: baked, compressed, reported and drawn; and rejected input.

#include "pipeline.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/image/image_file.h"
#include "prt/render/lightmap_file.h"
#include "support/glb_file.h"
#include "support/lightmap_model.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace prt::test {
namespace {

class Lightmaps : public Pipeline {
protected:
    static constexpr const char* kScene = "plain_room.glb";

    void SetUp() override { copy_examples(folder.path(), {"plain_room", "sky"}); }
    Outcome bake(const std::vector<std::string>& options, const char* output = "baked.glb") {
        std::vector<std::string> arguments = {"bake",   at(kScene), "-o",      at(output),
                                              "--rays", "16",       "--order", "3"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return prt(arguments);
    }
    void expect_refused(const Outcome& outcome, const std::string& why) {
        EXPECT_EQ(outcome.status, 1);
        EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
        EXPECT_EQ(outcome.err.find("prt: error: "), outcome.err.rfind("prt: error: ")) << outcome.err;
    }
};

/// A cube of 1 m.
Scene cube() {
    SceneBuilder builder;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool far : {false, true}) {
            glm::vec3 a(0), u(0), v(0);
            a[axis] = far ? 1.0f : 0.0f;
            u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1;
            if (far)
                builder.quad(a, a + u, a + u + v, a + v);
            else
                builder.quad(a, a + v, a + u + v, a + u);
        }
    return builder.build();
}

// Faces that touch their neighbours cost a few rays more each, not a thousand. Each block is a node: in one
// mesh, two faces at one position would be the sides of a wall.
TEST_F(Lightmaps, TouchingBlocksUseTheRequestedRays) {
    GlbFile file = scene_file(cube());
    file.json["nodes"] = nlohmann::json::array();
    for (int i = 0; i < 12; ++i) {
        file.json["nodes"].push_back({{"mesh", 0}, {"translation", {i % 3, i / 3 % 2, i / 6}}});
        file.json["scenes"][0]["nodes"][static_cast<std::size_t>(i)] = i;
    }
    file.write(folder / "blocks.glb");
    const Outcome baked = prt({"bake", at("blocks.glb"), "-o", at("b.glb"), "--texels", "512", "--texels",
                               "unwrap", "--rays", "64", "--order", "2", "--json", at("b.json")});
    ASSERT_EQ(baked.status, 0) << baked.err;
    const nlohmann::json report = read_json(folder / "b.json");
    EXPECT_LT(report["rays"].get<double>(), 1.2 * 64 * report["texels_measured"].get<double>());
    EXPECT_GT(report["texels_enclosed"], 10000); // out of 180 000
}

TEST_F(Lightmaps, WorkInAllCommands) {
    ASSERT_EQ(
        bake({"--texels", "128", "--texels", "unwrap", "--bounces", "1", "--json", at("bake.json")}).status,
        0);
    EXPECT_GT(read_json(folder / "bake.json")["texels_measured"], 1000);
    ASSERT_EQ(prt({"compress", at("baked.glb"), "-o", at("shipped.glb"), "--clusters", "8", "--bits", "56",
                   "--json", at("compress.json")})
                  .status,
              0);
    const nlohmann::json compressed = read_json(folder / "compress.json");
    EXPECT_EQ(compressed["bytes_bound_per_texel"], 8);
    EXPECT_EQ(validator_errors(folder / "shipped.glb"), 0);

    const Scene scene = extract_scene(load_gltf(folder / "baked.glb"));
    const GltfDocument baked_file = load_gltf(folder / "baked.glb"),
                       shipped_file = load_gltf(folder / "shipped.glb");
    const std::optional<BakedLightmap> baked = read_lightmap(baked_file, scene);
    std::optional<EncodedLightmap> encoded = read_encoded_lightmap(shipped_file, scene);
    ASSERT_TRUE(baked && encoded);
    const std::optional<CompressedLightmap> shipped = decoded_lightmap(std::move(*encoded));
    EXPECT_EQ(baked->layout, shipped->layout);
    EXPECT_FALSE(read_encoded_lightmap(baked_file, scene) || read_lightmap(shipped_file, scene));
    EXPECT_EQ(shipped->compressed.transfer.receivers.size(), 128u * 128u);

    ASSERT_EQ(prt({"evaluate", at("baked.glb"), at("shipped.glb"), "--json", at("evaluate.json")}).status, 0);
    EXPECT_NEAR(read_json(folder / "evaluate.json")["relative_l2"].get<double>(),
                compressed["relative_l2"].get<double>(), 1e-6);
    const Outcome info = prt({"info", at("shipped.glb")});
    EXPECT_NE(info.out.find("1 map, 128 x 128"), std::string::npos) << info.out;
    for (const char* model : {"baked.glb", "shipped.glb"})
        EXPECT_EQ(prt({"render", at(model), "--lights", at("sky.exr"), "-o", at("p.png"), "--size", "64x48"})
                      .status,
                  0);
}

TEST_F(Lightmaps, AreDecodedFromTheFormatPageWithTheSameError) {
    if (std::string(PRT_NODE).empty() ||
        !std::filesystem::exists(std::string(PRT_VALIDATOR_MODULES) + "/pngjs"))
        GTEST_SKIP() << "node or pngjs is not installed";
    ASSERT_EQ(bake({"--texels", "64", "--texels", "unwrap", "--bounces", "1"}).status,
              0); // two parts, one of them colored
    const std::vector<std::vector<std::string>> ways = {
        {}, {"--preset", "u64"}, {"--clusters", "50", "--bits", "40"}, {"--clusters", "1", "--bits", "0"}};
    for (const std::vector<std::string>& way : ways) {
        std::vector<std::string> arguments = {"compress", at("baked.glb"),     "-o",       at("shipped.glb"),
                                              "--json",   at("compress.json"), "--lights", "natural"};
        arguments.insert(arguments.end(), way.begin(), way.end());
        ASSERT_EQ(prt(arguments).status, 0);
        const Outcome decoder =
            run(PRT_NODE, {PRT_DECODE, at("baked.glb"), at("shipped.glb"), PRT_VALIDATOR_MODULES});
        ASSERT_EQ(decoder.status, 0) << decoder.err;
        std::istringstream found(decoder.out);
        double l2 = 0, lit_rms = 0;
        found >> l2 >> lit_rms;
        const nlohmann::json report = read_json(folder / "compress.json");
        const double expected_l2 = report["relative_l2"], expected_lit_rms = report["lit_rms"];
        EXPECT_NEAR(l2, expected_l2, 1e-5 * expected_l2); // areas and vectors are floats there
        EXPECT_NEAR(lit_rms, expected_lit_rms, 1e-5 * expected_lit_rms);
    }
}

TEST_F(Lightmaps, ShadersCompile) {
    ASSERT_EQ(bake({"--texels", "64", "--texels", "unwrap"}).status, 0);
    ASSERT_EQ(prt({"compress", at("baked.glb"), "-o", at("shipped.glb")}).status, 0);
    const struct {
        const char *language, *file;
        bool fragment;
    } cases[] = {{"glsl450", "a.comp", false}, {"vulkan", "b.comp", false},  {"glsl450", "c.frag", true},
                 {"glsl330", "d.frag", false}, {"essl300", "e.frag", false}, {"vulkan", "f.frag", true}};
    for (const auto& c : cases) {
        std::vector<std::string> arguments = {"shader",   at("shipped.glb"), "-o",
                                              at(c.file), "--language",      c.language};
        if (c.fragment)
            arguments.insert(arguments.end(), {"--stage", "fragment"});
        ASSERT_EQ(prt(arguments).status, 0) << c.language;
        if (const std::string glslang = PRT_GLSLANG; !glslang.empty()) {
            const Outcome outcome = c.language == std::string("vulkan")
                                        ? run(glslang, {"-V", "-o", at("s.spv"), at(c.file)})
                                        : run(glslang, {at(c.file)});
            EXPECT_EQ(outcome.status, 0) << c.language << " " << c.file << ": " << outcome.out;
        }
    }
}

TEST_F(Lightmaps, AreRemovedByAVertexBake) {
    ASSERT_EQ(bake({"--texels", "64", "--texels", "unwrap"}).status, 0);
    ASSERT_EQ(prt({"compress", at("baked.glb"), "-o", at("shipped.glb")}).status, 0);
    ASSERT_EQ(prt({"bake", at("shipped.glb"), "-o", at("again.glb"), "--rays", "16"}).status, 0);
    const GlbFile file = read_glb(folder / "again.glb");
    EXPECT_EQ(file.json.dump().find("texels"), std::string::npos);
    EXPECT_TRUE(!file.json.contains("images") || file.json["images"].empty());
    EXPECT_EQ(validator_errors(folder / "again.glb"), 0);
}

// Receivers are texels, and there are fewer of them than vertices: code must not index them by vertex.
TEST_F(Lightmaps, ShowSunsForMoreVerticesThanTexels) {
    GlbFile floor = mapped_floor(60);
    floor.json["meshes"][0]["primitives"].erase(1);
    floor.write(folder / kScene);
    ASSERT_EQ(bake({"--texels", "8", "--texels", "uv=0"}).status, 0);
    ASSERT_EQ(
        prt({"compress", at("baked.glb"), "-o", at("shipped.glb"), "--clusters", "1", "--bits", "24"}).status,
        0);
    const std::string sun =
        R"({"prtkit_light": 1, "order": 3, "coefficients": {"red": [0,0,0,0,0,0,0,0,0],
                "green": [0,0,0,0,0,0,0,0,0], "blue": [0,0,0,0,0,0,0,0,0]},
            "suns": [{"towards": [0, 1, 0], "irradiance": [3, 3, 3], "half_angle_radians": 0.01}]})";
    std::ofstream(folder / "sun.json") << sun;
    std::vector<double> brightness;
    for (const char* model : {"baked.glb", "shipped.glb"}) {
        const Outcome drawn = prt({"render", at(model), "--lights", at("sun.json"), "-o", at("sun.exr"),
                                   "--size", "32x16", "--device", "cpu", "--no-background"});
        ASSERT_EQ(drawn.status, 0) << drawn.err;
        double sum = 0;
        for (const glm::vec3& p : load_environment(folder / "sun.exr").environment.image.pixels)
            sum += static_cast<double>(p.r);
        brightness.push_back(sum);
    }
    EXPECT_GT(brightness[0], 1);
    EXPECT_NEAR(brightness[0], brightness[1], 0.02 * brightness[1]);
}

/// A leaf beside a block of marble, which is not in the picture, from above and from below in the sun.
TEST_F(Lightmaps, ShowSheetsLikeThePathTracer) {
    GlbFile leaf = scene_file(SceneBuilder().floor({0, 0, 0}, 1).build());
    leaf.json["materials"] = {
        {{"name", "leaf"},
         {"doubleSided", true},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.5, 0.1, 1}}, {"metallicFactor", 0}}},
         {"extensions",
          {{"KHR_materials_diffuse_transmission",
            {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {0.5, 0.7, 0.1}}}}}}},
        {{"name", "stone"}}};
    leaf.json["extensionsUsed"] = {"KHR_materials_diffuse_transmission"};
    leaf.json["meshes"][0]["primitives"][0]["material"] = 0;
    leaf.json["meshes"].push_back(leaf.json["meshes"][0]);
    leaf.json["meshes"][1]["primitives"][0]["material"] = 1;
    leaf.json["nodes"].push_back({{"mesh", 1}, {"translation", {5, 0, 0}}});
    leaf.json["scenes"][0]["nodes"].push_back(1);
    leaf.write(folder / kScene);
    ASSERT_EQ(bake({"--texels", "16", "--texels", "unwrap", "--subsurface",
                    "stone=0.01,0.02,0.03,0.001,0.001,0.001", "--bounces", "1", "--json", at("bake.json")})
                  .status,
              0);
    EXPECT_EQ(read_json(folder / "bake.json")["terms"].size(), 2u);
    ASSERT_EQ(
        prt({"compress", at("baked.glb"), "-o", at("shipped.glb"), "--clusters", "4", "--components", "4"})
            .status,
        0);
    const auto sky = [](float upward) {
        std::vector<float> coefficients(36);
        coefficients[0] = 1;
        coefficients[1] = upward;
        return coefficients;
    };
    std::ofstream(folder / "light.json") << nlohmann::json{
        {"prtkit_light", 1},
        {"order", 6},
        {"coefficients", {{"red", sky(0.2f)}, {"green", sky(0.1f)}, {"blue", sky(-0.2f)}}},
        {"suns", {{{"towards", {0, 0.8, 0.6}}, {"irradiance", {1, 2, 3}}, {"half_angle_radians", 0.01}}}}};
    const auto brightness = [&](const char* model, const char* camera, std::vector<std::string> more) {
        more.insert(more.begin(),
                    {"render", at(model), "--lights", at("light.json"), "-o", at("p.exr"), "--size", "16x8",
                     "--device", "cpu", "--camera", camera, "--look-at", "0,0,0"});
        const Outcome drawn = prt(more);
        EXPECT_EQ(drawn.status, 0) << drawn.err;
        glm::dvec3 sum(0);
        for (const glm::vec3& p : load_environment(folder / "p.exr").environment.image.pixels)
            sum += glm::dvec3(p) / 128.0;
        return sum;
    };
    for (const char* camera : {"0.1,1.4,0", "0.1,-1.4,0"}) {
        const glm::dvec3 truth = brightness(kScene, camera, {"--path-trace", "32"}),
                         lit = brightness("shipped.glb", camera, {});
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(lit[c], truth[c], 0.03 * truth[c]) << camera << " " << c;
    }
}

TEST_F(Lightmaps, AreRejectedIfUnsupported) {
    expect_refused(bake({"--texels", "64"}), "has no TEXCOORD_1");
    expect_refused(bake({"--texels", "unwrap"}), "--texels needs a size");
    expect_refused(bake({"--texels", "64", "--texels", "unwrap", "--refine", "0.1"}),
                   "--refine and --texels cannot be combined");
    expect_refused(bake({"--texels", "8", "--texels", "unwrap"}), "texels");
    expect_refused(bake({"--texels", "4096", "--texels", "unwrap", "--memory-limit", "100MB"}), "memory");
    EXPECT_FALSE(std::filesystem::exists(folder / "baked.glb"));
    ASSERT_EQ(bake({"--texels", "64", "--texels", "unwrap"}).status, 0);
    const auto compress = [&](const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {"compress", at("baked.glb"), "-o", at("shipped.glb")};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return prt(arguments);
    };
    expect_refused(compress({"--predictors", "normal"}), "texels have no normals");
    expect_refused(compress({"--bits", "float"}), "does not support lightmaps");
    expect_refused(compress({"--reorder"}), "changes the order of vertices");
    expect_refused(compress({"--fallback", at("sky.exr")}), "writes vertex colors");
    EXPECT_FALSE(std::filesystem::exists(folder / "shipped.glb"));
    expect_refused(prt({"relight", at("baked.glb"), "--lights", at("sky.exr"), "-o", at("r.glb")}),
                   "contains a lightmap");
}

} // namespace
} // namespace prt::test
