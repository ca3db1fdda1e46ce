#pragma once

// A scene for ambient occlusion.

#include "bake/scene/trace_scene.h"
#include "bake/trace/tracer.h"
#include "prt/bake/ambient_occlusion.h"

#include <memory>
#include <string>
#include <vector>

namespace prt {

/// Options of the bake that computes ambient occlusion.
BakeOptions bake_options(const OcclusionOptions& options);

/// A scene and its tracer, with the requested fall-off.
class OcclusionScene {
public:
    /// Keeps a reference to `scene`. Throws the same errors as `bake`.
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
