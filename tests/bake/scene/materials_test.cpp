// Tests cut-outs, blended surfaces, leaves, receivers inside geometry, and textures at the hit.

#include "bake/scene/surfaces.h"
#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "support/scene_builder.h"
#include "support/traced.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

using test::SceneBuilder;

/// Transfer of one receiver under `scene`, with its textures.
std::vector<float> transfer_below(const Scene& scene, const std::vector<Texture>& textures, int rays = 4096) {
    const TraceScene trace_scene(scene, textures);
    return test::traced_at(trace_scene, {0.1f, 0, 0}, {0, 1, 0}, {.order = 4, .rays = rays, .seed = 1})
        .vectors;
}

/// A square of side 2 at height 1, facing down, with texture coordinates over it.
Scene ceiling() {
    Scene scene = SceneBuilder().quad({-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}).build();
    VertexArray& v = scene.vertex_arrays[0];
    v.texcoords.resize(1);
    for (const glm::vec3& p : v.positions)
        v.texcoords[0].emplace_back((p.x + 1) / 2, (p.z + 1) / 2);
    return scene;
}

/// Alpha 0 inside the middle square of side 1 of the ceiling, 255 outside.
Texture hole_texture() {
    constexpr int kSize = 64;
    Image8 image{kSize, kSize, {}};
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const bool hole = x >= kSize / 4 && x < 3 * kSize / 4 && y >= kSize / 4 && y < 3 * kSize / 4;
            image.pixels.emplace_back(255, 255, 255, hole ? 0 : 255);
        }
    return make_texture(image);
}

TEST(CutOut, IsTheSameAsAModelledHole) {
    Scene masked = ceiling();
    masked.materials[0].alpha_mode = AlphaMode::mask;
    masked.materials[0].base_color_texture.image = 0;
    const Scene modelled = SceneBuilder()
                               .quad({-1, 1, -1}, {1, 1, -1}, {1, 1, -0.5f}, {-1, 1, -0.5f})
                               .quad({-1, 1, 0.5f}, {1, 1, 0.5f}, {1, 1, 1}, {-1, 1, 1})
                               .quad({-1, 1, -0.5f}, {-0.5f, 1, -0.5f}, {-0.5f, 1, 0.5f}, {-1, 1, 0.5f})
                               .quad({0.5f, 1, -0.5f}, {1, 1, -0.5f}, {1, 1, 0.5f}, {0.5f, 1, 0.5f})
                               .build();
    const auto a = transfer_below(masked, {hole_texture()}), b = transfer_below(modelled, {});
    for (std::size_t k = 0; k < a.size();
         ++k) // the edge of alpha 0.5 is where the hole's is, to the rounding
        EXPECT_NEAR(a[k], b[k], 2e-4f) << k;
    const auto whole = transfer_below(ceiling(), {});
    EXPECT_GT(a[0], whole[0] + 0.02f); // and the hole does let light in
}

TEST(Blended, SurfacesTransmitTheirFraction) {
    Scene half = ceiling();
    half.materials[0].alpha_mode = AlphaMode::blend;
    half.materials[0].base_color.a = 0.25f;
    const auto open = transfer_below(SceneBuilder().floor({0, -9, 0}, 0.1f).build(), {});
    const auto blocked = transfer_below(ceiling(), {}), through = transfer_below(half, {});
    // If more rays are blocked than open, the open ones are summed, otherwise the blocked ones: equal up to
    // sampling error.
    for (std::size_t k = 0; k < open.size(); ++k)
        EXPECT_NEAR(through[k], 0.75f * open[k] + 0.25f * blocked[k], 2e-4f) << k;
    // Two of them, one over the other and larger, so that every ray that meets one meets both.
    Scene far = half;
    for (glm::vec3& p : far.vertex_arrays[0].positions)
        p *= glm::vec3(1.1f, 1.1f, 1.1f);
    const Scene both = test::join({half, far});
    const auto twice = transfer_below(both, {});
    const auto far_alone = transfer_below(far, {});
    EXPECT_LT(twice[0], through[0]);
    EXPECT_LT(twice[0], far_alone[0]);
    EXPECT_GT(twice[0], blocked[0]);
}

