// Lobes in files.

#include "bake/gltf/encode_glb.h"
#include "prt/core/error.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/glb_file.h"
#include "support/random_volume.h"
#include "support/volume_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

namespace prt {
namespace lobes_of_files { // joined sources share one scope
namespace {

using test::GlbFile;
using Json = nlohmann::ordered_json;

GltfDocument parsed(const GlbFile& file) {
    const std::string bytes = file.bytes();
    return parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb");
}

/// A triangle of two nodes, by different words.
StoredLobes any_lobes() {
    StoredLobes stored;
    stored.model.order = 3;
    stored.model.lobes = 2;
    stored.model.profiles = {{1, 0.5f, 0.25f}, {-0.25f, 2, 0.125f}, {0, 0, 1}};
    for (std::uint8_t i = 0; i < 12; ++i)
        stored.model.words.push_back({static_cast<std::uint8_t>(20 * i), static_cast<std::uint8_t>(255 - i),
                                      static_cast<std::uint8_t>(i % 3), i});
    stored.record = {.poses = 9, .rays = 256, .bounces = 1, .seed = 7};
    return stored;
}

GlbFile two_triangles() {
    GlbFile file = test::triangle_file();
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 0, 1}}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    return file;
}

/// Returns the scene of `document`; its nodes `moving` get lobes.
Scene with_figure(const GltfDocument& document, const std::set<int>& moving = {0, 1}) {
    Scene scene = extract_scene(document);
    for (const Primitive& primitive : scene.primitives)
        scene.vertex_arrays[primitive.vertices].lobes = moving.contains(primitive.node);
    return scene;
}

GlbFile with_lobes() {
    GltfDocument document = parsed(two_triangles());
    write_lobes(document, with_figure(document), any_lobes());
    return test::glb_of(encode_glb(document));
}

TEST(LobesOfFiles, RoundTrip) {
    const GltfDocument document = parsed(with_lobes());
    const std::optional<StoredLobes> read = read_lobes(document, extract_scene(document));
    const StoredLobes expected = any_lobes();
    ASSERT_TRUE(read);
    EXPECT_EQ(read->model.words, expected.model.words);
    EXPECT_EQ(read->model.profiles, expected.model.profiles);
    EXPECT_EQ(read->model.order, 3);
    EXPECT_EQ(read->model.lobes, 2u);
    EXPECT_EQ(read->record.poses, 9);
    EXPECT_EQ(read->record.rays, 256);
    EXPECT_EQ(read->record.bounces, 1);
    EXPECT_EQ(read->record.seed, 7u);
    const GltfDocument none = parsed(two_triangles());
    EXPECT_FALSE(read_lobes(none, extract_scene(none)));
}

/// Writes a document as a file and reads it back.
GltfDocument read_again(const GltfDocument& document) {
    return parse_gltf(encode_glb(document), "memory.glb");
}

TEST(LobesOfFiles, ReplaceTheTransferOfTheirVertices) {
    GltfDocument document = parsed(two_triangles());
    Scene scene = extract_scene(document);
    write_transfer(document, scene, {zero_transfer(2, 1, scene.receivers()), {}});
    document = read_again(document);
    write_lobes(document, with_figure(document), any_lobes());
    document = read_again(document);
    scene = extract_scene(document);
    EXPECT_FALSE(read_transfer(document, scene));
    EXPECT_TRUE(read_lobes(document, scene));
    discard_transfer(document);
    EXPECT_TRUE(read_lobes(document, scene));
    discard_lobes(document);
    const GlbFile left = test::glb_of(encode_glb(document));
    EXPECT_FALSE(left.json.contains("extensionsUsed"));
    EXPECT_FALSE(left.json["meshes"][0]["primitives"][0]["attributes"].contains("_PRT_LOBE_0"));
}

/// The files have the same lobes at node 1, and the same transfer at node 0, whichever is written first.
TEST(LobesOfFiles, AreBesideTheTransferOfOtherVertices) {
    Transfer transfer = zero_transfer(2, 1, 6);
    std::iota(transfer.vectors.begin(), transfer.vectors.end(), 1.0f);
    std::vector<float> of_level = transfer.vectors;
    std::fill(of_level.begin() + 12, of_level.end(), 0.0f);
    std::vector<LobeWord> of_figure = any_lobes().model.words;
    std::fill_n(of_figure.begin(), 6, LobeWord{});
    for (const bool transfer_first : {true, false}) {
        GltfDocument document = parsed(two_triangles());
        if (transfer_first) {
            write_transfer(document, extract_scene(document), {transfer, {}});
            document = read_again(document);
        }
        write_lobes(document, with_figure(document, {1}), any_lobes());
        document = read_again(document);
        if (!transfer_first) {
            write_transfer(document, extract_scene(document), {transfer, {}});
            document = read_again(document);
        }
        const Scene scene = extract_scene(document);
        EXPECT_EQ(read_transfer(document, scene).value().transfer.vectors, of_level);
        EXPECT_EQ(read_lobes(document, scene).value().model.words, of_figure);
        const GltfDocument level = parse_gltf(encode_glb(document), "memory.glb", {.leave_out_lobes = true});
        EXPECT_EQ(read_transfer(level, extract_scene(level)).value().transfer.vectors,
                  std::vector<float>(of_level.begin(), of_level.begin() + 12));
        EXPECT_FALSE(read_lobes(level, extract_scene(level)));
    }
}

TEST(LobesOfFiles, AreReadAfterTheVolumeIsDiscarded) {
    std::mt19937 random(3);
    GltfDocument document = parsed(test::with_volume(two_triangles(), test::random_volume(2, false, random)));
    write_lobes(document, with_figure(document), any_lobes());
    document = read_again(document); // the views of the volume are before those of the lobes
    const Scene scene = extract_scene(document);
    discard_volume(document);
    const std::optional<StoredLobes> read = read_lobes(document, scene);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->model.words, any_lobes().model.words);
    EXPECT_FALSE(read_compressed_volume(document, scene));
}

