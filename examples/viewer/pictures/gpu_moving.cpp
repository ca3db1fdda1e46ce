// Draws skinned and rigidly moving scenes.

#include "pictures/gpu_moving.h"

#include "prt/shader/shader_source.h"
#include "shared_layout.h"
#include "shared_viewer.h"

#include <epoxy/gl.h>
#include <glm/vec2.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace viewer {
namespace {

/// Rows of a sphere between the poles, and columns.
constexpr int kRows = 24, kColumns = 48;

std::vector<glm::uvec2> influences_of(const prt::MovingVertices& moving) {
    std::vector<glm::uvec2> influences;
    for (std::size_t i = 0; i < moving.weights.size(); ++i)
        influences.emplace_back(moving.matrices[i], std::bit_cast<std::uint32_t>(moving.weights[i]));
    if (influences.empty())
        influences.emplace_back(0); // a buffer must not be empty
    return influences;
}

} // namespace

GpuMoving::GpuMoving(prt::Scene scene, std::span<const prt::MovingVertices> moving,
                     std::span<const prt::Texture> textures)
    : scene_(std::move(scene)), gpu_(scene_, textures), arrays_(gpu_.make_vertex_arrays()) {
    // Emission keeps the strength of its file.
    gpu_.shine(std::vector<glm::vec3>(scene_.materials.size(), glm::vec3(1)));
    for (const prt::MovingVertices& m : moving) {
        const std::vector<glm::uvec2> influences = influences_of(m);
        vertices_.push_back({prt::make_buffer(std::span<const glm::uvec2>(influences)),
                             {},
                             m.skin < 0 ? 0 : static_cast<int>(m.influences)});
    }
}

void GpuMoving::set_lobes(const prt::LobeModel& lobes) {
    lobe_words_ = prt::make_buffer(std::span<const prt::LobeWord>(lobes.words));
    const std::vector<glm::vec4> profiles = prt::lobe_profile_block(lobes);
    lobe_profiles_ = prt::make_buffer(std::span<const glm::vec4>(profiles));
}

void GpuMoving::move(const Palettes& palettes) {
    for (std::size_t a = 0; a < palettes.size(); ++a) {
        Vertices& vertices = vertices_[a];
        const std::size_t bytes = palettes[a].size() * sizeof(glm::mat4);
        if (vertices.matrices != palettes[a].size())
            vertices.palette = prt::make_buffer(std::span<const glm::mat4>(palettes[a]));
        else
            glNamedBufferSubData(vertices.palette.name(), 0, static_cast<GLsizeiptr>(bytes),
                                 palettes[a].data());
        vertices.matrices = palettes[a].size();
    }
}

void GpuMoving::bind(const prt::GlObject& program, std::size_t primitive) const {
    const Vertices& vertices = vertices_[scene_.primitives[primitive].vertices];
    prt::bind_storage(PRT_BINDING_PALETTE, vertices.palette);
    prt::bind_storage(PRT_BINDING_INFLUENCES, vertices.influences);
    glUniform1i(prt::uniform(program, "influences_each"), vertices.each);
    if (lobe_words_.name() == 0)
        return;
    prt::bind_storage(PRT_BINDING_LOBE_WORDS, lobe_words_);
    glBindBufferBase(GL_UNIFORM_BUFFER, PRT_BINDING_LOBES, lobe_profiles_.name());
    const prt::VertexArray& array = scene_.vertex_arrays[scene_.primitives[primitive].vertices];
    glUniform1i(prt::uniform(program, "first_vertex"), static_cast<GLint>(array.first_receiver));
}

bool GpuMoving::moves(std::size_t primitive) const {
    return lobe_words_.name() == 0 || scene_.vertex_arrays[scene_.primitives[primitive].vertices].lobes;
}

void GpuMoving::draw(const prt::GlObject& program) {
    for (std::size_t p = 0; p < scene_.primitives.size(); ++p) {
        if (!moves(p))
            continue;
        bind(program, p);
        gpu_.draw(program, arrays_, p);
    }
}

void GpuMoving::draw_casters(const prt::GlObject& program) {
    for (std::size_t p = 0; p < scene_.primitives.size(); ++p) {
        if (!moves(p) || gpu_.blocking(scene_.primitives[p]) == prt::Blocking::nothing)
            continue;
        bind(program, p);
        gpu_.draw_caster(program, arrays_, p);
    }
}

prt::Scene scene_before_moving(const prt::AnimatedScene& figure) {
    prt::Scene scene = figure.scene();
    for (std::size_t a = 0; a < scene.vertex_arrays.size(); ++a) {
        scene.vertex_arrays[a].positions = figure.vertices()[a].positions;
        scene.vertex_arrays[a].normals = figure.vertices()[a].normals;
    }
    return scene;
}

UnitSphere unit_sphere(const glm::vec3& color) {
    constexpr float kPi = std::numbers::pi_v<float>;
    prt::VertexArray vertices;
    prt::Primitive primitive;
    for (int row = 0; row <= kRows; ++row)
        for (int column = 0; column <= kColumns; ++column) {
            const float latitude = kPi * static_cast<float>(row) / kRows,
                        longitude = 2 * kPi * static_cast<float>(column) / kColumns;
            vertices.positions.emplace_back(std::sin(latitude) * std::sin(longitude), std::cos(latitude),
                                            std::sin(latitude) * std::cos(longitude));
        }
    vertices.normals = vertices.positions;
    for (std::uint32_t row = 0; row < kRows; ++row)
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            const std::uint32_t a = row * (kColumns + 1) + column, below = a + kColumns + 1;
            if (row > 0)
                primitive.triangles.emplace_back(a, below + 1, a + 1);
            if (row + 1 < kRows)
                primitive.triangles.emplace_back(a, below, below + 1);
        }
    UnitSphere sphere;
    sphere.moving.push_back({0, -1, vertices.positions, vertices.normals, 1, {}, {}});
    sphere.scene.vertex_arrays.push_back(std::move(vertices));
    sphere.scene.primitives.push_back(std::move(primitive));
    sphere.scene.materials.resize(1);
    sphere.scene.materials[0].base_color = glm::vec4(color, 1);
    return sphere;
}

} // namespace viewer
