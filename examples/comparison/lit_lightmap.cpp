// Unwraps a scene, bakes a lightmap for it and compresses it.

#include "lit_lightmap.h"

#include "bake/products/lightmaps/unwrap.h"
#include "prt/bake/lightmap_bake.h"
#include "prt/compress/search.h"
#include "prt/render/lightmap_file.h"

namespace comparison {

LitLightmap make_lightmap(const std::filesystem::path& scene, int size, int order, int rays) {
    prt::GltfDocument document = prt::load_gltf(scene);
    prt::Scene charted = prt::extract_scene(document);
    prt::Unwrapping unwrapping = prt::unwrap(charted, {.size = size, .atlases = prt::AtlasMode::one});
    const int set = prt::free_texcoord(charted);
    for (prt::Atlas& atlas : unwrapping.atlases)
        atlas.uv_set = set;
    document = prt::with_texcoords(std::move(document), charted, unwrapping.primitives, set);

    LitLightmap result;
    result.model = viewer::make_model(prt::extract_scene(document), scene);
    prt::BakeOptions options;
    options.order = order;
    options.rays = rays;
    options.bounces = prt::kEndlessBounces;
    options.tracer.backend = prt::Backend::cpu;
    options.repairs.bad_textures = prt::BadTextures::ignore;
    options.lamps.mode = prt::LampMode::none;
    const prt::BakedLightmap baked =
        prt::bake_lightmap(result.model->scene, unwrapping.atlases, options).lightmap;

    prt::SceneSurface surface;
    surface.areas = baked.areas;
    surface.edges = prt::lightmap_edges(baked.layout, baked.texels, baked.seams);
    surface.jumps = prt::seam_jumps(result.model->scene, baked.layout, baked.texels);
    prt::CompressOptions how{.coding = prt::preset_u64()};
    how.predictors = prt::PredictorChoice::none; // texels have no normals
    prt::CompressResult compressed = prt::compress_preset(baked.baked.transfer, surface.view(), how).result;
    result.bytes_per_texel = compressed.statistics.bytes_with_bases(baked.texels.size());
    result.lightmap = prt::scatter_to_maps(baked, std::move(compressed.transfer));
    return result;
}

} // namespace comparison