std::string error_of(const GlbFile& file) {
    try {
        const GltfDocument document = parsed(file);
        read_lobes(document, extract_scene(document));
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(LobesOfFiles, DamageIsRejected) {
    const auto damaged = [](auto damage) {
        GlbFile file = with_lobes();
        damage(file.json["extensions"]["PRTKIT_lobes"],
               file.json["meshes"][0]["primitives"][0]["attributes"]);
        return error_of(file);
    };
    const auto expect = [&](const std::string& says, auto damage) {
        const std::string error = damaged(damage);
        EXPECT_NE(error.find(says), std::string::npos) << error;
        EXPECT_EQ(error.find('\n'), std::string::npos);
    };
    expect("PRTKIT_lobes has version 9", [](Json& e, Json&) { e["version"] = 9; });
    expect("the order of the lobes", [](Json& e, Json&) { e["order"] = 5; });
    expect("lobes", [](Json& e, Json&) { e["lobes"] = 4; });
    expect("the number of profiles", [](Json& e, Json&) { e["profiles"]["count"] = 300; });
    expect("the profiles of lobes", [](Json& e, Json&) { e["profiles"]["count"] = 2; });
    expect("4711", [](Json& e, Json&) { e["profiles"]["bufferView"] = 4711; });
    expect("memory.glb", [](Json& e, Json&) { e.erase("profiles"); });
    expect("poses", [](Json& e, Json&) { e["bake"]["poses"] = -1; });
    expect("mesh 0 primitive 0", [](Json&, Json& a) { a.erase("_PRT_LOBE_1"); });
    expect("_PRT_LOBE_1 must have four unsigned bytes for each of 3 vertices",
           [](Json&, Json& a) { a["_PRT_LOBE_1"] = a["POSITION"]; });
}

TEST(LobesOfFiles, MissingProfilesAreRejected) {
    GlbFile file = with_lobes();
    const std::size_t accessor = file.json["meshes"][0]["primitives"][0]["attributes"]["_PRT_LOBE_0"];
    const std::size_t view = file.json["accessors"][accessor]["bufferView"];
    file.binary[file.json["bufferViews"][view]["byteOffset"].get<std::size_t>() + 2] = std::byte{3};
    EXPECT_NE(error_of(file).find("profile 3, but there are only 3"), std::string::npos) << error_of(file);
}

} // namespace
} // namespace lobes_of_files
} // namespace prt
