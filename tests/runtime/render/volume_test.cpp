// Volumes on the GPU against C++: their light as it is formed, and as shaders of every language look it up.

#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "prt/gl/gl_context.h"
#include "prt/shader/shader_source.h"
#include "runtime/render/gl/gl_relit_textures.h"
#include "runtime/shader/run_shader.h"
#include "shared_layout.h"
#include "support/random_volume.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>

namespace prt::test {
namespace {

const glm::vec3 kSun = glm::normalize(glm::vec3(1, 2, -0.5f));

std::vector<std::byte> constants_by_cpp(const TextureRelighter& relighter) {
    std::vector<glm::vec4> constants(relighter.rows());
    std::vector<std::byte> texels(relighter.bytes(0));
    relighter.update_constants(lighting_of_probes(), kSun, constants);
    relighter.update(0, constants, texels, 1);
    return texels;
}

struct Position {
    glm::vec3 position, normal;
};

/// Returns positions inside, outside, and on faces between bricks; their coordinates are exact in floats, so
/// that rounding moves none across a face.
std::vector<Position> positions_in(const VolumeGrid& grid, std::mt19937& random) {
    std::uniform_int_distribution<int> along(-1024, 6 * 1024), axis(0, 6);
    std::vector<Position> positions;
    for (int i = 0; i < 3000; ++i) {
        glm::vec3 bricks(along(random), along(random), along(random));
        bricks /= 1024.0f;
        const int a = axis(random);
        if (i % 3 == 0)
            bricks[a % 3] = std::round(bricks[a % 3]);
        glm::vec3 normal(0);
        if (a < 6)
            normal[a / 2] = a % 2 ? 1.0f : -1.0f;
        positions.push_back({grid.origin + grid.spacing * static_cast<float>(kBrickCells) * bricks, normal});
    }
    return positions;
}

/// Result of a shader at a position: [coefficients] of incident light; irradiance and radiance from the
/// facing direction, the main light direction, and the visible fraction of the sun.
struct Found {
    std::vector<glm::vec3> light;
    glm::vec3 irradiance, radiance, direction;
    float sun;
};

/// Radiance in unit direction `towards`, not below 0.
glm::vec3 radiance_of(std::span<const glm::vec3> incident, const glm::vec3& towards, int order) {
    std::array<float, 16> basis{};
    evaluate_sh(order, towards, std::span(basis).first(incident.size()));
    glm::vec3 sum(0);
    for (std::size_t i = 0; i < incident.size(); ++i)
        sum += basis[i] * incident[i];
    return glm::max(sum, glm::vec3(0));
}

/// A unit vector that is not an axis: every function of the basis has a different value there.
const glm::vec3 kFacing = glm::normalize(glm::vec3(0.3f, -0.8f, 0.45f));

std::vector<Found> found_by_cpp(const CompressedVolume& volume, const std::vector<Position>& positions) {
    const VolumeLookup lookup(volume.grid, volume.visibility);
    const TextureRelighter relighter(volume, TexelFormat::rgba32);
    const std::vector<std::byte> texels = constants_by_cpp(relighter);
    const std::size_t n = relighter.atlas().coefficients();
    const std::vector<glm::vec3> incident = incident_light(volume, lighting_of_probes());
    std::vector<float> suns(lookup.probes().size());
    for (std::size_t b = 0; b < volume.grid.bricks.size(); ++b)
        for (std::size_t i = 0; i < kBrickProbes; ++i)
            std::memcpy(&suns[lookup.probes().of_brick[b][i]],
                        &texels[4 * (4 * (3 * n / 4 * relighter.atlas().texels_of_plane() +
                                          relighter.atlas().texel(b, i)) +
                                     3 * n % 4)],
                        4);
    std::vector<Found> all;
    for (const Position& point : positions) {
        const VolumeCorners corners = lookup.find(point.position, point.normal);
        Found& found =
            all.emplace_back(Found{std::vector<glm::vec3>(n), glm::vec3(0), glm::vec3(0), glm::vec3(0), 0});
        mix_incident(corners, incident, found.light);
        const glm::vec3 facing = point.normal == glm::vec3(0) ? kFacing : point.normal;
        found.irradiance = irradiance_of(found.light, facing);
        found.radiance = radiance_of(found.light, facing, volume.order);
        // Y_1 = 0.488603 (-y, z, -x)
        const auto gray = [&](std::size_t i) { return glm::dot(found.light[i], glm::vec3(kLuminance)); };
        found.direction = glm::normalize(glm::vec3(-gray(3), -gray(1), gray(2)));
        for (std::size_t i = 0; i < 8; ++i)
            found.sun += corners.weights[i] * suns[corners.probes[i]];
    }
    return all;
}

const char* version_of(ShaderLanguage language) {
    return language == ShaderLanguage::glsl450   ? "#version 450\n"
           : language == ShaderLanguage::glsl330 ? "#version 330\n"
                                                 : "#version 300 es\nprecision highp float;\n";
}

/// Returns a program whose vertex shader looks positions up; transform feedback records the results.
GLuint lookup_program(const std::string& functions, ShaderLanguage language) {
    const std::string vertex = version_of(language) + functions + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
out vec3 light[PRT_VOLUME_COEFFICIENTS];
out vec3 radiance;
out vec3 direction;
out vec4 rest;
void main() {
    vec3 incident[PRT_VOLUME_COEFFICIENTS];
    prt_volume_incident(position, normal, incident);
    for (int i = 0; i < PRT_VOLUME_COEFFICIENTS; ++i)
        light[i] = incident[i];
    vec3 facing = normal == vec3(0.0) ? normalize(vec3(0.3, -0.8, 0.45)) : normal;
    radiance = prt_incident_radiance(incident, facing);
    direction = prt_incident_direction(incident);
    rest = vec4(prt_incident_irradiance(incident, facing), prt_volume_sun_visibility(position, normal));
    gl_Position = vec4(0.0);
})";
    const std::string fragment =
        std::string(version_of(language)) + "out vec4 color;\nvoid main() { color = vec4(0.0); }\n";
    const GLuint program = glCreateProgram();
    glAttachShader(program, compiled(GL_VERTEX_SHADER, vertex));
    glAttachShader(program, compiled(GL_FRAGMENT_SHADER, fragment));
    const char* const captured[] = {"light", "radiance", "direction", "rest"};
    glTransformFeedbackVaryings(program, 4, captured, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "prt_volume_light"), PRT_UNIT_VOLUME_LIGHT);
    glUniform1i(glGetUniformLocation(program, "prt_volume_visibility"), PRT_UNIT_VOLUME_VISIBILITY);
    glUniform1i(glGetUniformLocation(program, "prt_volume_index"), PRT_UNIT_VOLUME_INDEX);
    return program;
}