TEST(Blended, LayersMultiply) {
    // Seven sheets without end (as far as 256 rays see) of transmittance 0.8.
    std::vector<Scene> sheets;
    for (int i = 1; i <= 7; ++i) {
        Scene sheet = SceneBuilder().floor({0, 0.1f * static_cast<float>(i), 0}, 1e4f).build();
        sheet.materials[0].alpha_mode = AlphaMode::blend;
        sheet.materials[0].base_color.a = 0.2f;
        sheets.push_back(sheet);
    }
    const auto t = transfer_below(test::join(sheets), {}, 256);
    std::array<double, 16> lobe{};
    clamped_cosine_lobe(4, {0, 1, 0}, lobe);
    for (std::size_t k = 0; k < t.size(); ++k)
        EXPECT_NEAR(static_cast<double>(t[k]), std::pow(0.8, 7) * lobe[k], 0.01) << k;
}

/// A texture of one texel that holds numbers.
Texture numbers(const glm::u8vec4& texel) {
    return make_texture({1, 1, {texel}}, TextureEncoding::linear);
}

TEST(Glass, PassesItsFactorTimesItsTextureTimesItsTint) {
    // Two sheets without end of grey glass: factor 0.9, red of the texture 0.6, tint 0.5.
    std::vector<Scene> sheets;
    for (int i = 1; i <= 2; ++i) {
        Scene sheet = SceneBuilder().floor({0, 0.1f * static_cast<float>(i), 0}, 1e4f).build();
        sheet.vertex_arrays[0].texcoords = {std::vector<glm::vec2>(sheet.receivers(), {0.5f, 0.5f})};
        sheet.materials[0].base_color = {0.5f, 0.5f, 0.5f, 1};
        sheet.materials[0].glass = {0.9f, {.image = 0}};
        sheets.push_back(sheet);
    }
    std::array<double, 16> lobe{};
    clamped_cosine_lobe(4, {0, 1, 0}, lobe);
    const auto t = transfer_below(test::join(sheets), {numbers({153, 0, 0, 0})}, 256);
    for (std::size_t k = 0; k < t.size(); ++k)
        EXPECT_NEAR(static_cast<double>(t[k]), std::pow(0.9 * 0.6 * 0.5, 2) * lobe[k], 0.005) << k;
    // With blending: alpha stops its fraction first.
    sheets.pop_back();
    sheets[0].materials[0].alpha_mode = AlphaMode::blend;
    sheets[0].materials[0].base_color.a = 0.25f;
    const auto both = transfer_below(sheets[0], {numbers({153, 0, 0, 0})}, 256);
    for (std::size_t k = 0; k < both.size(); ++k)
        EXPECT_NEAR(static_cast<double>(both[k]), (1 - 0.25 * (1 - 0.27)) * lobe[k], 0.005) << k;
}

TEST(Glass, ReflectsDiffuselyByOneMinusItsFactor) {
    Scene sheet = SceneBuilder().floor({0, 0, 0}, 1).build();
    sheet.vertex_arrays[0].texcoords = {std::vector<glm::vec2>(sheet.receivers(), {0.5f, 0.5f})};
    sheet.materials[0].glass.texture.image = 0;
    constexpr float kTexel = 0.6f;
    for (const float factor : {0.0f, 0.3f, 1.0f})
        for (const glm::vec3& tint : {glm::vec3(1), glm::vec3(0.2f, 0.5f, 0.9f)}) {
            sheet.materials[0].base_color = glm::vec4(tint, 1);
            sheet.materials[0].glass.factor = factor;
            const TraceScene traced(sheet, {numbers({153, 0, 0, 0})});
            const Surfaces& surfaces = traced.surfaces();
            const SurfacePoint point{0, {0.3f, 0.3f}, 1e-4f};
            // Rays that meet it bring a share of the light, and of all light 1 - factor is reflected.
            const glm::vec3 reflected = surfaces.coverage(point) * surfaces.scattering(point).reflected;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(reflected[c], (1 - kTexel * factor) * tint[c], 1e-6f);
        }
}

