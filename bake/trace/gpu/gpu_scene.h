#pragma once

// A scene in the buffers that the bake shaders read.

#include "prt/gl_objects.h"
#include "prt/trace_scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace prt {

class GpuScene {
public:
    /// Builds the hierarchy and uploads. A context must be current. Throws `Error` when memory runs out.
    explicit GpuScene(const TraceScene& scene);

    bool has_alpha() const { return has_alpha_; }
    std::size_t triangles() const { return triangles_; }
    /// Where the triangle stands in the alpha table, counting from 1; 0: it is opaque.
    std::uint32_t alpha_index(std::uint32_t triangle) const { return alpha_index_[triangle]; }
    /// Defines for shaders that include bake_bvh.glsl.
    std::string defines() const;
    void bind() const;

private:
    GlObject nodes_, corners_, alpha_triangles_, alpha_materials_, alpha_texels_;
    std::vector<std::uint32_t> alpha_index_;
    int stack_size_ = 0;
    std::size_t triangles_ = 0;
    bool has_alpha_ = false;
};

} // namespace prt
