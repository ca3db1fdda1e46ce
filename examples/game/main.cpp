// A game that relights a model: game SHIPPED.glb SKY.exr OUTPUT.png [frames]
// It shows all steps of an engine from top to bottom, without a window, so that it runs anywhere. The sky
// rotates once during the given number of frames; the last frame is written as a picture. The sun is separate
// from the sky: the game draws it with its own shadow map, and transfer lights the rest.

#include "prt/core/cluster_lighting.h"
#include "prt/core/dering.h"
#include "prt/core/light.h"
#include "prt/core/sh_rotation.h"
#include "prt/fit/suns.h"
#include "prt/gl/gl_context.h"
#include "prt/image/image_file.h"
#include "prt/load/model.h"
#include "prt/shader/shader_source.h"
#include "shared_layout.h" // attribute locations of the shader

#include <epoxy/gl.h>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace {

constexpr int kWidth = 640, kHeight = 400;
constexpr int kConstantsUnit = 0, kClustersUnit = 1, kShadowUnit = 2; // texture units
constexpr int kShadowTexels = 2048;                                   // texels along a side of the shadow map

struct World {
    prt::Scene scene;
    prt::ClusteredTransfer transfer;
    prt::Light sky; ///< without the sun
    prt::Sun sun;   ///< black if the sky has no sun, or the transfer has no separate direct term
};

/// Shader programs: the relit picture, and the sun's shadow map.
struct Programs {
    GLuint picture, shadow;
};

struct Mesh {
    GLuint vertex_array;
    GLsizei indices;
    glm::vec3 albedo;
};

// ---- Once: the model with its transfer, and the sky.

World load(const char* model, const char* sky) {
    prt::Model shipped = prt::load_model(model);
    if (!shipped.vertices)
        throw std::runtime_error("the model contains no compressed transfer; run prt compress first");
    prt::ClusteredTransfer& transfer = shipped.vertices->transfer;
    const prt::TransferLayout& layout = transfer.bases.layout;
    const int suns = layout.has(prt::TermKind::direct) ? 1 : 0;
    const prt::SunSplit split =
        prt::find_suns(prt::load_environment(sky).environment, {.order = layout.order, .count = suns});
    const prt::Light light = prt::deringed(prt::project(split.remainder, layout.order)); // nowhere negative
    return {std::move(shipped.scene), std::move(transfer), light,
            split.suns.empty() ? prt::Sun{} : split.suns[0]};
}

// ---- Once: the programs. prt_exit_radiance(position, normal) is prtkit's, written for the model; all else
// is the game's.

std::string read(const std::string& file) {
    std::ifstream stream(GAME_FOLDER "/" + file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

GLuint compile(GLenum stage, const std::string& source) {
    const GLuint name = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(name, 1, &text, nullptr);
    glCompileShader(name);
    GLint compiled = 0;
    glGetShaderiv(name, GL_COMPILE_STATUS, &compiled);
    if (!compiled)
        throw std::runtime_error("the driver cannot compile a shader");
    return name;
}

GLuint link(const std::string& vertex, const std::string& fragment) {
    const GLuint program = glCreateProgram();
    glAttachShader(program, compile(GL_VERTEX_SHADER, vertex));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragment));
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked)
        throw std::runtime_error("the driver cannot link a program");
    return program;
}

Programs make_programs(const prt::ClusteredTransfer& transfer) {
    constexpr auto kLanguage = prt::ShaderLanguage::glsl330;
    const std::string relight = prt::shader_source(
        "prt_exit_radiance.glsl", prt::relight_defines(transfer, prt::ConstantSource::texture, kLanguage),
        kLanguage);
    const Programs programs{link(relight + read("game.vert"), read("game.frag")),
                            link(read("shadow.vert"), read("shadow.frag"))};
    glUseProgram(programs.picture);
    glUniform1i(glGetUniformLocation(programs.picture, "prt_constants"), kConstantsUnit);
    glUniform1i(glGetUniformLocation(programs.picture, "prt_clusters"), kClustersUnit);
    glUniform1i(glGetUniformLocation(programs.picture, "shadow_map"), kShadowUnit);
    return programs;
}

