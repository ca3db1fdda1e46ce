#pragma once

// A scene file in memory, and what the viewer computes of it once.

#include "pictures/triangle_clusters.h"

#include "prt/gltf.h"
#include "prt/mesh_edges.h"
#include "prt/picture.h"
#include "prt/support/progress.h"
#include "prt/trace_scene.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer {

/// Never changes once it is loaded; shared by threads.
struct Model {
    std::filesystem::path path;
    prt::Scene scene;                                   ///< triangles in the order of `clusters`
    std::vector<std::vector<TriangleCluster>> clusters; ///< [primitives]
    std::vector<float> areas;                           ///< [receivers]
    std::vector<prt::Edge> edges;
    prt::Bounds box{};
    glm::vec3 center{0};
    float radius = 1;
    std::string receivers_id;
    std::optional<prt::TraceScene> trace; ///< of `scene`

    Model() = default;
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;
};

/// What a file holds.
struct LoadedModel {
    std::shared_ptr<const Model> model;
    std::shared_ptr<const prt::Transfer> raw;
    std::shared_ptr<const prt::ClusteredTransfer> compressed;
    prt::BakeRecord record; ///< of the transfer
};

/// What the viewer needs of `scene`; textures that are missing or damaged are left out.
std::shared_ptr<const Model> make_model(prt::Scene scene, std::filesystem::path path);

/// Reads `path`. Throws `prt::Error`.
LoadedModel load_model(const std::filesystem::path& path);

/// Of a model from a place, a sample for each pixel; nothing but `radiance` lights it.
prt::Picture picture_of(const Model& model, std::span<const glm::vec3> radiance, const prt::Camera& camera,
                        int width, int height);

/// Share of the cosine-weighted hemisphere that is open, for every receiver.
std::vector<float> ambient_occlusion(const Model& model, const prt::Progress& progress);

/// The first bands of `transfer`.
prt::Transfer truncated(const prt::Transfer& transfer, int order);

} // namespace viewer