/// With the textures that are bound, in the context that is current; calls of ES 3.0 alone.
std::vector<Found> found_by_shader(const CompressedVolume& volume, TexelFormat format,
                                   ShaderLanguage language, const std::vector<Position>& positions) {
    bind_small_framebuffer();
    lookup_program(volume_functions(volume, format), language);
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
    const auto n = static_cast<std::size_t>(coefficient_count(volume.order));
    const std::size_t numbers = 3 * n + 10;
    const auto bytes = static_cast<GLsizeiptr>(numbers * positions.size() * sizeof(float));
    glGenBuffers(1, &results);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, results);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr, GL_STATIC_READ);
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(positions.size()));
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    const auto* values =
        static_cast<const float*>(glMapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, GL_MAP_READ_BIT));
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    if (!values)
        return {};
    std::vector<Found> all;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        Found found;
        const float* v = values + i * numbers;
        for (std::size_t o = 0; o < n; ++o)
            found.light.emplace_back(v[3 * o], v[3 * o + 1], v[3 * o + 2]);
        v += 3 * n;
        found.radiance = {v[0], v[1], v[2]};
        found.direction = {v[3], v[4], v[5]};
        found.irradiance = {v[6], v[7], v[8]};
        found.sun = v[9];
        all.push_back(found);
    }
    glUnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
    return all;
}

float largest_difference(const std::vector<Found>& a, const std::vector<Found>& b) {
    EXPECT_EQ(a.size(), b.size());
    float largest = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        float square = 0, size = 0;
        for (std::size_t o = 0; o < a[i].light.size(); ++o) {
            square += glm::dot(a[i].light[o] - b[i].light[o], a[i].light[o] - b[i].light[o]);
            size += glm::dot(a[i].light[o], a[i].light[o]);
        }
        const float unit = std::sqrt(std::max(1.0f, size));
        largest = std::max({largest, std::sqrt(square) / unit, std::abs(a[i].sun - b[i].sun),
                            glm::distance(a[i].irradiance, b[i].irradiance) / unit,
                            glm::distance(a[i].radiance, b[i].radiance) / unit,
                            // relative to a small difference
                            0.1f * glm::distance(a[i].direction, b[i].direction)});
    }
    return largest;
}

/// Calls of ES 3.0 alone.
void bind_texture_3d(GLuint unit, GLenum internal, GLenum format, GLenum type, const glm::ivec3& size,
                     const void* texels) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_3D, name);
    const GLint filter = internal == GL_RGBA16F ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, filter);
    glTexImage3D(GL_TEXTURE_3D, 0, static_cast<GLint>(internal), size.x, size.y, size.z, 0, format, type,
                 texels);
}

