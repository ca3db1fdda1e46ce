#include "core/transfer_work.h"

#include "prt/bake.h"
#include "prt/receiver_colors.h"
#include "prt/reorder.h"
#include "prt/search.h"
#include "prt/support/error.h"

#include <fmt/core.h>

namespace viewer {
namespace {

/// A first picture at once, then better ones.
constexpr int kBakeRays[] = {16, 128, 1024};

/// The preset where its own sizes are asked for, made to fit small meshes as `prt compress` does; else as
/// asked.
prt::CompressResult compressed_as(const CompressionSettings& how, const prt::Transfer& transfer,
                                  const Model& model, const prt::Progress& progress) {
    prt::CompressOptions options{.coding = prt::preset_u32x4()};
    const prt::SceneSurface owner(model.scene);
    const prt::ReceiverSurface surface = owner.view();
    if (how.clusters == options.clusters && how.components == options.coding.components)
        return prt::compress_preset(transfer, surface, options, progress).result;
    options.clusters = how.clusters;
    // As many bits for each component as the preset has.
    options.coding = {.components = how.components, .bits = 6 * how.components};
    return prt::compress(transfer, surface, options, progress);
}

/// Takes over from `other` the transfer that `loaded` lacks; false where there is none, or the scenes differ.
bool add_transfer(LoadedModel& loaded, LoadedModel other) {
    if (loaded.model->receivers_id != other.model->receivers_id)
        return false;
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

} // namespace

LoadedModel load_together(const std::vector<std::filesystem::path>& paths, const LoadedModel& open) {
    LoadedModel loaded = load_model(paths.front());
    for (std::size_t i = 1; i < paths.size(); ++i)
        if (!add_transfer(loaded, load_model(paths[i])))
            throw prt::Error(paths[i].string() + ": is another scene than " + paths.front().string() +
                             ", or adds no transfer to it");
    if (open.model)
        add_transfer(loaded, open);
    return loaded;
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

Compressed compress_as(Channel& channel, const Model& model, const prt::Transfer& raw,
                       const CompressionSettings& how) {
    channel.enter(Stage::compressing, "compressing");
    prt::CompressResult result = compressed_as(how, truncated(raw, how.order), model, channel.progress());
    return {std::make_shared<const prt::ClusteredTransfer>(std::move(result.transfer)), how};
}

void save_compressed(const Model& model, const prt::CompressedTransfer& compressed,
                     const std::filesystem::path& output) {
    prt::GltfDocument document = prt::load_gltf(model.path);
    const prt::Scene scene = prt::extract_scene(document);
    if (prt::receivers_id(scene) != model.receivers_id)
        throw prt::Error(model.path.string() + ": has changed since it was opened");
    prt::write_clustered(document, scene, compressed);
    prt::save_glb(document, output);
}

std::vector<std::pair<PictureKind, std::vector<glm::vec3>>>
number_pictures(const Model& model, const prt::Transfer* raw, const prt::ClusteredTransfer& compressed,
                const prt::Lighting& lighting, const LampSettings& lamps) {
    std::vector<std::pair<PictureKind, std::vector<glm::vec3>>> pictures;
    pictures.emplace_back(PictureKind::clusters, prt::cluster_colors(compressed));
    pictures.emplace_back(PictureKind::components, prt::component_colors(compressed));
    if (!raw)
        return pictures;
    const auto reference = prt::exit_radiance(*raw, with_lamps(lighting, lamps, raw->layout), 1),
               approximation =
                   prt::exit_radiance(compressed, with_lamps(lighting, lamps, compressed.bases.layout), 1);
    pictures.emplace_back(PictureKind::error, prt::error_colors(reference, approximation, model.areas));
    pictures.emplace_back(PictureKind::seams, prt::seam_colors(reference, approximation, model.areas,
                                                               model.edges, compressed.receivers.clusters));
    return pictures;
}

} // namespace viewer
