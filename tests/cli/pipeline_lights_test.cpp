// Tests light in the commands: images, light files, suns, exposure.

#include "pipeline.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace prt::test {
namespace {

/// A dim sky with a sun of one texel.
Image sunny_image() {
    Image image{64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(0.2f, 0.3f, 0.5f))};
    image.at(20, 9) = {900, 800, 600};
    return image;
}

double largest_difference(const nlohmann::json& a, const nlohmann::json& b) {
    double largest = 0;
    for (const char* channel : {"red", "green", "blue"})
        for (std::size_t i = 0; i < a["coefficients"][channel].size(); ++i)
            largest = std::max(largest, std::abs(a["coefficients"][channel][i].get<double>() -
                                                 b["coefficients"][channel][i].get<double>()));
    return largest;
}

TEST_F(Pipeline, SunsOfALightFileAreAddedToItsCoefficients) {
    write_exr(folder / "sky.exr", sunny_image(), EnvironmentLayout::lat_long);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("full.json")}).status, 0);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("suns.json"), "--suns", "1"}).status, 0);
    ASSERT_EQ(prt({"project", at("suns.json"), "-o", at("back.json")}).status, 0);
    const auto full = read_json(folder / "full.json"), suns = read_json(folder / "suns.json");
    EXPECT_EQ(suns["suns"].size(), 1u);
    EXPECT_GT(largest_difference(full, suns), 0.5);
    // A disc represents a square texel of 5.6 degrees; band 0 is equal.
    EXPECT_LT(largest_difference(full, read_json(folder / "back.json")),
              0.02 * full["coefficients"]["red"][0].get<double>());

    nlohmann::json damaged = suns;
    damaged["suns"][0]["half_angle_radians"] = -1;
    std::ofstream(folder / "bad.json") << damaged;
    const Outcome bad = prt({"project", at("bad.json"), "-o", at("x.json")});
    EXPECT_EQ(bad.status, 1);
    EXPECT_NE(bad.err.find("\"half_angle_radians\" is not in the range 0..1.5708"), std::string::npos)
        << bad.err;
}

TEST_F(Pipeline, WorthwhileSunsAreFoundAndRotateWithTheSky) {
    write_exr(folder / "sky.exr", sunny_image(), EnvironmentLayout::lat_long);
    ASSERT_EQ(
        prt({"project", at("sky.exr"), "-o", at("a.json"), "--suns", "auto", "--json", at("r.json")}).status,
        0);
    const auto report = read_json(folder / "r.json"), light = read_json(folder / "a.json");
    ASSERT_EQ(light["suns"].size(), 1u);
    EXPECT_EQ(report["suns"], light["suns"]);
    EXPECT_LT(report["error_with_suns"], 0.4 * report["error_without_suns"].get<double>());
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("t.json"), "--suns", "1", "--rotate", "90"}).status, 0);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("full.json"), "--rotate", "90"}).status, 0);
    ASSERT_EQ(prt({"project", at("t.json"), "-o", at("back.json")}).status, 0);
    EXPECT_LT(largest_difference(read_json(folder / "full.json"), read_json(folder / "back.json")), 0.1);
    EXPECT_EQ(prt({"project", at("sky.exr"), "-o", at("l.json"), "--suns", "some"}).status, 2);

    write_exr(folder / "gray.exr", {8, 4, std::vector<glm::vec3>(32, glm::vec3(1))},
              EnvironmentLayout::lat_long);
    ASSERT_EQ(prt({"project", at("gray.exr"), "-o", at("g.json"), "--suns", "auto"}).status, 0);
    EXPECT_TRUE(read_json(folder / "g.json")["suns"].empty());
}

TEST_F(Pipeline, CenterOfALatLongImageMayFaceX) {
    write_exr(folder / "sky.exr", sunny_image(), EnvironmentLayout::lat_long);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("x.json"), "--env-layout", "lat-long-x"}).status, 0);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("turned.json"), "--rotate", "90"}).status, 0);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("z.json")}).status, 0);
    EXPECT_LT(largest_difference(read_json(folder / "x.json"), read_json(folder / "turned.json")), 1e-5);
    EXPECT_GT(largest_difference(read_json(folder / "x.json"), read_json(folder / "z.json")), 0.5);
}

TEST_F(Pipeline, LightFilesServeAsEnvironments) {
    triangle_file().write(folder / "t.glb");
    write_exr(folder / "e.exr", {4, 2, std::vector<glm::vec3>(8, glm::vec3(1, 2, 3))});
    ASSERT_EQ(
        prt({"project", at("e.exr"), "-o", at("l.json"), "--order", "6", "--json", at("r.json")}).status, 0);
    EXPECT_NEAR(read_json(folder / "r.json")["mean_radiance"][2].get<double>(), 3, 1e-5);
    ASSERT_EQ(prt({"render", at("t.glb"), "--lights", at("l.json"), "-o", at("a.exr"), "--size", "32x32",
                   "--device", "cpu"})
                  .status,
              0);
    ASSERT_EQ(prt({"render", at("t.glb"), "--lights", at("e.exr"), "-o", at("b.exr"), "--size", "32x32",
                   "--device", "cpu", "--no-background"})
                  .status,
              0);
    EXPECT_EQ(read_file(folder / "a.exr"), read_file(folder / "b.exr"));
}

