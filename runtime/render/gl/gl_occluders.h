#pragma once

// Occlusion volumes on the GPU. An OpenGL 4.5 context must be current.

#include "prt/core/occlusion_volume.h"
#include "runtime/render/gl/gl_objects.h"

#include <span>

namespace prt {

/// Occlusion volumes on the GPU, for shaders that include `shaders/prt_occluders.glsl`.
class GlOccluders {
public:
    /// Uploads copies of `volumes` into one 3D texture. Slot i of the texture is volumes[i]: the argument
    /// `slot` of `placed`. `volumes` may be empty. Throws `Error` if the device does not support a 3D texture
    /// with a depth of 8 texels per volume, or if GPU memory runs out.
    explicit GlOccluders(std::span<const OcclusionVolume> volumes);

    /// Selects the occluders of subsequent draws: copies `objects` to the uniform block, and binds the block
    /// and the texture. `objects`: results of `placed`. Throws `Error` for more than kMaxOccluders objects.
    void use(std::span<const PlacedOccluder> objects);

private:
    GlObject texture_, block_;
};

} // namespace prt
