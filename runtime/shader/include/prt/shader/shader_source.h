#pragma once

// The shaders of the runtime as source text, for the graphics API of a game: vertices, lightmaps, volumes,
// instances and lobes. The functions for vertices are stable.

#include "prt/core/clustered_transfer.h"
#include "prt/core/lobes.h"
#include "prt/core/texture_relighter.h"

#include <glm/vec4.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

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
/// for albedo 1. `relight_bindings` and a comment in the shader list its inputs.
/// The arguments are those of `relight_defines`. Throws the errors of `relight_defines`.
std::string relight_shader(const ClusteredTransfer& transfer, ConstantSource constants,
                           ShaderLanguage language, const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns the lines of #define for shaders/prt_terms.glsl. Throws `Error` if `layout` is invalid
/// (`check_layout`).
std::string term_defines(const TransferLayout& layout);

/// Returns a complete compute shader that computes the constants on the GPU, as ClusterLighting::update does
/// on the CPU (shaders/prt_constants.comp). Throws `Error` for OpenGL 3.3 and ES 3.0, and the errors of
/// `term_defines`.
std::string constants_shader(const ClusteredTransfer& transfer, ShaderLanguage language);

/// Returns the lines of #define for shaders/prt_texels.comp: those of `relight_defines`, the number of
/// outputs and the format of the image. Throws `Error` for TexelFormat::rgb9e5, which shaders cannot write,
/// and the errors of `relight_defines`.
std::string texel_defines(const ClusteredTransfer& transfer, TexelFormat format = TexelFormat::rgba16,
                          ConstantSource constants = ConstantSource::buffer,
                          ShaderLanguage language = ShaderLanguage::glsl450);

/// Returns a complete compute shader that computes the texels of a lightmap or of the light texture of a
/// volume (shaders/prt_texels.comp), from the constants of TextureRelighter::update_constants. `transfer`
/// must have packed weights, of at most 8 words, and no predictors. Throws the errors of `texel_defines`, and
/// `Error` in OpenGL 3.3 and ES 3.0.
std::string texel_shader(const ClusteredTransfer& transfer, ShaderLanguage language,
                         TexelFormat format = TexelFormat::rgba16,
                         ConstantSource constants = ConstantSource::buffer);

/// Returns a complete fragment shader, for every language, that computes the exit radiance, for albedo 1, of
/// the texels of a lightmap when it is drawn over the map (shaders/prt_lightmap.frag). `transfer` must have
/// packed weights and no predictors. Throws the errors of `relight_defines`.
std::string lightmap_shader(const ClusteredTransfer& transfer, ConstantSource constants,
                            ShaderLanguage language);

/// Returns the lines of #define for shaders/prt_volume.glsl, with all sizes of `volume` as constants.
/// `format`: format of the light texture. Its sampler must clamp; for TexelFormat::rgba16 it must also
/// filter linearly. The shader gets the positions of the Scene plus `seen_from`. `seen_from` 0: positions
/// relative to Scene::origin. `seen_from` = Scene::origin: positions in the file's world. `volume` must have
/// at least one brick.
std::string volume_defines(const CompressedVolume& volume, TexelFormat format = TexelFormat::rgba16,
                           const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns the GLSL functions that look up the light of a volume at a position (shaders/prt_volume.glsl), the
/// same for every language. Insert them after the version line of a shader, in ES after
/// `precision highp float`. The arguments are those of `volume_defines`.
std::string volume_functions(const CompressedVolume& volume, TexelFormat format = TexelFormat::rgba16,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns the lines of #define for shaders/prt_lobes.glsl. `light_order`: number of bands of the incident
/// light that the shader gets, 2..4; 0: the order of the model. Throws `Error` for any other `light_order`,
/// and the errors of `check_lobes`.
std::string lobe_defines(const LobeModel& model, int light_order = 0);

/// Returns the GLSL functions of lobes (shaders/prt_lobes.glsl), the same for every language. Insert them
/// after the version line of a shader, in ES after `precision highp float`. `behind`: source that is put
/// before the functions. If `behind` is empty, the incident light has the order of the model. Otherwise
/// `behind` must be the result of `volume_functions`, and the incident light has the order of that volume.
/// Throws the errors of `check_lobes`.
std::string lobe_functions(const LobeModel& model, const std::string& behind = {});

/// Returns the content of the uniform block PrtLobeProfiles: [kMaxProfiles] the gains of bands 0 to 3 of each
/// profile. Entries beyond the profiles of the model are 0. `model` must be valid (`check_lobes`); this is
/// not checked.
std::vector<glm::vec4> lobe_profile_block(const LobeModel& model);

/// Maximum number of unpacked (float) weights per vertex of a mesh that is drawn as instances. More weights
/// would need the attribute locations of the instance data.
inline constexpr int kMaxInstancedWeights = 24;

/// Returns the lines of #define for shaders/prt_instances.glsl: those of `relight_defines` for the same
/// arguments, and PRT_INSTANCES. `seen_from` 0: the shader gets positions relative to the origin of
/// the stored scene (Model::scene, InstancedModel::stored). `seen_from` = this origin: the shader gets
/// positions in the mesh's frame, as in the file. `relit_instances` must get the same `seen_from`. Throws the
/// errors of `relight_defines`, and `Error` for ConstantSource::block and for more than kMaxInstancedWeights
/// unpacked weights.
std::string instance_defines(const ClusteredTransfer& transfer,
                             ConstantSource constants = ConstantSource::buffer,
                             ShaderLanguage language = ShaderLanguage::glsl450,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns a complete vertex shader for the instances of a model (shaders/prt_instances.vert); its output is
/// the exit radiance for albedo 1. The arguments are those of `instance_defines`. Throws the errors of
/// `instance_defines`.
std::string instance_shader(const ClusteredTransfer& transfer,
                            ConstantSource constants = ConstantSource::buffer,
                            ShaderLanguage language = ShaderLanguage::glsl450,
                            const glm::dvec3& seen_from = glm::dvec3(0));

/// Kind of an input or output of a shader.
enum class BindingKind {
    attribute,      ///< vertex attribute
    storage_buffer, ///< shader storage buffer
    uniform_block,  ///< uniform buffer
    sampler,        ///< texture
    uniform,        ///< uniform variable outside blocks
    push_constant,  ///< member of the push constants of Vulkan
    output          ///< output of the vertex shader, an input of the fragment shader
};

/// One input of a shader, or its output.
struct ShaderBinding {
    BindingKind kind;      ///< kind of the input or output
    std::string name = {}; ///< name of the attribute, block, sampler, uniform or output in the shader
    std::string type = {}; ///< type in GLSL, for example "uvec4" or "vec4[]"
    int number = -1; ///< location of an attribute or output, else binding point; -1: the shader states no
                     ///< number; uniforms, blocks and samplers are then looked up by name
    std::string content = {}; ///< description of the data, in English, for the application's programmer
};

/// Returns the bindings of the vertex shader that `relight_shader` returns for the same arguments:
/// attributes, then constants, table of clusters (absent if `clusters_have_equal_layout`), matrix and output.
/// Does not check that `relight_shader` supports the arguments.
std::vector<ShaderBinding> relight_bindings(const ClusteredTransfer& transfer, ConstantSource constants,
                                            ShaderLanguage language);

/// Returns `bindings` as a text table with one line each: kind, number, name, type and content. Each line
/// begins with `prefix`, for example "// ", and ends with a line feed. "-" is a missing number.
std::string binding_table(std::span<const ShaderBinding> bindings, const std::string& prefix = "");

} // namespace prt
