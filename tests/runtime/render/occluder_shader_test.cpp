// Occlusion by moving objects: shaders of every language against C++.

#include "prt/core/occlusion_volume.h"
#include "prt/gl/gl_context.h"
#include "prt/shader/shader_source.h"
#include "runtime/shader/run_shader.h"
#include "shared_layout.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>

namespace prt::test {
namespace occluder_shaders { // joined sources share one scope
namespace {

constexpr float kHalfAngle = 0.05f;
const glm::vec3 kSun = glm::normalize(glm::vec3(1, 2, -0.5f));

struct Position {
    glm::vec3 position, normal;
};

struct Objects {
    std::vector<OcclusionVolume> volumes;
    std::vector<PlacedOccluder> where;
};

glm::vec3 any_vector(std::mt19937& random) {
    std::normal_distribution<float> normal;
    const float x = normal(random), y = normal(random), z = normal(random);
    return {x, y, z};
}

Objects any_objects(std::mt19937& random) {
    Objects objects;
    std::uniform_int_distribution<int> any(-127, 127);
    for (std::size_t i = 0; i < 5; ++i) {
        OcclusionVolume& volume = objects.volumes.emplace_back();
        volume.low = glm::vec3(-1, -0.7f, -0.4f);
        volume.high = glm::vec3(0.8f, 0.9f, 1.1f);
        volume.reach = 3;
        for (OccluderTexel& texel : volume.texels)
            for (std::int8_t& n : texel)
                n = static_cast<std::int8_t>(any(random));
        const glm::mat4 world =
            glm::scale(glm::rotate(glm::translate(glm::mat4(1), any_vector(random)),
                                   1.0f + static_cast<float>(i), glm::normalize(any_vector(random))),
                       glm::vec3(0.7f));
        objects.where.push_back(placed(volume, world, i));
    }
    return objects;
}

/// Returns ambient visibility and visible fraction of the sun.
std::vector<glm::vec2> found_by_cpp(const Objects& objects, const std::vector<Position>& positions) {
    std::vector<glm::vec2> all;
    for (const Position& point : positions) {
        glm::vec2& left = all.emplace_back(1, 1);
        for (std::size_t i = 0; i < objects.volumes.size(); ++i) {
            const BlockedCap cap = blocked_at(objects.volumes[i], objects.where[i], point.position);
            left *= 1.0f - glm::vec2(blocked_cosine(cap, point.normal), blocked_sun(cap, kSun, kHalfAngle));
        }
    }
    return all;
}

/// The rows and the count behind them, as the block has them. Calls of ES 3.0 alone.
void bind_block(const Objects& objects, GLuint program) {
    std::vector<glm::vec4> rows(5 * PRT_MAX_OCCLUDERS + 1);
    static_assert(sizeof(PlacedOccluder) == 5 * sizeof(glm::vec4));
    std::memcpy(rows.data(), objects.where.data(), objects.where.size() * sizeof(PlacedOccluder));
    const auto count = static_cast<std::int32_t>(objects.where.size());
    std::memcpy(&rows.back(), &count, sizeof count);
    GLuint block = 0;
    glGenBuffers(1, &block);
    glBindBufferBase(GL_UNIFORM_BUFFER, PRT_BINDING_OCCLUDERS, block);
    glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(rows.size() * sizeof(glm::vec4)), rows.data(),
                 GL_STATIC_DRAW);
    glUniformBlockBinding(program, glGetUniformBlockIndex(program, "PrtOccluders"), PRT_BINDING_OCCLUDERS);
}

enum class Texels { bytes, floats };

void bind_texels(const Objects& objects, Texels kind) {
    const std::vector<OccluderTexel> texels = occluder_texture(objects.volumes);
    std::vector<float> floats;
    for (const OccluderTexel& texel : texels)
        for (const std::int8_t n : texel)
            floats.push_back(std::max(static_cast<float>(n) / 127, -1.0f));
    GLuint name = 0;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0 + PRT_UNIT_OCCLUDERS);
    glBindTexture(GL_TEXTURE_3D, name);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAX_LEVEL, 0);
    const auto depth = static_cast<GLsizei>(8 * objects.volumes.size());
    if (kind == Texels::bytes)
        glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8_SNORM, 8, 8, depth, 0, GL_RGBA, GL_BYTE, texels.data());
    else
        glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA32F, 8, 8, depth, 0, GL_RGBA, GL_FLOAT, floats.data());
}

