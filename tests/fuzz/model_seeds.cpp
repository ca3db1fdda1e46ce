// Seeds: models.
#include "seeds.h"

#include "bake/gltf/vertex_fallback.h"
#include "prt/compress/compress.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "runtime/load/mesh_edges.h"
#include "support/glb_file.h"
#include "support/lightmap_model.h"
#include "support/predicted.h"
#include "support/random_lightmap.h"
#include "support/scene_builder.h"

#include <array>
#include <fstream>
#include <random>
#include <string>
#include <utility>

namespace prt::fuzz {
namespace {

using test::GlbFile;

std::string base64(std::span<const std::byte> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = 256 * group + (i + k < bytes.size() ? static_cast<unsigned>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? kDigits[(group >> (18 - 6 * k)) % 64] : '=';
    }
    return text;
}

GlbFile floor_file(int cells) {
    return test::scene_file(test::SceneBuilder().floor(glm::vec3(0), 1, cells).build());
}

/// One of every optional part: texture, materials with extensions, colors, morph target, skin.
GlbFile dressed_file() {
    GlbFile file = test::triangle_file();
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    auto& attributes = primitive["attributes"];
    attributes["TEXCOORD_0"] = file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, test::kFloat, "VEC2", 2);
    attributes["COLOR_0"] =
        file.accessor(std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255},
                      test::kUnsignedByte, "VEC4", 4, true, 4);
    attributes["JOINTS_0"] = file.accessor(std::vector<std::uint8_t>(12, 0), test::kUnsignedByte, "VEC4", 4);
    attributes["WEIGHTS_0"] =
        file.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, test::kFloat, "VEC4", 4);
    primitive["targets"] = {{{"POSITION", file.accessor(std::vector<float>{0, 0, 1, 0, 0, 0, 0, 0, 0},
                                                        test::kFloat, "VEC3", 3)}}};
    primitive["material"] = 0;
    file.json["meshes"][0]["weights"] = {0.5};
    file.json["skins"] = {{{"joints", {1}}}};
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"children", {1}}}, {{"translation", {0, 0, 1}}}};
    const std::vector<glm::u8vec3> pixels(4, glm::u8vec3(200, 100, 50));
    file.json["images"] = {{{"bufferView", file.view(encode_png(2, 2, pixels))}, {"mimeType", "image/png"}}};
    file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.json["materials"] = {
        {{"name", "leaf"},
         {"alphaMode", "MASK"},
         {"doubleSided", true},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {1, 0.5, 0.25, 1}},
           {"baseColorTexture",
            {{"index", 0},
             {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 1}}}}}}}}},
         {"extensions",
          {{"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.5}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
           {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 2}}}}}}};
    return file;
}

