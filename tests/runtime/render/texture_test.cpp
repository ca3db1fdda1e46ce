// Tests texture lookups.

#include "prt/render/texture.h"

#include "prt/core/error.h"
#include "prt/render/tone_map.h"

#include <gtest/gtest.h>

namespace prt {
namespace {

TEST(Texture, NeedsDependOnTheRequestedLight) {
    Scene scene;
    for (int m = 0; m < 3; ++m) { // opaque, cut out, shining
        Material& material = scene.materials.emplace_back();
        material.base_color_texture.image = m;
        material.alpha_mode = m == 1 ? AlphaMode::mask : AlphaMode::opaque;
        if (m == 2)
            material.emission.texture.image = 3;
        scene.primitives.emplace_back().material = static_cast<std::size_t>(m);
    }
    const auto needed = [&](TextureNeeds needs) {
        std::vector<int> images;
        for (const auto& [image, encoding] : needed_images(scene, needs))
            images.push_back(image);
        return images;
    };
    EXPECT_EQ(needed(TextureNeeds::shadows), (std::vector<int>{1}));
    EXPECT_EQ(needed(TextureNeeds::visibility), (std::vector<int>{1, 3}));
    EXPECT_EQ(needed(TextureNeeds::pictures), (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(needed(TextureNeeds::all), (std::vector<int>{0, 1, 2, 3}));
    scene.images = {{"image 0", {}}, {"image 1 'leaf.png'", {}, "cannot be read: gone"}};
    try {
        load_textures(scene, BadTextures::error, TextureNeeds::shadows);
        FAIL();
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("image 1 'leaf.png' cannot be read: gone"))
            << error.what();
    }
    EXPECT_TRUE(load_textures(scene, BadTextures::ignore, TextureNeeds::shadows).at(1).levels.empty());
}

TEST(Texture, MipsAverageInLinearLight) {
    const Texture texture = make_texture({2, 1, {{255, 255, 255, 255}, {0, 0, 0, 255}}});
    ASSERT_EQ(texture.levels.size(), 2u);
    EXPECT_NEAR(srgb_decode(static_cast<float>(texture.levels[1].pixels[0].r) / 255), 0.5f, 0.005f);
}

TEST(Texture, MipsOfNumbersAverageTheNumbers) {
    const Texture texture =
        make_texture({2, 1, {{255, 100, 0, 255}, {0, 50, 200, 255}}}, TextureEncoding::linear);
    EXPECT_EQ(texture.levels[1].pixels[0], glm::u8vec4(128, 75, 100, 255));
    const glm::vec4 middle = sample(texture, {}, {0.5f, 0.5f}, 0);
    EXPECT_NEAR(middle.r, 0.5f, 1e-6f);
    EXPECT_NEAR(middle.g, 75.0f / 255, 1e-6f);
}

TEST(Texture, OddSizesEndInOneTexel) {
    Image8 image{7, 3, std::vector<glm::u8vec4>(21, {50, 100, 150, 200})};
    const Texture texture = make_texture(image);
    EXPECT_EQ(texture.levels.back().width, 1);
    EXPECT_EQ(texture.levels.back().height, 1);
    EXPECT_EQ(texture.levels.back().pixels[0], glm::u8vec4(50, 100, 150, 200));
}

TEST(Texture, TexelCentersAndWrapModes) {
    Image8 image{4, 1, {}};
    for (int i = 0; i < 4; ++i)
        image.pixels.emplace_back(0, 0, 0, 10 * i);
    const Texture texture = make_texture(image);
    TextureUse use;
    const auto alpha = [&](float u) { return 255 * sample(texture, use, {u, 0.5f}, 0).a; };
    EXPECT_NEAR(alpha(0.125f), 0, 1e-3f);
    EXPECT_NEAR(alpha(0.375f), 10, 1e-3f);
    EXPECT_NEAR(alpha(0.25f), 5, 1e-3f);
    EXPECT_NEAR(alpha(1.375f), 10, 1e-3f);
    EXPECT_NEAR(alpha(-0.125f), 30, 1e-3f);
    use.wrap_u = Wrap::clamp;
    EXPECT_NEAR(alpha(1.375f), 30, 1e-3f);
    EXPECT_NEAR(alpha(-5), 0, 1e-3f);
    use.wrap_u = Wrap::mirror;
    EXPECT_NEAR(alpha(1.125f), 30, 1e-3f);
    EXPECT_NEAR(alpha(-0.375f), 10, 1e-3f);
}

TEST(Texture, LevelOfDetailBlendsLevels) {
    const Texture texture = make_texture({2, 1, {{0, 0, 0, 255}, {0, 0, 0, 0}}});
    EXPECT_NEAR(sample(texture, {}, {0.25f, 0.5f}, 0).a, 1, 1e-3f);
    EXPECT_NEAR(sample(texture, {}, {0.25f, 0.5f}, 9).a, 0.5f, 5e-3f);
    EXPECT_NEAR(sample(texture, {}, {0.25f, 0.5f}, 0.5f).a, 0.75f, 5e-3f);
}

} // namespace
} // namespace prt
