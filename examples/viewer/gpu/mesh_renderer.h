#pragma once

#include "gpu/lobe.h"

#include "runtime/render/gl/gl_objects.h"

#include <glm/mat4x4.hpp>

namespace viewer {

/// Draws colored meshes in front of the existing picture.
class MeshRenderer {
public:
    MeshRenderer();
    void draw(const ColoredMesh& mesh, const glm::mat4& view_projection, std::uint32_t framebuffer) const;

private:
    prt::GlObject program_;
};

} // namespace viewer
