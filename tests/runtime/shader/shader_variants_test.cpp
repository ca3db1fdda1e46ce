// Compares the vertex shader with C++, in every language and with every storage of the constants, run by the
// driver.

#include "prt/compress/compress.h"
#include "prt/core/cluster_lighting.h"
#include "prt/gl/gl_context.h"
#include "prt/shader/shader_source.h"
#include "run_shader.h"
#include "runtime/render/gl/gl_objects.h"
#include "shared_layout.h"
#include "support/predicted.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <utility>

namespace prt::test {
namespace {

/// Returns a layout with separate sky and suns, and lamps.
TransferLayout several_terms() {
    return {4,
            {{TermKind::direct, 1},
             {TermKind::indirect, 3},
             {TermKind::lamp, 3, "lantern"},
             {TermKind::lamp, 1, "window"}}};
}

/// Bits per component: different for each cluster, or equal in all.
enum class Division { of_their_own, alike };

ClusteredTransfer compressed(WeightFormat format, Division division = Division::of_their_own,
                             const TransferLayout& layout = layout_of_one(4, 3)) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    Transfer transfer = zero_transfer(layout, 600);
    for (std::size_t i = 0; i < transfer.vectors.size(); ++i)
        transfer.vectors[i] = normal(random) + (i % 16 == 0 ? 3.0f : 0.0f);
    CompressOptions options;
    options.clusters = 20;
    options.coding.components = 6;
    options.coding.format = format;
    // Five words: weights lie across words and attributes.
    if (division == Division::of_their_own) {
        options.coding.bits = 150;
        options.mean_components = 4;
    } else if (format == WeightFormat::packed) {
        options.coding.fixed_bits = {16, 15, 16, 15, 13, 16, 11, 16, 16, 14};
        options.coding.components = 10;
    }
    return compress(transfer, {std::vector<float>(600, 1.0f)}, options).transfer;
}

Light random_light() {
    std::mt19937 random(6);
    std::normal_distribution<float> normal;
    Light light = constant_light(4, glm::vec3(1));
    for (glm::vec3& c : light.coefficients)
        c += 0.3f * glm::vec3(normal(random), normal(random), normal(random));
    return light;
}

struct Variant {
    ShaderLanguage language;
    ConstantSource constants;
};
class ShaderVariants : public testing::TestWithParam<Variant> {
protected:
    void SetUp() override {
        if (GetParam().language == ShaderLanguage::essl300) {
            es = std::make_unique<EsContext>();
            ASSERT_TRUE(es->current());
        } else {
            desktop = GlContext::create(GlDevice::any);
            ASSERT_TRUE(desktop);
        }
    }
    /// Compares with C++ for all sets of predictors.
    void agree_with_cpp(const ClusteredTransfer& plain, const Lighting& lighting) {
        const auto [language, constants] = GetParam();
        for (const std::vector<PredictorKind>& predictors : sets_of_predictors()) {
            ClusteredTransfer transfer = plain;
            std::mt19937 random(2);
            add_predictors(transfer, predictors, random);
            const auto expected = exit_radiance(transfer, lighting),
                       measured = radiance_of_shader(transfer, lighting, language, constants);
            float largest = 0;
            for (std::size_t p = 0; p < expected.size(); ++p)
                largest = std::max(largest, glm::distance(expected[p], measured[p]) /
                                                std::max(1.0f, glm::length(expected[p])));
            EXPECT_LT(largest, 1e-5f)
                << static_cast<int>(transfer.receivers.format) << " " << predictors.size();
        }
    }