GLuint occluder_program(ShaderLanguage language) {
    const std::string version = language == ShaderLanguage::glsl450 ? "#version 450\n"
                                : language == ShaderLanguage::glsl330
                                    ? "#version 330\n"
                                    : "#version 300 es\nprecision highp float;\n";
    const std::string vertex = version + shader_part("prt_occluders.glsl", "") + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
out vec2 left;
void main() {
    left = vec2(prt_occluders_visibility(position, normal),
                prt_occluders_sun(position, normalize(vec3(1.0, 2.0, -0.5)), 0.05));
    gl_Position = vec4(0.0);
})";
    const GLuint program = glCreateProgram();
    glAttachShader(program, compiled(GL_VERTEX_SHADER, vertex));
    glAttachShader(program, compiled(GL_FRAGMENT_SHADER,
                                     version + "out vec4 color;\nvoid main() { color = vec4(0.0); }\n"));
    const char* const captured[] = {"left"};
    glTransformFeedbackVaryings(program, 1, captured, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "prt_occluder_texture"), PRT_UNIT_OCCLUDERS);
    return program;
}

std::vector<glm::vec2> found_by_shader(const Objects& objects, ShaderLanguage language,
                                       const std::vector<Position>& positions) {
    bind_small_framebuffer();
    bind_block(objects, occluder_program(language));
    GLuint array = 0, vertices = 0, results = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(1, &vertices);
    glBindBuffer(GL_ARRAY_BUFFER, vertices);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(positions.size() * sizeof(Position)),
                 positions.data(), GL_STATIC_DRAW);
    for (const GLuint a : {0u, 1u}) {
        glEnableVertexAttribArray(a);
        glVertexAttribPointer(a, 3, GL_FLOAT, GL_FALSE, sizeof(Position),
                              reinterpret_cast<const void*>(a * sizeof(glm::vec3)));
    }
    const auto bytes = static_cast<GLsizeiptr>(positions.size() * sizeof(glm::vec2));
    glGenBuffers(1, &results);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, results);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr, GL_STATIC_READ);
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(positions.size()));
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    std::vector<glm::vec2> found(positions.size());
    const void* values = glMapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, GL_MAP_READ_BIT);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    if (values)
        std::memcpy(found.data(), values, static_cast<std::size_t>(bytes));
    glUnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
    return found;
}

class OccluderLanguages : public testing::TestWithParam<ShaderLanguage> {
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
INSTANTIATE_TEST_SUITE_P(All, OccluderLanguages,
                         testing::Values(ShaderLanguage::glsl450, ShaderLanguage::glsl330,
                                         ShaderLanguage::essl300));

TEST_P(OccluderLanguages, MatchCpp) {
    std::mt19937 random(5);
    const Objects objects = any_objects(random);
    std::vector<Position> positions;
    for (int i = 0; i < 3000; ++i)
        positions.push_back({1.5f * any_vector(random), glm::normalize(any_vector(random))});
    const std::vector<glm::vec2> expected = found_by_cpp(objects, positions);
    for (const Texels kind : {Texels::floats, Texels::bytes}) {
        // ES filters no floats.
        if (kind == Texels::floats && GetParam() == ShaderLanguage::essl300)
            continue;
        bind_texels(objects, kind);
        const std::vector<glm::vec2> found = found_by_shader(objects, GetParam(), positions);
        float largest = 0;
        double mean = 0;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            largest = std::max(largest, glm::distance(expected[i], found[i]));
            mean += static_cast<double>(glm::distance(expected[i], found[i])) /
                    static_cast<double>(positions.size());
        }
        RecordProperty(kind == Texels::floats ? "floats" : "bytes", std::to_string(1e9f * largest));
        // Filters of bytes may have eight bits for shares of a texel, between neighbours that differ by all
        // there is.
        const bool exact = kind == Texels::floats && test::device_is_exact();
        EXPECT_LT(largest, exact ? 5e-5f : 0.05f);
        EXPECT_LT(mean, exact ? 1e-5 : 3e-3);
    }
}

} // namespace
} // namespace occluder_shaders
} // namespace prt::test
