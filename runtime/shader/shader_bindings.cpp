// Lists the inputs of prt_relight.vert and prt_exit_radiance.glsl for a model.

#include "prt/shader/shader_source.h"

#include "shared_layout.h"

#include <algorithm>
#include <array>

namespace prt {
namespace {

std::string offset_and_stride(std::size_t offset, std::size_t stride) {
    return "offset " + std::to_string(offset) + ", stride " + std::to_string(stride);
}

void append_weights(const ClusteredReceivers& receivers, std::vector<ShaderBinding>& bindings) {
    const std::size_t stride = receivers.stride();
    const bool packed = receivers.format == WeightFormat::packed;
    const int count = packed ? receivers.words : receivers.components;
    for (int first = 0; first < count; first += 4) {
        const std::string values =
            std::to_string(std::min(4, count - first)) + (packed ? " x UNSIGNED_INT (integers)" : " x FLOAT");
        bindings.push_back({.kind = BindingKind::attribute,
                            .name = (packed ? "prt_words_" : "prt_weights_") + std::to_string(first / 4),
                            .type = packed ? "uvec4" : "vec4",
                            .number = PRT_LOCATION_WEIGHTS + first / 4,
                            .content = "receivers.weights: " + values + ", " +
                                       offset_and_stride(4 * static_cast<std::size_t>(first), stride)});
    }
    if (!packed)
        bindings.push_back({.kind = BindingKind::attribute,
                            .name = "prt_cluster",
                            .type = "uint",
                            .number = PRT_LOCATION_CLUSTER,
                            .content = "receivers.clusters: 1 x UNSIGNED_SHORT (integer), " +
                                       offset_and_stride(0, sizeof(std::uint16_t))});
}

void append_attributes(const ClusteredTransfer& transfer, std::vector<ShaderBinding>& bindings) {
    const std::string vector = " in the coordinate frame of the bake: 3 x FLOAT, " + offset_and_stride(0, 12);
    bindings.push_back({.kind = BindingKind::attribute,
                        .name = "position",
                        .type = "vec3",
                        .number = PRT_LOCATION_POSITION,
                        .content = "position" + vector});
    append_weights(transfer.receivers, bindings);
    if (std::ranges::any_of(transfer.bases.predictors, [](const Predictor& predictor) {
            return predictor.kind == PredictorKind::normal;
        }))
        bindings.push_back({.kind = BindingKind::attribute,
                            .name = "normal",
                            .type = "vec3",
                            .number = PRT_LOCATION_NORMAL,
                            .content = "unit normal" + vector});
}

/// Whether a language states the bindings of blocks and samplers.
bool has_binding_numbers(ShaderLanguage language) {
    return language == ShaderLanguage::glsl450 || language == ShaderLanguage::vulkan;
}

/// A table that the shader reads: `name` of the sampler, `block` of the block.
ShaderBinding table_binding(ConstantSource source, const char* name, const char* block, int number,
                            bool integers) {
    switch (source) {
    case ConstantSource::buffer:
        return {.kind = BindingKind::storage_buffer, .name = block, .number = number};
    case ConstantSource::block:
        return {.kind = BindingKind::uniform_block, .name = block, .number = number};
    case ConstantSource::texture:
        break;
    }
    return {.kind = BindingKind::sampler,
            .name = name,
            .type = integers ? "usampler2D" : "sampler2D",
            .number = number};
}

void append_tables(const ClusteredTransfer& transfer, ConstantSource source, ShaderLanguage language,
                   std::vector<ShaderBinding>& bindings) {
    const bool numbered = has_binding_numbers(language), texture = source == ConstantSource::texture;
    const std::string rows_of_texels = ", " + std::to_string(kConstantTextureWidth) + " per row";
    ShaderBinding constants =
        table_binding(source, "prt_constants", "PrtConstants", numbered ? PRT_BINDING_CONSTANTS : -1, false);
    constants.type += texture ? "" : "vec4[]";
    constants.content = std::to_string(constant_rows(transfer.bases)) +
                        (texture ? " texels RGBA32F" + rows_of_texels : " vec4") +
                        " from ClusterLighting::update, updated for each lighting";
    bindings.push_back(constants);
    if (clusters_have_equal_layout(transfer.bases))
        return;
    ShaderBinding clusters =
        table_binding(source, "prt_clusters", "PrtClusters", numbered ? PRT_BINDING_CLUSTERS : -1, true);
    clusters.type += texture ? "" : "uvec4[]";
    clusters.content = std::to_string(transfer.bases.clusters()) +
                       (texture ? " texels RGBA32UI" + rows_of_texels : " uvec4") +
                       " from cluster_layouts, constant";
    bindings.push_back(clusters);
}

constexpr std::array kKindNames = {"attribute", "storage buffer", "uniform block", "sampler",
                                   "uniform",   "push constant",  "output"};

} // namespace

std::vector<ShaderBinding> relight_bindings(const ClusteredTransfer& transfer, ConstantSource constants,
                                            ShaderLanguage language) {
    std::vector<ShaderBinding> bindings;
    append_attributes(transfer, bindings);
    append_tables(transfer, constants, language, bindings);
    const bool vulkan = language == ShaderLanguage::vulkan;
    bindings.push_back({.kind = vulkan ? BindingKind::push_constant : BindingKind::uniform,
                        .name = "view_projection",
                        .type = "mat4",
                        .content = "from the coordinate frame of `position` to clip space"});
    bindings.push_back({.kind = BindingKind::output,
                        .name = "radiance",
                        .type = "vec3",
                        .number = vulkan ? 0 : -1,
                        .content = "exit radiance for albedo 1, read by the fragment shader"});
    return bindings;
}

std::string binding_table(std::span<const ShaderBinding> bindings, const std::string& prefix) {
    const auto padded = [](std::string text, std::size_t width) {
        text.resize(std::max(text.size(), width), ' ');
        return text + "  ";
    };
    std::string table;
    for (const ShaderBinding& binding : bindings)
        table += prefix + padded(kKindNames[static_cast<std::size_t>(binding.kind)], 14) +
                 padded(binding.number < 0 ? "-" : std::to_string(binding.number), 2) +
                 padded(binding.name, 15) + padded(binding.type, 10) + binding.content + "\n";
    return table;
}

} // namespace prt
