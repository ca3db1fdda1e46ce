#pragma once

// Occlusion volumes on the GPU.

#include "prt/gl_objects.h"
#include "prt/occlusion_volume.h"

#include <span>

namespace prt {

/// Occlusion volumes on the GPU, for shaders that include `shaders/prt_occluders.glsl`.
class GlOccluders {
public:
    /// Slot i of the texture is volume i. Throws `Error` if the device does not support a texture of this
    /// depth.
    explicit GlOccluders(std::span<const OcclusionVolume> volumes);

    /// Binds the texture, and a block with these objects, at most kMaxOccluders, for subsequent draws.
    void use(std::span<const PlacedOccluder> objects);

private:
    GlObject texture_, block_;
};

} // namespace prt
