// Lobes: shaders of every language against C++.

#include "prt/core/error.h"
#include "prt/gl/gl_context.h"
#include "prt/shader/shader_source.h"
#include "runtime/shader/run_shader.h"
#include "shared_layout.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>

namespace prt::test {
namespace lobe_shaders { // joined sources share one scope
namespace {

static_assert(kMaxProfiles == PRT_MAX_PROFILES);

constexpr std::size_t kLobes = 3;

/// Input of a vertex: its words, the matrix of its skin, its normal in the world and that of a normal map.
struct Vertex {
    std::array<LobeWord, kLobes> words;
    glm::mat3 matrix;
    glm::vec3 normal, mapped;
};

glm::vec3 any_vector(std::mt19937& random) {
    std::normal_distribution<float> normal;
    const float x = normal(random), y = normal(random), z = normal(random);
    return {x, y, z};
}

LobeModel any_model(std::mt19937& random, int order) {
    LobeModel model;
    model.order = order;
    model.lobes = kLobes;
    std::uniform_real_distribution<float> gain(-0.5f, 1);
    for (std::size_t p = 0; p < kMaxProfiles; ++p) {
        LobeProfile& profile = model.profiles.emplace_back();
        for (std::size_t l = 0; l < static_cast<std::size_t>(order); ++l)
            profile[l] = gain(random);
    }
    return model;
}

std::vector<Vertex> any_vertices(std::mt19937& random) {
    std::uniform_int_distribution<int> any(0, 255);
    std::vector<Vertex> vertices(2000);
    for (Vertex& vertex : vertices) {
        for (LobeWord& word : vertex.words)
            for (std::uint8_t& byte : word)
                byte = static_cast<std::uint8_t>(any(random));
        vertex.matrix = glm::mat3(any_vector(random), any_vector(random), any_vector(random));
        vertex.normal = glm::normalize(any_vector(random));
        vertex.mapped = glm::normalize(vertex.normal + 0.5f * any_vector(random));
    }
    return vertices;
}

struct Lit {
    glm::vec3 plain, mapped;
};

/// Applies the smallest rotation from unit vector `from` to unit vector `to` to an axis, as a normal map does
/// to lobes.
glm::vec3 axis_onto(const glm::vec3& axis, const glm::vec3& from, const glm::vec3& to) {
    const glm::vec3 sum = from + to;
    return axis - glm::dot(sum, axis) / (1 + glm::dot(from, to)) * sum + 2 * glm::dot(from, axis) * to;
}

std::vector<Lit> lit_by_cpp(const LobeModel& model, const std::vector<Vertex>& vertices,
                            std::span<const glm::vec3> light, int light_order) {
    std::vector<Lit> all;
    for (const Vertex& vertex : vertices) {
        std::array<Lobe, kLobes> lobes, mapped;
        for (std::size_t k = 0; k < kLobes; ++k) {
            lobes[k] = model.decode(vertex.words[k]);
            lobes[k].axis = rotated_axis(lobes[k].axis, axis_rotation(vertex.matrix));
            mapped[k] = lobes[k];
            mapped[k].axis = axis_onto(lobes[k].axis, vertex.normal, vertex.mapped);
        }
        all.push_back({lobe_radiance(lobes, light, light_order), lobe_radiance(mapped, light, light_order)});
    }
    return all;
}

std::string vertex_source(const LobeModel& model, ShaderLanguage language, int light_order) {
    const std::string version = language == ShaderLanguage::glsl450 ? "#version 450\n"
                                : language == ShaderLanguage::glsl330
                                    ? "#version 330\n"
                                    : "#version 300 es\nprecision highp float;\n";
    return version + shader_part("prt_lobes.glsl", lobe_defines(model, light_order)) + R"(
layout(location = 0) in vec4 word_0;
layout(location = 1) in vec4 word_1;
layout(location = 2) in vec4 word_2;
layout(location = 3) in vec3 column_0;
layout(location = 4) in vec3 column_1;
layout(location = 5) in vec3 column_2;
layout(location = 6) in vec3 normal;
layout(location = 7) in vec3 mapped_normal;
uniform vec3 light[PRT_LOBE_COEFFICIENTS];
out vec3 plain;
out vec3 mapped;
void main() {
    mat3 turn = prt_lobe_rotation(mat3(column_0, column_1, column_2));
    PrtLobe lobes[PRT_LOBES];
    lobes[0] = prt_rotated_lobe(prt_lobe(word_0), turn);
    lobes[1] = prt_rotated_lobe(prt_lobe(word_1), turn);
    lobes[2] = prt_rotated_lobe(prt_lobe(word_2), turn);
    plain = prt_lobes_radiance(lobes, light);
    for (int k = 0; k < PRT_LOBES; ++k)
        lobes[k] = prt_mapped_lobe(lobes[k], normal, mapped_normal);
    mapped = prt_lobes_radiance(lobes, light);
    gl_Position = vec4(0.0);
})";
}

GLuint lobe_program(const LobeModel& model, ShaderLanguage language, int light_order) {
    const std::string version = language == ShaderLanguage::glsl450 ? "#version 450\n"
                                : language == ShaderLanguage::glsl330
                                    ? "#version 330\n"
                                    : "#version 300 es\nprecision highp float;\n";
    const GLuint program = glCreateProgram();
    glAttachShader(program, compiled(GL_VERTEX_SHADER, vertex_source(model, language, light_order)));
    glAttachShader(program, compiled(GL_FRAGMENT_SHADER,
                                     version + "out vec4 color;\nvoid main() { color = vec4(0.0); }\n"));
    const char* const captured[] = {"plain", "mapped"};
    glTransformFeedbackVaryings(program, 2, captured, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    glUseProgram(program);
    return program;
}

void bind_vertices(const std::vector<Vertex>& vertices) {
    GLuint array = 0, name = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(1, &name);
    glBindBuffer(GL_ARRAY_BUFFER, name);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
                 GL_STATIC_DRAW);
    const auto stride = static_cast<GLsizei>(sizeof(Vertex));
    for (GLuint a = 0; a < 8; ++a) {
        glEnableVertexAttribArray(a);
        // The words are not normalised; five vectors of three floats follow them.
        const std::size_t offset =
            a < kLobes ? a * sizeof(LobeWord) : kLobes * sizeof(LobeWord) + (a - kLobes) * sizeof(glm::vec3);
        glVertexAttribPointer(a, a < kLobes ? 4 : 3, a < kLobes ? GL_UNSIGNED_BYTE : GL_FLOAT, GL_FALSE,
                              stride, reinterpret_cast<const void*>(offset));
    }
}

std::vector<Lit> lit_by_shader(const LobeModel& model, ShaderLanguage language,
                               const std::vector<Vertex>& vertices, const std::vector<glm::vec3>& light,
                               int light_order) {
    bind_small_framebuffer();
    const GLuint program = lobe_program(model, language, light_order);
    bind_buffer(GL_UNIFORM_BUFFER, PRT_BINDING_LOBES, lobe_profile_block(model));
    glUniformBlockBinding(program, glGetUniformBlockIndex(program, "PrtLobeProfiles"), PRT_BINDING_LOBES);
    glUniform3fv(glGetUniformLocation(program, "light"), light_order * light_order, &light[0].x);
    bind_vertices(vertices);
    GLuint results = 0;
    const auto bytes = static_cast<GLsizeiptr>(vertices.size() * sizeof(Lit));
    glGenBuffers(1, &results);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, results);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr, GL_STATIC_READ);
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(vertices.size()));
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    std::vector<Lit> found(vertices.size());
    const void* values = glMapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, GL_MAP_READ_BIT);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    if (values)
        std::memcpy(found.data(), values, static_cast<std::size_t>(bytes));
    glUnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
    return found;
}

