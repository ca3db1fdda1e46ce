#pragma once

// Inputs of the vertex shader that lights a model: the attributes, buffers, textures and uniforms that an
// application binds. Stable.

#include "prt/shader_source.h"

#include <span>
#include <string>
#include <vector>

namespace prt {

/// Kind of an input or output of a shader.
enum class BindingKind { attribute, storage_buffer, uniform_block, sampler, uniform, push_constant, output };

/// One input of a shader, or its output.
struct ShaderBinding {
    BindingKind kind;
    std::string name = {}; ///< name of the attribute, block, sampler or uniform
    std::string type = {}; ///< type in GLSL
    int number = -1; ///< location of an attribute or output, else the binding point; -1: look it up by name
    std::string content = {}; ///< description of the data that the application binds
};

/// Returns the bindings of the shader that `relight_shader` returns for the same arguments, attributes first.
std::vector<ShaderBinding> relight_bindings(const ClusteredTransfer& transfer, ConstantSource constants,
                                            ShaderLanguage language);

/// Returns a table with one line for each binding; each line begins with `prefix`.
std::string binding_table(std::span<const ShaderBinding> bindings, const std::string& prefix = "");

} // namespace prt
