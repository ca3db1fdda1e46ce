#pragma once

// The shaders of the runtime as text, for the graphics interface of a game. Stable.

#include "prt/clustered_transfer.h"

#include <string>
#include <string_view>

namespace prt {

enum class ShaderLanguage {
    glsl450, ///< OpenGL 4.5
    glsl330, ///< OpenGL 3.3; blocks and samplers are bound by name
    essl300, ///< OpenGL ES 3.0, WebGL 2; the same
    vulkan,  ///< GLSL to be compiled to SPIR-V, and from there to HLSL
};

/// Where a vertex shader reads the constants.
enum class ConstantSource {
    buffer,  ///< storage buffers; not in OpenGL 3.3 and ES 3.0
    block,   ///< uniform blocks; 16 bytes a row, and a driver may allow no more than 16 KB
    texture, ///< texel fetch from an RGBA32F and an RGBA32UI texture of kConstantTextureWidth texels a row
};

inline constexpr int kConstantTextureWidth = 256;

/// Source of a file of shaders/: version line, `defines` (lines), then the file with its includes in place,
/// each once. Throws `Error` for a file that is not there.
std::string shader_source(std::string_view name, std::string_view defines,
                          ShaderLanguage language = ShaderLanguage::glsl450);

/// The same without a version line: to be put into shaders.
std::string shader_part(std::string_view name, std::string_view defines);

/// Components that fit the attributes of a vertex where weights are not packed: 48, or 44 beside guides.
int most_vertex_components(const ClusteredBases& bases);

/// The lines that `prt_exit_radiance.glsl` wants for a model. The shader is given positions as the Scene has
/// them where `seen_from` is 0, and in the file's world where it is Scene::origin: floats of a world whose
/// origin is far away are coarse. Where clusters_are_alike the shader has no loop, and no table of clusters
/// to bind (PrtClusters, prt_clusters). Throws `Error` where the weights do not fit the vertex attributes,
/// and for storage buffers in a language that has none.
std::string relight_defines(const ClusteredTransfer& transfer,
                            ConstantSource constants = ConstantSource::buffer,
                            ShaderLanguage language = ShaderLanguage::glsl450,
                            const glm::dvec3& seen_from = glm::dvec3(0));

/// A complete vertex shader for a model (shaders/prt_relight.vert); relight_bindings (prt/shader_bindings.h)
/// lists its inputs, and so does a comment at its head.
std::string relight_shader(const ClusteredTransfer& transfer, ConstantSource constants,
                           ShaderLanguage language, const glm::dvec3& seen_from = glm::dvec3(0));

/// The lines that prt_parts.glsl wants for a layout. Throws `Error` where it is none.
std::string part_defines(const TransferLayout& layout);

/// A complete compute shader that forms the constants (shaders/prt_constants.comp), for GLSL 4.5 and Vulkan.
std::string constants_shader(const ClusteredTransfer& transfer, ShaderLanguage language);

/// Which pass lights a lightmap.
enum class LightmapPass {
    compute,  ///< prt_lightmap.comp: GLSL 4.5 and Vulkan
    fragment, ///< prt_lightmap.frag: every language
};

/// The whole shader that lights a lightmap of packed words. Throws `Error` as `relight_defines` does, and
/// where the language has no compute shaders.
std::string lightmap_shader(const ClusteredTransfer& transfer, LightmapPass pass, ConstantSource constants,
                            ShaderLanguage language);

} // namespace prt