TEST(Metal, ReflectsDiffuselyAsFarAsItIsRough) {
    Scene sheet = SceneBuilder().floor({0, 0, 0}, 1).build();
    sheet.vertex_arrays[0].texcoords = {std::vector<glm::vec2>(sheet.receivers(), {0.5f, 0.5f})};
    Material& m = sheet.materials[0];
    m.base_color = {0.8f, 0.6f, 0.2f, 1};
    const auto reflected = [&](float metallic, float roughness, const std::vector<Texture>& textures) {
        m.metal.factor = metallic;
        m.metal.roughness = roughness;
        m.metal.texture.image = textures.empty() ? -1 : 0;
        return Surfaces(sheet, textures).scattering({0, {0.3f, 0.3f}, 1e-4f}).reflected.r;
    };
    EXPECT_FLOAT_EQ(reflected(0, 0.3f, {}), 0.8f);
    EXPECT_FLOAT_EQ(reflected(1, 1, {}), 0.8f); // glTF's default material
    EXPECT_FLOAT_EQ(reflected(1, 0, {}), 0);
    EXPECT_FLOAT_EQ(reflected(1, 0.5f, {}), 0.2f);
    EXPECT_FLOAT_EQ(reflected(0.5f, 0.5f, {}), 0.8f * (1 - 0.5f * 0.75f));
    // Metallic in blue, roughness in green, both as numbers: 51 is a fifth, not sRGB.
    EXPECT_NEAR(reflected(1, 1, {numbers({9, 51, 255, 9})}), 0.8f * 0.04f, 1e-6f);
    EXPECT_NEAR(reflected(1, 0, {numbers({9, 255, 51, 9})}), 0.8f * 0.8f, 1e-6f);
    // The image is also used as a color texture.
    EXPECT_NEAR(reflected(1, 1, {make_texture({1, 1, {{9, 51, 255, 9}}})}), 0.8f * 0.04f, 1e-5f);
}

TEST(Metal, BouncesItsDiffuseFractionWithANotice) {
    const auto bounced = [](float metallic, float roughness, std::size_t& notices) {
        Scene bowl = SceneBuilder().bowl({0, 0, 0}, 1, 12, 4).build();
        bowl.materials[0].metal.factor = metallic;
        bowl.materials[0].metal.roughness = roughness;
        BakeOptions options;
        options.order = 1;
        options.rays = 256;
        options.tracer.backend = Backend::cpu;
        const auto radiance = [&](int bounces) {
            options.bounces = bounces;
            const BakeResult result = bake(bowl, options);
            notices = 0;
            for (const std::string& notice : result.statistics.notices)
                notices += notice.find("1 material is metallic") != std::string::npos;
            return exit_radiance(result.baked.transfer, constant_light(1, glm::vec3(1)))[12 * 25].x;
        };
        const float direct = radiance(0);
        EXPECT_EQ(notices, 0u); // without bounces it does not affect the bake
        return radiance(1) - direct;
    };
    std::size_t notices = 0;
    const float diffuse = bounced(0, 0, notices);
    EXPECT_EQ(notices, 0u);
    EXPECT_GT(diffuse, 0.1f);
    EXPECT_NEAR(bounced(1, 0.5f, notices), 0.25f * diffuse, 1e-3f);
    EXPECT_EQ(notices, 1u);
    EXPECT_NEAR(bounced(1, 0, notices), 0, 1e-6f);
}

/// A ceiling that has a texture with coordinates, and no image behind it.
Scene ceiling_without_its_image() {
    Scene scene = test::join({SceneBuilder().floor({0, 0, 0}, 1).build(), ceiling()});
    scene.images.push_back({"image 0 'wood.ktx2'", {}});
    for (const char c : std::string("\xABKTX 20\xBB\r\n\x1A\n"))
        scene.images[0].bytes.push_back(static_cast<std::byte>(c));
    scene.materials[1].base_color_texture.image = 0;
    return scene;
}