TEST_F(Pipeline, AutomaticExposureMeasuresTheModelAndIsReported) {
    GlbFile file = triangle_file();
    file.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 0.125, 1}}, {"metallicFactor", 0}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "t.glb");
    write_exr(folder / "e.exr", {4, 2, std::vector<glm::vec3>(8, glm::vec3(4))});
    const auto stops = [&](const char* exposure, const char* backend) {
        const Outcome outcome =
            prt({"render", at("t.glb"), "--lights", at("e.exr"), "-o", at("p.png"), "--size", "64x48",
                 "--device", backend, "--exposure", exposure, "--json", at("r.json")});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_NE(outcome.out.find(" stops"), std::string::npos) << outcome.out;
        const auto report = read_json(folder / "r.json");
        EXPECT_EQ(report["exposure_automatic"].get<bool>(), std::string(exposure).starts_with("auto"));
        return report["exposure_stops"].get<double>();
    };
    // An open receiver of that base colour under light of radiance 4 is mapped to 0.22.
    const double luminance = 4 * (0.2126 * 0.25 + 0.7152 * 0.5 + 0.0722 * 0.125);
    for (const char* backend : {"cpu", "gpu"}) {
        EXPECT_NEAR(stops("auto", backend), std::log2(0.22 / luminance), 1e-3);
        EXPECT_NEAR(stops("auto+1", backend), std::log2(0.22 / luminance) + 1, 1e-3);
        EXPECT_NEAR(stops("auto-0.5", backend), std::log2(0.22 / luminance) - 0.5, 1e-3);
        EXPECT_NEAR(stops("-1.5", backend), -1.5, 1e-6);
    }
    for (const char* wrong : {"auto1", "auto+", "bright", "", "nan", "auto+inf"})
        EXPECT_EQ(
            prt({"render", at("t.glb"), "--lights", at("e.exr"), "-o", at("p.png"), "--exposure", wrong})
                .status,
            2)
            << wrong;
}

TEST_F(Pipeline, SunsAreSeparatedAndTheRemainderRelights) {
    Image sky{64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(0.5f, 0.6f, 0.8f))};
    sky.at(32, 10) = glm::vec3(3000, 2800, 2000); // 10.5 rows of 32 from +Y, in the column of +Z
    write_exr(folder / "sky.exr", sky, EnvironmentLayout::lat_long);
    const Outcome project = prt({"project", at("sky.exr"), "-o", at("l.json"), "--suns", "1"});
    ASSERT_EQ(project.status, 0) << project.err;
    const auto light = read_json(folder / "l.json");
    ASSERT_EQ(light["suns"].size(), 1u);
    const auto towards = light["suns"][0]["towards"].get<std::vector<double>>();
    EXPECT_NEAR(towards[1], std::cos(10.5 / 32 * 3.14159265), 0.02);
    EXPECT_GT(towards[2], 0.8);
    EXPECT_GT(light["suns"][0]["irradiance"][0], light["suns"][0]["irradiance"][2]);
    const double red = light["coefficients"]["red"][0];
    EXPECT_NEAR(red * 0.2820948, 0.5, 0.05); // the sky without its sun
    triangle_file().write(folder / "t.glb");
    EXPECT_EQ(
        prt({"render", at("t.glb"), "--lights", at("l.json"), "-o", at("p.png"), "--size", "32x32"}).status,
        0);
    EXPECT_EQ(prt({"project", at("sky.exr"), "-o", at("l.json"), "--suns", "-1"}).status, 2);
}

TEST_F(Pipeline, NoonSkyHasTheStatedSun) {
    copy_examples(folder.path(), {"noon"});
    const Image image = load_environment(folder / "noon.exr").environment.image;
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.62, 0.9, 0.42));
    // The irradiance of the ground by each texel: its solid angle times its height.
    double sky = 0, sun = 0, farthest = 0;
    for (int y = 0; y < image.height / 2; ++y)
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec3 d = lat_long_direction(image.width, image.height, x + 0.5, y + 0.5);
            const double solid_angle = 2 * glm::pi<double>() / image.width *
                                       (std::cos(glm::pi<double>() * y / image.height) -
                                        std::cos(glm::pi<double>() * (y + 1) / image.height));
            const glm::vec3 pixel = image.pixels[static_cast<std::size_t>(y * image.width + x)];
            const double luminance = glm::dot(glm::dvec3(pixel), glm::dvec3(0.2126, 0.7152, 0.0722));
            const bool in_sun = luminance > 100; // the adjacent sky has about 1
            (in_sun ? sun : sky) += luminance * d.y * solid_angle;
            if (in_sun)
                farthest = std::max(farthest, std::acos(glm::dot(d, towards)));
        }
    // Texels are 0.35 degrees wide: half a diagonal is added to the disc's 0.265.
    EXPECT_LT(glm::degrees(farthest), 0.265 + 0.25);
    EXPECT_NEAR(sun / towards.y / sky, 6, 0.06); // 1 % error for texel centers instead of the disc
    EXPECT_NEAR((sun + sky) / glm::pi<double>(), 1, 0.01);
}

} // namespace
} // namespace prt::test
