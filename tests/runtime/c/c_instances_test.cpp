// Instances that share transfer through the C interface, against C++.

#include "prt/prt.h"

#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/instanced_model.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <random>
#include <string>

namespace prt {
namespace c_instances {

class CInstances : public testing::Test {
protected:
    void SetUp() override {
        prt_message message;
        ASSERT_EQ(prt_model_load_memory(encoded.data(), encoded.size(), &model, &message), PRT_OK)
            << message.text;
        ASSERT_EQ(prt_instances_get_info(model, &info, nullptr), PRT_OK);
    }
    void TearDown() override { prt_model_destroy(model); }

    std::string encoded = test::instanced_triangles().bytes();
    prt_model* model = nullptr;
    prt_instances_info info = {};
};

TEST_F(CInstances, MatchTheFile) {
    EXPECT_EQ(info.count, 3u);
    prt_model_info all = {};
    ASSERT_EQ(prt_model_get_info(model, &all, nullptr), PRT_OK);
    EXPECT_EQ(all.meshes, 2u);
    EXPECT_EQ(all.receivers, 6u);
    std::size_t drawn = 0;
    for (std::size_t mesh = 0; mesh < all.meshes; ++mesh) {
        std::size_t first = 9, count = 9;
        ASSERT_EQ(prt_instances_of_mesh(model, mesh, &first, &count, nullptr), PRT_OK);
        drawn += count;
        EXPECT_TRUE(count == 0 || count == 3);
    }
    EXPECT_EQ(drawn, 3u);
    const float x = info.worlds[12 + 3] - info.worlds[3];
    EXPECT_FLOAT_EQ(x, 2); // second instance relative to the first
}

TEST_F(CInstances, HaveTheConstantsOfCpp) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    Lighting lighting{
        constant_light(3, glm::vec3(1)), constant_light(3, glm::vec3(0.5f)), {glm::vec3(0.5f, 2, 1)}};
    for (glm::vec3& c : lighting.sky.coefficients)
        c += glm::vec3(normal(random), normal(random), normal(random));
    std::vector<float> constants(4 * info.constants);
    const prt_lighting given{3, &lighting.sky.coefficients[0].x, &lighting.suns->coefficients[0].x,
                             &lighting.lamps[0].x, nullptr};
    ASSERT_EQ(prt_instances_update_constants(model, &given, 1, constants.data(), nullptr), PRT_OK);
    const GltfDocument document = parse_gltf(std::as_bytes(std::span(encoded)), "scene.glb");
    const InstancedModel expected = read_instanced(document, extract_scene(document), "scene.glb");
    const InstanceRelighter relighter(expected.compressed->transfer, relit_instances(expected));
    ASSERT_EQ(relighter.size(), info.constants);
    std::vector<glm::vec4> computed(relighter.size());
    relighter.update(lighting, computed);
    for (std::size_t i = 0; i < computed.size(); ++i)
        for (int c = 0; c < 4; ++c)
            EXPECT_EQ(constants[4 * i + static_cast<std::size_t>(c)], computed[i][c]);
}

TEST_F(CInstances, WriteTheirShader) {
    std::size_t size = 0;
    EXPECT_EQ(prt_instances_shader(model, PRT_ESSL300, PRT_CONSTANTS_IN_TEXTURE, nullptr, &size, nullptr),
              PRT_TOO_SMALL);
    std::string source(size, ' ');
    ASSERT_EQ(
        prt_instances_shader(model, PRT_ESSL300, PRT_CONSTANTS_IN_TEXTURE, source.data(), &size, nullptr),
        PRT_OK);
    EXPECT_NE(source.find("prt_instance_radiance"), std::string::npos);
    EXPECT_EQ(prt_instances_shader(model, PRT_GLSL450, PRT_CONSTANTS_IN_BLOCK, source.data(), &size, nullptr),
              PRT_BAD_ARGUMENT);
}

TEST_F(CInstances, BadArgumentsAreRejected) {
    std::size_t first = 0, count = 0;
    EXPECT_EQ(prt_instances_of_mesh(model, 2, &first, &count, nullptr), PRT_BAD_ARGUMENT);
    EXPECT_EQ(prt_instances_of_mesh(model, 0, nullptr, &count, nullptr), PRT_BAD_ARGUMENT);
    std::vector<float> light(3 * 9, 1e30f), constants(4 * info.constants);
    prt_lighting given{3, light.data(), nullptr, nullptr, nullptr};
    const auto update = [&] {
        return prt_instances_update_constants(model, &given, 1, constants.data(), nullptr);
    };
    EXPECT_EQ(update(), PRT_BAD_ARGUMENT);
    light.assign(3 * 9, 1);
    EXPECT_EQ(update(), PRT_OK);
    given.order = 2;
    EXPECT_EQ(update(), PRT_BAD_ARGUMENT);
    const std::vector<float> blinding(3, 1e30f);
    given = {3, light.data(), nullptr, blinding.data(), nullptr};
    EXPECT_EQ(update(), PRT_BAD_ARGUMENT);
}

} // namespace c_instances
} // namespace prt