void bind_textures_of(const CompressedVolume& volume, TexelFormat format) {
    const TextureRelighter relighter(volume, format);
    const VolumeLookup lookup(volume.grid, volume.visibility);
    const VolumeAtlas& atlas = relighter.atlas();
    const bool half = format == TexelFormat::rgba16;
    bind_texture_3d(PRT_UNIT_VOLUME_LIGHT, half ? GL_RGBA16F : GL_RGBA32F, GL_RGBA,
                    half ? GL_HALF_FLOAT : GL_FLOAT, atlas.light_texels(),
                    constants_by_cpp(relighter).data());
    bind_texture_3d(PRT_UNIT_VOLUME_VISIBILITY, GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT,
                    atlas.visibility_texels(),
                    visibility_texels(volume.grid, lookup.probes(), volume.visibility).data());
    bind_texture_3d(PRT_UNIT_VOLUME_INDEX, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, volume.grid.size,
                    index_texels(volume.grid, lookup.index()).data());
}

class VolumeLanguages : public testing::TestWithParam<ShaderLanguage> {
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
INSTANTIATE_TEST_SUITE_P(All, VolumeLanguages,
                         testing::Values(ShaderLanguage::glsl450, ShaderLanguage::glsl330,
                                         ShaderLanguage::essl300));

TEST_P(VolumeLanguages, MatchCpp) {
    std::mt19937 random(11);
    for (const int order : {2, 3, 4}) {
        const CompressedVolume volume = random_volume(order, false, random);
        const std::vector<Position> positions = positions_in(volume.grid, random);
        const std::vector<Found> expected = found_by_cpp(volume, positions);
        for (const TexelFormat format : {TexelFormat::rgba32, TexelFormat::rgba16}) {
            bind_textures_of(volume, format);
            const float largest =
                largest_difference(expected, found_by_shader(volume, format, GetParam(), positions));
            RecordProperty((format == TexelFormat::rgba32 ? "floats_" : "halves_") + std::to_string(order),
                           std::to_string(1e9f * largest));
            // Half floats, and filters whose weights may have eight bits.
            EXPECT_LT(largest,
                      format == TexelFormat::rgba32 ? test::rounding_tolerance() : test::filter_tolerance())
                << order;
        }
    }
}

TEST_P(VolumeLanguages, FilterFullyVisibleCells) {
    std::mt19937 random(12);
    CompressedVolume volume = random_volume(3, true, random);
    std::ranges::fill(volume.visibility, ProbeVisibility{255, 255, 255, 255, 255, 255});
    const std::vector<Position> positions = positions_in(volume.grid, random);
    bind_textures_of(volume, TexelFormat::rgba16);
    EXPECT_LT(largest_difference(found_by_cpp(volume, positions),
                                 found_by_shader(volume, TexelFormat::rgba16, GetParam(), positions)),
              test::filter_tolerance());
}

class VolumePass : public testing::TestWithParam<std::tuple<int, bool>> {};
INSTANTIATE_TEST_SUITE_P(Orders, VolumePass, testing::Combine(testing::Values(2, 3, 4), testing::Bool()));

TEST_P(VolumePass, MatchesCpp) {
    const auto context = GlContext::create(GlDevice::any);
    ASSERT_TRUE(context);
    const auto [order, alike] = GetParam();
    std::mt19937 random(13);
    const CompressedVolume volume = random_volume(order, alike, random);
    for (const TexelFormat format : {TexelFormat::rgba32, TexelFormat::rgba16}) {
        GlRelitTextures by_gpu(volume, format);
        by_gpu.set_light(lighting_of_probes(), kSun);
        const std::vector<std::byte> floats = constants_by_cpp(TextureRelighter(volume, TexelFormat::rgba32));
        const std::vector<glm::vec4> computed = by_gpu.read(0);
        std::vector<glm::vec4> expected(computed.size());
        std::memcpy(expected.data(), floats.data(), floats.size());
        float largest = 0;
        for (std::size_t b = 0; b < volume.grid.bricks.size(); ++b)
            for (std::size_t i = 0; i < kBrickProbes; ++i)
                for (int plane = 0; plane < by_gpu.relighter().atlas().planes(); ++plane) {
                    const VolumeAtlas& atlas = by_gpu.relighter().atlas();
                    const std::size_t t =
                        static_cast<std::size_t>(plane) * atlas.texels_of_plane() + atlas.texel(b, i);
                    largest = std::max(largest, glm::distance(expected[t], computed[t]) /
                                                    std::max(1.0f, glm::length(expected[t])));
                }
        EXPECT_LT(largest, format == TexelFormat::rgba32 ? 1e-5f : 1e-3f); // a half float may be truncated
        if (format != TexelFormat::rgba32)
            continue;
        by_gpu.bind_volume();
        const std::vector<Position> positions = positions_in(volume.grid, random);
        EXPECT_LT(largest_difference(found_by_cpp(volume, positions),
                                     found_by_shader(volume, format, ShaderLanguage::glsl450, positions)),
                  test::rounding_tolerance());
    }
}

} // namespace
} // namespace prt::test
