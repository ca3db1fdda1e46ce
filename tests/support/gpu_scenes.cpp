#include "support/gpu_scenes.h"

#include "support/scene_builder.h"

#include <cmath>

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

} // namespace prt::test
