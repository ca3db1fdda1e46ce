// Assembles shaders: version line, defines, and files with expanded includes.

#include "prt/shader/shader_source.h"

#include "prt/core/error.h"
#include "runtime/shader/defines.h"
#include "runtime/shader/embedded_files.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace prt {
namespace {

constexpr int kMaxWeightVectors = 12, kMaxWords = 8;

void append_file(const std::string& name, std::set<std::string>& included, std::string& source) {
    const auto found = embedded_files().find(name);
    if (found == embedded_files().end())
        throw Error("the shader file " + name + " does not exist");
    if (!included.insert(name).second)
        return;
    std::istringstream lines(found->second);
    for (std::string line; std::getline(lines, line);) {
        constexpr std::string_view kInclude = "#include \"";
        if (line.starts_with(kInclude))
            append_file(line.substr(kInclude.size(), line.rfind('"') - kInclude.size()), included, source);
        else
            source += line + "\n";
    }
}

const char* version_lines(ShaderLanguage language) {
    switch (language) {
    case ShaderLanguage::glsl330:
        return "#version 330 core\n";
    case ShaderLanguage::essl300:
        return "#version 300 es\nprecision highp float;\nprecision highp int;\n";
    case ShaderLanguage::vulkan:
        return "#version 450\n";
    case ShaderLanguage::glsl450:
        break;
    }
    return "#version 450 core\n";
}

void check_compute(ShaderLanguage language, const char* remedy) {
    if (language != ShaderLanguage::glsl450 && language != ShaderLanguage::vulkan)
        throw Error(std::string("OpenGL 3.3 and OpenGL ES 3.0 do not support compute shaders; ") + remedy);
}

std::string predictor_defines(const ClusteredBases& bases, const glm::dvec3& seen_from) {
    std::string text;
    for (const Predictor& predictor : bases.predictors) {
        if (predictor.kind == PredictorKind::normal) {
            text += "#define PRT_PREDICTOR_NORMAL\n";
            continue;
        }
        text += "#define PRT_PREDICTOR_POSITION\n" +
                define("PRT_PREDICTOR_ORIGIN", glsl_vector(seen_from + glm::dvec3(predictor.origin)));
    }
    return text;
}

/// Returns defines for the layout of weights in vertex attributes.
std::string weight_defines(const ClusteredTransfer& transfer) {
    const ClusteredReceivers& receivers = transfer.receivers;
    if (receivers.format == WeightFormat::packed) {
        if (receivers.words > kMaxWords)
            throw Error(std::to_string(receivers.words) +
                        " words of packed weights are needed, but the vertex attributes have only " +
                        std::to_string(kMaxWords));
        return define("PRT_PACKED_WORDS", static_cast<std::size_t>(receivers.words)) +
               define("PRT_CLUSTER_BITS", static_cast<std::size_t>(receivers.cluster_bits));
    }
    const int most = max_vertex_components(transfer.bases),
              components = std::max(receivers.components, transfer.bases.max_components());
    if (components > most)
        throw Error(std::to_string(components) +
                    " components are needed, but the vertex attributes have only " + std::to_string(most));
    return define("PRT_WEIGHT_VECTORS", static_cast<std::size_t>(receivers.components / 4));
}

/// Returns defines that replace the loop over weights and the cluster table in the shader.
std::string same_weight_defines(const ClusteredTransfer& transfer) {
    const ClusteredBases& bases = transfer.bases;
    if (!clusters_have_equal_layout(bases))
        return "";
    const auto components = static_cast<std::size_t>(bases.components.front());
    std::string text =
        define("PRT_CLUSTER_ROWS", bases.fixed_rows() + components) + "#define PRT_SAME_WEIGHTS";
    int position = transfer.receivers.cluster_bits;
    for (std::size_t j = 0; j < components; ++j) {
        text += " PRT_ADD(" + std::to_string(j) + "u, ";
        if (transfer.receivers.format == WeightFormat::packed) {
            const int width = bases.bits[j];
            text += "PRT_BITS(" + std::to_string(position) + "u, " + std::to_string(width) + "u))";
            position += width;
        } else {
            text += "prt_weights_" + std::to_string(j / 4) + "[" + std::to_string(j % 4) + "])";
        }
    }
    return text + "\n";
}

} // namespace

std::string shader_part(std::string_view name, std::string_view defines) {
    std::string source(defines);
    std::set<std::string> included;
    append_file(std::string(name), included, source);
    return source;
}

std::string shader_source(std::string_view name, std::string_view defines, ShaderLanguage language) {
    return version_lines(language) + shader_part(name, defines);
}

