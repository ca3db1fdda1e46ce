// Tests notices about materials that the bake simplifies.

#include "bake/scene/material_notices.h"

#include <gtest/gtest.h>

namespace prt {
namespace {

/// Returns a scene with a primitive for each of `materials`, and an unused material of tinted, polished
/// metal.
Scene scene_of_materials(std::vector<Material> materials) {
    Scene scene;
    scene.primitives.resize(materials.size());
    for (std::size_t i = 0; i < materials.size(); ++i)
        scene.primitives[i].material = i;
    scene.materials = std::move(materials);
    Material& unused = scene.materials.emplace_back();
    unused.base_color = {1, 0, 0, 1};
    unused.glass.factor = unused.metal.factor = 1;
    unused.metal.roughness = 0;
    return scene;
}

std::string notice_of(const std::vector<Material>& materials, bool with_bounces = true) {
    const auto notices = material_notices(scene_of_materials(materials), with_bounces);
    EXPECT_LE(notices.size(), 1u);
    return notices.empty() ? "" : notices[0].substr(0, notices[0].find(':'));
}

TEST(Glass, IsReportedIfTinted) {
    Material clear;
    clear.metal.factor = 0;
    clear.glass.factor = 0.5f;
    clear.base_color = {0.4f, 0.4f, 0.4f, 1};
    Material red = clear, blue = clear, textured = clear;
    red.base_color.r = 0.5f;
    blue.base_color.b = 0.5f;
    textured.base_color_texture.image = 0;
    EXPECT_EQ(notice_of({clear}), "");
    for (const Material& tinted : {red, blue, textured}) {
        EXPECT_EQ(notice_of({clear, tinted}, false), "1 material is tinted glass");
        Material opaque = tinted;
        opaque.glass.factor = 0;
        EXPECT_EQ(notice_of({opaque}), "");
    }
    EXPECT_EQ(notice_of({red, clear, blue}), "2 materials are tinted glass");
}

TEST(Metal, IsReportedIfItMirrorsWithBounces) {
    Material rough;
    rough.metal.factor = 0.5f;
    rough.metal.roughness = 1;
    Material smooth = rough, textured = rough;
    smooth.metal.roughness = 0.9f;
    textured.metal.texture.image = 0;
    EXPECT_EQ(notice_of({rough}), "");
    for (const Material& polished : {smooth, textured}) {
        EXPECT_EQ(notice_of({rough, polished}), "1 material is metallic");
        EXPECT_EQ(notice_of({polished}, false), "");
        Material other = polished;
        other.metal.factor = 0;
        EXPECT_EQ(notice_of({other}), "");
    }
    EXPECT_EQ(notice_of({smooth, textured}), "2 materials are metallic");
}

} // namespace
} // namespace prt
