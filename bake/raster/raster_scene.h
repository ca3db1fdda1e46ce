#pragma once

// A scene in the buffers that depth maps are drawn from.

#include "bake/scene/trace_scene.h"
#include "runtime/render/gl/gl_objects.h"

#include <string>

namespace prt {

class RasterScene {
public:
    /// Uploads the scene. A context must be current. Throws `Error` when memory runs out.
    explicit RasterScene(const TraceScene& scene);

    std::size_t triangles() const { return triangles_; }
    /// Preprocessor definitions for shaders that draw the scene.
    std::string defines() const;
    void bind() const;

private:
    GlObject corners_, alpha_triangles_, alpha_materials_, alpha_texels_;
    std::size_t triangles_ = 0;
    bool has_alpha_ = false;
};

} // namespace prt
