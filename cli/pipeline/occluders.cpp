// Bakes occlusion volumes of the rigid parts of a file.

#include "cli/pipeline/occluders.h"

#include "bake/gltf/rigid_parts.h"
#include "prt/core/error.h"
#include "prt/gltf/transfer_gltf.h"
#include "runtime/core/support/counted.h"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>

namespace prt::pipeline {
namespace {

/// Lengths of a frame's axes differ by more than a hundredth.
bool is_uneven(const glm::dmat4& frame) {
    const double x = glm::length(glm::dvec3(frame[0])), y = glm::length(glm::dvec3(frame[1])),
                 z = glm::length(glm::dvec3(frame[2]));
    return std::max({x, y, z}) > 1.01 * std::min({x, y, z});
}

Table table_of_parts() {
    Table table{"occlusion_volumes", "Occlusion volumes", "", {}, {}};
    table.about =
        "Fraction of light that each rigid object blocks, for receivers at random positions in its box with "
        "random normals: the mean, and the mean difference from ray tracing.";
    table.columns = {{"object", "object"},
                     {"triangles", "triangles"},
                     {"mean_blocked", "mean blocked", Unit::percent, 2},
                     {"mean_error", "mean error", Unit::percent, 2}};
    return table;
}

/// Volumes of all parts, and their figures for the report.
struct BakedParts {
    std::vector<NodeOccluder> occluders;
    std::vector<OcclusionVolume> volumes;
    std::vector<glm::dmat4> frames;
    Table table = table_of_parts();
    Json uneven = Json::array(), left_out = Json::array();
    double error = 0;
    std::size_t rays = 0;
};

BakedParts bake_parts(const std::vector<RigidPart>& parts, const OccluderOptions& options,
                      const Progress& progress) {
    BakedParts all;
    const auto share = [&](std::size_t n) {
        return static_cast<double>(n) / static_cast<double>(parts.size());
    };
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const RigidPart& part = parts[i];
        try {
            const OccluderBake one =
                bake_occluder(part.scene, part.frame, options, progress.range(share(i), share(i + 1)));
            all.occluders.push_back({part.node, one.volume});
            all.volumes.push_back(one.volume);
            all.frames.push_back(part.frame);
            all.table.rows.push_back({part.name, part.scene.triangles(), one.mean_blocked, one.mean_error});
            all.error += one.mean_error;
            all.rays += one.rays;
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& failed) {
            all.left_out.push_back(fmt::format("{}: {}", part.name, failed.what()));
            continue;
        }
        if (is_uneven(part.frame))
            all.uneven.push_back(part.name);
    }
    if (all.occluders.empty())
        throw Error(all.left_out.front().get<std::string>());
    return all;
}

/// Returns the objects, with triangles of the high-poly model if there is one; DetailedParts::scene is empty
/// without it.
DetailedParts parts_of(const OccluderRequest& request, const GltfDocument& document, const Scene& scene) {
    if (request.high_poly.empty())
        return {.parts = rigid_parts(document, scene)};
    const GltfDocument high_poly = load_gltf(request.high_poly, request.reading);
    const Scene finer = extract_scene(high_poly);
    DetailedParts detailed = detailed_parts(document, scene, high_poly, finer);
    std::vector<std::string> notices = finer.notices;
    if (!detailed.own.empty())
        notices.push_back(
            fmt::format("has no nodes with triangles for these objects, which keep their own: {}",
                        fmt::join(detailed.own, ", ")));
    if (detailed.unused > 0)
        notices.push_back(fmt::format("{} no object with the name of their node, and block no light",
                                      counted(detailed.unused, "triangle has", "triangles have")));
    send(request.notify, request.high_poly, notices);
    return detailed;
}

} // namespace

Report bake_occluders(GltfDocument& document, const Scene& scene, const OccluderRequest& request,
                      const Progress& progress) {
    const DetailedParts objects = parts_of(request, document, scene);
    const BakedParts baked = bake_parts(objects.parts, request.options, progress.range(0, 0.9));
    write_occluders(document, baked.occluders);
    const FloorOcclusion floor =
        floor_occlusion(request.high_poly.empty() ? scene : objects.scene, baked.volumes, baked.frames,
                        request.options, progress.range(0.9, 1));
    Report report;
    add_figures(report, {{"objects", baked.occluders.size()},
                         {"objects_omitted", baked.left_out},
                         {"bytes_volumes", baked.occluders.size() * sizeof(OcclusionVolume::texels)},
                         {"rays", baked.rays},
                         {"mean_error", baked.error / static_cast<double>(baked.occluders.size())},
                         {"floor_mean_blocked", floor.mean_blocked},
                         {"floor_mean_error", floor.mean_error},
                         {"floor_max_error", floor.largest_error},
                         {"objects_scaled_nonuniformly", baked.uneven}});
    report.sentences = {
        "{output}: occlusion volumes of {objects:#rigid object}, {bytes_volumes} bytes; mean error "
        "{mean_error:.2f%} of the light of receivers nearby",
        "all objects together, on the floor below: {floor_mean_blocked:.2f%} of the light blocked, mean "
        "error {floor_mean_error:.2f%} against ray tracing, maximum {floor_max_error:.2f%}"};
    if (!baked.uneven.empty())
        report.sentences.push_back(
            "directions of occlusion are approximate for objects with non-uniform scale");
    for (std::size_t i = 0; i < baked.left_out.size(); ++i)
        report.sentences.push_back(fmt::format("omitted: {{objects_omitted/{}}}", i));
    report.tables.push_back(baked.table);
    return report;
}

} // namespace prt::pipeline
