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

/// Storage from which a shader reads the constants (ClusterLighting::update) and the table of clusters.
enum class ConstantSource {
    buffer,  ///< storage buffers; not in OpenGL 3.3 and ES 3.0
    block,   ///< uniform blocks; 16 bytes per row of constants; a driver may support only 16 KB
    texture, ///< textures without filtering: RGBA32F for the constants, RGBA32UI for the table of clusters;
             ///< kConstantTextureWidth texels wide
};

/// Width in texels of the textures of ConstantSource::texture. Row i of the constants, or entry i of the
/// table of clusters, is texel (i % width, i / width).
inline constexpr int kConstantTextureWidth = 256;

/// Returns the source of a complete shader: version line of `language` (in ES also default precisions),
/// `defines`, then file `name` of the folder shaders/, in which each include is expanded once. `defines`:
/// lines of #define, each with a line feed; may be empty. Throws `Error` if the file does not exist.
std::string shader_source(std::string_view name, std::string_view defines,
                          ShaderLanguage language = ShaderLanguage::glsl450);

/// Returns `defines`, then file `name` of the folder shaders/, in which each include is expanded once,
/// without a version line, for insertion into a shader. `defines`: lines of #define, each with a line feed;
/// may be empty. Throws `Error` if the file does not exist.
std::string shader_part(std::string_view name, std::string_view defines);

/// Returns the maximum number of unpacked (float) weights per vertex that the vertex attributes of the
/// shaders can hold: 48, or 44 if `bases` has predictors.
int max_vertex_components(const ClusteredBases& bases);

/// Returns the lines of #define for shaders/prt_exit_radiance.glsl. The shader gets the positions of the
/// Scene plus `seen_from`. `seen_from` 0: positions relative to Scene::origin. `seen_from` = Scene::origin:
/// positions in the file's world, in which floats lose precision if the origin is far away. If
/// `clusters_have_equal_layout`, the shader has no loop and no table of clusters (PrtClusters, prt_clusters)
/// to bind. Throws `Error` if the weights do not fit into the vertex attributes, and for
/// ConstantSource::buffer in OpenGL 3.3 and ES 3.0.
std::string relight_defines(const ClusteredTransfer& transfer,
                            ConstantSource constants = ConstantSource::buffer,
                            ShaderLanguage language = ShaderLanguage::glsl450,
                            const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns a complete vertex shader for a model (shaders/prt_relight.vert); its output is the exit radiance
/// for albedo 1. `relight_bindings` (prt/shader_bindings.h) and a comment in the shader list its inputs. The
/// arguments are those of `relight_defines`. Throws the errors of `relight_defines`.
std::string relight_shader(const ClusteredTransfer& transfer, ConstantSource constants,
                           ShaderLanguage language, const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns the lines of #define for shaders/prt_terms.glsl. Throws `Error` if `layout` is invalid
/// (`check_layout`).
std::string term_defines(const TransferLayout& layout);

/// Returns a complete compute shader that computes the constants on the GPU, as ClusterLighting::update does
/// on the CPU (shaders/prt_constants.comp). Throws `Error` for OpenGL 3.3 and ES 3.0, and the errors of
/// `term_defines`.
std::string constants_shader(const ClusteredTransfer& transfer, ShaderLanguage language);

/// Type of the shader pass that lights a lightmap.
enum class LightmapPass {
    compute,  ///< compute shader prt_lightmap.comp: only ShaderLanguage::glsl450 and vulkan
    fragment, ///< fragment shader prt_lightmap.frag, drawn over the map: every language
};

/// Returns the complete shader of a pass that computes the exit radiance, for albedo 1, of the texels of a
/// lightmap. `transfer` must have packed weights and no predictors. Throws the errors of `relight_defines`,
/// and `Error` for LightmapPass::compute in OpenGL 3.3 and ES 3.0.
std::string lightmap_shader(const ClusteredTransfer& transfer, LightmapPass pass, ConstantSource constants,
                            ShaderLanguage language);

} // namespace prt
