#pragma once

#include "prt/gl_objects.h"
#include "prt/ray_scene.h"

#include <span>

namespace prt {

/// A buffer with a receiver for each index, as the bake shaders read it: where its rays start with the seed
/// of its samples as bits, and its normal; two vec4.
GlObject upload_receivers(const RayScene& rays, const Receivers& receivers,
                          std::span<const std::uint32_t> indices, std::uint64_t seed, int threads);

} // namespace prt
