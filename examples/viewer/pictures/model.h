#pragma once

// A scene file in memory, and the data that the viewer computes once from it.

#include "pictures/picture_kind.h"
#include "pictures/triangle_clusters.h"

#include "bake/scene/trace_scene.h"
#include "prt/core/lightmap.h"
#include "prt/core/progress.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/render/picture.h"
#include "runtime/load/mesh_edges.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer {

/// Immutable after loading; shared by threads.
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
    std::uint64_t surface_id = 0;         ///< hash of the triangles' positions, independent of vertex sharing
                                          ///< and order
    std::optional<prt::TraceScene> trace; ///< for rays into `scene`

    Model() = default;
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;
};

/// Transfer of texels; both are null if the receivers are vertices.
struct LoadedLightmap {
    std::shared_ptr<const prt::BakedLightmap> baked;
    std::shared_ptr<const prt::CompressedLightmap> compressed; ///< transfer of all texels

    const prt::LightmapLayout* layout() const {
        return compressed ? &compressed->layout : baked ? &baked->layout : nullptr;
    }
};

/// Content of a file.
struct LoadedModel {
    std::shared_ptr<const Model> model;
    std::shared_ptr<const prt::Transfer> raw;
    std::shared_ptr<const prt::ClusteredTransfer> compressed;
    prt::BakeRecord record;  ///< record of the transfer
    LoadedLightmap lightmap; ///< set if the receivers are texels; `raw` and `compressed` are parts of it
    /// Set if instances share compressed transfer; `compressed` is then null.
    std::shared_ptr<const prt::InstancedModel> instanced;

    bool has_transfer() const { return raw || compressed || instanced; }

    bool of_texels() const { return lightmap.layout() != nullptr; }
    Receivers receivers() const { return of_texels() ? Receivers::texels : Receivers::vertices; }
    void set(std::shared_ptr<const prt::BakedLightmap> baked);
    void set(std::shared_ptr<const prt::CompressedLightmap> of_all_texels);
};

/// Prepares `scene` for the viewer; missing or damaged textures are ignored.
std::shared_ptr<const Model> make_model(prt::Scene scene, std::filesystem::path path);

/// Reads `path`. Throws `prt::Error`.
LoadedModel load_model(const std::filesystem::path& path);

/// Draws the model with one sample per pixel; only `radiance` lights it.
prt::Picture picture_of(const Model& model, std::span<const glm::vec3> radiance, const prt::Camera& camera,
                        int width, int height);

/// Returns the open fraction of the cosine-weighted hemisphere for every receiver.
std::vector<float> ambient_occlusion(const Model& model, const prt::Progress& progress);

/// Returns the first bands of `transfer`.
prt::Transfer truncated(const prt::Transfer& transfer, int order);

} // namespace viewer
