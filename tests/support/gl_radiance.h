#pragma once

// Radiance that shaders compute, read back from OpenGL.

#include "prt/core/clustered_transfer.h"
#include "prt/core/lightmap.h"
#include "prt/gl/gl_context.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt::test {

/// The exit radiance that the vertex shader computes: [receivers].
std::vector<glm::vec3> exit_radiance_gl(const ClusteredTransfer& transfer, const Lighting& lighting,
                                        const GlContext& context);
/// The radiance that the compute shader writes at full precision: [texels of the layout].
std::vector<glm::vec3> lightmap_radiance_gl(const CompressedLightmap& lightmap, const Lighting& lighting,
                                            const GlContext& context);
/// Returns the radiance computed by `shaders/prt_lightmap.frag`, drawn over the maps.
std::vector<glm::vec3> lightmap_radiance_by_fragments(const CompressedLightmap& lightmap,
                                                      const Lighting& lighting, const GlContext& context);

} // namespace prt::test
