#pragma once

// Inputs of the vertex shader that lights a model: the attributes, buffers, textures and uniforms that an
// application binds. Stable.

#include "prt/shader_source.h"

#include <span>
#include <string>
#include <vector>

namespace prt {

enum class BindingKind { attribute, storage_buffer, uniform_block, sampler, uniform, push_constant, output };

/// One input of a shader, or its output.
struct ShaderBinding {
    BindingKind kind;
    std::string name = {};    ///< of the attribute, block, sampler or uniform
    std::string type = {};    ///< in GLSL
    int number = -1;          ///< location of attributes and outputs, else the binding; -1: looked up by name
    std::string content = {}; ///< what the application binds
};

/// The bindings of relight_shader with the same arguments, attributes first.
std::vector<ShaderBinding> relight_bindings(const ClusteredTransfer& transfer, ConstantSource constants,
                                            ShaderLanguage language);

/// One line for each binding, in columns; each begins with `prefix`.
std::string binding_table(std::span<const ShaderBinding> bindings, const std::string& prefix = "");

} // namespace prt
