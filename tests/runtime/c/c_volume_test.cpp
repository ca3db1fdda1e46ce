// A volume through the C interface, against C++.

#include "prt/prt.h"

#include "prt/core/texture_relighter.h"
#include "prt/gltf/gltf.h"
#include "support/glb_file.h"
#include "support/random_volume.h"
#include "support/volume_model.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace prt {
namespace {

/// A volume in a file with a triangle without transfer.
class CVolume : public testing::Test {
protected:
    void SetUp() override {
        test::GlbFile file = test::triangle_file();
        file.json["nodes"][0]["translation"] = {1e6, 20, 3};
        std::mt19937 random(3);
        expected = test::random_volume(3, false, random);
        encoded = test::with_volume(file, expected).bytes();
        scene = extract_scene(parse_gltf(std::as_bytes(std::span(encoded)), "t.glb"));
        prt_message message;
        ASSERT_EQ(prt_volume_load_memory(encoded.data(), encoded.size(), &volume, &message), PRT_OK)
            << message.text;
        ASSERT_EQ(prt_volume_get_info(volume, &info, nullptr), PRT_OK);
        ASSERT_EQ(prt_volume_get_textures(volume, &textures, nullptr), PRT_OK);
        sky = cone_light(3, {0, 1, 0}, 0.7, {1, 2, 3});
    }
    void TearDown() override { prt_volume_destroy(volume); }
    std::vector<float> constants() const {
        std::vector<float> computed(4 * info.rows);
        const prt_lighting lighting{3, &sky.coefficients[0].x, nullptr, nullptr, kSun};
        EXPECT_EQ(prt_volume_update_constants(volume, &lighting, computed.data(), nullptr), PRT_OK);
        return computed;
    }

