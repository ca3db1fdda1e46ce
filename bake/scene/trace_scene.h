#pragma once

// A scene with all data that tracers of light need.

#include "bake/scene/ray_scene.h"
#include "bake/scene/surfaces.h"

#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace prt {

/// Settings of `TraceScene`.
struct TraceSceneOptions {
    /// [materials] true: the material has a medium inside and is not a thin sheet; empty: false for all.
    std::vector<bool> solid = {};
    int threads = 0; ///< number of threads that build the hierarchy and that tracers use; 0: all
};

/// A scene with the data for tracing light: textures, optical properties of surfaces, and a hierarchy of the
/// triangles. Owns all data except the `Scene`. Cannot be copied or moved, because tracers keep references to
/// it. Const functions are thread-safe.
class TraceScene {
public:
    /// Keeps a reference to `scene`. `textures`: load_textures(scene), or empty to ignore all textures.
    explicit TraceScene(const Scene& scene, std::vector<Texture> textures = {},
                        const TraceSceneOptions& options = {})
        : TraceScene(std::make_shared<const std::vector<Texture>>(std::move(textures)), scene, options) {}
    /// Shares the textures of `other`, whose scene has the same images.
    static TraceScene sharing(const TraceScene& other, const Scene& scene, const TraceSceneOptions& options) {
        return TraceScene(other.textures_, scene, options);
    }
    TraceScene(const TraceScene&) = delete;
    TraceScene& operator=(const TraceScene&) = delete;

    const Scene& scene() const { return scene_; }
    /// Returns the textures of the constructor: [images of the scene], or empty.
    const std::vector<Texture>& textures() const { return *textures_; }
    const Surfaces& surfaces() const { return surfaces_; }
    /// Returns TraceSceneOptions::threads; 0: all.
    int threads() const { return threads_; }
    /// Returns the hierarchy of triangles. The first call builds the hierarchy, and throws the errors of
    /// RayScene::RayScene if it fails; the next call then tries again.
    const RayScene& rays() const {
        std::call_once(built_, [this] { rays_.emplace(scene_, threads_); });
        return *rays_;
    }

private:
    TraceScene(std::shared_ptr<const std::vector<Texture>> textures, const Scene& scene,
               const TraceSceneOptions& options)
        : scene_(scene), textures_(std::move(textures)), surfaces_(scene, *textures_, options.solid),
          threads_(options.threads) {}

    const Scene& scene_;
    std::shared_ptr<const std::vector<Texture>> textures_;
    Surfaces surfaces_;
    int threads_;
    mutable std::once_flag built_;
    mutable std::optional<RayScene> rays_;
};

} // namespace prt
