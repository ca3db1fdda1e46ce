// A game that relights a model: game SHIPPED.glb SKY.exr OUTPUT.png [frames]
//
// What an engine does is all here; only the window is missing, so that it runs anywhere: after so many
// frames, in which the sky turns once, it writes the last as a picture.

#include "prt/constant_former.h"
#include "prt/dering.h"
#include "prt/gl_context.h"
#include "prt/gltf.h"
#include "prt/image_file.h"
#include "prt/scene.h"
#include "prt/sh_rotation.h"
#include "prt/shader_source.h"

#include <epoxy/gl.h>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace {

constexpr int kWidth = 640, kHeight = 400;

const char* const kFragmentShader = R"(#version 330 core
in vec3 radiance;
out vec4 pixel;
uniform vec3 albedo;
uniform float exposure;
void main() { pixel = vec4(pow(1.0 - exp(-exposure * albedo * max(radiance, 0.0)), vec3(1.0 / 2.2)), 1.0); })";

GLuint shader(GLenum stage, const std::string& source) {
    const GLuint name = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(name, 1, &text, nullptr);
    glCompileShader(name);
    GLint compiled = 0;
    glGetShaderiv(name, GL_COMPILE_STATUS, &compiled);
    if (!compiled)
        throw std::runtime_error("a shader does not compile");
    return name;
}

template <class T>
GLuint buffer(GLenum target, const std::vector<T>& values) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), GL_DYNAMIC_DRAW);
    return name;
}

/// A texture whose rows are kConstantTextureWidth texels of `values`.
template <class T>
GLuint texture(int unit, GLint internal, GLenum format, GLenum type, std::vector<T>& values) {
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
    return name;
}

void play(const char* model, const char* sky, const char* picture, int frames) {
    // Once: model, sky, shader.
    const prt::GltfDocument document = prt::load_gltf(model);
    const prt::Scene scene = prt::extract_scene(document);
    const auto compressed = prt::read_clustered(document, scene);
    if (!compressed)
        throw std::runtime_error("the model is not compressed");
    const prt::ClusteredTransfer& transfer = compressed->transfer;
    const prt::ConstantFormer former(transfer);
    const prt::Light light = prt::deringed(
        prt::project(prt::load_environment(sky).environment, former.order())); // nowhere negative

    const auto context = prt::GlContext::create(prt::GlDevice::any);
    if (!context)
        throw std::runtime_error("no OpenGL");
    const GLuint program = glCreateProgram();
    glAttachShader(program,
                   shader(GL_VERTEX_SHADER, prt::relight_shader(transfer, prt::ConstantSource::texture,
                                                                prt::ShaderLanguage::glsl330)));
    glAttachShader(program, shader(GL_FRAGMENT_SHADER, kFragmentShader));
    glLinkProgram(program);
    glUseProgram(program);

    // Once: the weights of all vertices in one buffer (here packed words), the table of clusters, the
    // constants.
    if (transfer.receivers.format != prt::WeightFormat::packed)
        throw std::runtime_error("this page shows packed weights only");
    const GLuint words = buffer(GL_ARRAY_BUFFER, transfer.receivers.weights);
    auto layouts = prt::cluster_layouts(transfer.bases);
    std::vector<glm::vec4> constants(former.rows());
    std::vector<glm::vec3> turned(light.coefficients.size());
    texture(1, GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, layouts);
    texture(0, GL_RGBA32F, GL_RGBA, GL_FLOAT, constants);
    glUniform1i(glGetUniformLocation(program, "prt_constants"), 0);
    glUniform1i(glGetUniformLocation(program, "prt_clusters"), 1);

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
    glViewport(0, 0, kWidth, kHeight);
    glEnable(GL_DEPTH_TEST);

    struct Mesh {
        GLuint vertex_array;
        GLsizei indices;
        glm::vec3 albedo;
    };
    std::vector<Mesh> meshes;
    for (const prt::Primitive& primitive : scene.primitives) {
        const prt::VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        Mesh mesh{0, static_cast<GLsizei>(3 * primitive.triangles.size()),
                  glm::vec3(scene.materials[primitive.material].base_color)};
        glGenVertexArrays(1, &mesh.vertex_array);
        glBindVertexArray(mesh.vertex_array);
        buffer(GL_ARRAY_BUFFER, vertices.positions);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
        glBindBuffer(GL_ARRAY_BUFFER, words);
        const std::size_t stride = transfer.receivers.stride();
        for (int first = 0; first < transfer.receivers.words; first += 4) { // four words an attribute
            const auto location = static_cast<GLuint>(4 + first / 4);
            glEnableVertexAttribArray(location);
            glVertexAttribIPointer(location, std::min(4, transfer.receivers.words - first), GL_UNSIGNED_INT,
                                   static_cast<GLsizei>(stride),
                                   reinterpret_cast<const void*>(vertices.first_receiver * stride +
                                                                 static_cast<std::size_t>(first) * 4));
        }
        buffer(GL_ELEMENT_ARRAY_BUFFER, primitive.triangles);
        meshes.push_back(mesh);
    }
    const prt::Bounds box = prt::bounds(scene);
    const glm::vec3 centre = 0.5f * (box.low + box.high);
    const float size = glm::length(box.high - box.low);
    const glm::mat4 view_projection =
        glm::perspective(0.6f, float(kWidth) / float(kHeight), 0.01f * size, 10 * size) *
        glm::lookAt(centre + size * glm::vec3(0.6f, 0.6f, 1.1f), centre, glm::vec3(0, 1, 0));
    glUniformMatrix4fv(glGetUniformLocation(program, "view_projection"), 1, GL_FALSE,
                       glm::value_ptr(view_projection));
    const float mean = glm::dot(light.coefficients[0], glm::vec3(0.2126f, 0.7152f, 0.0722f)) * 0.282095f;
    glUniform1f(glGetUniformLocation(program, "exposure"), 1.5f / mean);

    // Every frame: turn the light, form the constants, upload, draw.
    for (int frame = 0; frame < frames; ++frame) {
        prt::ShRotation::about_y(light.order, glm::two_pi<double>() * (frame + 1) / frames)
            .apply(light.coefficients, turned);
        former.form(turned, constants);
        glActiveTexture(GL_TEXTURE0);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, prt::kConstantTextureWidth,
                        static_cast<GLsizei>(constants.size()) / prt::kConstantTextureWidth, GL_RGBA,
                        GL_FLOAT, constants.data());
        glClearColor(0.05f, 0.06f, 0.08f, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (const Mesh& mesh : meshes) {
            glUniform3fv(glGetUniformLocation(program, "albedo"), 1, glm::value_ptr(mesh.albedo));
            glBindVertexArray(mesh.vertex_array);
            glDrawElements(GL_TRIANGLES, mesh.indices, GL_UNSIGNED_INT, nullptr);
        }
    }

    std::vector<glm::u8vec3> pixels(static_cast<std::size_t>(kWidth) * kHeight), upright(pixels.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    for (std::size_t y = 0; y < kHeight; ++y)
        std::copy_n(&pixels[(kHeight - 1 - y) * kWidth], kWidth, &upright[y * kWidth]);
    if (glGetError() != GL_NO_ERROR)
        throw std::runtime_error("OpenGL has noted an error");
    prt::write_png(picture, kWidth, kHeight, upright);
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: game SHIPPED.glb SKY.exr OUTPUT.png [frames]\n");
        return 2;
    }
    try {
        play(argv[1], argv[2], argv[3], argc > 4 ? std::max(1, std::atoi(argv[4])) : 60);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "game: %s\n", error.what());
        return 1;
    }
}