TEST(BadTextures, FailOnlyBakesThatUseThem) {
    BakeOptions options;
    options.order = 1;
    options.rays = 16;
    options.tracer.backend = Backend::cpu;
    const auto message = [&](const Scene& scene) -> std::string {
        try {
            bake(scene, options);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    Scene scene = ceiling_without_its_image();
    EXPECT_EQ(message(scene), ""); // direct light, opaque
    scene.materials[1].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(message(scene),
              "image 0 'wood.ktx2' is KTX 2, which is not supported, and the texture has no PNG, JPEG, WebP "
              "or AVIF as a fallback; ignore such textures with --bad-textures ignore");
    scene.materials[1].alpha_mode = AlphaMode::opaque;
    options.bounces = 1;
    EXPECT_NE(message(scene), "");
    options.repairs.bad_textures = BadTextures::ignore;
    EXPECT_EQ(message(scene), "");
    scene.materials[1].base_color_texture.image = 7; // beyond the images
    EXPECT_EQ(message(scene), "");
}

TEST(Leaf, IsLitFromBehindByDiffuseTransmission) {
    // A single sheet: nothing is in front or behind, so both sides have their clamped-cosine lobe.
    Scene leaf = SceneBuilder().floor({0, 0, 0}, 1, 2).build();
    Material& m = leaf.materials[0];
    m.base_color = {0.2f, 0.5f, 0.1f, 1};
    m.double_sided = true;
    m.transmission.factor = 0.4f;
    m.transmission.color = {0.4f, 0.6f, 0.05f};
    BakeOptions options;
    options.order = 4;
    options.rays = 256;
    options.tracer.backend = Backend::cpu;
    const BakeResult result = bake(leaf, options);
    const Transfer& t = result.baked.transfer;
    ASSERT_EQ(t.layout.channels(), 3);
    EXPECT_EQ(result.statistics.receivers.back_sides, leaf.receivers());
    std::array<double, 16> above{}, below{};
    clamped_cosine_lobe(4, {0, 1, 0}, above);
    clamped_cosine_lobe(4, {0, -1, 0}, below);
    for (std::size_t p = 0; p < t.receivers(); ++p)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t k = 0; k < 16; ++k) {
                const auto i = static_cast<int>(c);
                const double ratio = static_cast<double>(m.transmission.color[i] / m.base_color[i]);
                EXPECT_NEAR(static_cast<double>(t.vector(p)[c * 16 + k]),
                            0.6 * above[k] + 0.4 * ratio * below[k], 1e-6);
            }
}

TEST(Leaf, VariesFromVertexToVertex) {
    // Transmitted light is white; reflected light has the color of the vertex, which is multiplied later.
    Scene leaf = SceneBuilder().triangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}).build();
    leaf.vertex_arrays[0].colors = {{1, 0.5f, 0.25f, 1}, {0.25f, 1, 0.5f, 1}, {0.5f, 0.25f, 1, 1}};
    Material& m = leaf.materials[0];
    m.base_color = {0.8f, 0.6f, 0.4f, 1};
    m.transmission.factor = 0.5f;
    BakeOptions options;
    options.order = 1;
    options.rays = 16;
    options.tracer.backend = Backend::cpu;
    const Transfer t = bake(leaf, options).baked.transfer;
    ASSERT_EQ(t.layout.channels(), 3);
    const double half = 0.25 / std::sqrt(std::numbers::pi); // half of Y_00, which either side sees completely
    for (std::size_t p = 0; p < 3; ++p)
        for (int c = 0; c < 3; ++c) {
            const auto base = static_cast<double>(m.base_color[c] * leaf.vertex_arrays[0].colors[p][c]);
            EXPECT_NEAR(static_cast<double>(t.vector(p)[static_cast<std::size_t>(c)]), half + half / base,
                        1e-5);
        }
}

TEST(Leaf, NeedsChannelsForColoredLight) {
    Scene leaf = SceneBuilder().floor({0, 0, 0}, 1).build();
    leaf.materials[0].transmission.factor = 0.4f;
    const auto colors = [&](const glm::vec3& color) {
        leaf.materials[0].transmission.color = color;
        return Surfaces(leaf, {}).traits().color;
    };
    EXPECT_FALSE(colors(glm::vec3(0.5f)));
    EXPECT_TRUE(colors({0.5f, 0.6f, 0.5f}));
}

TEST(Leaf, LightsSurfacesBelowIt) {
    // Over a floor hangs a large leaf in the sun: with transmission the floor's bounces see it shine.
    const auto floor_under_leaf = [](float factor) {
        Scene leaf = SceneBuilder().floor({0, 0.5f, 0}, 2, 8).build();
        leaf.materials[0].base_color = glm::vec4(0.5f);
        leaf.materials[0].double_sided = true;
        leaf.materials[0].transmission.factor = factor;
        const Scene scene = test::join({SceneBuilder().floor({0, 0, 0}, 1, 8).build(), leaf});
        BakeOptions options;
        options.bounces = 1;
        options.tracer.backend = Backend::cpu;
        const Transfer t = bake(scene, options).baked.transfer;
        return exit_radiance(t, constant_light(6, glm::vec3(1)))[8 * 4 * 6 + 4 * 6].x;
    };
    // The leaf blocks about 16/17; all light that it scatters down comes from above: f · 1 · (its light from
    // above).
    const float without = floor_under_leaf(0), with = floor_under_leaf(0.5f);
    EXPECT_GT(with, without + 0.3f);
    EXPECT_LT(with, 1);
}

