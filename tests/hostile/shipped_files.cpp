// Builds valid shipped files with all variants of the format.

#include "shipped_files.h"

#include "bake/gltf/vertex_fallback.h"
#include "prt/compress/compress.h"
#include "prt/gltf/gltf.h"
#include "support/lightmap_model.h"
#include "support/predicted.h"
#include "support/random_lightmap.h"
#include "support/random_volume.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"
#include "support/volume_model.h"

#include <algorithm>
#include <iterator>
#include <random>
#include <string>
#include <utility>

namespace prt::test {
namespace {

const TransferLayout kSky{3, {{TermKind::direct, 1}, {TermKind::indirect, 3}}};
const TransferLayout kLamps{
    2, {{TermKind::combined, 1}, {TermKind::lamp, 3, "lantern"}, {TermKind::lamp, 1, "window"}}};

/// Options of a file.
struct Recipe {
    std::string name;
    TransferLayout layout;
    CompressOptions options;
    bool position_alone = false; ///< only a position predictor, which the compressor never chooses
    GlbFile scene = {};
    bool has_fallback = false;
};

/// Returns a ball on a floor.
GlbFile smooth_scene() {
    return scene_file(SceneBuilder().floor({0, 0, 0}, 2, 3).sphere({0.3f, 1, 0}, 0.8f, 4).build());
}

/// Returns a scene with normals in bytes, a primitive without normals, and nodes that mirror, scale and
/// rotate.
GlbFile hard_scene() {
    GlbFile file = smooth_scene();
    file.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    nlohmann::ordered_json& primitives = file.json["meshes"][0]["primitives"];
    const std::size_t count = file.json["accessors"][0]["count"];
    std::vector<std::int8_t> normals;
    for (std::size_t v = 0; v < count; ++v)
        normals.insert(normals.end(), {static_cast<std::int8_t>(v % 90), 45, 77, 99});
    const std::size_t bytes = file.accessor(std::as_bytes(std::span(normals)), count, kByte, "VEC3", true, 4);
    nlohmann::ordered_json bare = primitives[0];
    primitives[0]["attributes"]["NORMAL"] = bytes;
    bare["attributes"].erase("NORMAL");
    primitives.push_back(bare);
    file.json["nodes"] = {{{"children", {1, 2}}, {"translation", {100, 2, -30}}},
                          {{"mesh", 0}, {"scale", {-1, 1, 1}}},
                          {{"mesh", 0}, {"scale", {3, 0.5, 1.25}}, {"rotation", {0, 0.6, 0, 0.8}}}};
    return file;
}

Transfer transfer_of(const Scene& scene, const TransferLayout& layout) {
    Transfer transfer = zero_transfer(layout, scene.receivers());
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (float& value : transfer.vectors)
        value = 0.5f + 0.3f * normal(random);
    return transfer;
}

GlbFile made(const Recipe& recipe) {
    const TemporaryFolder folder;
    (recipe.scene.binary.empty() ? smooth_scene() : recipe.scene).write(folder / "scene.glb");
    GltfDocument document = load_gltf(folder / "scene.glb");
    const Scene scene = extract_scene(document);
    CompressedTransfer compressed{
        compress(transfer_of(scene, recipe.layout), SceneSurface(scene).view(), recipe.options).transfer,
        {.rays = 16, .receivers = receivers_id(scene)}};
    std::mt19937 random(4);
    if (recipe.position_alone)
        add_predictors(compressed.transfer.bases, {PredictorKind::position}, random);
    write_clustered(document, scene, compressed);
    save_glb(document, folder / "shipped.glb");
    if (recipe.has_fallback) {
        document = load_gltf(folder / "shipped.glb");
        const Scene shipped = extract_scene(document);
        write_fallback(document, shipped, std::vector<glm::vec3>(shipped.receivers(), glm::vec3(0.5f)), 1.5f);
        save_glb(document, folder / "shipped.glb");
    }
    return read_glb(folder / "shipped.glb");
}

/// Adds words over coded bases with a lamp, and over plain bases.
std::vector<ShippedFile> lightmap_files() {
    const GlbFile scene = mapped_floor(2);
    const LightmapLayout layout = layout_of_floor({12, 10}, {9, 7});
    std::mt19937 random(5);
    const BakedLightmap baked = made_up_lightmap(layout, kLamps, random);
    const std::vector<Edge> edges = lightmap_edges(layout, baked.texels, baked.seams);
    const CompressOptions options{.clusters = 5, .coding = preset_u64(), .predictors = PredictorChoice::none};
    const ClusteredTransfer coded = compress(baked.baked.transfer, {baked.areas, edges}, options).transfer;
    CompressedLightmap plain = random_lightmap(layout.maps, 1, false, random);
    plain.layout = layout;
    return {{"texels_coded", with_lightmap(scene, scatter_to_maps(baked, coded))},
            {"texels_plain", with_lightmap(scene, plain)}};
}

CompressedVolume coded_volume(std::mt19937& random) {
    const CompressedVolume plain = random_volume(3, false, random);
    BakedVolume baked{plain, {}};
    baked.baked.transfer = decode(plain.compressed.transfer);
    baked.baked.transfer.layout.outputs = 1;
    return compress_volume(baked, {.clusters = 5, .coding = preset_volume()}).volume;
}

std::vector<Recipe> recipes() {
    const WeightCoding fixed = preset_u32x4(), free = preset_u64(),
                       floats{.format = WeightFormat::float32, .components = 5};
    return {
        {"none_fixed", kSky, {.clusters = 6, .coding = fixed, .predictors = PredictorChoice::none}},
        {"normal_fixed", kSky, {.clusters = 6, .coding = fixed}},
        {"normal_free", kLamps, {.clusters = 5, .coding = free}},
        {"both_free",
         kSky,
         {.clusters = 4, .coding = free, .predictors = PredictorChoice::normal_and_position}},
        {"both_floats",
         kLamps,
         {.clusters = 4, .coding = floats, .predictors = PredictorChoice::normal_and_position}},
        {"position_plain", kSky, {.clusters = 4, .coding = fixed, .predictors = PredictorChoice::none}, true},
        {"both_hard",
         kLamps,
         {.clusters = 4, .coding = free, .predictors = PredictorChoice::normal_and_position},
         false,
         hard_scene(),
         true},
    };
}

} // namespace

std::vector<ShippedFile> shipped_files() {
    std::vector<ShippedFile> files;
    for (const Recipe& recipe : recipes())
        files.push_back({recipe.name, made(recipe)});
    std::ranges::move(lightmap_files(), std::back_inserter(files));
    return files;
}

std::vector<ShippedFile> volume_files() {
    std::mt19937 random(1);
    const GlbFile plain = with_volume(triangle_file(), random_volume(2, false, random)),
                  coded = with_volume(triangle_file(), coded_volume(random));
    return {{"probes_plain", plain}, {"probes_coded", coded}};
}

} // namespace prt::test
