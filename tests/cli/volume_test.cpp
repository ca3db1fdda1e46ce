// Tests volumes through the program: baked, compressed, reported and evaluated; and rejected input.

#include "pipeline.h"
#include "prt/core/texture_relighter.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/glb_file.h"
#include "support/random_volume.h"
#include "support/volume_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <random>

namespace prt::test {
namespace {

class Volumes : public Pipeline {
protected:
    static constexpr const char* kScene = "plain_room.glb";

    void SetUp() override { copy_examples(folder.path(), {"plain_room", "sky"}); }
    Outcome bake(const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {"bake",   at(kScene), "-o",      at("baked.glb"),
                                              "--rays", "32",       "--order", "3"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return prt(arguments);
    }
    void expect_refused(const Outcome& outcome, const std::string& why, int status = 1) {
        EXPECT_EQ(outcome.status, status);
        EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "baked.glb"));
    }
};

/// The model is the scene with dark materials; a light is only in the scene, another one in both files.
TEST_F(Volumes, ReceiveTheLightOfTheHighPolyModel) {
    const auto light = [](GlbFile& file, const char* name, double intensity) {
        file.json["extensionsUsed"].push_back("KHR_lights_punctual");
        nlohmann::ordered_json& lights = file.json["extensions"]["KHR_lights_punctual"]["lights"];
        file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
        file.json["nodes"].push_back({{"name", name},
                                      {"translation", {0, 1, 0}},
                                      {"extensions", {{"KHR_lights_punctual", {{"light", lights.size()}}}}}});
        lights.push_back({{"type", "point"}, {"intensity", intensity}});
    };
    GlbFile scene = read_glb(folder / kScene), dark = scene;
    for (auto& material : dark.json["materials"])
        material["pbrMetallicRoughness"]["baseColorFactor"] = {0.1, 0.1, 0.1, 1};
    GlbFile whole = dark; // what the bake with both files lights
    light(scene, "both", 1);
    light(scene, "scene only", 5);
    light(dark, "both", 2);
    light(whole, "both", 2);
    light(whole, "scene only", 5);
    scene.write(folder / "scene.glb");
    dark.write(folder / "dark.glb");
    whole.write(folder / "whole.glb");
    const auto volume = [&](const char* file, std::vector<std::string> options) {
        std::vector<std::string> arguments = {"bake",    at(file), "-o",       at("b.glb"), "--rays",    "32",
                                              "--order", "3",      "--volume", "1",         "--bounces", "1"};
        std::ranges::move(options, std::back_inserter(arguments));
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        const GltfDocument document = load_gltf(folder / "b.glb");
        return read_volume(document, extract_scene(document)).value();
    };
    const BakedVolume both = volume("scene.glb",
                                    {"--texels", "64", "--texels", "unwrap", "--high-poly", at("dark.glb")}),
                      with_vertices = volume("scene.glb", {"--high-poly", at("dark.glb")}),
                      alone = volume("whole.glb", {}), bright = volume("scene.glb", {});
    EXPECT_EQ(both.grid, alone.grid);
    EXPECT_EQ(both.baked.transfer.layout, alone.baked.transfer.layout);
    EXPECT_EQ(both.baked.transfer.vectors, alone.baked.transfer.vectors);
    EXPECT_EQ(with_vertices.baked.transfer.vectors, alone.baked.transfer.vectors);
    EXPECT_NE(both.baked.transfer.vectors, bright.baked.transfer.vectors);
}

TEST_F(Volumes, WorkWithATargetErrorOfSurfaces) {
    const auto bake_with = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"bake", at(kScene), "-o", at("t.glb"), "--order", "2", "--bounces",
                                         "1", "--volume", "2", "--volume", "rays=48"});
        return prt(options);
    };
    ASSERT_EQ(bake_with({"--target-error", "0.5"}).status, 0);
    const GltfDocument document = load_gltf(folder / "t.glb");
    EXPECT_EQ(read_volume(document, extract_scene(document))->baked.record.rays, 48);
    EXPECT_EQ(bake_with({"--target-error", "0.5", "--rays", "64"}).status, 2);
}

TEST_F(Volumes, WorkInAllCommands) {
    ASSERT_EQ(bake({"--volume", "1", "--bounces", "1", "--json", at("bake.json")}).status, 0);
    const nlohmann::json baked_figures = read_json(folder / "bake.json")["volume"];
    EXPECT_GT(baked_figures["probes"], 400);
    EXPECT_EQ(validator_errors(folder / "baked.glb"), 0);
    ASSERT_EQ(prt({"compress", at("baked.glb"), "-o", at("shipped.glb"), "--volume", "bytes=8", "--json",
                   at("compress.json")})
                  .status,
              0);
    const nlohmann::json compressed = read_json(folder / "compress.json")["volume"];
    EXPECT_EQ(compressed["bytes_bound_per_probe"], 8);
    EXPECT_EQ(compressed["probes"], baked_figures["probes"]);
    EXPECT_EQ(validator_errors(folder / "shipped.glb"), 0);

    const GltfDocument baked_file = load_gltf(folder / "baked.glb"),
                       shipped_file = load_gltf(folder / "shipped.glb");
    const Scene scene = extract_scene(baked_file);
    const std::optional<BakedVolume> baked = read_volume(baked_file, scene);
    const std::optional<CompressedVolume> shipped =
        read_compressed_volume(shipped_file, extract_scene(shipped_file));
    ASSERT_TRUE(baked && shipped);
    EXPECT_FALSE(read_volume(shipped_file, scene) || read_compressed_volume(baked_file, scene));
    EXPECT_EQ(baked->grid, shipped->grid);
    EXPECT_EQ(baked->visibility, shipped->visibility);
    EXPECT_EQ(baked->visibility.size(), baked_figures["probes"]);

    const Outcome info = prt({"info", at("shipped.glb")});
    EXPECT_EQ(info.status, 0);
    EXPECT_NE(info.out.find("volume: "), std::string::npos) << info.out;
    const Outcome evaluation = prt({"evaluate", at("baked.glb"), at("shipped.glb"), "--measure", "volume",
                                    "--lights", at("sky.exr"), "--json", at("errors.json")});
    ASSERT_EQ(evaluation.status, 0) << evaluation.err;
    const nlohmann::json errors = read_json(folder / "errors.json")["volume_errors"];
    ASSERT_EQ(errors.size(), 5u); // rows of both files, and of other engines' data at these probes
    for (const nlohmann::json& row : errors) {
        const bool ours = row["volume"] == "baked" || row["volume"] == "shipped";
        EXPECT_EQ(ours, row["error"].is_number());
        if (ours) {
            EXPECT_GT(row["error"], 0);
            EXPECT_LT(row["error"], 1);
        }
        EXPECT_GT(row["irradiance_error"], ours ? 0.0 : errors[0]["irradiance_error"].get<double>());
    }
}

