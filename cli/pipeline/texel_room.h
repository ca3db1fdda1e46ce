#pragma once

// Space for texels in texture coordinates, and high-poly models.

#include "cli/pipeline/model.h"
#include "cli/report/report.h"
#include "prt/bake/ambient_occlusion.h"
#include "prt/bake/texels.h"

#include <optional>
#include <vector>

namespace prt::pipeline {

/// Textures to bake into, and the model whose surface is measured.
/// A high-poly model.
struct HighPolyRequest {
    Path file;                      ///< model whose surface blocks light and is lit, in place of the scene
    std::optional<double> distance; ///< maximum distance of that surface, metres

    /// Returns `distance`, by default a fiftieth of the extent of `scene`.
    double distance_in(const Scene& scene) const;
};

struct TexelRequest {
    TexelOptions texels;
    bool unwrap = false; ///< write new texture coordinates if the existing ones do not fit
    HighPolyRequest high_poly;

    /// True if textures are requested.
    bool given() const { return texels.size > 0 || texels.per_metre > 0; }
};

/// The high-poly model, and its maximum distance.
struct HighPoly {
    std::optional<Scene> scene;
    double distance = 0;

    FinerModel model() const { return {scene ? &*scene : nullptr, distance}; }
};
/// Returns no scene without a high-poly model.
HighPoly load_high_poly(const TexelRequest& request, const GltfOptions& reading, const Scene& scene,
                        const Notify& notify);

/// Textures for the scene, and figures about their layout.
struct TexelRoom {
    std::vector<Atlas> atlases;
    Json figures = Json::object();
};
/// Finds space for all surfaces of `scene`, read from `path`. With `unwrap`, document and scene get new
/// coordinates if the existing ones have no space for every surface. Throws `Error`.
TexelRoom make_room(const TexelRequest& request, const Path& path, GltfDocument& document, Scene& scene,
                    const Notify& notify);

} // namespace prt::pipeline
