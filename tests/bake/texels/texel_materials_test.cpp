// Tests texels on sheets and media: closed forms, and bakes of the same surfaces at vertices.

#include "prt/core/error_measures.h"
#include "prt/core/sh.h"
#include "texel_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace prt {
namespace texel_materials {

using test::beside_map;
using test::floor_map;
using test::of_one_texel;
using test::options_of;
using test::SceneBuilder;
using test::whole;

/// Two metres of leaf at y = 0, in cells, as a map.
Scene leaf(int cells) {
    Scene scene =
        floor_map(test::painted(SceneBuilder().floor({0, 0, 0}, 1, cells).build(), {0.2f, 0.5f, 0.1f}, true));
    scene.materials[0].transmission.factor = 0.4f;
    scene.materials[0].transmission.color = {0.4f, 0.6f, 0.05f};
    return scene;
}

/// Two metres of floor with a medium, in cells, as a map.
Scene stone(int cells) {
    Scene scene = floor_map(SceneBuilder().floor({0, 0, 0}, 1, cells).build());
    scene.materials[0].name = "stone";
    return scene;
}

BakeOptions with_medium(BakeOptions options) {
    options.subsurface.media = {{"stone", {glm::dvec3(4, 8, 16), glm::dvec3(0.5), 1.3}}};
    return options;
}

/// `map` above a red floor and below a green ball, which cover each other in part, between two lamps.
Scene surrounded(const Scene& map) {
    Scene around = test::painted(
        SceneBuilder().floor({0.5f, -0.6f, 0}, 1, 6).sphere({0.3f, 0.8f, 0.2f}, 0.5f, 6).build(),
        {0.8f, 0.5f, 0.3f});
    Scene scene = beside_map(map, around);
    scene.lights = {test::lamp_at({-0.5f, 1.2f, 0.3f}), test::lamp_at({0.4f, -0.4f, -1.2f})};
    scene.lights[0].name = "above";
    scene.lights[1].intensity = {1, 2, 3};
    return scene;
}

/// Transfer at the inner vertices of the first array: of a bake, and of a lightmap that is looked up there.
struct AtVertices {
    Transfer vertices, texels;

    AtVertices(const Scene& scene, const Transfer& baked, const BakedLightmap& map)
        : vertices(zero_transfer(baked.layout, 0)), texels(zero_transfer(map.baked.transfer.layout, 0)) {
        const VertexArray& array = scene.vertex_arrays[0];
        for (std::size_t v = 0; v < array.size(); ++v) {
            if (std::max(std::abs(array.positions[v].x), std::abs(array.positions[v].z)) > 0.9f)
                continue;
            vertices.vectors.insert(vertices.vectors.end(), baked.vector(v).begin(), baked.vector(v).end());
            const std::vector<float> here = test::lookup(map, array.texcoords[0][v]);
            texels.vectors.insert(texels.vectors.end(), here.begin(), here.end());
        }
    }
    double difference() const {
        return relative_l2(vertices, texels, std::vector<float>(vertices.receivers(), 1.0f));
    }
};

/// Relative L2 difference between a bake at vertices of the first array and a lightmap.
double difference(const Scene& scene, const BakeOptions& options, int size) {
    BakeOptions at_vertices = options;
    at_vertices.fit = FitMode::vertex;
    const LightmapBake map = bake_lightmap(scene, {whole(scene, size), of_one_texel()}, options);
    const AtVertices light(scene, bake(scene, at_vertices).baked.transfer, map.lightmap);
    EXPECT_TRUE(light.vertices.layout == light.texels.layout);
    return light.difference();
}

TEST(TexelsOfSheets, HaveTheLobesOfBothSides) {
    Scene scene = leaf(1);
    for (VertexArray& vertices : scene.vertex_arrays)
        for (const glm::vec3& p : vertices.positions) // varies along x, not in the middle channel
            vertices.colors.emplace_back(0.75f + 0.25f * p.x, 1, 1, 1);
    const BakedLightmap map = bake_lightmap(scene, {whole(scene, 8)}, options_of(4, 4096, 0)).lightmap;
    const Transfer& t = map.baked.transfer;
    ASSERT_TRUE(t.layout == layout_of_one(4, 3, TermKind::direct));
    std::array<double, 16> above{}, below{};
    clamped_cosine_lobe(4, {0, 1, 0}, above);
    clamped_cosine_lobe(4, {0, -1, 0}, below);
    const Material& m = scene.materials[0];
    for (std::size_t p = 0; p < t.receivers(); ++p) {
        const double x = (map.texels[p] % 8 + 0.5) / 4 - 1;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t k = 0; k < 16; ++k) {
                const auto i = static_cast<int>(c);
                const double ratio = static_cast<double>(m.transmission.color[i] / m.base_color[i]) /
                                     (c == 0 ? 0.75 + 0.25 * x : 1.0);
                EXPECT_NEAR(static_cast<double>(t.vector(p)[c * 16 + k]),
                            0.6 * above[k] + 0.4 * ratio * below[k], 0.01)
                    << p << " " << c << " " << k;
            }
    }
}

TEST(TexelsOfSheets, HaveTheLightOfVertices) {
    EXPECT_LT(difference(surrounded(leaf(6)), options_of(2, 512, 1), 18), 0.03);
}

