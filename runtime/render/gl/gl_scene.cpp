// Uploads and draws geometry, textures and materials of a scene.

#include "runtime/render/gl/gl_scene.h"

#include "runtime/load/light_passing.h"
#include "shared_layout.h"
#include "shared_suns.h"

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

namespace prt {
namespace {

GLint wrap_mode(Wrap wrap) {
    switch (wrap) {
    case Wrap::clamp:
        return GL_CLAMP_TO_EDGE;
    case Wrap::mirror:
        return GL_MIRRORED_REPEAT;
    case Wrap::repeat:
        break;
    }
    return GL_REPEAT;
}

GlObject upload(const Texture& texture) {
    if (texture.levels.empty())
        return {};
    const Image8& base = texture.levels[0];
    const GLenum format = texture.encoding == TextureEncoding::srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8;
    GlObject object =
        make_texture_2d(static_cast<int>(texture.levels.size()), format, base.width, base.height);
    for (std::size_t level = 0; level < texture.levels.size(); ++level) {
        const Image8& image = texture.levels[level];
        glTextureSubImage2D(object.name(), static_cast<GLint>(level), 0, 0, image.width, image.height,
                            GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
    }
    glTextureParameteri(object.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(object.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return object;
}

void attach_floats(GLuint vertex_array, const GlObject& buffer, GLuint location, int components,
                   std::size_t first = 0) {
    const std::size_t size = sizeof(float) * static_cast<std::size_t>(components);
    glVertexArrayVertexBuffer(vertex_array, location, buffer.name(), static_cast<GLintptr>(first * size),
                              static_cast<GLsizei>(size));
    glEnableVertexArrayAttrib(vertex_array, location);
    glVertexArrayAttribFormat(vertex_array, location, components, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(vertex_array, location, location);
}

glm::vec3 center_of(const Primitive& primitive, const VertexArray& vertices) {
    glm::vec3 sum(0);
    for (const glm::uvec3& t : primitive.triangles)
        sum += vertices.positions[t.x];
    return sum / static_cast<float>(std::max<std::size_t>(1, primitive.triangles.size()));
}

/// Returns whether each triangle is there twice, once for each side.
bool has_both_sides(const Primitive& primitive, const VertexArray& vertices) {
    std::set<std::array<std::tuple<float, float, float>, 3>> triangles;
    const auto corners_of = [&](const glm::uvec3& t) {
        std::array<std::tuple<float, float, float>, 3> corners;
        for (int i = 0; i < 3; ++i) {
            const glm::vec3& at = vertices.positions[t[i]];
            corners[static_cast<std::size_t>(i)] = {at.x, at.y, at.z};
        }
        std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
        return corners;
    };
    for (const glm::uvec3& t : primitive.triangles)
        triangles.insert(corners_of(t));
    return std::ranges::all_of(primitive.triangles, [&](const glm::uvec3& t) {
        return triangles.contains(corners_of({t.x, t.z, t.y}));
    });
}

/// Binds `texture` with the wrap modes of `use`, and sets its transform. A sampler without a texture is not
/// sampled.
void bind(GLuint unit, const GlObject* texture, const TextureUse& use, int transform) {
    glUniformMatrix3x2fv(transform, 1, GL_FALSE, glm::value_ptr(use.transform));
    if (!texture)
        return;
    glTextureParameteri(texture->name(), GL_TEXTURE_WRAP_S, wrap_mode(use.wrap_u));
    glTextureParameteri(texture->name(), GL_TEXTURE_WRAP_T, wrap_mode(use.wrap_v));
    glBindTextureUnit(unit, texture->name());
}

static_assert(PRT_ALPHA_OPAQUE == static_cast<int>(AlphaMode::opaque) &&
              PRT_ALPHA_MASK == static_cast<int>(AlphaMode::mask) &&
              PRT_ALPHA_BLEND == static_cast<int>(AlphaMode::blend));

} // namespace

GlScene::GlScene(const Scene& scene, std::span<const Texture> textures) : scene_(scene) {
    for (const Texture& texture : textures) {
        textures_.push_back(upload(texture));
        encoded_.push_back(texture.encoding == TextureEncoding::srgb);
    }
    for (const VertexArray& array : scene.vertex_arrays) {
        Vertices vertices;
        vertices.positions = make_buffer(std::span<const glm::vec3>(array.positions));
        vertices.normals = make_buffer(std::span<const glm::vec3>(array.normals));
        if (!array.colors.empty())
            vertices.colors = make_buffer(std::span<const glm::vec4>(array.colors));
        for (const auto& set : array.texcoords)
            vertices.texcoords.push_back(set.empty() ? GlObject()
                                                     : make_buffer(std::span<const glm::vec2>(set)));
        bytes_ += array.size() * (2 * sizeof(glm::vec3) + array.texcoords.size() * sizeof(glm::vec2));
        vertices_.push_back(std::move(vertices));
    }
    for (const Primitive& primitive : scene.primitives) {
        indices_.push_back(make_buffer(std::span<const glm::uvec3>(primitive.triangles)));
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        centers_.push_back(center_of(primitive, vertices));
        twice_.push_back(blocking(primitive) == Blocking::term && has_both_sides(primitive, vertices));
        bytes_ += primitive.triangles.size() * sizeof(glm::uvec3);
    }
}

GlVertexArrays GlScene::make_vertex_arrays() const {
    GlVertexArrays arrays;
    for (const Vertices& vertices : vertices_) {
        const GLuint name = arrays.emplace_back(make_vertex_array()).name();
        attach_floats(name, vertices.positions, PRT_LOCATION_POSITION, 3);
        attach_floats(name, vertices.normals, PRT_LOCATION_NORMAL, 3);
        if (vertices.colors.name() != 0)
            attach_floats(name, vertices.colors, PRT_LOCATION_COLOR, 4);
    }
    return arrays;
}

void GlScene::attach_receivers(const GlVertexArrays& arrays, const GlObject& buffer, std::uint32_t location,
                               int components) const {
    for (std::size_t i = 0; i < arrays.size(); ++i)
        attach_floats(arrays[i].name(), buffer, location, components, scene_.vertex_arrays[i].first_receiver);
}

bool GlScene::is_blended(const Primitive& primitive) const {
    return scene_.materials[primitive.material].alpha_mode == AlphaMode::blend;
}

std::vector<std::size_t> GlScene::blended_from_far(const glm::vec3& position) const {
    std::vector<std::size_t> blended;
    for (std::size_t p = 0; p < scene_.primitives.size(); ++p)
        if (is_blended(scene_.primitives[p]))
            blended.push_back(p);
    std::stable_sort(blended.begin(), blended.end(), [&](std::size_t a, std::size_t b) {
        return glm::distance(position, centers_[a]) > glm::distance(position, centers_[b]);
    });
    return blended;
}

const GlObject* GlScene::texture_of(const TextureUse& use, const Vertices& vertices) const {
    const auto image = static_cast<std::size_t>(use.image), set = static_cast<std::size_t>(use.texcoord);
    const bool there = use.image >= 0 && image < textures_.size() && textures_[image].name() != 0 &&
                       set < vertices.texcoords.size() && vertices.texcoords[set].name() != 0;
    return there ? &textures_[image] : nullptr;
}

void GlScene::prepare(const GlObject& program, const GlVertexArrays& arrays, std::size_t index) const {
    const Primitive& primitive = scene_.primitives[index];
    const Material& material = scene_.materials[primitive.material];
    const Vertices& vertices = vertices_[primitive.vertices];
    const GLuint array = arrays[primitive.vertices].name();
    const TextureUse& use = material.base_color_texture;
    const GlObject* texture = texture_of(use, vertices);
    glUniform1i(uniform(program, "has_texture"), texture != nullptr);
    glUniform4fv(uniform(program, "base_color"), 1, glm::value_ptr(material.base_color));
    glUniform1i(uniform(program, "alpha_mode"), static_cast<int>(material.alpha_mode));
    set_uniform(program, "alpha_cutoff", material.alpha_cutoff);
    glVertexAttrib4f(PRT_LOCATION_COLOR, 1, 1, 1, 1); // used without an array
    glVertexAttrib2f(PRT_LOCATION_TEXCOORD, 0, 0);
    bind(PRT_UNIT_BASE_COLOR, texture, use, uniform(program, "texture_transform"));
    if (texture)
        attach_floats(array, vertices.texcoords[static_cast<std::size_t>(use.texcoord)],
                      PRT_LOCATION_TEXCOORD, 2);
    if (material.double_sided)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glVertexArrayElementBuffer(array, indices_[index].name());
    glBindVertexArray(array);
    if (lightmaps_.layout && uniform(program, "lightmap") >= 0)
        prepare_lightmap(array, index);
    bind_storage(PRT_BINDING_NORMALS, vertices_[primitive.vertices].normals); // shaders/vertex_normals.glsl
    if (uniform(program, "sunlit") >= 0)
        prepare_for_suns(program, primitive);
    if (uniform(program, "emission") >= 0)
        prepare_emission(program, primitive);
}

/// Sets the inputs of shaders/lightmap.glsl for a surface.
void GlScene::prepare_lightmap(std::uint32_t array, std::size_t primitive) const {
    const LightmapPlacement& placement = lightmaps_.layout->placements[primitive];
    const Vertices& vertices = vertices_[scene_.primitives[primitive].vertices];
    attach_floats(array, vertices.texcoords[static_cast<std::size_t>(placement.texcoord)],
                  PRT_LOCATION_LIGHTMAP, 2);
    glBindTextureUnit(PRT_UNIT_LIGHTMAP, lightmaps_.maps[placement.map].name());
}

/// Sets the inputs of shaders/emission.glsl for a surface.
void GlScene::prepare_emission(const GlObject& program, const Primitive& primitive) const {
    const Emission& emission = scene_.materials[primitive.material].emission;
    const Vertices& vertices = vertices_[primitive.vertices];
    const auto image = static_cast<std::size_t>(emission.texture.image);
    const bool missing =
        emission.texture.image >= 0 && image < textures_.size() && textures_[image].name() == 0;
    const glm::vec3 radiance =
        emission_.empty() || missing ? glm::vec3(0) : emission.radiance * emission_[primitive.material];
    const GlObject* texture = radiance == glm::vec3(0) ? nullptr : texture_of(emission.texture, vertices);
    glUniform3fv(uniform(program, "emission"), 1, glm::value_ptr(radiance));
    glUniform1i(uniform(program, "has_emission_texture"), texture != nullptr);
    bind(PRT_UNIT_EMISSION, texture, emission.texture, uniform(program, "emission_transform"));
    if (texture)
        bind_storage(PRT_BINDING_EMISSION_TEXCOORDS,
                     vertices.texcoords[static_cast<std::size_t>(emission.texture.texcoord)]);
}

/// Sets the inputs of shaders/sun_light.glsl for a surface.
void GlScene::prepare_for_suns(const GlObject& program, const Primitive& primitive) const {
    const Material& material = scene_.materials[primitive.material];
    const DiffuseTransmission& transmission = material.transmission;
    const Vertices& vertices = vertices_[primitive.vertices];
    const bool thin = transmission.factor > 0;
    const GlObject* factor = thin ? texture_of(transmission.factor_texture, vertices) : nullptr;
    const GlObject* tint = thin ? texture_of(transmission.color_texture, vertices) : nullptr;
    glUniform1i(uniform(program, "sunlit"), !lit_through_medium(material));
    glUniform1f(uniform(program, "transmission_factor"), transmission.factor);
    glUniform3fv(uniform(program, "transmission_tint"), 1, glm::value_ptr(transmission.color));
    glUniform1i(uniform(program, "has_transmission_factor"), factor != nullptr);
    glUniform1i(uniform(program, "has_transmission_tint"), tint != nullptr);
    bind(PRT_UNIT_TRANSMISSION_FACTOR, factor, transmission.factor_texture,
         uniform(program, "factor_transform"));
    bind(PRT_UNIT_TRANSMISSION_TINT, tint, transmission.color_texture, uniform(program, "tint_transform"));
    const auto texcoords = [&](const TextureUse& use) -> const GlObject& {
        return vertices.texcoords[static_cast<std::size_t>(use.texcoord)];
    };
    if (factor)
        bind_storage(PRT_BINDING_FACTOR_TEXCOORDS, texcoords(transmission.factor_texture));
    if (tint)
        bind_storage(PRT_BINDING_TINT_TEXCOORDS, texcoords(transmission.color_texture));
}

Blocking GlScene::blocking(const Primitive& primitive) const {
    const Material& material = scene_.materials[primitive.material];
    const Vertices& vertices = vertices_[primitive.vertices];
    if (!material.casts_shadow)
        return Blocking::nothing;
    const bool varies = texture_of(material.base_color_texture, vertices) || vertices.colors.name() != 0;
    const bool blended = material.alpha_mode == AlphaMode::blend && (varies || material.base_color.a < 1);
    return blended || material.glass.factor > 0 ? Blocking::term : Blocking::all;
}

void GlScene::draw_caster(const GlObject& program, const GlVertexArrays& arrays, std::size_t index) const {
    const Primitive& primitive = scene_.primitives[index];
    const Glass& glass = scene_.materials[primitive.material].glass;
    const Vertices& vertices = vertices_[primitive.vertices];
    prepare(program, arrays, index);
    if (!twice_[index])
        glDisable(GL_CULL_FACE);
    const GlObject* texture = glass.factor > 0 ? texture_of(glass.texture, vertices) : nullptr;
    glUniform1f(uniform(program, "glass"), glass_transmittance(scene_.materials[primitive.material]));
    glUniform1i(uniform(program, "has_glass_texture"), texture != nullptr);
    bind(PRT_UNIT_GLASS, texture, glass.texture, uniform(program, "glass_transform"));
    if (texture) {
        glUniform1i(uniform(program, "glass_as_color"),
                    encoded_[static_cast<std::size_t>(glass.texture.image)]);
        attach_floats(arrays[primitive.vertices].name(),
                      vertices.texcoords[static_cast<std::size_t>(glass.texture.texcoord)],
                      PRT_LOCATION_GLASS_TEXCOORD, 2);
    }
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * primitive.triangles.size()), GL_UNSIGNED_INT,
                   nullptr);
    glDisable(GL_CULL_FACE);
}

void GlScene::draw(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const {
    const auto all = static_cast<std::uint32_t>(scene_.primitives[primitive].triangles.size());
    draw(program, arrays, primitive, std::array{TriangleRange{0, all}});
}

void GlScene::draw(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive,
                   std::span<const TriangleRange> ranges) const {
    if (ranges.empty())
        return;
    prepare(program, arrays, primitive);
    std::vector<GLsizei> counts;
    std::vector<const void*> offsets;
    for (const TriangleRange& range : ranges) {
        counts.push_back(static_cast<GLsizei>(3 * range.count));
        offsets.push_back(reinterpret_cast<const void*>(std::uintptr_t{range.first} * sizeof(glm::uvec3)));
    }
    glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, offsets.data(),
                        static_cast<GLsizei>(counts.size()));
}

void GlScene::draw_instances(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive,
                             std::size_t count) const {
    prepare(program, arrays, primitive);
    glDrawElementsInstanced(GL_TRIANGLES,
                            static_cast<GLsizei>(3 * scene_.primitives[primitive].triangles.size()),
                            GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(count));
}

GlObject make_texture_2d(int levels, std::uint32_t format, int width, int height) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    GlObject texture(GlKind::texture, name);
    glTextureStorage2D(name, levels, format, width, height);
    check_gl("a texture");
    return texture;
}

GlObject make_background(const Image& image) {
    GlObject texture = make_texture_2d(1, GL_RGB32F, image.width, image.height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(texture.name(), 0, 0, 0, image.width, image.height, GL_RGB, GL_FLOAT,
                        image.pixels.data());
    glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    return texture;
}

} // namespace prt
