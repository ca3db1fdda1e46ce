// Tests prt lobes: transfer that rotates with a skin, and rejected input.

#include "pipeline.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/image/image_file.h"
#include "support/glb_file.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

namespace prt::test {
namespace {

class LobesCommand : public Pipeline {
protected:
    void SetUp() override { copy_examples(folder.path(), {"figure"}); }
    Outcome lobes(const char* model, std::vector<std::string> options = {}) {
        options.insert(options.begin(), {"lobes", at(model), "-o", at("out.glb")});
        return prt(options);
    }
    /// Expects a one-line error with the reason, and no output file.
    void expect_refusal(const char* model, const std::string& why, std::vector<std::string> options = {}) {
        const Outcome outcome = lobes(model, std::move(options));
        EXPECT_EQ(outcome.status, 1);
        EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find(at(model)), std::string::npos) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
    }
};

TEST_F(LobesCommand, WritesLobesAndMeasuresThemOverFrames) {
    const Outcome outcome = lobes("figure.glb", {"--poses", "animation=dance", "--rays", "64", "--poses", "4",
                                                 "--poses", "frames=2", "--json", at("lobes.json")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_LE(validator_errors(folder / "out.glb"), 0);
    const nlohmann::json figures = read_json(folder / "lobes.json");
    EXPECT_EQ(figures["poses"], 5); // with that of the file
    EXPECT_EQ(figures["bytes_bound_per_vertex"], 8);
    EXPECT_EQ(figures["lobe_errors_by_frame"].size(), 2u);
    EXPECT_LT(figures["lit_rms"], figures["lit_rms_rest"]);
    EXPECT_LT(figures["lit_rms_rest"], figures["lit_rms_unshadowed"]);
    EXPECT_LT(figures["lit_rms"], 1.1 * figures["lit_rms_best"].get<double>());
    const GltfDocument document = load_gltf(folder / "out.glb");
    const std::optional<StoredLobes> stored = read_lobes(document, extract_scene(document));
    ASSERT_TRUE(stored);
    EXPECT_EQ(stored->model.vertices(), figures["vertices"]);
    EXPECT_NE(prt({"info", at("out.glb")}).out.find("lobes that rotate with the skin: order 4, 2 lobes"),
              std::string::npos);
    ASSERT_EQ(prt({"shader", at("out.glb"), "-o", at("lobes.glsl"), "--stage", "lobes"}).status, 0);
    EXPECT_GT(std::filesystem::file_size(folder / "lobes.glsl"), 1000u);
    EXPECT_EQ(prt({"shader", at("figure.glb"), "-o", at("x.glsl"), "--stage", "lobes"}).status, 1);
}

TEST_F(LobesCommand, IsByteIdenticalForAllThreadCounts) {
    const std::vector<std::string> options = {"--rays",  "16",       "--poses", "2",
                                              "--poses", "frames=0", "--lobes", "1"};
    std::vector<std::string> one = options;
    one.insert(one.end(), {"--threads", "1"});
    ASSERT_EQ(lobes("figure.glb", one).status, 0);
    std::filesystem::rename(folder / "out.glb", folder / "one.glb");
    ASSERT_EQ(lobes("figure.glb", options).status, 0);
    EXPECT_EQ(read_glb(folder / "out.glb").binary, read_glb(folder / "one.glb").binary);
}

// Compares rendered lobes of the file's only pose with its bake, under light from one side. The errors of
// order 4 and two lobes, and 3 % of noise, are far below the effect of shadows.
TEST_F(LobesCommand, AreRenderedInThePoseOfTheFile) {
    GlbFile still = read_glb(folder / "figure.glb");
    auto& animation = still.json["animations"][0];
    animation["channels"] = nlohmann::ordered_json::array({animation["channels"][0]});
    animation["channels"][0]["target"]["node"] = still.json["nodes"].size();
    still.json["nodes"].push_back({{"name", "draws nothing"}});
    still.json["animations"] = nlohmann::ordered_json::array({animation});
    still.write(folder / "still.glb");
    const Outcome outcome = lobes("still.glb", {"--rays", "256", "--poses", "1", "--poses", "frames=0"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("no vertex moves"), std::string::npos) << outcome.err;
    ASSERT_EQ(prt({"bake", at("still.glb"), "-o", at("baked.glb"), "--order", "4", "--rays", "256",
                   "--bounces", "1"})
                  .status,
              0);
    std::vector<glm::vec3> sky(32, glm::vec3(0.1f));
    for (std::size_t y = 0; y < 4; ++y)
        for (std::size_t x = 0; x < 3; ++x)
            sky[8 * y + x] = glm::vec3(1);
    write_exr(folder / "sky.exr", {8, 4, sky});
    const auto picture = [&](const char* model) {
        const Outcome rendered =
            prt({"render", at(model), "--lights", at("sky.exr"), "-o", at("p.exr"), "--size", "192x96",
                 "--no-background", "--suns", "0", "--device", "cpu"});
        EXPECT_EQ(rendered.status, 0) << rendered.err;
        const bool unlit = rendered.err.find("has no transfer") != std::string::npos;
        EXPECT_EQ(unlit, std::string(model) == "still.glb") << rendered.err;
        return load_environment(folder / "p.exr").environment.image.pixels;
    };
    const auto baked = picture("baked.glb"), posed = picture("out.glb"), open = picture("still.glb");
    const auto difference = [&](const std::vector<glm::vec3>& other) {
        double wrong = 0, all = 0;
        for (std::size_t i = 0; i < baked.size(); ++i) {
            const glm::dvec3 pixel(baked[i]), off = glm::dvec3(other[i]) - pixel;
            wrong += glm::dot(off, off);
            all += glm::dot(pixel, pixel);
        }
        return std::sqrt(wrong / all);
    };
    EXPECT_LT(difference(posed), 0.1);
    EXPECT_GT(difference(open), 2 * difference(posed));
}

/// Both determine how the light of a pose is measured: a smaller error needs more rays, and depth maps give
/// the light of rays.
TEST_F(LobesCommand, MeasuresLightWithATargetErrorAndByDepthMaps) {
    const auto figures = [&](std::vector<std::string> options) {
        options.insert(options.end(), {"--poses", "1", "--poses", "frames=1", "--bounces", "0", "--lobes",
                                       "1", "--json", at("lobes.json")});
        const Outcome outcome = lobes("figure.glb", options);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return read_json(folder / "lobes.json");
    };
    const int coarse = figures({"--target-error", "0.1"})["rays_per_receiver"],
              fine = figures({"--target-error", "0.03"})["rays_per_receiver"];
    EXPECT_GT(fine, coarse);
    const double rays = figures({"--rays", "128"})["lit_rms"],
                 maps = figures({"--rays", "128", "--method", "raster", "--method", "resolution=128",
                                 "--device", "gpu"})["lit_rms"];
    EXPECT_NEAR(maps, rays, 0.3 * rays);
    EXPECT_EQ(
        prt({"lobes", at("figure.glb"), "-o", at("out.glb"), "--rays", "64", "--target-error", "0.1"}).status,
        2);
}

TEST_F(LobesCommand, RejectsStaticModels) {
    GlbFile still = read_glb(folder / "figure.glb");
    still.json.erase("animations");
    still.write(folder / "still.glb");
    expect_refusal("still.glb", "has no animation, but poses need one");
    expect_refusal("figure.glb", "has no animation 'fly'; available: walk, idle, dance",
                   {"--poses", "animation=fly"});
}

TEST_F(LobesCommand, RejectsASkinWithoutWeights) {
    GlbFile bare = read_glb(folder / "figure.glb");
    for (auto& mesh : bare.json["meshes"])
        for (auto& primitive : mesh["primitives"])
            for (const char* name : {"JOINTS_0", "WEIGHTS_0"})
                primitive["attributes"].erase(name);
    bare.write(folder / "bare.glb");
    expect_refusal("bare.glb", "mesh 0 primitive 0 has a skin, but no weights");
}

TEST_F(LobesCommand, RejectsNonFiniteAnimations) {
    GlbFile bad = read_glb(folder / "figure.glb");
    const std::size_t output = bad.json["animations"][0]["samplers"][0]["output"];
    const std::size_t view = bad.json["accessors"][output]["bufferView"];
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(&bad.binary[bad.json["bufferViews"][view]["byteOffset"].get<std::size_t>()], &nan,
                sizeof nan);
    bad.write(folder / "bad.glb");
    expect_refusal("bad.glb", "not finite");
}

TEST_F(LobesCommand, RejectsOptionsOutOfRange) {
    for (const auto& options : std::vector<std::vector<std::string>>{
             {"--lobes", "4"}, {"--lobes", "0"}, {"--order", "6"}, {"--poses", "0"}, {"--rays", "-1"}})
        EXPECT_EQ(lobes("figure.glb", options).status, 2) << options[0];
}

} // namespace
} // namespace prt::test