    static constexpr float kSun[3] = {2, 4, -1};
    Scene scene;
    CompressedVolume expected;
    std::string encoded;
    prt_volume* volume = nullptr;
    prt_volume_info info = {};
    prt_volume_textures textures = {};
    Light sky;
};

TEST_F(CVolume, ReportsItsProperties) {
    EXPECT_EQ(info.order, 3);
    EXPECT_EQ(info.incident_order, 3);
    EXPECT_EQ(info.probes, expected.visibility.size());
    EXPECT_EQ(info.lamps, 1u);
    EXPECT_EQ(info.has_direct_term, 1);
    EXPECT_EQ(info.spacing, 0.5f);
    for (int a = 0; a < 3; ++a) {
        EXPECT_NEAR(info.corner[a], expected.grid.origin[a], 1e-6f);
        EXPECT_EQ(info.origin[a], scene.origin[a]);
        EXPECT_EQ(textures.index[a], expected.grid.size[a]);
        EXPECT_EQ(textures.light[a], textures.visibility[a] * (a == 2 ? 7 : 1));
    }
}

TEST_F(CVolume, ComputesTheTexturesOfCpp) {
    const TextureRelighter relighter(expected);
    const VolumeLookup lookup(expected.grid, expected.visibility);
    std::vector<glm::vec4> computed(relighter.rows());
    std::vector<std::byte> light(relighter.bytes(0)), texels(textures.light_bytes);
    relighter.update_constants(sky, glm::normalize(glm::make_vec3(kSun)), computed);
    relighter.update(0, computed, light, 1);
    const std::vector<float> by_c = constants();
    const std::size_t half = info.probes / 2;
    EXPECT_EQ(prt_volume_update_light(volume, by_c.data(), 0, half, texels.data(), nullptr), PRT_OK);
    EXPECT_EQ(prt_volume_update_light(volume, by_c.data(), half, info.probes, texels.data(), nullptr),
              PRT_OK);
    EXPECT_EQ(texels, light);
    const std::vector<std::uint32_t> visibility = visibility_texels(expected.grid, lookup.probes(),
                                                                    expected.visibility),
                                     index = index_texels(expected.grid, lookup.index());
    EXPECT_EQ(std::memcmp(textures.visibility_texels, visibility.data(), 4 * visibility.size()), 0);
    EXPECT_EQ(std::memcmp(textures.index_texels, index.data(), 4 * index.size()), 0);
}

TEST_F(CVolume, LightsAPositionLikeCpp) {
    const std::vector<float> computed = constants();
    std::vector<float> incident(3 * 9 * info.probes);
    ASSERT_EQ(prt_volume_evaluate(volume, computed.data(), incident.data(), nullptr), PRT_OK);
    const VolumeLookup lookup(expected.grid, expected.visibility);
    const std::vector<glm::vec3> of_cpp = incident_light(expected, {sky});
    for (const glm::vec3 position : {glm::vec3(0, 1, 3), glm::vec3(2.2f, 1, 2.3f), glm::vec3(-9, 99, 0)}) {
        const glm::vec3 normal(0, 0.6f, -0.8f);
        const prt_volume_position point{{position.x, position.y, position.z}, {normal.x, normal.y, normal.z}};
        float light[27], irradiance[3];
        ASSERT_EQ(prt_volume_incident(volume, incident.data(), &point, light, nullptr), PRT_OK);
        ASSERT_EQ(prt_volume_irradiance(volume, incident.data(), &point, irradiance, nullptr), PRT_OK);
        std::vector<glm::vec3> mixed(9);
        mix_incident(lookup.find(position, normal), of_cpp, mixed);
        for (int i = 0; i < 27; ++i)
            EXPECT_NEAR(light[i], mixed[static_cast<std::size_t>(i / 3)][i % 3], 1e-4f);
        EXPECT_LT(glm::distance(glm::make_vec3(irradiance), irradiance_of(mixed, normal)), 1e-4f);
    }
}

TEST_F(CVolume, WritesItsShaders) {
    std::size_t size = 0;
    prt_message message;
    EXPECT_EQ(prt_volume_functions(volume, nullptr, &size, &message), PRT_TOO_SMALL);
    std::string source(size, ' ');
    EXPECT_EQ(prt_volume_functions(volume, source.data(), &size, &message), PRT_OK);
    EXPECT_NE(source.find("vec3 prt_volume_irradiance("), std::string::npos);
    size = 0;
    EXPECT_EQ(prt_volume_shader(volume, PRT_VULKAN, nullptr, &size, &message), PRT_TOO_SMALL);
    source.assign(size, ' ');
    EXPECT_EQ(prt_volume_shader(volume, PRT_VULKAN, source.data(), &size, &message), PRT_OK);
    EXPECT_EQ(source.find("#version 450"), 0u);
    EXPECT_EQ(prt_volume_shader(volume, PRT_ESSL300, source.data(), &size, &message), PRT_BAD_ARGUMENT);
}

TEST_F(CVolume, RejectsInvalidArguments) {
    prt_message message;
    std::vector<float> computed = constants(), incident(3 * 9 * info.probes, 1.0f), light(27);
    const auto update = [&](const prt_lighting& lighting) {
        return prt_volume_update_constants(volume, &lighting, computed.data(), &message);
    };
    const float none[3] = {}, nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(update({3, nullptr, nullptr, nullptr, nullptr}), PRT_BAD_ARGUMENT);
    EXPECT_EQ(update({2, &sky.coefficients[0].x, nullptr, nullptr, nullptr}), PRT_BAD_ARGUMENT);
    EXPECT_EQ(update({3, &sky.coefficients[0].x, nullptr, nullptr, none}), PRT_BAD_ARGUMENT);
    EXPECT_EQ(prt_volume_update_light(volume, computed.data(), 0, info.probes + 1, light.data(), &message),
              PRT_BAD_ARGUMENT);
    prt_volume_position point{{nan, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(prt_volume_incident(volume, incident.data(), &point, light.data(), &message), PRT_BAD_ARGUMENT);
    point = {{0, 0, 0}, {0, 0, 0}};
    EXPECT_EQ(prt_volume_incident(volume, incident.data(), &point, light.data(), &message), PRT_OK);
    EXPECT_EQ(prt_volume_irradiance(volume, incident.data(), &point, light.data(), &message),
              PRT_BAD_ARGUMENT);
    point.normal[1] = 1;
    std::fill(incident.begin(), incident.end(), nan);
    EXPECT_EQ(prt_volume_incident(volume, incident.data(), &point, light.data(), &message), PRT_BAD_ARGUMENT);
    const std::string triangle = test::triangle_file().bytes();
    prt_volume* other = nullptr;
    EXPECT_EQ(prt_volume_load_memory(triangle.data(), triangle.size(), &other, &message), PRT_BAD_FILE);
    EXPECT_NE(std::string(message.text).find("no compressed volume"), std::string::npos);
    EXPECT_EQ(prt_volume_load("no such file.glb", &other, &message), PRT_BAD_FILE);
    EXPECT_EQ(other, nullptr);
    prt_volume_destroy(nullptr);
}

} // namespace
} // namespace prt