TEST(TexelsOfSheets, AreFilteredLikeOthers) {
    const Scene scene = surrounded(leaf(1));
    const auto baked = [&](int rays, std::uint64_t seed, bool denoise) {
        BakeOptions options = options_of(2, rays, 1);
        options.lamps.mode = LampMode::none;
        options.seed = seed;
        options.repairs.denoise = denoise;
        return bake_lightmap(scene, {whole(scene, 24), of_one_texel()}, options);
    };
    const BakedTransfer truth = baked(1 << 9, 9, false).lightmap.baked;
    const auto error = [&](const LightmapBake& bake) {
        return relative_l2(as_combined(truth.transfer), as_combined(bake.lightmap.baked.transfer),
                           bake.lightmap.areas);
    };
    const double before = error(baked(64, 1, false)), after = error(baked(64, 1, true));
    EXPECT_LT(after, 0.75 * before);
}

/// A leaf through a closed ball: texels inside take the light of texels outside.
TEST(TexelsOfSheets, AreSealedInSolids) {
    const Scene scene = beside_map(leaf(1), SceneBuilder().sphere({0, 0, 0}, 0.5f, 12).build());
    const LightmapBake baked =
        bake_lightmap(scene, {whole(scene, 16), of_one_texel()}, options_of(1, 256, 0));
    EXPECT_GT(baked.statistics.texels.sealed, 20u); // of 50
    const Transfer& t = baked.lightmap.baked.transfer;
    for (std::size_t p = 0; p + 1 < t.receivers(); ++p)
        EXPECT_GT(static_cast<double>(t.vector(p)[1]), 0.4 * (0.6 + 0.4 * 0.6 / 0.5) * kY00) << p;
    EXPECT_LT(baked.statistics.mean_visibility, 1);
}

TEST(TexelsOfMedia, HaveTheLightOfVertices) {
    for (const int bounces : {0, 1})
        EXPECT_LT(difference(surrounded(stone(8)), with_medium(options_of(2, 256, bounces)), 16), 0.02)
            << bounces;
}

TEST(TexelsOfMedia, AreNotFiltered) {
    const Scene scene = surrounded(stone(1));
    const auto texels = [&](bool denoise) {
        BakeOptions options = with_medium(options_of(2, 16, 0));
        options.repairs.denoise = denoise;
        Transfer t = bake_lightmap(scene, {whole(scene, 8), of_one_texel()}, options).lightmap.baked.transfer;
        t.vectors.resize(64 * t.dimension());
        return t;
    };
    EXPECT_LT(relative_l2(texels(false), texels(true), std::vector<float>(64, 1.0f)), 1e-6); // rounding
}

/// In light of a uniform sky, a large plane of a medium sends back all light: T is that of an open plane of
/// any other material, in the rest and not in direct light.
TEST(TexelsOfMedia, AreBesideOtherSurfaces) {
    Scene scene = floor_map(SceneBuilder().floor({0, 0, 0}, 1).build());
    scene.primitives.push_back(scene.primitives[0]);
    for (std::size_t p = 0; p < 2; ++p) // one of both triangles of the floor each
        scene.primitives[p].triangles = {scene.primitives[p].triangles[p]};
    scene.materials.emplace_back().name = "stone";
    scene.primitives[1].material = 1;
    BakeOptions options = with_medium(options_of(1, 256, 0));
    for (MediumChoice& choice : options.subsurface.media)
        choice.medium = {glm::dvec3(400), glm::dvec3(1), 1.3};
    const LightmapBake baked = bake_lightmap(scene, {whole(scene, 8)}, options);
    const BakedLightmap& map = baked.lightmap;
    ASSERT_EQ(map.baked.transfer.layout.terms.size(), 2u);
    std::array<std::size_t, 2> counts{};
    for (std::size_t p = 0; p < map.texels.size(); ++p) {
        const std::span<const float> t = map.baked.transfer.vector(p);
        EXPECT_NEAR((t[0] + t[1]) / kY00, 1, 0.03) << p;
        for (std::size_t i = 0; i < 2; ++i)
            counts[i] += std::abs(t[i]) < 1e-6f ? 1 : 0;
    }
    EXPECT_EQ(counts[0], 28u); // the texels of a triangle without its longest edge
    EXPECT_EQ(counts[1], 28u);
    EXPECT_NEAR(baked.statistics.mean_visibility, 1, 1e-3);
    EXPECT_EQ(map.baked.record.media, std::vector<std::string>{"stone"});
}

/// Texels of a flat scene that are measured on another model, and texels of that model itself.
double difference_from_high_poly(const Scene& map, const BakeOptions& options) {
    constexpr float kDown = 0.25f;
    Scene lower = map;
    for (glm::vec3& p : lower.vertex_arrays[0].positions)
        p.y -= kDown;
    const Scene model = surrounded(lower);
    const Transfer baked =
        as_combined(bake_lightmap(map, {whole(map, 16)}, options, {&model, 0.5}).lightmap.baked.transfer);
    Transfer truth = as_combined(
        bake_lightmap(model, {whole(model, 16), of_one_texel()}, options).lightmap.baked.transfer);
    truth.vectors.resize(baked.vectors.size());
    EXPECT_TRUE(truth.layout == baked.layout);
    return relative_l2(truth, baked, std::vector<float>(baked.receivers(), 1.0f));
}

TEST(TexelsOfSheets, AreMeasuredOnBothSidesOfAHighPolyModel) {
    EXPECT_LT(difference_from_high_poly(leaf(1), options_of(2, 512, 1)), 0.02);
}

TEST(TexelsOfMedia, ScatterTheLightOfAHighPolyModel) {
    EXPECT_LT(difference_from_high_poly(stone(1), with_medium(options_of(2, 256, 1))), 0.02);
}

} // namespace texel_materials
} // namespace prt
