// Adds vertex colors under one light to a compressed file.

#include "cli/pipeline/fallback.h"

#include "bake/gltf/encode_glb.h"
#include "bake/gltf/vertex_fallback.h"
#include "cli/pipeline/loaded_light.h"
#include "prt/gltf/levels.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::pipeline {

std::optional<Fallback> load_fallback(const Path& light, int order, const LightOptions& options,
                                      int threads) {
    if (light.empty())
        return std::nullopt;
    LoadedLight loaded = load_light(light, order, {0}, options, threads);
    return Fallback{{.sky = std::move(loaded.sky), .name = std::move(loaded.name)}};
}

std::vector<std::byte> with_fallback(std::span<const std::byte> file, const Path& path, Fallback& fallback,
                                     BufferCompression buffers, int threads) {
    GltfDocument document = parse_gltf(file, path);
    LeveledScene levels = extract_levels(document);
    const std::vector<float> areas = areas_of_level(levels, 0);
    const bool all = levels.nodes.empty() || levels_have_transfer(document, levels);
    const Scene scene = all ? std::move(levels.scene) : extract_scene(document);
    const std::optional<CompressedTransfer> compressed = read_clustered(document, scene);
    const std::vector<glm::vec3> radiance = exit_radiance(compressed->transfer, fallback.lighting, threads);
    fallback.exposure =
        fallback_exposure(radiance, std::span(areas).first(std::min(areas.size(), radiance.size())));
    fallback.primitives = write_fallback(document, scene, radiance, fallback.exposure);
    return encode_glb(document, buffers);
}

void report_fallback(const std::optional<Fallback>& fallback, Report& report) {
    if (!fallback)
        return;
    add_figures(report, {{"fallback",
                          {{"light", fallback->lighting.name},
                           {"exposure", fallback->exposure},
                           {"primitives", fallback->primitives}}}});
    report.sentences.emplace_back(
        "viewers without PRT show the model lit by {fallback/light}, at exposure {fallback/exposure:.4g}");
}

} // namespace prt::pipeline