// ---- Once: vertices. One buffer holds the weights of the whole model, another its clusters.

template <class T>
GLuint buffer(GLenum target, const std::vector<T>& values) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), GL_STATIC_DRAW);
    return name;
}

const void* offset(std::size_t bytes) {
    return reinterpret_cast<const void*>(bytes);
}

/// Attributes of packed weights, in the bound buffer: four words per attribute; they also contain the
/// cluster.
void attach_words(const prt::ClusteredReceivers& receivers, std::size_t first) {
    const std::size_t stride = receivers.stride();
    for (int word = 0; word < receivers.words; word += 4) {
        const auto location = static_cast<GLuint>(PRT_LOCATION_WEIGHTS + word / 4);
        glEnableVertexAttribArray(location);
        glVertexAttribIPointer(location, std::min(4, receivers.words - word), GL_UNSIGNED_INT,
                               static_cast<GLsizei>(stride),
                               offset(first * stride + static_cast<std::size_t>(word) * sizeof(GLuint)));
    }
}

/// Attributes of weights that are floats, four an attribute.
void attach_weights(const prt::ClusteredReceivers& receivers, std::size_t first) {
    const std::size_t stride = receivers.stride();
    for (int weight = 0; weight < receivers.components; weight += 4) {
        const auto location = static_cast<GLuint>(PRT_LOCATION_WEIGHTS + weight / 4);
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, 4, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                              offset(first * stride + static_cast<std::size_t>(weight) * sizeof(GLfloat)));
    }
}

void attach_transfer(const prt::ClusteredReceivers& receivers, GLuint weights, GLuint clusters,
                     std::size_t first) {
    glBindBuffer(GL_ARRAY_BUFFER, weights);
    if (receivers.format == prt::WeightFormat::packed)
        return attach_words(receivers, first);
    attach_weights(receivers, first);
    glBindBuffer(GL_ARRAY_BUFFER, clusters);
    glEnableVertexAttribArray(PRT_LOCATION_CLUSTER);
    glVertexAttribIPointer(PRT_LOCATION_CLUSTER, 1, GL_UNSIGNED_SHORT, 0, offset(first * sizeof(GLushort)));
}

std::vector<Mesh> upload_meshes(const World& world) {
    const prt::ClusteredReceivers& receivers = world.transfer.receivers;
    const GLuint weights = buffer(GL_ARRAY_BUFFER, receivers.weights),
                 clusters = buffer(GL_ARRAY_BUFFER, receivers.clusters);
    std::vector<Mesh> meshes;
    for (const prt::Primitive& primitive : world.scene.primitives) {
        const prt::VertexArray& vertices = world.scene.vertex_arrays[primitive.vertices];
        if (vertices.lobes) // a figure: see prt/core/lobes.h
            continue;
        Mesh mesh{0, static_cast<GLsizei>(3 * primitive.triangles.size()),
                  glm::vec3(world.scene.materials[primitive.material].base_color)};
        glGenVertexArrays(1, &mesh.vertex_array);
        glBindVertexArray(mesh.vertex_array);
        buffer(GL_ARRAY_BUFFER, vertices.positions);
        glEnableVertexAttribArray(PRT_LOCATION_POSITION);
        glVertexAttribPointer(PRT_LOCATION_POSITION, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
        buffer(GL_ARRAY_BUFFER, vertices.normals);
        glEnableVertexAttribArray(PRT_LOCATION_NORMAL);
        glVertexAttribPointer(PRT_LOCATION_NORMAL, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
        attach_transfer(receivers, weights, clusters, vertices.first_receiver);
        buffer(GL_ELEMENT_ARRAY_BUFFER, primitive.triangles);
        meshes.push_back(mesh);
    }
    return meshes;
}

// ---- Once: the tables that the vertex shader reads, as textures of kConstantTextureWidth texels a row.

template <class T>
void make_table(int unit, GLint internal, GLenum format, GLenum type, std::vector<T>& values) {
    const int width = prt::kConstantTextureWidth;
    const int height = (static_cast<int>(values.size()) + width - 1) / width;
    values.resize(static_cast<std::size_t>(width * height));
    GLuint name = 0;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, internal, width, height, 0, format, type, values.data());
}

/// Creates both tables. Returns the constants, which change with the light.
std::vector<glm::vec4> make_tables(const prt::ClusteredTransfer& transfer) {
    auto layouts = prt::cluster_layouts(transfer.bases);
    make_table(kClustersUnit, GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, layouts);
    std::vector<glm::vec4> constants(prt::constant_rows(transfer.bases));
    make_table(kConstantsUnit, GL_RGBA32F, GL_RGBA, GL_FLOAT, constants);
    return constants;
}

// ---- Once: a screen, a shadow map and a camera.

GLuint make_screen() {
    GLuint framebuffer = 0, targets[2] = {};
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenRenderbuffers(2, targets);
    for (int i = 0; i < 2; ++i) {
        glBindRenderbuffer(GL_RENDERBUFFER, targets[i]);
        glRenderbufferStorage(GL_RENDERBUFFER, i == 0 ? GL_RGBA8 : GL_DEPTH_COMPONENT24, kWidth, kHeight);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, i == 0 ? GL_COLOR_ATTACHMENT0 : GL_DEPTH_ATTACHMENT,
                                  GL_RENDERBUFFER, targets[i]);
    }
    glEnable(GL_DEPTH_TEST);
    return framebuffer;
}

