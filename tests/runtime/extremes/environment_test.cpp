// Tests environment maps with invalid pixels, and invalid directions.

#include "prt/core/environment.h"
#include "support/extremes.h"

namespace prt {
namespace {

using test::ExtremeCase;
using test::numbers_of;

Environment environment_of(EnvironmentLayout layout, float x, float y) {
    const int height = layout == EnvironmentLayout::angular    ? 4
                       : layout == EnvironmentLayout::lat_long ? 2
                                                               : 24;
    Environment environment{{4, height, {}}, layout};
    environment.image.pixels.assign(static_cast<std::size_t>(4 * height), glm::vec3(1));
    environment.image.pixels[5] = {x, y, 1};
    return environment;
}

ExtremeCase projected(const char* name, EnvironmentLayout layout) {
    return {name, [layout](int n, float x, float y) {
                return numbers_of(project(environment_of(layout, x, y), n, 1).coefficients);
            }};
}

ExtremeCase repaired(const char* name, BadPixels policy) {
    return {name, [policy](int n, float x, float y) {
                Environment environment = environment_of(EnvironmentLayout::lat_long, x, y);
                repair_pixels(environment.image, policy);
                return numbers_of(project(environment, n, 1).coefficients);
            }};
}

/// Samples white pixels in a direction that may be invalid.
ExtremeCase sampled(const char* name, EnvironmentLayout layout) {
    return {name, [layout](int, float x, float y) {
                const Environment white = environment_of(layout, 1, 1);
                return numbers_of(std::vector{sample(white, {x, y, 1}), sample(white, {0, x, y}),
                                              sample(white, {y, 0, x}), sample(white, {0, 0, 0})});
            }};
}

class EnvironmentMap : public testing::TestWithParam<ExtremeCase> {};
INSTANTIATE_TEST_SUITE_P(Functions, EnvironmentMap,
                         testing::Values(projected("project_lat_long", EnvironmentLayout::lat_long),
                                         projected("project_cube", EnvironmentLayout::cube),
                                         projected("project_cube_faces", EnvironmentLayout::cube_faces),
                                         projected("project_angular", EnvironmentLayout::angular),
                                         repaired("repair_error", BadPixels::error),
                                         repaired("repair_zero", BadPixels::zero),
                                         repaired("repair_clamp", BadPixels::clamp),
                                         sampled("sample_lat_long", EnvironmentLayout::lat_long),
                                         sampled("sample_cube", EnvironmentLayout::cube),
                                         sampled("sample_cube_faces", EnvironmentLayout::cube_faces),
                                         sampled("sample_angular", EnvironmentLayout::angular)),
                         test::name_of);
TEST_P(EnvironmentMap, IsFiniteOrRejected) {
    test::expect_finite_or_refused(GetParam());
}

TEST(EnvironmentMap, WithoutPixelsIsRejected) {
    EXPECT_THROW(project({}, 3), Error);
    EXPECT_THROW(resampled_lat_long({}), Error);
    EXPECT_THROW(project({{2, 1, {glm::vec3(1)}}}, 3), Error); // one of two
    Image nothing;
    EXPECT_EQ(repair_pixels(nothing, BadPixels::error), 0u);
}

} // namespace
} // namespace prt
