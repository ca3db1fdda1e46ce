// The comparison of methods: a small run.

#include "report.h"

#include "runtime/core/support/file.h"

#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

namespace comparison {
namespace {

/// The page and the sheet of pictures that hold the figures of `result`.
void expect_page(const SceneResult& result, const std::vector<Sky>& skies, const Options& options,
                 const prt::test::TemporaryFolder& folder) {
    const std::string page = report({result}, skies, options, "images", "Made by a test.");
    for (const char* part : {"## ball", "| baked AO | 1 |", "error, sky | FLIP |", "images/ball.png",
                             "Made by a test.", "Mean error"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    write_pictures({result}, options, folder / "images");
    EXPECT_EQ(prt::decode_image(prt::read_file(folder / "images/ball.png")).width, 7 * 96);
}

TEST(Comparison, MeasuresEveryMethodAndWritesItsPage) {
    const prt::test::TemporaryFolder folder;
    prt::test::scene_file(
        prt::test::SceneBuilder().floor({0, -0.5f, 0}, 1.2f, 24).sphere({0, 0, 0}, 0.5f, 20).build())
        .write(folder / "ball.glb");
    prt::Image image{32, 16, {}};
    for (int i = 0; i < 32 * 16; ++i)
        image.pixels.emplace_back(i / 32 < 8 ? 1.5f : 0.1f, 1, i % 32 == 9 && i / 32 == 4 ? 30.0f : 0.5f);
    prt::write_exr(folder / "sky.exr", image, prt::EnvironmentLayout::lat_long);
    const std::vector<Sky> skies = {load_sky(folder / "sky.exr")};
    Options options;
    options.width = 96;
    options.height = 54;
    options.passes = 32;
    options.bake_rays = 128;
    options.lightmap_size = 64;
    options.frame_seconds = 0.01;
    const auto context = prt::GlContext::create(prt::GlDevice::any);
    ASSERT_TRUE(context);
    const SceneResult result =
        measure(folder / "ball.glb", skies, options, *context, [](const std::string&) {});
    ASSERT_EQ(result.rows.size(), 17u);
    const auto row = [&](const std::string& start) {
        for (const Row& r : result.rows)
            if (r.method.starts_with(start))
                return r;
        ADD_FAILURE() << start;
        return Row{};
    };
    for (const Row& r : result.rows) {
        const bool drawn_by_rays =
            r.method.find("sun by") != std::string::npos || r.method.starts_with("lightmap");
        EXPECT_EQ(r.frame_milliseconds.has_value(), !drawn_by_rays) << r.method;
        EXPECT_GT(r.frame_milliseconds.value_or(1), 0) << r.method;
        ASSERT_EQ(r.errors.size(), 1u);
        EXPECT_LT(r.errors[0].relative_l2, 1) << r.method;
        EXPECT_LT(r.errors[0].flip_mean, 0.3) << r.method;
        EXPECT_TRUE(r.errors[0].flip.empty());
    }
    // A ball shadows a floor: methods without shadows have larger errors.
    EXPECT_LT(row("PRT, order 6").errors[0].relative_l2, 0.5 * row("unshadowed").errors[0].relative_l2);
    EXPECT_LT(row("PRT, order 6").errors[0].relative_l2, row("PRT, order 3").errors[0].relative_l2);
    // The sun is a texel of 11 degrees, of which order 6 misses the edge of the shadow.
    EXPECT_LT(row("PRT, order 6, sun by rays").errors[0].relative_l2,
              row("PRT, order 6").errors[0].relative_l2);
    EXPECT_NEAR(row("PRT, 8 bytes, sun by rays").errors[0].relative_l2,
                row("PRT, order 6, sun by rays").errors[0].relative_l2, 0.02);
    EXPECT_NEAR(row("PRT, 8 bytes, sun by shadow map").errors[0].relative_l2,
                row("PRT, 8 bytes, sun by rays").errors[0].relative_l2, 0.02);
    EXPECT_NEAR(row("lightmap, 8 bytes per texel").errors[0].relative_l2,
                row("PRT, order 6").errors[0].relative_l2, 0.03);
    EXPECT_NEAR(row("lightmap, 8 bytes, sun by rays").errors[0].relative_l2,
                row("PRT, order 6, sun by rays").errors[0].relative_l2, 0.03);
    EXPECT_EQ(row("PRT, order 6").bytes_per_vertex, 72);
    EXPECT_LE(row("PRT, order 6, 8 bytes").bytes_per_vertex, 8);
    EXPECT_NEAR(row("PRT, order 6, 16 bytes").errors[0].relative_l2,
                row("PRT, order 6").errors[0].relative_l2, 0.02);
    expect_page(result, skies, options, folder);
}

} // namespace
} // namespace comparison