GLuint make_shadow_map() {
    GLuint framebuffer = 0, map = 0;
    glGenTextures(1, &map);
    glActiveTexture(GL_TEXTURE0 + kShadowUnit);
    glBindTexture(GL_TEXTURE_2D, map);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, kShadowTexels, kShadowTexels, 0, GL_DEPTH_COMPONENT,
                 GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, map, 0);
    glDrawBuffer(GL_NONE);
    return framebuffer;
}

void set_camera(GLuint program, const World& world) {
    const prt::Bounds box = prt::bounds(world.scene);
    const glm::vec3 center = 0.5f * (box.low + box.high);
    const float size = glm::length(box.high - box.low);
    const glm::mat4 view_projection =
        glm::perspective(0.6f, float(kWidth) / float(kHeight), 0.01f * size, 10 * size) *
        glm::lookAt(center + size * glm::vec3(0.6f, 0.6f, 1.1f), center, glm::vec3(0, 1, 0));
    glUniformMatrix4fv(glGetUniformLocation(program, "view_projection"), 1, GL_FALSE,
                       glm::value_ptr(view_projection));
    // The mean luminance of the light is its first coefficient times the first basis function.
    const prt::Light all = prt::sum(world.sky, prt::as_light(world.sun, world.sky.order));
    const float mean = prt::luminance(all.coefficients[0]) * static_cast<float>(prt::kY00);
    glUniform1f(glGetUniformLocation(program, "exposure"), 0.8f / mean);
}

// ---- Every frame: draw the shadow map, upload the constants of the current light, draw the picture.

/// From the world to the sun's map, [0, 1]³: a cube round the scene.
glm::mat4 sun_view(const World& world, const glm::vec3& towards_sun) {
    const prt::Bounds box = prt::bounds(world.scene);
    const glm::vec3 center = 0.5f * (box.low + box.high);
    const float radius = 0.505f * glm::length(box.high - box.low);
    const glm::vec3 up = std::abs(towards_sun.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::mat4 to_unit_cube =
        glm::translate(glm::mat4(1), glm::vec3(0.5f)) * glm::scale(glm::mat4(1), glm::vec3(0.5f));
    return to_unit_cube * glm::ortho(-radius, radius, -radius, radius, 0.0f, 2 * radius) *
           glm::lookAt(center + radius * towards_sun, center, up);
}

void draw_shadows(GLuint program, const std::vector<Mesh>& meshes, const glm::mat4& sun_map) {
    glViewport(0, 0, kShadowTexels, kShadowTexels);
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "sun_map"), 1, GL_FALSE, glm::value_ptr(sun_map));
    glClear(GL_DEPTH_BUFFER_BIT);
    for (const Mesh& mesh : meshes) {
        glBindVertexArray(mesh.vertex_array);
        glDrawElements(GL_TRIANGLES, mesh.indices, GL_UNSIGNED_INT, nullptr);
    }
}