TEST(Textures, CauseVariationOnlyIfUsed) {
    const std::vector<Texture> textures = {numbers({1, 2, 3, 4})};
    const auto varies = [&](float transmission, void (*give_image)(Material&)) {
        Scene scene = ceiling();
        scene.materials[0].transmission.factor = transmission;
        give_image(scene.materials[0]);
        return !Surfaces(scene, textures).constant_scattering(1);
    };
    const auto factor = [](Material& m) { m.transmission.factor_texture.image = 0; };
    const auto color = [](Material& m) { m.transmission.color_texture.image = 0; };
    const auto metal = [](Material& m) { m.metal.texture.image = 0; };
    EXPECT_TRUE(varies(0.5f, factor));
    EXPECT_TRUE(varies(0.5f, color));
    EXPECT_FALSE(varies(0.5f, metal)); // a metal is not a leaf
    EXPECT_FALSE(varies(0, factor));
    EXPECT_FALSE(varies(0, color));
    EXPECT_TRUE(varies(0, metal));
}

TEST(Textures, AreFilteredOverTheRayFootprint) {
    // A wall with a fine chequer of black and white is as bright as a grey one of the mean in linear light.
    Scene chequered = SceneBuilder().quad({-2, 0, -1}, {2, 0, -1}, {2, 4, -1}, {-2, 4, -1}).build();
    VertexArray& v = chequered.vertex_arrays[0];
    v.texcoords.resize(1);
    for (const glm::vec3& p : v.positions)
        v.texcoords[0].emplace_back(p.x / 4 + 0.5f, p.y / 4);
    chequered.materials[0].base_color_texture.image = 0;
    Image8 image{256, 256, {}};
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            const auto value = static_cast<std::uint8_t>((x + y) % 2 ? 255 : 0);
            image.pixels.emplace_back(value, value, value, 255);
        }
    const std::vector<Texture> textures = {make_texture(image)};
    const Surfaces surfaces(chequered, textures);
    EXPECT_FALSE(surfaces.traits().color);
    // Half of white in linear light, once the footprint is large.
    for (const unsigned triangle : {0u, 1u})
        EXPECT_NEAR(surfaces.scattering({triangle, {0.3f, 0.3f}, 0.01f}).reflected.g, 0.5f, 0.01f);
    // Texels are there once it is small: 4/256 m wide, this is the middle of one.
    const float sharp = surfaces.scattering({0, {1.0f / 256, 0.5f / 256}, 1e-7f}).reflected.g;
    EXPECT_TRUE(sharp < 0.35f || sharp > 0.65f) << sharp;
}

TEST(InsideGeometry, EnclosedBodiesStayDark) {
    const Scene scene = SceneBuilder().sphere({0, 0, 0}, 1, 12).sphere({0, 0, 0}, 0.3f, 6).build();
    BakeOptions options;
    options.rays = 64;
    options.tracer.backend = Backend::cpu;
    const BakeResult result = bake(scene, options);
    EXPECT_GT(result.statistics.receivers.sealed, 0u);
    EXPECT_EQ(result.statistics.receivers.refilled, 0u);
}

TEST(Textures, MissingTexturesAreReportedIfUsed) {
    Scene scene = ceiling();
    scene.materials[0].base_color_texture.image = 0;
    scene.images.push_back({"image 0 'gone.png'", {}});
    BakeOptions options;
    options.rays = 16;
    options.bounces = 1;
    options.tracer.backend = Backend::cpu;
    try {
        bake(scene, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("gone.png"), std::string::npos);
    }
    options.repairs.bad_textures = BadTextures::ignore;
    EXPECT_FALSE(bake(scene, options).statistics.notices.empty());
    options.repairs.bad_textures = BadTextures::error;
    options.bounces = 0; // nobody looks at the texture
    EXPECT_NO_THROW(bake(scene, options));
}

} // namespace
} // namespace prt
