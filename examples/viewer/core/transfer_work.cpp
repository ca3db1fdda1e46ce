// Loads, bakes, compresses and saves the transfer of the open model.

#include "core/transfer_work.h"

#include "bake/gltf/reorder.h"
#include "compress/study/receiver_colors.h"
#include "prt/bake/bake.h"
#include "prt/bake/lightmap_bake.h"
#include "prt/compress/search.h"
#include "prt/core/error.h"
#include "prt/render/lightmap_file.h"

#include <fmt/core.h>

namespace viewer {
namespace {

/// Rays of the stages: a first picture at once, then better ones.
constexpr int kBakeRays[] = {16, 128, 1024};

/// Returns the areas and edges of the receivers for the compressor.
prt::SceneSurface surface_of(const LoadedModel& loaded) {
    if (!loaded.of_texels())
        return prt::SceneSurface(loaded.model->scene);
    const prt::BakedLightmap& lightmap = *loaded.lightmap.baked;
    prt::SceneSurface surface;
    surface.areas = lightmap.areas;
    surface.edges = prt::lightmap_edges(lightmap.layout, lightmap.texels, lightmap.seams);
    surface.jumps = prt::seam_jumps(loaded.model->scene, lightmap.layout, lightmap.texels);
    return surface;
}

/// Compresses with the preset, fitted to small meshes as `prt compress` does, if the settings match its
/// sizes; otherwise with the given settings.
prt::CompressResult compressed_as(const CompressionSettings& how, const LoadedModel& loaded,
                                  const prt::Progress& progress) {
    const prt::Transfer transfer = truncated(*loaded.raw, how.order);
    prt::CompressOptions options{.coding = prt::preset_u32x4()};
    if (loaded.of_texels()) // texels have no normals
        options.predictors = prt::PredictorChoice::none;
    const prt::SceneSurface owner = surface_of(loaded);
    const prt::ReceiverSurface surface = owner.view();
    if (how.clusters == options.clusters && how.components == options.coding.components)
        return prt::compress_preset(transfer, surface, options, progress).result;
    options.clusters = how.clusters;
    // The number of bits per component is that of the preset.
    options.coding = {.components = how.components, .bits = 6 * how.components};
    return prt::compress(transfer, surface, options, progress);
}

/// Takes over the transfer of texels that `loaded` lacks from `other`. Returns the reason if it cannot; empty
/// on success.
std::string add_lightmap(LoadedModel& loaded, const LoadedModel& other) {
    if (*loaded.lightmap.layout() != *other.lightmap.layout() ||
        loaded.model->receivers_id != other.model->receivers_id)
        return "its maps differ from those of ";
    if (!loaded.lightmap.compressed && other.lightmap.compressed)
        loaded.set(other.lightmap.compressed);
    else if (!loaded.lightmap.baked && other.lightmap.baked)
        loaded.set(other.lightmap.baked);
    else
        return "contains no additional transfer for ";
    return "";
}

/// Takes over the transfer of vertices that `loaded` lacks. Returns true on success.
bool add_vertices(LoadedModel& loaded, LoadedModel other) {
    if (loaded.compressed && !loaded.raw && other.raw) {
        loaded.raw = std::make_shared<const prt::Transfer>(
            prt::in_order_of(loaded.model->scene, other.model->scene, *other.raw));
        return true;
    }
    if (loaded.raw && !loaded.compressed && other.compressed) {
        other.raw = std::make_shared<const prt::Transfer>(
            prt::in_order_of(other.model->scene, loaded.model->scene, *loaded.raw));
        loaded = std::move(other);
        return true;
    }
    return false;
}

/// Takes over the transfer that `loaded` lacks, for the same kind of receivers. Returns the reason if it
/// cannot; empty on success.
std::string add_transfer(LoadedModel& loaded, LoadedModel other) {
    const bool same_surface = loaded.model->surface_id == other.model->surface_id;
    // Vertices may be split differently; the maps then differ in the same way.
    if (loaded.of_texels() && same_surface)
        return add_lightmap(loaded, other);
    if (loaded.model->receivers_id != other.model->receivers_id)
        return "contains a different scene than ";
    return add_vertices(loaded, std::move(other)) ? "" : "contains no additional transfer for ";
}

/// Adds `other` to the open scene: its transfer if the receivers are equal, otherwise the whole model as the
/// second one. Returns the reason if it cannot; empty on success.
std::string add_model(OpenModels& open, LoadedModel other) {
    if (open.first.receivers() == other.receivers())
        return add_transfer(open.first, std::move(other));
    if (open.first.model->surface_id != other.model->surface_id)
        return "contains a different scene than ";
    if (open.beside.model)
        return add_transfer(open.beside, std::move(other));
    open.beside = std::move(other);
    if (open.first.of_texels())
        std::swap(open.first, open.beside);
    return "";
}

} // namespace

OpenModels load_together(const std::vector<std::filesystem::path>& paths, const OpenModels& open) {
    OpenModels models{load_model(paths.front()), {}};
    for (std::size_t i = 1; i < paths.size(); ++i)
        if (const std::string why = add_model(models, load_model(paths[i])); !why.empty())
            throw prt::Error(paths[i].string() + ": " + why + paths.front().string());
    for (const LoadedModel* before : {&open.first, &open.beside})
        if (before->model)
            add_model(models, *before); // only if it holds this scene
    return models;
}

Baked bake_in_stages(Channel& channel, const Model& model) {
    Baked baked;
    for (const int rays : kBakeRays) {
        channel.enter(Stage::baking, fmt::format("baking with {} rays", rays));
        prt::BakeOptions options;
        options.order = kBakeOrder;
        options.rays = rays;
        options.bounces = kBakeBounces;
        options.repairs.bad_textures = prt::BadTextures::ignore;
        prt::BakedTransfer result = prt::bake(model.scene, options, channel.progress()).baked;
        baked = {std::make_shared<const prt::Transfer>(std::move(result.transfer)), result.record};
        channel.post(baked);
    }
    return baked;
}

Compressed compress_as(Channel& channel, const LoadedModel& loaded, const CompressionSettings& how) {
    channel.enter(Stage::compressing, loaded.of_texels() ? "compressing the lightmap" : "compressing");
    prt::ClusteredTransfer transfer = compressed_as(how, loaded, channel.progress()).transfer;
    Compressed compressed{.model = loaded.model, .how = how};
    if (!loaded.of_texels()) {
        compressed.transfer = std::make_shared<const prt::ClusteredTransfer>(std::move(transfer));
        return compressed;
    }
    compressed.lightmap = std::make_shared<const prt::CompressedLightmap>(
        prt::scatter_to_maps(*loaded.lightmap.baked, std::move(transfer)));
    return compressed;
}

void save_compressed(const LoadedModel& loaded, const std::filesystem::path& output) {
    const Model& model = *loaded.model;
    prt::GltfDocument document = prt::load_gltf(model.path, {.leave_out_lobes = true});
    const prt::Scene scene = prt::extract_scene(document);
    if (prt::receivers_id(scene) != model.receivers_id)
        throw prt::Error(model.path.string() + ": the file has changed since it was opened");
    if (loaded.of_texels())
        prt::write_encoded_lightmap(document, scene, prt::encoded_lightmap(*loaded.lightmap.compressed));
    else
        prt::write_clustered(document, scene, {*loaded.compressed, loaded.record});
    prt::save_glb(document, output);
}

std::vector<std::pair<PictureKind, std::vector<glm::vec3>>>
number_pictures(const LoadedModel& loaded, const prt::Lighting& lighting, const LampSettings& lamps) {
    std::vector<std::pair<PictureKind, std::vector<glm::vec3>>> pictures;
    pictures.emplace_back(PictureKind::clusters, prt::cluster_colors(*loaded.compressed));
    pictures.emplace_back(PictureKind::components, prt::component_colors(*loaded.compressed));
    if (!loaded.raw)
        return pictures;
    const prt::BakedLightmap* lightmap = loaded.lightmap.baked.get();
    const prt::ClusteredTransfer picked =
        lightmap ? prt::gather_texels(*loaded.compressed, lightmap->texels) : prt::ClusteredTransfer();
    const prt::ClusteredTransfer& compressed = lightmap ? picked : *loaded.compressed;
    const std::vector<prt::Edge> of_texels =
        lightmap ? prt::lightmap_edges(lightmap->layout, lightmap->texels, lightmap->seams)
                 : std::vector<prt::Edge>();
    const std::vector<prt::Edge>& edges = lightmap ? of_texels : loaded.model->edges;
    const std::vector<float>& areas = lightmap ? lightmap->areas : loaded.model->areas;
    const auto reference =
                   prt::exit_radiance(*loaded.raw, with_lamps(lighting, lamps, loaded.raw->layout), 1),
               approximation =
                   prt::exit_radiance(compressed, with_lamps(lighting, lamps, compressed.bases.layout), 1);
    const auto add = [&](PictureKind kind, std::vector<glm::vec3> colors) {
        pictures.emplace_back(kind, lightmap
                                        ? prt::scatter_to_maps(lightmap->layout, lightmap->texels, colors)
                                        : std::move(colors));
    };
    add(PictureKind::error, prt::error_colors(reference, approximation, areas));
    add(PictureKind::seams,
        prt::seam_colors(reference, approximation, areas, edges, compressed.receivers.cluster_indices()));
    return pictures;
}

} // namespace viewer
