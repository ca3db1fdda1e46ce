// Builds scenes for tests of the GPU tracer.

#include "support/gpu_scenes.h"

#include "support/scene_builder.h"

#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <random>

namespace prt::test {

Scene balls_over_floor() {
    return SceneBuilder()
        .floor({0, 0, 0}, 2, 8)
        .sphere({0, 0.8f, 0}, 0.5f, 12)
        .sphere({0.9f, 0.4f, 0.2f}, 0.3f, 8)
        .build();
}

Scene under_a_ceiling(AlphaMode mode) {
    Scene ceiling = SceneBuilder().floor({0, 0.7f, 0}, 1, 3).build();
    VertexArray& v = ceiling.vertex_arrays[0];
    v.texcoords.resize(1);
    for (const glm::vec3& p : v.positions)
        v.texcoords[0].emplace_back(1.7f * p.x + 0.3f, 0.9f * p.z - 0.4f);
    Material& m = ceiling.materials[0];
    m.base_color = {0.7f, 0.4f, 0.3f, 0.8f};
    m.base_color_texture.image = 0;
    m.base_color_texture.wrap_v = Wrap::mirror;
    m.alpha_mode = mode;
    m.double_sided = true;
    return test::join({SceneBuilder().floor({0, 0, 0}, 1, 6).build(), ceiling,
                       SceneBuilder().sphere({0.2f, 0.3f, 0}, 0.2f, 8).build()});
}

Texture dotted_texture() {
    Image8 image{32, 16, {}};
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            image.pixels.emplace_back(200, 220, 180, std::hypot(x - 16, y - 8) < 6 ? 30 : 255);
    return make_texture(image);
}

Scene under_glass(AlphaMode mode) {
    Scene scene = under_a_ceiling(mode);
    Material& m = scene.materials[1];
    m.base_color = {0.9f, 0.8f, 1, 0.8f};
    m.glass = {0.7f, {.image = 1, .texcoord = 0, .transform = {2, 0, 0, 3, 0.1f, 0}}};
    return scene;
}

std::vector<Texture> glass_textures() {
    Image8 image{8, 8, {}};
    for (int i = 0; i < 64; ++i)
        image.pixels.emplace_back(4 * i, 0, 0, 255);
    return {dotted_texture(), make_texture(image, TextureEncoding::linear)};
}

Scene copies_over_floor(int copies, bool alone) {
    Scene ball = SceneBuilder().sphere({0, 0, 0}, 0.2f, 8).build(),
          leaf = SceneBuilder().floor({0, 0, 0}, 0.3f, 1).build();
    leaf.materials[0].alpha_mode = AlphaMode::blend;
    leaf.materials[0].base_color.a = 0.6f;
    leaf.materials[0].base_color_texture.image = 0;
    leaf.materials[0].double_sided = true;
    leaf.vertex_arrays[0].texcoords.resize(1);
    for (const glm::vec3& p : leaf.vertex_arrays[0].positions)
        leaf.vertex_arrays[0].texcoords[0].emplace_back(3 * p.x, 2 * p.z);
    std::vector<Scene> scenes{SceneBuilder().floor({0, 0, 0}, 3, 6).build()};
    for (int i = 0; i < copies; ++i) {
        const auto t = static_cast<float>(i);
        const glm::mat3 rotation =
            (0.5f + 0.1f * t) * glm::mat3_cast(glm::angleAxis(0.7f * t, glm::normalize(glm::vec3(1, t, 2))));
        for (const Scene* mesh : {&ball, &leaf}) {
            Scene copy = *mesh;
            for (glm::vec3& p : copy.vertex_arrays[0].positions) {
                if (mesh == &ball && i == 1)
                    p.y *= 0.5f;
                p = rotation * p +
                    glm::vec3(std::cos(2.4f * t), mesh == &ball ? 0.5f : 1.0f, std::sin(2.4f * t)) *
                        (0.4f + 0.2f * t);
            }
            for (glm::vec3& n : copy.vertex_arrays[0].normals)
                n = glm::normalize(rotation * n);
            scenes.push_back(std::move(copy));
        }
    }
    Scene scene = join(scenes);
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        scene.primitives[p].node = static_cast<int>(p);
        scene.primitives[p].mesh = static_cast<int>(alone || p == 0 ? p : 1000 + p % 2);
        if (p > 0)
            scene.primitives[p].material = p % 2 == 1 ? 1 : 2;
    }
    return scene;
}

Scene degenerate_triangles(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::uniform_int_distribution<int> kind(0, 7);
    const auto point = [&] { return glm::vec3(unit(random), 1.2f + unit(random), unit(random)); };
    Scene scene = SceneBuilder().floor({0, 0, 0}, 2, 5).build();
    VertexArray& v = scene.vertex_arrays[0];
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 a = point();
        glm::vec3 b = a + 0.3f * (point() - glm::vec3(0, 1.2f, 0)),
                  c = a + 0.3f * (point() - glm::vec3(0, 1.2f, 0));
        const int which = kind(random);
        if (which == 0)
            b = c = a; // a point
        else if (which == 1)
            c = 0.5f * (a + b); // a line
        else if (which == 2)
            c = b + glm::vec3(1e-6f, 0, 0); // a needle
        else if (which == 3)
            b = glm::vec3(1e3f, 3, 1e3f) * unit(random); // far away
        const auto first = static_cast<unsigned>(v.positions.size());
        for (const glm::vec3& p : {a, b, c}) {
            v.positions.push_back(p);
            v.normals.emplace_back(0, 1, 0);
        }
        scene.primitives[0].triangles.emplace_back(first, first + 1, first + 2);
        if (which == 4) // twice, from both sides
            scene.primitives[0].triangles.emplace_back(first, first + 2, first + 1);
    }
    return scene;
}

} // namespace prt::test
