#include "gpu/gpu_scene.h"

#include "gpu/wide_bvh.h"
#include "prt/error.h"
#include "shared_layout.h"

#include <epoxy/gl.h>
#include <glm/geometric.hpp>

#include <bit>
#include <cmath>

namespace prt {
namespace {

// As in shaders/bake_alpha.glsl.
struct AlphaTriangle {
    glm::vec2 texcoord[3];
    float vertex_alpha[3];
    std::uint32_t material;
    float texel_density;
    std::uint32_t unused;
};
static_assert(sizeof(AlphaTriangle) == 48);
struct AlphaMaterial {
    std::uint32_t mode;
    float cutoff, factor;
    std::uint32_t texels;
    std::int32_t width, height, levels;
    std::uint32_t wrap;
};
static_assert(sizeof(AlphaMaterial) == 32);

constexpr std::uint32_t kNoTexels = ~0u;

/// Tables for triangles that are not opaque.
struct AlphaTables {
    std::vector<std::uint32_t> index; ///< [triangles], counting from 1; 0: opaque
    std::vector<AlphaTriangle> triangles;
    std::vector<AlphaMaterial> materials; ///< [primitives]
    std::vector<std::uint8_t> texels;
};

AlphaMaterial alpha_material(const Scene& scene, const Surfaces& surfaces, const Primitive& primitive,
                             const std::vector<Texture>& textures, std::vector<std::uint8_t>& texels) {
    const Material& m = scene.materials[primitive.material];
    const TextureUse& use = m.base_color_texture;
    AlphaMaterial result{static_cast<std::uint32_t>(m.alpha_mode),
                         m.alpha_cutoff,
                         m.base_color.a,
                         kNoTexels,
                         1,
                         1,
                         1,
                         static_cast<std::uint32_t>(use.wrap_u) | static_cast<std::uint32_t>(use.wrap_v)
                                                                      << 8};
    if (!surfaces.has_texture(scene.vertex_arrays[primitive.vertices], use))
        return result;
    const Texture& texture = textures[static_cast<std::size_t>(use.image)];
    result.texels = static_cast<std::uint32_t>(texels.size());
    result.width = texture.levels[0].width;
    result.height = texture.levels[0].height;
    result.levels = static_cast<std::int32_t>(texture.levels.size());
    for (const Image8& level : texture.levels)
        for (const glm::u8vec4& texel : level.pixels)
            texels.push_back(texel.a);
    return result;
}

AlphaTables make_alpha_tables(const Scene& scene, const Surfaces& surfaces,
                              const std::vector<Texture>& textures) {
    AlphaTables tables;
    tables.index.resize(surfaces.triangles());
    std::vector<std::uint32_t> material_of(scene.primitives.size(), kNoTexels);
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        if (surfaces.opaque(t))
            continue;
        const Primitive& primitive = scene.primitives[surfaces.primitive(t)];
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        const TextureUse& use = scene.materials[primitive.material].base_color_texture;
        std::uint32_t& material = material_of[surfaces.primitive(t)];
        if (material == kNoTexels) {
            material = static_cast<std::uint32_t>(tables.materials.size());
            tables.materials.push_back(alpha_material(scene, surfaces, primitive, textures, tables.texels));
        }
        const AlphaMaterial& m = tables.materials[material];
        const glm::uvec3 local = surfaces.corners(t) - static_cast<unsigned>(vertices.first_receiver);
        AlphaTriangle triangle{{}, {1, 1, 1}, material, 0, 0};
        for (int i = 0; i < 3; ++i) {
            if (m.texels != kNoTexels)
                triangle.texcoord[i] =
                    use.transform *
                    glm::vec3(vertices.texcoords[static_cast<std::size_t>(use.texcoord)][local[i]], 1);
            if (!vertices.colors.empty())
                triangle.vertex_alpha[i] = vertices.colors[local[i]].a;
        }
        const glm::vec2 size(m.width, m.height);
        const glm::vec2 ab = (triangle.texcoord[1] - triangle.texcoord[0]) * size,
                        ac = (triangle.texcoord[2] - triangle.texcoord[0]) * size;
        const glm::vec3& a = vertices.positions[local.x];
        const float area =
            glm::length(glm::cross(vertices.positions[local.y] - a, vertices.positions[local.z] - a));
        const float density = std::abs(ab.x * ac.y - ab.y * ac.x) / area;
        triangle.texel_density = std::isfinite(density) ? density : 0;
        tables.triangles.push_back(triangle);
        tables.index[t] = static_cast<std::uint32_t>(tables.triangles.size());
    }
    tables.texels.resize((tables.texels.size() + 3) / 4 * 4);
    return tables;
}

template <class T>
GlObject storage_buffer(const std::vector<T>& values, const char* what) {
    GLint64 largest = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
    if (static_cast<GLint64>(values.size() * sizeof(T)) > largest)
        throw Error(std::string("the scene is too large for this GPU: ") + what + " take " +
                    std::to_string(values.size() * sizeof(T) >> 20) + " MB, and a buffer holds " +
                    std::to_string(largest >> 20) + " MB");
    return make_buffer(std::as_bytes(std::span(values)));
}

} // namespace

GpuScene::GpuScene(const Scene& scene, const Surfaces& surfaces, const std::vector<Texture>& textures,
                   int threads)
    : triangles_(surfaces.triangles()), has_alpha_(surfaces.has_alpha()) {
    std::vector<glm::vec3> positions;
    for (const VertexArray& vertices : scene.vertex_arrays)
        positions.insert(positions.end(), vertices.positions.begin(), vertices.positions.end());
    std::vector<glm::uvec3> indices(surfaces.triangles());
    for (std::uint32_t t = 0; t < indices.size(); ++t)
        indices[t] = surfaces.corners(t);
    const WideBvh bvh = build_wide_bvh(positions, indices, threads);
    const AlphaTables alpha = make_alpha_tables(scene, surfaces, textures);

    std::vector<glm::vec4> corners;
    corners.reserve(3 * bvh.triangles.size());
    for (const std::uint32_t t : bvh.triangles) {
        const float tags[3] = {std::bit_cast<float>(t), std::bit_cast<float>(alpha.index[t]), 0};
        for (int i = 0; i < 3; ++i)
            corners.emplace_back(positions[indices[t][i]], tags[i]);
    }
    nodes_ = storage_buffer(bvh.nodes, "the nodes");
    corners_ = storage_buffer(corners, "the triangles");
    alpha_triangles_ = storage_buffer(alpha.triangles, "the cut-out triangles");
    alpha_materials_ = storage_buffer(alpha.materials, "the cut-out materials");
    alpha_texels_ = storage_buffer(alpha.texels, "the cut-out textures");
    // On every level at most seven siblings wait besides the child that is visited.
    stack_size_ = 7 * bvh.depth + 2;
}

std::string GpuScene::defines() const {
    return "#define PRT_STACK_SIZE " + std::to_string(stack_size_) + "\n" +
           (has_alpha_ ? "#define PRT_ALPHA\n" : "");
}

void GpuScene::bind() const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_NODES, nodes_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_CORNERS, corners_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_ALPHA_TRIANGLES, alpha_triangles_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_ALPHA_MATERIALS, alpha_materials_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_ALPHA_TEXELS, alpha_texels_.name());
}

} // namespace prt