    std::unique_ptr<GlContext> desktop;
    std::unique_ptr<EsContext> es;
};
INSTANTIATE_TEST_SUITE_P(All, ShaderVariants,
                         testing::Values(Variant{ShaderLanguage::glsl450, ConstantSource::buffer},
                                         Variant{ShaderLanguage::glsl450, ConstantSource::block},
                                         Variant{ShaderLanguage::glsl450, ConstantSource::texture},
                                         Variant{ShaderLanguage::glsl330, ConstantSource::block},
                                         Variant{ShaderLanguage::glsl330, ConstantSource::texture},
                                         Variant{ShaderLanguage::essl300, ConstantSource::block},
                                         Variant{ShaderLanguage::essl300, ConstantSource::texture}));

using Names = std::multiset<std::string>;

std::string line_of(const char* kind, const std::string& name, int number, const std::string& type) {
    return std::string(kind) + " " + name + " " + std::to_string(number) + " " + type;
}

/// The GLSL name of a type of OpenGL's.
std::string glsl_type(GLenum type) {
    switch (type) {
    case GL_FLOAT_VEC3:
        return "vec3";
    case GL_FLOAT_VEC4:
        return "vec4";
    case GL_UNSIGNED_INT:
        return "uint";
    case GL_UNSIGNED_INT_VEC4:
        return "uvec4";
    case GL_FLOAT_MAT4:
        return "mat4";
    case GL_SAMPLER_2D:
        return "sampler2D";
    case GL_UNSIGNED_INT_SAMPLER_2D:
        return "usampler2D";
    default:
        return "unknown";
    }
}

/// The inputs that the driver reports of a linked program; of desktop OpenGL with their bindings.
Names inputs_of_driver(GLuint program, ShaderLanguage language) {
    Names names;
    char name[100];
    GLint count = 0, size = 0;
    GLenum type = 0;
    const auto each = [&](GLenum what) {
        glGetProgramiv(program, what, &count);
        return static_cast<GLuint>(count);
    };
    for (GLuint i = 0; i < each(GL_ACTIVE_ATTRIBUTES); ++i) {
        glGetActiveAttrib(program, i, sizeof name, nullptr, &size, &type, name);
        names.insert(line_of("attribute", name, glGetAttribLocation(program, name), glsl_type(type)));
    }
    const bool numbered = language == ShaderLanguage::glsl450;
    for (GLuint i = 0; i < each(GL_ACTIVE_UNIFORM_BLOCKS); ++i) {
        glGetActiveUniformBlockName(program, i, sizeof name, nullptr, name);
        GLint binding = -1;
        if (numbered)
            glGetActiveUniformBlockiv(program, i, GL_UNIFORM_BLOCK_BINDING, &binding);
        names.insert(line_of("block", name, binding, ""));
    }
    for (GLuint i = 0; i < each(GL_ACTIVE_UNIFORMS); ++i) {
        glGetActiveUniform(program, i, sizeof name, nullptr, &size, &type, name);
        const GLint location = glGetUniformLocation(program, name);
        if (location < 0)
            continue; // in a block
        GLint unit = -1;
        if (numbered && type != GL_FLOAT_MAT4)
            glGetUniformiv(program, location, &unit);
        names.insert(line_of("uniform", name, unit, glsl_type(type)));
    }
    if (numbered) {
        GLint buffers = 0;
        glGetProgramInterfaceiv(program, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &buffers);
        for (GLuint i = 0; i < static_cast<GLuint>(buffers); ++i) {
            glGetProgramResourceName(program, GL_SHADER_STORAGE_BLOCK, i, sizeof name, nullptr, name);
            const GLenum property = GL_BUFFER_BINDING;
            GLint binding = -1;
            glGetProgramResourceiv(program, GL_SHADER_STORAGE_BLOCK, i, 1, &property, 1, nullptr, &binding);
            names.insert(line_of("buffer", name, binding, ""));
        }
    }
    return names;
}

/// The same of the table.
Names inputs_of_table(const std::vector<ShaderBinding>& bindings) {
    Names names;
    for (const ShaderBinding& b : bindings)
        switch (b.kind) {
        case BindingKind::attribute:
            names.insert(line_of("attribute", b.name, b.number, b.type));
            break;
        case BindingKind::storage_buffer:
            names.insert(line_of("buffer", b.name, b.number, ""));
            break;
        case BindingKind::uniform_block:
            names.insert(line_of("block", b.name, b.number, ""));
            break;
        case BindingKind::sampler:
        case BindingKind::uniform:
        case BindingKind::push_constant:
            names.insert(line_of("uniform", b.name, b.number, b.type));
            break;
        case BindingKind::output:
            break;
        }
    return names;
}

constexpr WeightFormat kFormats[] = {WeightFormat::packed, WeightFormat::float32};

TEST_P(ShaderVariants, MatchCpp) {
    for (const WeightFormat format : kFormats) {
        const ClusteredTransfer transfer = compressed(format);
        EXPECT_FALSE(clusters_have_equal_layout(transfer.bases));
        agree_with_cpp(transfer, {random_light()});
    }
}

TEST_P(ShaderVariants, ComputeEqualClustersWithoutALoop) {
    Lighting lighting{random_light(), rotated_about_y(random_light(), 1)};
    lighting.lamps = {glm::vec3(0.5f, 1, 2), glm::vec3(3)};
    for (const WeightFormat format : kFormats) {
        const ClusteredTransfer transfer = compressed(format, Division::alike, several_terms());
        EXPECT_TRUE(clusters_have_equal_layout(transfer.bases));
        agree_with_cpp(transfer, lighting);
    }
}

TEST_P(ShaderVariants, HaveTheBindingsOfTheTable) {
    const auto [language, constants] = GetParam();
    for (const Division division : {Division::of_their_own, Division::alike})
        for (const WeightFormat format : kFormats) {
            const ClusteredTransfer plain = compressed(format, division);
            for (const std::vector<PredictorKind>& predictors : sets_of_predictors()) {
                ClusteredTransfer transfer = plain;
                std::mt19937 random(2);
                add_predictors(transfer, predictors, random);
                const GLuint program =
                    linked_program(relight_shader(transfer, constants, language), language);
                EXPECT_EQ(inputs_of_driver(program, language),
                          inputs_of_table(relight_bindings(transfer, constants, language)));
                glDeleteProgram(program);
            }
        }
}

TEST(ConstantsShader, MatchesCpp) {
    const auto context = GlContext::create(GlDevice::any);
    ASSERT_TRUE(context);
    const Light light = random_light();
    std::vector<ClusteredTransfer> transfers = {compressed(WeightFormat::packed),
                                                compressed(WeightFormat::float32)};
    for (const auto& [first, second] :
         {std::pair(1, 3), std::pair(3, 1)}) { // rows of four channels, as with several terms
        transfers.push_back(transfers[1]);
        ClusteredBases& bases = transfers.back().bases;
        bases.layout.terms = {{TermKind::direct, first}, {TermKind::indirect, second}};
        bases.rows.resize(constant_rows(bases) * bases.dimension());
        for (std::size_t i = 0; i < bases.rows.size(); ++i)
            bases.rows[i] = std::sin(static_cast<float>(i));
    }
    // Lamps with and without a sky, more than the bits of a word.
    for (const bool sky : {true, false}) {
        transfers.push_back(transfers[1]);
        ClusteredBases& bases = transfers.back().bases;
        bases.layout.terms.clear();
        if (sky)
            bases.layout.terms = {{TermKind::direct, 1}, {TermKind::indirect, 3}};
        for (int k = 0; k < 40; ++k)
            bases.layout.terms.push_back({TermKind::lamp, k % 3 == 0 ? 3 : 1, "lamp " + std::to_string(k)});
        bases.rows.resize(constant_rows(bases) * bases.dimension());
        for (std::size_t i = 0; i < bases.rows.size(); ++i)
            bases.rows[i] = std::sin(static_cast<float>(i));
    }
    for (const ClusteredTransfer& transfer : transfers) {
        const ClusterLighting relighter(transfer);
        std::vector<glm::vec4> expected(relighter.rows()), measured(relighter.rows()), coefficients;
        Lighting lighting{light, rotated_about_y(light, 1)};
        for (std::size_t k = 0; k < relighter.layout().lamps(); ++k)
            lighting.lamps.emplace_back(0.1f * static_cast<float>(k), 1, 2);
        relighter.update(lighting, expected);
        for (const glm::vec3& c : light_columns(relighter.layout(), lighting))
            coefficients.emplace_back(c, 0);
        const GLuint program = glCreateProgram();
        glAttachShader(program,
                       compiled(GL_COMPUTE_SHADER, constants_shader(transfer, ShaderLanguage::glsl450)));
        glLinkProgram(program);
        glUseProgram(program);
        bind_buffer(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_MATRIX,
                    std::vector<float>(relighter.matrix().begin(), relighter.matrix().end()));
        bind_buffer(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_LIGHT, coefficients);
        bind_buffer(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_CONSTANTS, measured);
        glDispatchCompute(static_cast<GLuint>((relighter.rows() + 63) / 64), 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                           static_cast<GLsizeiptr>(measured.size() * sizeof(glm::vec4)), measured.data());
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_LT(glm::distance(expected[i], measured[i]), 2e-4f) << i;
    }
}

} // namespace
} // namespace prt::test