/// Instances, a node with a matrix, one that mirrors, a sparse accessor.
GlbFile instanced_file() {
    GlbFile file = test::triangle_file();
    const std::size_t moves = file.accessor(std::vector<float>{0, 0, 0, 2, 0, 0}, test::kFloat, "VEC3", 3);
    const std::array<std::uint16_t, 1> changed = {1};
    const std::array<float, 3> value = {2, 0, 0};
    const std::size_t where = file.view(std::as_bytes(std::span(changed)));
    const std::size_t what = file.view(std::as_bytes(std::span(value)));
    file.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", what}}}};
    file.json["nodes"] = {
        {{"mesh", 0},
         {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", moves}}}}}}}},
        {{"mesh", 0}, {"scale", {-1, 1, 1}}, {"rotation", {0, 0.6, 0, 0.8}}},
        {{"children", {1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1}}}};
    file.json["scenes"] = {{{"nodes", {0, 2}}}};
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    return file;
}

BakedTransfer bake_of(const Scene& scene, const TransferLayout& layout) {
    BakedTransfer baked{{layout, {}}, {.bounces = 1, .rays = 16, .receivers = receivers_id(scene)}};
    baked.transfer.vectors.resize(scene.receivers() * baked.transfer.dimension());
    for (std::size_t i = 0; i < baked.transfer.vectors.size(); ++i)
        baked.transfer.vectors[i] = 0.1f + static_cast<float>(i * 7919 % 101) / 101;
    return baked;
}

GltfDocument document_of(const GlbFile& file) {
    const std::string text = file.bytes();
    return parse_gltf(std::as_bytes(std::span(text)), "seed.glb");
}

void write_bakes(const Path& folder) {
    const TransferLayout both{2, {{TermKind::direct, 1}, {TermKind::indirect, 3}}};
    const TransferLayout lamps{
        2, {{TermKind::indirect, 1}, {TermKind::lamp, 3, "lanterns", {"a", "b"}}, {TermKind::lamp, 1, "c"}}};
    for (const auto& [name, layout] :
         {std::pair("1", layout_of_one(2, 1)), std::pair("3", layout_of_one(2, 3)), std::pair("terms", both),
          std::pair("lamps", lamps)})
        for (const TransferStorage storage : {TransferStorage::float32, TransferStorage::float16}) {
            GltfDocument document = document_of(floor_file(1));
            const Scene scene = extract_scene(document);
            BakedTransfer baked = bake_of(scene, layout);
            baked.storage = storage;
            write_transfer(document, scene, baked);
            save_glb(document, folder / ("baked" + std::string(name) + to_string(storage) + ".glb"));
        }
}

void write_shipped(const Path& folder, const std::string& name, const CompressOptions& options) {
    GltfDocument document = document_of(floor_file(2));
    const Scene scene = extract_scene(document);
    const BakedTransfer baked =
        bake_of(scene, {3, {{TermKind::direct, 1}, {TermKind::indirect, 1}, {TermKind::lamp, 3, "lamp"}}});
    const CompressResult result =
        compress(baked.transfer, {receiver_areas(scene), mesh_edges(scene)}, options);
    write_clustered(document, scene, {result.transfer, baked.record});
    save_glb(document, folder / (name + ".glb"));
    save_glb(document, folder / (name + ".meshopt.glb"), BufferCompression::meshopt);
}

void write_with_fallback(const Path& folder) {
    GltfDocument document = parse_gltf(read_file(folder / "u64.glb"), "u64.glb");
    const Scene scene = extract_scene(document);
    write_fallback(document, scene, std::vector<glm::vec3>(scene.receivers(), glm::vec3(0.5f)), 1.5f);
    save_glb(document, folder / "fallback.glb");
}

void write_predicted(const Path& folder) {
    GltfDocument document = document_of(floor_file(2));
    const Scene scene = extract_scene(document);
    const BakedTransfer baked = bake_of(scene, layout_of_one(2, 1));
    CompressedTransfer compressed{
        compress(baked.transfer, {receiver_areas(scene), mesh_edges(scene)}, {.clusters = 3}).transfer,
        baked.record};
    std::mt19937 random(1);
    test::add_predictors(compressed.transfer.bases, {PredictorKind::normal, PredictorKind::position}, random);
    write_clustered(document, scene, compressed);
    save_glb(document, folder / "predicted.glb");
}

/// Raw, of words over plain bases, and of words over coded ones.
void write_lightmaps(const Path& folder) {
    const GlbFile scene = test::mapped_floor(1);
    const LightmapLayout layout = test::layout_of_floor({6, 5}, {4, 3});
    std::mt19937 random(2);
    BakedLightmap baked = test::made_up_lightmap(
        layout, {2, {{TermKind::direct, 1}, {TermKind::indirect, 3}, {TermKind::lamp, 1, "lamp"}}}, random);
    for (const TransferStorage storage : {TransferStorage::float32, TransferStorage::float16}) {
        baked.baked.storage = storage;
        test::with_lightmap(scene, baked)
            .write(folder / ("lightmap" + std::string(to_string(storage)) + ".glb"));
    }
    for (const int words : {1, 2}) {
        CompressedLightmap shipped = test::random_lightmap(layout.maps, words, words == 1, random);
        shipped.layout = layout;
        test::with_lightmap(scene, shipped)
            .write(folder / ("lightmap.words" + std::to_string(words) + ".glb"));
    }
    const std::vector<Edge> edges = lightmap_edges(layout, baked.texels, baked.seams);
    const CompressOptions options{.clusters = 3, .coding = preset_u64(), .predictors = PredictorChoice::none};
    const ClusteredTransfer coded = compress(baked.baked.transfer, {baked.areas, edges}, options).transfer;
    test::with_lightmap(scene, scatter_to_maps(baked, coded)).write(folder / "lightmap.coded.glb");
}

/// Writes a skinned triangle with an occluder at its joint.
void write_occluder(const Path& folder) {
    GltfDocument document = document_of(dressed_file());
    OcclusionVolume volume{glm::vec3(-1), glm::vec3(1), 4, {}};
    volume.texels.fill(occluder_texel(0.2f, {0, 0.5f, 0}));
    const NodeOccluder occluders[] = {{1, volume}};
    write_occluders(document, occluders);
    save_glb(document, folder / "occluder.glb");
}

/// A skinned triangle with two lobes a vertex.
void write_lobed(const Path& folder) {
    GltfDocument document = document_of(dressed_file());
    Scene scene = extract_scene(document);
    for (VertexArray& vertices : scene.vertex_arrays)
        vertices.lobes = true;
    StoredLobes lobes;
    lobes.model.order = 3;
    lobes.model.lobes = 2;
    lobes.model.profiles = {{1, 0.6f, 0.25f}, {0.5f, -0.25f, 0.125f}};
    for (std::size_t v = 0; v < scene.receivers(); ++v)
        lobes.model.words.insert(lobes.model.words.end(), {{127, 200, 0, 255}, {10, 90, 1, 40}});
    write_lobes(document, scene, lobes);
    save_glb(document, folder / "lobes.glb");
}

} // namespace

void write_model_seeds(const Path& to) {
    const Path folder = to / "models";
    test::triangle_file().write(folder / "triangle.glb");
    floor_file(2).write(folder / "floor.glb");
    dressed_file().write(folder / "dressed.glb");
    const Scene shadows =
        test::SceneBuilder().floor(glm::vec3(0), 1, 3).sphere(glm::vec3(0, 0.5f, 0), 0.4f, 3).build();
    test::scene_file(shadows).write(folder / "shadows.glb");
    instanced_file().write(folder / "instanced.glb");
    save_glb(document_of(floor_file(6)), folder / "floor.meshopt.glb", BufferCompression::meshopt);
    GlbFile text = test::triangle_file();
    text.json["buffers"] = {{{"byteLength", text.binary.size()},
                             {"uri", "data:application/octet-stream;base64," + base64(text.binary)}}};
    std::ofstream(folder / "triangle.gltf") << text.json.dump(1);
    write_bakes(folder);
    constexpr std::pair<const char*, WeightFormat> kFormats[] = {{"float32", WeightFormat::float32},
                                                                 {"packed", WeightFormat::packed}};
    for (const auto& [name, format] : kFormats)
        write_shipped(folder, name, {.clusters = 3, .coding = {.format = format, .components = 4}});
    write_shipped(folder, "plain", {.clusters = 2, .coding = {.components = 3}, .basis_share = 0});
    write_shipped(folder, "u64", {.clusters = 4, .coding = preset_u64()});
    write_with_fallback(folder);
    write_predicted(folder);
    write_lightmaps(folder);
    write_occluder(folder);
    write_lobed(folder);
}

} // namespace prt::fuzz
