// Writes files of a ball on a floor, once per process.

#include "examples/viewer/lightmap_files.h"

#include "bake/products/lightmaps/unwrap.h"
#include "prt/bake/lightmap_bake.h"
#include "prt/compress/compress.h"
#include "prt/render/lightmap_file.h"
#include "support/glb_file.h"
#include "support/made_once.h"
#include "support/scene_builder.h"

namespace viewer {
namespace {

using prt::test::made_once;

/// Few rays: pictures are compared with others of the same transfer.
prt::BakeOptions rough_bake() {
    prt::BakeOptions options;
    options.order = 4;
    options.rays = 32;
    options.bounces = 1;
    options.tracer.backend = prt::Backend::cpu;
    return options;
}

} // namespace

LightmapFiles::LightmapFiles() {
    prt::test::scene_file(
        prt::test::SceneBuilder().floor({0, -0.5f, 0}, 1.5f, 10).sphere({0, 0, 0}, 0.5f, 12).build())
        .write(unbaked());
}

std::filesystem::path LightmapFiles::vertices() const {
    return made_once("vertices", folder_ / "vertices.glb", [&](const std::filesystem::path& path) {
        prt::GltfDocument document = prt::load_gltf(unbaked());
        const prt::Scene scene = prt::extract_scene(document);
        prt::write_transfer(document, scene, prt::bake(scene, rough_bake()).baked);
        prt::save_glb(document, path);
    });
}

std::filesystem::path LightmapFiles::raw(int size) const {
    return made_once("raw" + std::to_string(size), folder_ / "lightmap.glb",
                     [&](const std::filesystem::path& path) { write_raw(size, path); });
}

void LightmapFiles::write_raw(int size, const std::filesystem::path& path) const {
    prt::GltfDocument document = prt::load_gltf(unbaked());
    prt::Scene scene = prt::extract_scene(document);
    prt::Unwrapping unwrapping = prt::unwrap(scene, {.size = size});
    const int set = prt::free_texcoord(scene);
    document = prt::with_texcoords(std::move(document), scene, unwrapping.primitives, set);
    scene = prt::extract_scene(document);
    for (prt::Atlas& atlas : unwrapping.atlases)
        atlas.uv_set = set;
    prt::write_lightmap(document, scene,
                        prt::bake_lightmap(scene, unwrapping.atlases, rough_bake()).lightmap);
    prt::save_glb(document, path);
}

std::filesystem::path LightmapFiles::shipped(int size) const {
    return made_once("shipped" + std::to_string(size), folder_ / "lightmap.shipped.glb",
                     [&](const std::filesystem::path& path) { write_shipped(size, path); });
}

void LightmapFiles::write_shipped(int size, const std::filesystem::path& path) const {
    prt::GltfDocument document = prt::load_gltf(raw(size));
    const prt::Scene scene = prt::extract_scene(document);
    const prt::BakedLightmap lightmap = *prt::read_lightmap(document, scene);
    const prt::CompressOptions options{
        .clusters = 24, .coding = prt::preset_u64(), .predictors = prt::PredictorChoice::none};
    const std::vector<prt::Edge> edges =
        prt::lightmap_edges(lightmap.layout, lightmap.texels, lightmap.seams);
    prt::write_encoded_lightmap(
        document, scene,
        prt::encoded_lightmap(prt::scatter_to_maps(
            lightmap, prt::compress(lightmap.baked.transfer, {lightmap.areas, edges}, options).transfer)));
    prt::save_glb(document, path);
}

} // namespace viewer
