// Opens models and environment maps.

#include "cli/pipeline/model.h"

#include "bake/gltf/reorder.h"
#include "prt/gltf/levels.h"
#include "prt/load/light_file.h"
#include "prt/render/lightmap_file.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/light_passing.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace prt::pipeline {

int SceneFile::order() const {
    if (compressed)
        return compressed->transfer.bases.layout.order;
    return baked ? baked->transfer.layout.order : 0;
}

const BakeRecord* SceneFile::record() const {
    if (compressed)
        return &compressed->record;
    return baked ? &baked->record : nullptr;
}

std::size_t vertices_with_lobes(const Scene& scene) {
    std::size_t count = 0;
    for (const VertexArray& vertices : scene.vertex_arrays)
        count += vertices.lobes ? vertices.size() : 0;
    return count;
}

void check_belong_together(const SceneFile& baked, const Path& baked_path, const SceneFile& shipped,
                           const Path& shipped_path) {
    for (const auto& [model, path] : {std::pair(&baked, &baked_path), std::pair(&shipped, &shipped_path)})
        if (!model->record())
            throw Error(path->string() + ": contains no transfer; run prt bake first");
    const bool same_positions = baked.lightmap && shipped.lightmap
                                    ? baked.lightmap->layout == shipped.lightmap->layout
                                    : !baked.lightmap && !shipped.lightmap;
    if (!same_positions || baked.record()->receivers != shipped.record()->receivers ||
        baked.scene.receivers() != shipped.scene.receivers())
        throw Error(shipped_path.string() + ": was not made from " + baked_path.string() +
                    ": their receivers differ; use files of one bake");
    if (baked.order() != shipped.order())
        throw Error(fmt::format("{}: has order {}, but {} has order {}; use files of one bake",
                                shipped_path.string(), shipped.order(), baked_path.string(), baked.order()));
}

void check_of_vertices(const SceneFile& model, const Path& path, const std::string& command) {
    if (model.lightmap)
        throw Error(path.string() + ": contains a lightmap; " + command);
}

const TransferLayout& layout_of(const SceneFile& model) {
    return model.compressed ? model.compressed->transfer.bases.layout : model.baked->transfer.layout;
}

void put_in_order_of(const Scene& scene, SceneFile& baked) {
    if (baked.lightmap)
        return; // texels stay where they are
    baked.baked->transfer = in_order_of(scene, baked.scene, baked.baked->transfer);
    baked.scene = scene;
}

namespace {

/// Reads the texels of a file, and their transfer into `baked` or `compressed`; empty if it has none.
std::optional<LightmapOfFile> read_texels(const GltfDocument& document, const Scene& scene, const Path& path,
                                          std::optional<BakedTransfer>& baked,
                                          std::optional<CompressedTransfer>& compressed) {
    if (std::optional<BakedLightmap> raw = read_lightmap(document, scene)) {
        std::vector<Edge> edges = lightmap_edges(raw->layout, raw->texels, raw->seams);
        baked = std::move(raw->baked);
        return LightmapOfFile{std::move(raw->layout), std::move(raw->texels), std::move(raw->areas),
                              std::move(raw->seams), std::move(edges)};
    }
    std::optional<EncodedLightmap> encoded = read_encoded_lightmap(document, scene);
    if (!encoded)
        return std::nullopt;
    CompressedLightmap shipped = about(path, [&] { return decoded_lightmap(std::move(*encoded)); });
    compressed = std::move(shipped.compressed);
    return LightmapOfFile{std::move(shipped.layout)};
}

} // namespace

SceneFile load_scene_file(const FileSource& file, const ReadingOptions& options) {
    return scene_file_of(file.read(options), file.path, options.notify, options.shared);
}

SceneFile scene_file_of(GltfDocument document, const Path& path, const Notify& notify,
                        SharedTransfer shared) {
    Scene scene = extract_scene(document);
    std::optional<BakedTransfer> baked;
    std::optional<CompressedTransfer> compressed;
    std::optional<InstancedModel> instanced;
    if (shares_instances(document)) {
        instanced = read_instanced(document, scene, path);
    }
    if (instanced && shared == SharedTransfer::expand) {
        baked = instanced->baked
                    ? std::exchange(instanced->baked, {})
                    : BakedTransfer{decode(instanced->compressed->transfer), instanced->compressed->record};
        baked->transfer = expanded(document, scene, instanced->stored, baked->transfer);
    }
    std::optional<LightmapOfFile> lightmap = read_texels(document, scene, path, baked, compressed);
    if (!lightmap && !instanced) {
        baked = read_transfer(document, scene);
        compressed = read_clustered(document, scene);
    }
    if (!baked && !compressed) // with transfer, the notices were shown when it was baked
        send(notify, path, scene.notices);
    SceneFile file{.document = std::move(document),
                   .scene = std::move(scene),
                   .baked = std::move(baked),
                   .compressed = std::move(compressed),
                   .lightmap = std::move(lightmap)};
    if (file.record())
        mark_media(file.scene, *file.record());
    file.volume = read_volume(file.document, file.scene);
    file.compressed_volume = read_compressed_volume(file.document, file.scene);
    file.occluders = read_occluders(file.document);
    file.lobes = read_lobes(file.document, file.scene);
    file.instanced = std::move(instanced);
    if (has_levels(file.document))
        extract_levels(file.document);
    return file;
}

BakedLightmap take_baked_lightmap(SceneFile& model) {
    LightmapOfFile& lightmap = *model.lightmap;
    return {std::move(lightmap.layout), std::move(lightmap.texels), std::move(lightmap.areas),
            std::move(lightmap.seams), std::move(*model.baked)};
}

ModelToPassOn load_to_pass_on(const Path& path, const ReadingOptions& options) {
    SceneFile file = load_scene_file(path, options);
    const bool transfer = file.record() != nullptr;
    if (transfer)
        send(options.notify, path, file.scene.notices);
    return {std::move(file.document), std::move(file.scene), transfer};
}

Environment load_environment_map(const Path& path, const EnvironmentOptions& options, const Notify& notify) {
    EnvironmentFile file = load_environment(path, options);
    send(notify, path, file.notices);
    if (file.repaired_pixels > 0)
        send(notify, path, {counted(file.repaired_pixels, "bad pixel was", "bad pixels were") + " repaired"});
    if (file.low_dynamic_range)
        send(notify, path,
             {"has 8 bits per channel: it is read as sRGB, and light brighter than white "
              "(suns, lamps) is clipped; use .exr or .hdr"});
    return std::move(file.environment);
}

std::string suffix_of(const Path& path) {
    std::string suffix = path.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix;
}

} // namespace prt::pipeline
