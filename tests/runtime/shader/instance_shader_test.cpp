// The vertex shader of instances against C++, through compressed transfer with guides.

#include "prt/compress.h"
#include "prt/constant_former.h"
#include "prt/gl_renderer.h"
#include "prt/instance_shader.h"
#include "prt/instances.h"

#include "run_shader.h"
#include "shared_instances.h"
#include "support/guided.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace instances_in_shaders {

static_assert(PRT_INSTANCE_PASSING == kPassingModes && PRT_INSTANCE_MODES == kInstanceModes &&
              PRT_INSTANCE_TABLE_ROWS == kInstanceTableRows);

constexpr int kOrder = 3;
constexpr std::size_t kVertices = 300;

ClusteredTransfer random_mesh(std::mt19937& random) {
    std::normal_distribution<float> normal;
    Transfer transfer = zero_transfer({kOrder, {{PartKind::direct, 1}, {PartKind::indirect, 3}}}, kVertices);
    for (float& value : transfer.vectors)
        value = normal(random);
    CompressOptions options;
    options.clusters = 5;
    options.coding.components = 4;
    options.coding.format = WeightFormat::packed;
    options.coding.bits = 24;
    ClusteredTransfer compressed =
        compress(transfer, {std::vector<float>(kVertices, 1.0f)}, options).transfer;
    test::add_guides(compressed, {GuideKind::normal, GuideKind::position}, random);
    return compressed;
}

InstanceFactors random_factors(std::mt19937& random) {
    std::normal_distribution<float> normal;
    std::array<float, kInstanceNumbers> numbers;
    for (float& number : numbers)
        number = normal(random);
    return factors_of(numbers);
}

TEST(InstanceShader, AgreesWithCppOnEveryModeAndTurn) {
    std::string why;
    const auto context = GlContext::create(GlDevice::any, &why);
    ASSERT_TRUE(context) << why;
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    const ClusteredTransfer mesh = random_mesh(random);
    Lighting lighting{constant_light(kOrder, glm::vec3(1)), constant_light(kOrder, glm::vec3(0.2f))};
    for (glm::vec3& c : lighting.sky.coefficients)
        c += 0.3f * glm::vec3(normal(random), normal(random), normal(random));

    const std::array rotations = {glm::dmat3(1), glm::dmat3(glm::angleAxis(1.1, glm::dvec3(0, 1, 0)))};
    const InstanceTurns turns = instance_turns(rotations, 0);
    const ConstantFormer former(mesh);
    const std::size_t rows = former.rows();
    std::vector<glm::vec4> constants(turns.rotations.size() * kInstanceModes * rows);
    for (std::size_t turn = 0; turn < turns.rotations.size(); ++turn) {
        const auto lightings = turned_into(turns.rotations[turn], InstanceModes(kOrder).lightings(lighting));
        for (std::size_t m = 0; m < kInstanceModes; ++m)
            former.form(lightings[m], std::span(constants).subspan((turn * kInstanceModes + m) * rows, rows));
    }
    const std::vector<InstanceFactors> factors = {random_factors(random), random_factors(random)};
    const std::vector<InstanceBox> boxes = {{glm::vec3(3, -1, 2), glm::vec3(2, 1, 3)},
                                            {glm::vec3(2, 0, 2), glm::vec3(1, 4, 2)}};
    test::bind_buffer(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_INSTANCES,
                      instance_table(factors, boxes, turns.of));

    std::string source = instance_shader(mesh, ShaderLanguage::glsl450, test::kSceneOrigin);
    source.replace(source.find("first_instance + PRT_INSTANCE_INDEX"), 35, "PRT_TEST_INSTANCE");
    const std::size_t guide_rows = mesh.bases.guide_rows(), of_position = guide_rows - 3;
    for (std::size_t i = 0; i < factors.size(); ++i) {
        const std::size_t behind_version = source.find('\n') + 1;
        std::string of_instance = source;
        of_instance.insert(behind_version, "#define PRT_TEST_INSTANCE " + std::to_string(i) + "u\n");
        const auto measured = test::radiance_of_vertices(mesh, of_instance, constants,
                                                         ShaderLanguage::glsl450, ConstantSource::buffer);
        std::array<std::vector<glm::vec3>, kInstanceModes> of_modes;
        for (std::size_t m = 0; m < kInstanceModes; ++m) {
            of_modes[m].resize(kVertices);
            evaluate(mesh, std::span(constants).subspan((turns.of[i] * kInstanceModes + m) * rows, rows),
                     of_modes[m]);
        }
        for (std::size_t v = 0; v < kVertices; ++v) {
            std::array<glm::vec3, kInstanceModes> of_vertex;
            for (std::size_t m = 0; m < kInstanceModes; ++m)
                of_vertex[m] = of_modes[m][v];
            const float* x = &mesh.receivers.guides[v * guide_rows + of_position];
            const glm::vec3 position =
                glm::vec3(x[0], x[1], x[2]) + mesh.bases.guides.back().origin + test::kSceneOrigin;
            const glm::vec3 expected = exit_radiance(factors[i], boxes[i].place_of(position), of_vertex);
            EXPECT_LT(glm::distance(expected, measured[v]), 2e-4f * std::max(1.0f, glm::length(expected)))
                << v;
        }
    }
}

TEST(InstanceShader, LanguagesWithoutStorageBuffersAreRefused) {
    std::mt19937 random(3);
    EXPECT_THROW(instance_shader(random_mesh(random), ShaderLanguage::essl300), Error);
    EXPECT_NE(instance_shader(random_mesh(random), ShaderLanguage::vulkan).find("prt_instances["),
              std::string::npos);
}

} // namespace instances_in_shaders
} // namespace prt