TEST_F(Volumes, AreRemovedByASecondBake) {
    ASSERT_EQ(bake({"--volume", "probes=400"}).status, 0);
    EXPECT_TRUE(read_volume(load_gltf(folder / "baked.glb"), extract_scene(load_gltf(folder / "baked.glb"))));
    ASSERT_EQ(prt({"bake", at("baked.glb"), "-o", at("again.glb"), "--rays", "8"}).status, 0);
    const GltfDocument again = load_gltf(folder / "again.glb");
    EXPECT_FALSE(read_volume(again, extract_scene(again)));
}

TEST_F(Volumes, CombineWithLightmaps) {
    ASSERT_EQ(bake({"--volume", "2", "--texels", "64", "--texels", "unwrap"}).status, 0);
    ASSERT_EQ(
        prt({"compress", at("baked.glb"), "-o", at("shipped.glb"), "--clusters", "4", "--bits", "24"}).status,
        0);
    const GltfDocument shipped = load_gltf(folder / "shipped.glb");
    EXPECT_TRUE(read_compressed_volume(shipped, extract_scene(shipped)));
    EXPECT_EQ(validator_errors(folder / "shipped.glb"), 0);
}

TEST_F(Volumes, RejectInvalidOptions) {
    expect_refused(bake({"--volume", "1e-3"}), "use smaller bounds");
    expect_refused(bake({"--volume", "1e-7"}), "below the precision of positions");
    expect_refused(bake({"--volume", "order=2"}), "--volume needs a distance");
    expect_refused(bake({"--volume", "1", "--volume", "bounds=1,1,1,0,0,0"}), "two corners");
    expect_refused(bake({"--volume", "0.05", "--memory-limit", "40MB"}), "memory");
    expect_refused(bake({"--volume", "probes=100000000", "--memory-limit", "500MB"}), "memory");
    EXPECT_NE(bake({"--volume", "1e18"}).status, 0);
    EXPECT_NE(bake({"--volume", "-1"}).status, 0);
    EXPECT_NE(bake({"--volume", "nan"}).status, 0);
    EXPECT_NE(bake({"--volume", "1", "--volume", "bounds=0,0,0,1,1"}).status, 0);
    EXPECT_NE(bake({"--volume", "1", "--volume", "bounds=0,0,0,1,nan,1"}).status, 0);
}

/// Writes the textures of a volume's shader lookup, one after the other: visibility distances, index, and the
/// light of coefficients cos(1), cos(2), .. with half as strong suns towards +Y.
void write_textures(const CompressedVolume& volume, const std::filesystem::path& path) {
    std::vector<glm::vec3> sky, suns;
    for (int i = 0; i < coefficient_count(volume.compressed.transfer.bases.layout.order); ++i)
        sky.emplace_back(std::cos(3 * i + 1), std::cos(3 * i + 2), std::cos(3 * i + 3));
    for (const glm::vec3& value : sky)
        suns.push_back(0.5f * value);
    const TextureRelighter relighter(volume);
    std::vector<glm::vec4> constants(relighter.rows());
    std::vector<std::byte> texels(relighter.bytes(0));
    relighter.update_constants({sky, suns}, glm::vec3(0, 1, 0), constants);
    relighter.update(0, constants, texels);
    const VolumeLookup lookup(volume.grid, volume.visibility);
    std::ofstream file(path, std::ios::binary);
    for (const auto& words : {visibility_texels(volume.grid, lookup.probes(), volume.visibility),
                              index_texels(volume.grid, lookup.index())})
        file.write(reinterpret_cast<const char*>(words.data()),
                   static_cast<std::streamsize>(words.size() * sizeof(std::uint32_t)));
    file.write(reinterpret_cast<const char*>(texels.data()), static_cast<std::streamsize>(texels.size()));
}

TEST_F(Pipeline, VolumesHaveTheSameTexturesInTheWeb) {
    if (std::string(PRT_NODE).empty())
        GTEST_SKIP() << "node is not installed";
    const std::string script = (std::filesystem::path(PRT_DECODE).parent_path() / "update_web.mjs").string();
    std::mt19937 random(9);
    for (const int order : {2, 3, 4}) {
        const CompressedVolume volume = random_volume(order, false, random);
        with_volume(triangle_file(), volume).write(folder / "v.glb");
        write_textures(volume, folder / "textures");
        const Outcome computed = run(PRT_NODE, {script, at("v.glb"), at("textures")});
        EXPECT_EQ(computed.status, 0) << "order " << order << ": " << computed.out << computed.err;
    }
}

} // namespace
} // namespace prt::test