int max_vertex_components(const ClusteredBases& bases) {
    return 4 * (bases.predictors.empty() ? kMaxWeightVectors : kMaxWeightVectors - 1); // normals take the
                                                                                       // last location
}

std::string relight_defines(const ClusteredTransfer& transfer, ConstantSource constants,
                            ShaderLanguage language, const glm::dvec3& seen_from) {
    // In this order: the first call rejects transfer that the second cannot process.
    std::string text = weight_defines(transfer);
    text += same_weight_defines(transfer);
    text += predictor_defines(transfer.bases, seen_from);
    switch (constants) {
    case ConstantSource::buffer:
        if (language == ShaderLanguage::glsl330 || language == ShaderLanguage::essl300)
            throw Error(
                "OpenGL 3.3 and OpenGL ES 3.0 do not support storage buffers; use --constants block or "
                "texture");
        return text + "#define PRT_CONSTANTS_BUFFER\n";
    case ConstantSource::block:
        return text + "#define PRT_CONSTANTS_BLOCK\n" +
               define("PRT_MAX_ROWS", constant_rows(transfer.bases)) +
               define("PRT_MAX_CLUSTERS", transfer.bases.clusters());
    case ConstantSource::texture:
        break;
    }
    return text + "#define PRT_CONSTANTS_TEXTURE\n" + define("PRT_TEXTURE_WIDTH", kConstantTextureWidth);
}

std::string relight_shader(const ClusteredTransfer& transfer, ConstantSource constants,
                           ShaderLanguage language, const glm::dvec3& seen_from) {
    const std::string defines = relight_defines(transfer, constants, language, seen_from);
    const std::string table = binding_table(relight_bindings(transfer, constants, language), "//   ");
    return shader_source(
        "prt_relight.vert",
        "// Bindings (kind, location or binding number, name, type, content; -: bound by name):\n" + table +
            defines,
        language);
}

std::string term_defines(const TransferLayout& layout) {
    check_layout(layout);
    std::string defines =
        define("PRT_NUMBERS", layout.dimension()) +
        define("PRT_COEFFICIENTS", static_cast<std::size_t>(coefficient_count(layout.order)));
    const char* const channels[] = {"PRT_FIRST_CHANNELS", "PRT_SECOND_CHANNELS"};
    const std::span<const TransferTerm> distant = layout.distant_terms(), lamps = layout.lamp_terms();
    for (std::size_t i = 0; i < distant.size(); ++i)
        defines += define(channels[i], static_cast<std::size_t>(distant[i].channels));
    if (lamps.empty())
        return defines;
    std::uint32_t colored[kMaxLamps / 32] = {};
    for (std::size_t k = 0; k < lamps.size(); ++k)
        if (lamps[k].channels == 3)
            colored[k / 32] |= 1u << (k % 32);
    static_assert(std::size(colored) == 2);
    defines += define("PRT_LAMPS", lamps.size()) + "#define PRT_COLORED_LAMPS " + std::to_string(colored[0]) +
               "u, " + std::to_string(colored[1]) + "u\n";
    return defines;
}

std::string constants_shader(const ClusteredTransfer& transfer, ShaderLanguage language) {
    check_compute(language, "compute the constants on the CPU");
    return shader_source(
        "prt_constants.comp",
        define("PRT_ROWS", constant_rows(transfer.bases)) + term_defines(transfer.bases.layout), language);
}

std::string texel_defines(const ClusteredTransfer& transfer, TexelFormat format, ConstantSource constants,
                          ShaderLanguage language) {
    const char* const names[] = {nullptr, "r11f_g11f_b10f", "rgba16f", "rgba32f"};
    if (format == TexelFormat::rgb9e5)
        throw Error("shaders cannot write RGB9_E5; use another TexelFormat");
    return relight_defines(transfer, constants, language) +
           define("PRT_OUTPUTS", transfer.bases.layout.outputs) +
           define("PRT_TEXEL_FORMAT", std::string(names[static_cast<std::size_t>(format)]));
}

std::string texel_shader(const ClusteredTransfer& transfer, ShaderLanguage language, TexelFormat format,
                         ConstantSource constants) {
    check_compute(language, "use the fragment shader of lightmaps, or compute the texture on the CPU");
    return shader_source("prt_texels.comp", texel_defines(transfer, format, constants, language), language);
}

std::string lightmap_shader(const ClusteredTransfer& transfer, ConstantSource constants,
                            ShaderLanguage language) {
    return shader_source("prt_lightmap.frag", relight_defines(transfer, constants, language), language);
}

} // namespace prt
