// Reads figures and measures their occluders; reads or bakes volumes.

#include "core/moving_work.h"

#include "core/transfer_work.h"

#include "bake/gltf/rigid_parts.h"
#include "prt/bake/ambient_occlusion.h"
#include "prt/bake/volume_bake.h"
#include "prt/compress/compress.h"
#include "prt/core/error.h"
#include "prt/gltf/transfer_gltf.h"

#include <fmt/core.h>

#include <algorithm>

namespace viewer {
namespace {

/// Rays and order of the stages: the first light at once, then better ones. Compression time grows with the
/// square of the number of bands, so the first stages have few.
struct VolumeStage {
    int rays, order;
};
constexpr VolumeStage kVolumeStages[] = {{32, 2}, {128, 3}, {512, kBakeOrder}};
/// Limit for volumes that the viewer bakes itself: seconds on a few cores.
constexpr std::size_t kMaxProbes = 3000;
constexpr int kOccluderRays = 64;
constexpr int kProbesOfCluster = 32, kMaxClusters = 256;

bool is_animated(const std::filesystem::path& path) {
    return prt::has_animations(prt::load_gltf(path));
}

std::shared_ptr<const prt::CompressedVolume> compressed(Channel& channel, const prt::BakedVolume& volume) {
    channel.enter(Stage::compressing, "compressing the volume");
    prt::CompressOptions options;
    options.coding = prt::preset_volume();
    options.clusters =
        std::clamp(static_cast<int>(volume.visibility.size()) / kProbesOfCluster, 1, kMaxClusters);
    return std::make_shared<const prt::CompressedVolume>(
        prt::compress_volume(volume, options, channel.progress()).volume);
}

void bake_in_stages(Channel& channel, const std::shared_ptr<const Model>& model) {
    for (const auto& [rays, order] : kVolumeStages) {
        channel.enter(Stage::baking, fmt::format("baking the volume with {} rays", rays));
        prt::BakeOptions options;
        options.order = order;
        options.rays = rays;
        options.bounces = kBakeBounces;
        options.repairs.bad_textures = prt::BadTextures::ignore;
        const prt::VolumeOptions volume{.probes = kMaxProbes};
        const prt::VolumeBake bake = prt::bake_volume(model->scene, volume, options, channel.progress());
        channel.post(FoundVolume{model, compressed(channel, bake.volume), rays});
    }
}

std::vector<prt::NodeOccluder> measured_occluders(Channel& channel, const prt::GltfDocument& document,
                                                  const prt::Scene& scene) {
    channel.enter(Stage::occlusion, "measuring occlusion of the figure");
    prt::OccluderOptions options;
    options.rays = kOccluderRays;
    options.repairs.bad_textures = prt::BadTextures::ignore;
    std::vector<prt::NodeOccluder> occluders;
    for (const prt::RigidPart& part : prt::rigid_parts(document, scene)) {
        channel.progress().check();
        try {
            occluders.push_back({part.node, prt::bake_occluder(part.scene, part.frame, options).volume});
        } catch (const prt::Cancelled&) {
            throw;
        } catch (const prt::Error&) {
            channel.progress().check(); // a part without extent does not block light
        }
    }
    return occluders;
}

} // namespace

SortedFiles sort_files(const std::vector<std::filesystem::path>& paths, bool scene_open) {
    SortedFiles sorted;
    for (const std::filesystem::path& path : paths)
        (is_animated(path) ? sorted.figures : sorted.scenes).push_back(path);
    if (!scene_open && sorted.scenes.empty() && !sorted.figures.empty()) {
        sorted.scenes.push_back(sorted.figures.front());
        sorted.figures.erase(sorted.figures.begin());
    }
    return sorted;
}

void find_figure(Channel& channel, const std::filesystem::path& path) {
    const prt::GltfDocument document = prt::load_gltf(path);
    const auto figure = std::make_shared<const prt::AnimatedScene>(document);
    std::shared_ptr<const prt::LobeModel> lobes;
    if (auto stored = prt::read_lobes(document, figure->scene()))
        lobes = std::make_shared<const prt::LobeModel>(std::move(stored->model));
    channel.post(FigureFile{path, figure, std::move(lobes)});
    std::vector<prt::NodeOccluder> occluders = prt::read_occluders(document);
    if (occluders.empty())
        occluders = measured_occluders(channel, document, figure->scene());
    channel.post(FoundOccluders{figure, std::move(occluders)});
}

void find_volume(Channel& channel, const std::shared_ptr<const Model>& model) {
    channel.enter(Stage::reading, "reading the volume");
    const prt::GltfDocument document = prt::load_gltf(model->path, {.leave_out_lobes = true});
    const prt::Scene scene = prt::extract_scene(document);
    if (prt::receivers_id(scene) != model->receivers_id)
        throw prt::Error(model->path.string() + ": the file has changed since it was opened");
    if (auto volume = prt::read_compressed_volume(document, scene))
        return channel.post(
            FoundVolume{model, std::make_shared<const prt::CompressedVolume>(std::move(*volume)), 0});
    if (const auto volume = prt::read_volume(document, scene))
        return channel.post(FoundVolume{model, compressed(channel, *volume), 0});
    bake_in_stages(channel, model);
}

} // namespace viewer