class LobeLanguages : public testing::TestWithParam<ShaderLanguage> {
protected:
    void SetUp() override {
        if (GetParam() == ShaderLanguage::essl300) {
            es = std::make_unique<EsContext>();
            ASSERT_TRUE(es->current());
        } else {
            desktop = GlContext::create(GlDevice::any);
            ASSERT_TRUE(desktop);
        }
    }
    std::unique_ptr<GlContext> desktop;
    std::unique_ptr<EsContext> es;
};
INSTANTIATE_TEST_SUITE_P(All, LobeLanguages,
                         testing::Values(ShaderLanguage::glsl450, ShaderLanguage::glsl330,
                                         ShaderLanguage::essl300));

TEST_P(LobeLanguages, MatchCpp) {
    std::mt19937 random(6);
    std::vector<glm::vec3> light;
    for (int i = 0; i < 16; ++i)
        light.push_back(any_vector(random) + glm::vec3(i == 0 ? 4.0f : 0.0f));
    const std::vector<Vertex> vertices = any_vertices(random);
    for (const auto& [order, light_order] : {std::pair(4, 4), std::pair(3, 3), std::pair(4, 2)}) {
        const LobeModel model = any_model(random, order);
        const std::vector<Lit> expected = lit_by_cpp(model, vertices, light, light_order),
                               found = lit_by_shader(model, GetParam(), vertices, light, light_order);
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            // Floats, and cofactors of matrices that may be nearly flat.
            EXPECT_LT(glm::distance(expected[v].plain, found[v].plain), 2e-3f) << v;
            EXPECT_LT(glm::distance(expected[v].mapped, found[v].mapped), 2e-3f) << v;
        }
    }
}

TEST(LobeShader, RejectsLightOfOtherOrders) {
    std::mt19937 random(7);
    EXPECT_THROW(lobe_defines(any_model(random, 4), 5), Error);
    EXPECT_THROW(lobe_defines({}, 3), Error);
}

} // namespace
} // namespace lobe_shaders
} // namespace prt::test
