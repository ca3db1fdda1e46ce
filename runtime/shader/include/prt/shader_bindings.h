#pragma once

// Inputs of the vertex shader that lights a model: the attributes, buffers, textures and uniforms that an
// application binds. Stable.

#include "prt/shader_source.h"

#include <span>
#include <string>
#include <vector>

namespace prt {

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
