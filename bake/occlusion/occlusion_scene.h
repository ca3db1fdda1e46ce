#pragma once

#include "prt/ambient_occlusion.h"
#include "prt/trace_scene.h"

#include <memory>
#include <string>
#include <vector>

namespace prt {

/// The bake that gives occlusion.
BakeOptions bake_options(const OcclusionOptions& options);

/// A scene and what traces it, with the fall-off that is asked for.
class OcclusionScene {
public:
    /// Keeps a reference to `scene`. Throws as `bake` does.
    OcclusionScene(const Scene& scene, const OcclusionOptions& options);
    const TraceScene& scene() const { return scene_; }
    Tracer& tracer() const { return *tracer_; }
    const std::vector<std::string>& notices() const { return notices_; }

private:
    BakeOptions options_;
    TraceScene scene_;
    std::unique_ptr<Tracer> tracer_;
    std::vector<std::string> notices_;
};

} // namespace prt
