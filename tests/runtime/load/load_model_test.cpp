// Tests `load_model`: the contents of shipped files, and files that it refuses.

#include "prt/load/model.h"

#include "hostile/shipped_files.h"
#include "prt/compress/compress.h"
#include "prt/core/cluster_lighting.h"
#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/instanced_model.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <string>

namespace prt::test {
namespace {

Model parsed(const GlbFile& file) {
    const std::string bytes = file.bytes();
    return parse_model(std::as_bytes(std::span(bytes)), "model.glb");
}

std::string refusal(const GlbFile& file) {
    try {
        parsed(file);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

void expect_same_geometry(const Scene& loaded, const Scene& extracted) {
    EXPECT_EQ(loaded.origin, extracted.origin);
    ASSERT_EQ(loaded.vertex_arrays.size(), extracted.vertex_arrays.size());
    for (std::size_t a = 0; a < loaded.vertex_arrays.size(); ++a) {
        EXPECT_EQ(loaded.vertex_arrays[a].positions, extracted.vertex_arrays[a].positions);
        EXPECT_EQ(loaded.vertex_arrays[a].normals, extracted.vertex_arrays[a].normals);
        EXPECT_EQ(loaded.vertex_arrays[a].texcoords, extracted.vertex_arrays[a].texcoords);
        EXPECT_EQ(loaded.vertex_arrays[a].colors, extracted.vertex_arrays[a].colors);
        EXPECT_EQ(loaded.vertex_arrays[a].first_receiver, extracted.vertex_arrays[a].first_receiver);
    }
    ASSERT_EQ(loaded.primitives.size(), extracted.primitives.size());
    for (std::size_t p = 0; p < loaded.primitives.size(); ++p) {
        EXPECT_EQ(loaded.primitives[p].triangles, extracted.primitives[p].triangles);
        EXPECT_EQ(loaded.materials[loaded.primitives[p].material].base_color,
                  extracted.materials[extracted.primitives[p].material].base_color);
    }
}

/// A random transfer, and the same after compression.
struct Compressed {
    GltfDocument document;
    Scene scene;
    CompressedTransfer transfer;
};
Compressed compressed_ball(const TransferLayout& layout) {
    const std::string bytes =
        scene_file(SceneBuilder().floor({5, 0, 3}, 2, 3).sphere({5.3f, 1, 3}, 0.8f, 4).build()).bytes();
    GltfDocument document = parse_gltf(std::as_bytes(std::span(bytes)), "ball.glb");
    Scene scene = extract_scene(document);
    Transfer transfer = zero_transfer(layout, scene.receivers());
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    for (float& value : transfer.vectors)
        value = 0.5f + 0.3f * normal(random);
    CompressedTransfer compressed{compress(transfer, SceneSurface(scene).view(), {.clusters = 6}).transfer,
                                  {.rays = 16, .receivers = receivers_id(scene)}};
    return {std::move(document), std::move(scene), std::move(compressed)};
}

TEST(LoadModel, LightsVerticesAsTheDataThatWereWritten) {
    // Compares with the transfer in memory: no code that reads files is involved.
    for (const BufferCompression compression : {BufferCompression::none, BufferCompression::meshopt}) {
        Compressed made = compressed_ball({3, {{TermKind::direct, 1}, {TermKind::indirect, 3}}});
        const TemporaryFolder folder;
        write_clustered(made.document, made.scene, made.transfer);
        save_glb(made.document, folder / "shipped.glb", compression);
        Model model = load_model(folder / "shipped.glb");
        ASSERT_TRUE(model.vertices);
        add_coordinates(model);
        EXPECT_EQ(model.vertices->record.rays, 16);
        EXPECT_FALSE(model.volume || model.lightmap || model.lobes);
        const Light light = sum(constant_light(3, {1, 0.5f, 0.25f}),
                                as_light({.towards = {0, 1, 0}, .irradiance = {2, 2, 2}}, 3));
        EXPECT_EQ(exit_radiance(model.vertices->transfer, light),
                  exit_radiance(made.transfer.transfer, light));
        // Vertices of the ball have the distance 0.8 from its center.
        const VertexArray& vertices = model.scene.vertex_arrays.back();
        std::size_t on_ball = 0;
        for (const glm::vec3& position : vertices.positions)
            on_ball +=
                std::abs(glm::distance(model.scene.world(position), glm::dvec3(5.3, 1, 3)) - 0.8) < 1e-5;
        EXPECT_EQ(on_ball, 45u); // all of them
    }
}

TEST(LoadModel, ReadsShippedFilesAsTheToolsDo) {
    const Light light = constant_light(3, glm::vec3(1, 2, 3));
    for (const ShippedFile& shipped : shipped_files()) {
        SCOPED_TRACE(shipped.name);
        const std::string bytes = shipped.file.bytes();
        const GltfDocument document = parse_gltf(std::as_bytes(std::span(bytes)), "model.glb");
        const Scene scene = extract_scene(document);
        Model model = parsed(shipped.file);
        add_coordinates(model);
        expect_same_geometry(model.scene, scene);
        const auto vertices = read_clustered(document, scene);
        const auto lightmap = read_encoded_lightmap(document, scene);
        ASSERT_EQ(model.vertices.has_value(), vertices.has_value());
        ASSERT_EQ(model.lightmap.has_value(), lightmap.has_value());
        EXPECT_TRUE(vertices || lightmap);
        if (vertices) {
            EXPECT_EQ(exit_radiance(model.vertices->transfer, light),
                      exit_radiance(vertices->transfer, light));
        }
        if (lightmap) {
            EXPECT_EQ(model.lightmap->lightmap.layout, lightmap->lightmap.layout);
            EXPECT_EQ(model.lightmap->images, lightmap->images);
        }
    }
    for (const ShippedFile& shipped : volume_files()) {
        const std::string bytes = shipped.file.bytes();
        const GltfDocument document = parse_gltf(std::as_bytes(std::span(bytes)), "model.glb");
        const auto volume = read_compressed_volume(document, extract_scene(document));
        const Model model = parsed(shipped.file);
        ASSERT_TRUE(volume && model.volume);
        const Lighting lighting{constant_light(kMaxOrder, glm::vec3(1))};
        EXPECT_EQ(incident_light(*model.volume, lighting), incident_light(*volume, lighting));
    }
}

TEST(LoadModel, KeepsOnlyTheWordsOfVertices) {
    Compressed made = compressed_ball({3, {{TermKind::direct, 1}, {TermKind::indirect, 3}}});
    const TemporaryFolder folder;
    write_clustered(made.document, made.scene, made.transfer);
    save_glb(made.document, folder / "shipped.glb");
    Model model = load_model(folder / "shipped.glb");
    ClusteredTransfer& transfer = model.vertices->transfer;
    ASSERT_FALSE(transfer.bases.predictors.empty());
    EXPECT_TRUE(transfer.receivers.clusters.empty() && transfer.receivers.predictors.empty());
    EXPECT_EQ(transfer.receivers.size(), model.scene.receivers());
    EXPECT_EQ(transfer.receivers.cluster_indices(), made.transfer.transfer.receivers.cluster_indices());

    // The CPU needs coordinates; constants need rows.
    const ClusterLighting lighting(transfer);
    std::vector<glm::vec4> constants(lighting.rows());
    lighting.update(constant_light(3, glm::vec3(1)).coefficients, constants);
    std::vector<glm::vec3> radiance(transfer.receivers.size());
    EXPECT_THROW(evaluate(transfer, constants, radiance), Error);
    EXPECT_THROW(decode(transfer), Error);
    add_coordinates(model);
    const std::vector<glm::vec3> expected = exit_radiance(transfer, constant_light(3, glm::vec3(1)));
    free_rows(transfer);
    evaluate(transfer, constants, radiance);
    EXPECT_EQ(radiance, expected);
    EXPECT_THROW(decode(transfer), Error);
    EXPECT_THROW(ClusterLighting{transfer}, Error);
    EXPECT_THROW(write_clustered(made.document, made.scene, *model.vertices), Error);
}

TEST(LoadModel, StoresSharedMeshesOnce) {
    const std::string bytes = instanced_triangles().bytes();
    const GltfDocument document = parse_gltf(std::as_bytes(std::span(bytes)), "model.glb");
    const Scene flat = extract_scene(document);
    const InstancedModel of_tools = read_instanced(document, flat, "model.glb");
    const Model model = parsed(instanced_triangles());
    ASSERT_TRUE(model.vertices);
    EXPECT_EQ(model.scene.receivers(), of_tools.stored.receivers());
    EXPECT_LT(model.scene.receivers(), flat.receivers());
    ASSERT_EQ(model.instances.size(), of_tools.instances.size());
    for (std::size_t i = 0; i < model.instances.size(); ++i) {
        const FileInstance &loaded = model.instances[i], &expected = of_tools.instances[i];
        EXPECT_EQ(loaded.number, expected.number);
        EXPECT_EQ(loaded.world, expected.world);
        EXPECT_EQ(loaded.placed.rotation, expected.placed.rotation);
        ASSERT_EQ(loaded.stored_arrays.size(), 1u);
        // World positions of the instance.
        const VertexArray& mesh = model.scene.vertex_arrays[loaded.stored_arrays[0]];
        const VertexArray& drawn = flat.vertex_arrays[expected.arrays[0]];
        ASSERT_EQ(mesh.size(), drawn.size());
        for (std::size_t v = 0; v < mesh.size(); ++v) {
            const glm::dvec3 world = loaded.world * glm::dvec4(model.scene.world(mesh.positions[v]), 1);
            EXPECT_LT(glm::distance(world, flat.world(drawn.positions[v])), 1e-5);
        }
    }
}

TEST(LoadModel, IgnoresRawTransferAndFilesWithout) {
    Compressed made = compressed_ball({2, {{TermKind::combined, 1}}});
    const TemporaryFolder folder;
    save_glb(made.document, folder / "scene.glb");
    EXPECT_FALSE(load_model(folder / "scene.glb").vertices);
    write_transfer(made.document, made.scene, {decode(made.transfer.transfer), {}});
    save_glb(made.document, folder / "baked.glb");
    const Model baked = load_model(folder / "baked.glb");
    EXPECT_FALSE(baked.vertices || baked.lightmap || baked.volume || baked.lobes);
    EXPECT_TRUE(baked.instances.empty() && baked.occluders.empty());
}

TEST(LoadModel, SkipsUnknownChunks) {
    const GlbFile file = shipped_files().front().file;
    std::string bytes = file.bytes();
    std::uint32_t json = 0;
    std::memcpy(&json, bytes.data() + 12, sizeof json);
    bytes.insert(20 + json, std::string("\4\0\0\0NEW!", 8) + "data");
    const Model model = parse_model(std::as_bytes(std::span(bytes)), "model.glb");
    ASSERT_TRUE(model.vertices);
    EXPECT_EQ(model.vertices->transfer.receivers.weights, parsed(file).vertices->transfer.receivers.weights);
}

TEST(LoadModel, RefusesFilesThatItCannotRead) {
    const std::vector<ShippedFile> files = shipped_files();
    const auto changed = [&](const std::function<void(GlbFile&)>& change) {
        GlbFile file = files.front().file;
        change(file);
        return refusal(file);
    };
    EXPECT_EQ(changed([](GlbFile&) {}), "");
    EXPECT_EQ(changed([](GlbFile& file) { file.json["extensionsRequired"] = {"EXT_of_others"}; }),
              "model.glb: requires the glTF extension EXT_of_others, which is not supported");
    EXPECT_EQ(changed([](GlbFile& file) { file.json["buffers"][0]["uri"] = "other.bin"; }),
              "model.glb: has a buffer outside the .glb file; write it with prt compress");
    EXPECT_EQ(changed([](GlbFile& file) {
                  file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
                      {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
              }),
              "model.glb: is compressed with Draco, which loading does not support; write it with prt "
              "compress");
    EXPECT_NE(changed([](GlbFile& file) {
                  file.json["extensions"]["PRTKIT_transfer"]["version"] = 1;
              }).find("PRTKIT_transfer has version 1"),
              std::string::npos);
    EXPECT_NE(changed([](GlbFile& file) {
                  file.json["extensions"]["PRTKIT_clustered_pca"] = {{"version", 8}};
              }).find("has PRTKIT_clustered_pca, a format of a former version"),
              std::string::npos);
    EXPECT_NE(changed([](GlbFile& file) {
                  file.json["accessors"][0]["bufferView"] = 1000;
              }).find("buffer view 1000 does not exist"),
              std::string::npos);
    EXPECT_NE(changed([](GlbFile& file) {
                  file.json["accessors"][0].erase("componentType");
              }).find("accessor 0: is damaged glTF"),
              std::string::npos);
    EXPECT_NE(changed([](GlbFile& file) {
                  file.json["nodes"][0]["children"] = {"a"};
              }).find("node 0: is damaged glTF: children is not a list of indices"),
              std::string::npos);
    EXPECT_NE(changed([](GlbFile& file) {
                  file.json["nodes"][0]["children"] = {4294967297};
              }).find("children is not a list of indices"),
              std::string::npos);
    EXPECT_NE(changed([](GlbFile& file) {
                  file.json["accessors"][0]["sparse"] = {
                      {"count", 1},
                      {"indices", {{"bufferView", 0}, {"componentType", kFloat}}},
                      {"values", {{"bufferView", 0}}}};
              }).find("is sparse, but its indices are not unsigned integers"),
              std::string::npos);
    const std::string text = "{\"asset\": {\"version\": \"2.0\"}}";
    EXPECT_THROW(parse_model(std::as_bytes(std::span(text)), "scene.gltf"), Error);
    EXPECT_THROW(load_model("no_such_file.glb"), Error);
}

} // namespace
} // namespace prt::test
