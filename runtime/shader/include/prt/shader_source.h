#pragma once

// The shaders of the runtime as source text, for the graphics API of a game. Stable.

#include "prt/clustered_transfer.h"

#include <string>
#include <string_view>

namespace prt {

/// Shading language, with the API that compiles it.
enum class ShaderLanguage {
    glsl450, ///< OpenGL 4.5
    glsl330, ///< OpenGL 3.3; blocks and samplers have no binding points and are looked up by name
    essl300, ///< OpenGL ES 3.0, WebGL 2; blocks and samplers have no binding points and are looked up by name
    vulkan,  ///< GLSL for compilation to SPIR-V, and from there to HLSL
};

/// Storage of the constants for a vertex shader.
enum class ConstantSource {
    buffer,  ///< storage buffers; not in OpenGL 3.3 and ES 3.0
    block,   ///< uniform blocks; 16 bytes per row; a driver may support no more than 16 KB
    texture, ///< texel fetch from an RGBA32F and an RGBA32UI texture, kConstantTextureWidth texels per row
};

/// Width in texels of the textures that store constants.
inline constexpr int kConstantTextureWidth = 256;

/// Returns the source of file `name` of shaders/: version line, `defines` (lines), then the file with its
/// includes expanded, each once. Throws `Error` if there is no such file.
std::string shader_source(std::string_view name, std::string_view defines,
                          ShaderLanguage language = ShaderLanguage::glsl450);

/// Returns the source of file `name` of shaders/ without a version line, for insertion into shaders.
std::string shader_part(std::string_view name, std::string_view defines);

/// Returns the maximum number of unpacked weight components in vertex attributes: 48, or 44 with predictors.
int max_vertex_components(const ClusteredBases& bases);

/// Returns the define lines that shaders/prt_exit_radiance.glsl needs for a model. `seen_from` 0: the shader
/// gets positions as in the Scene; `seen_from` = Scene::origin: positions in the file's world. Floats lose
/// precision in a world whose origin is far away. If `clusters_have_equal_layout`, the shader has no loop,
/// and there is no table of clusters (PrtClusters, prt_clusters) to bind. Throws `Error` if the weights do
/// not fit the vertex attributes, and for storage buffers in a language without them.
std::string relight_defines(const ClusteredTransfer& transfer,
                            ConstantSource constants = ConstantSource::buffer,
                            ShaderLanguage language = ShaderLanguage::glsl450,
                            const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns a complete vertex shader for a model (shaders/prt_relight.vert). Its inputs are listed by
/// `relight_bindings` (prt/shader_bindings.h) and in the comment at the top of the shader. Throws the errors
/// of `relight_defines`.
std::string relight_shader(const ClusteredTransfer& transfer, ConstantSource constants,
                           ShaderLanguage language, const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns the define lines that shaders/prt_terms.glsl needs for a layout. Throws `Error` for an invalid
/// layout.
std::string term_defines(const TransferLayout& layout);

/// Returns a complete compute shader that computes the constants (shaders/prt_constants.comp), for GLSL 4.5
/// and Vulkan.
std::string constants_shader(const ClusteredTransfer& transfer, ShaderLanguage language);

/// Type of the shader pass that lights a lightmap.
enum class LightmapPass {
    compute,  ///< prt_lightmap.comp: GLSL 4.5 and Vulkan
    fragment, ///< prt_lightmap.frag: every language
};

/// Returns the complete shader that lights a lightmap with packed weights. Throws the errors of
/// `relight_defines`, and `Error` for LightmapPass::compute in a language without compute shaders.
std::string lightmap_shader(const ClusteredTransfer& transfer, LightmapPass pass, ConstantSource constants,
                            ShaderLanguage language);

} // namespace prt