void set_sun(GLuint program, const prt::Sun& sun, const glm::mat4& sun_map) {
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "sun_map"), 1, GL_FALSE, glm::value_ptr(sun_map));
    glUniform3fv(glGetUniformLocation(program, "towards_sun"), 1, glm::value_ptr(sun.towards));
    glUniform3fv(glGetUniformLocation(program, "sun_irradiance"), 1, glm::value_ptr(sun.irradiance));
    glUniform1f(glGetUniformLocation(program, "sun_radius"), static_cast<float>(std::tan(sun.half_angle)));
}

void draw(GLuint program, const std::vector<Mesh>& meshes, const std::vector<glm::vec4>& constants) {
    glViewport(0, 0, kWidth, kHeight);
    glActiveTexture(GL_TEXTURE0 + kConstantsUnit);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, prt::kConstantTextureWidth,
                    static_cast<GLsizei>(constants.size()) / prt::kConstantTextureWidth, GL_RGBA, GL_FLOAT,
                    constants.data());
    glClearColor(0.05f, 0.06f, 0.08f, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (const Mesh& mesh : meshes) {
        glUniform3fv(glGetUniformLocation(program, "albedo"), 1, glm::value_ptr(mesh.albedo));
        glBindVertexArray(mesh.vertex_array);
        glDrawElements(GL_TRIANGLES, mesh.indices, GL_UNSIGNED_INT, nullptr);
    }
}

void play(World& world, int frames) {
    const GLuint screen = make_screen(), shadow_map = make_shadow_map();
    const Programs programs = make_programs(world.transfer);
    set_camera(programs.picture, world);
    const std::vector<Mesh> meshes = upload_meshes(world);
    std::vector<glm::vec4> constants = make_tables(world.transfer);
    const prt::ClusterLighting relighter(world.transfer);
    prt::free_rows(world.transfer);
    std::vector<glm::vec3> rotated(world.sky.coefficients.size());
    for (int frame = 0; frame < frames; ++frame) {
        const double angle = glm::two_pi<double>() * (frame + 1) / frames;
        prt::ShRotation::about_y(world.sky.order, angle).apply(world.sky.coefficients, rotated);
        prt::Sun sun = world.sun;
        sun.towards = glm::vec3(glm::rotate(glm::dmat4(1), angle, glm::dvec3(0, 1, 0)) *
                                glm::dvec4(glm::dvec3(world.sun.towards), 0));
        // The sun is part of the light after a bounce; the shader adds its direct light.
        relighter.update({rotated, prt::as_light(sun, world.sky.order).coefficients}, constants);
        const glm::mat4 sun_map = sun_view(world, sun.towards);
        glBindFramebuffer(GL_FRAMEBUFFER, shadow_map);
        draw_shadows(programs.shadow, meshes, sun_map);
        set_sun(programs.picture, sun, sun_map);
        glBindFramebuffer(GL_FRAMEBUFFER, screen);
        draw(programs.picture, meshes, constants);
    }
}

void save(const char* picture) {
    std::vector<glm::u8vec3> pixels(static_cast<std::size_t>(kWidth) * kHeight), upright(pixels.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    for (std::size_t y = 0; y < kHeight; ++y)
        std::copy_n(&pixels[(kHeight - 1 - y) * kWidth], kWidth, &upright[y * kWidth]);
    if (glGetError() != GL_NO_ERROR)
        throw std::runtime_error("OpenGL reports an error");
    prt::write_png(picture, kWidth, kHeight, upright);
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: game SHIPPED.glb SKY.exr OUTPUT.png [frames]\n");
        return 2;
    }
    try {
        World world = load(argv[1], argv[2]);
        const auto context = prt::GlContext::create(prt::GlDevice::any);
        if (!context)
            throw std::runtime_error("OpenGL 4.5 is not available");
        play(world, argc > 4 ? std::max(1, std::atoi(argv[4])) : 60);
        save(argv[3]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "game: %s\n", error.what());
        return 1;
    }
}
