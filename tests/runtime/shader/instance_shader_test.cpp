// Compares the vertex shader of instances with C++, for compressed transfer with predictors.

#include "prt/compress/compress.h"
#include "prt/core/error.h"
#include "prt/core/instances.h"
#include "prt/gl/gl_renderer.h"
#include "prt/shader/shader_source.h"

#include "run_shader.h"
#include "shared_layout.h"
#include "support/predicted.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace instances_in_shaders {

static_assert(kMaxInstancedWeights == 4 * (PRT_LOCATION_INSTANCE_X - PRT_LOCATION_WEIGHTS));

constexpr int kOrder = 3;
constexpr std::size_t kVertices = 300;

ClusteredTransfer random_mesh(std::mt19937& random) {
    std::normal_distribution<float> normal;
    Transfer transfer = zero_transfer({kOrder, {{TermKind::direct, 1}, {TermKind::indirect, 3}}}, kVertices);
    for (float& value : transfer.vectors)
        value = normal(random);
    CompressOptions options;
    options.clusters = 5;
    options.coding.components = 4;
    options.coding.format = WeightFormat::packed;
    options.coding.bits = 24;
    ClusteredTransfer compressed =
        compress(transfer, {std::vector<float>(kVertices, 1.0f)}, options).transfer;
    test::add_predictors(compressed, {PredictorKind::normal, PredictorKind::position}, random);
    return compressed;
}

InstanceFactors random_factors(std::mt19937& random) {
    std::normal_distribution<float> normal;
    std::array<float, kInstanceNumbers> numbers;
    for (float& number : numbers)
        number = normal(random);
    return factors_of(numbers);
}

/// Returns the radiance evaluated for each of the nine modes of an instance.
std::vector<glm::vec3> radiance_of(const ClusteredTransfer& mesh, const PlacedInstance& instance,
                                   const Lighting& lighting) {
    std::array<std::vector<glm::vec3>, kInstanceModes> of_modes;
    const auto lightings = rotated_into(instance.rotation, InstanceModes(kOrder).lightings(lighting));
    for (std::size_t m = 0; m < kInstanceModes; ++m)
        of_modes[m] = exit_radiance(mesh, lightings[m]);
    const std::size_t predictor_rows = mesh.bases.predictor_rows(), of_position = predictor_rows - 3;
    std::vector<glm::vec3> radiance;
    for (std::size_t v = 0; v < kVertices; ++v) {
        std::array<glm::vec3, kInstanceModes> of_vertex;
        for (std::size_t m = 0; m < kInstanceModes; ++m)
            of_vertex[m] = of_modes[m][v];
        const float* x = &mesh.receivers.predictors[v * predictor_rows + of_position];
        const glm::vec3 position =
            glm::vec3(x[0], x[1], x[2]) + mesh.bases.predictors.back().origin + test::kSceneOrigin;
        radiance.push_back(exit_radiance(instance.factors, instance.box.position_of(position), of_vertex));
    }
    return radiance;
}

Lighting random_lighting(std::mt19937& random) {
    std::normal_distribution<float> normal;
    Lighting lighting{constant_light(kOrder, glm::vec3(1)), constant_light(kOrder, glm::vec3(0.2f))};
    for (glm::vec3& c : lighting.sky.coefficients)
        c += 0.3f * glm::vec3(normal(random), normal(random), normal(random));
    return lighting;
}

/// In the context that is current.
void expect_agreement(ShaderLanguage language, ConstantSource source) {
    std::mt19937 random(3);
    const ClusteredTransfer mesh = random_mesh(random);
    const Lighting lighting = random_lighting(random);
    const std::vector<RelitInstance> instances = {
        {{random_factors(random), glm::dmat3(1), {glm::vec3(3, -1, 2), glm::vec3(2, 1, 3)}},
         rows_of(mesh, 0, kVertices)},
        {{random_factors(random),
          glm::dmat3(glm::angleAxis(1.1, glm::dvec3(0, 1, 0))),
          {glm::vec3(2, 0, 2), glm::vec3(1, 4, 2)}},
         rows_of(mesh, 0, kVertices)}};
    const InstanceRelighter relighter(mesh, instances, 0);
    std::vector<glm::vec4> constants(relighter.size());
    relighter.update(lighting, constants);
    const std::vector<glm::vec4> table = relighter.table();
    const std::string shader = instance_shader(mesh, source, language, test::kSceneOrigin);
    for (std::size_t i = 0; i < instances.size(); ++i) {
        glVertexAttrib4f(PRT_LOCATION_INSTANCE_X, 1, 0, 0, 0);
        glVertexAttrib4f(PRT_LOCATION_INSTANCE_Y, 0, 1, 0, 0);
        glVertexAttrib4f(PRT_LOCATION_INSTANCE_Z, 0, 0, 1, 0);
        glVertexAttrib4fv(PRT_LOCATION_INSTANCE_0, &table[2 * i].x);
        glVertexAttrib4fv(PRT_LOCATION_INSTANCE_1, &table[2 * i + 1].x);
        const auto measured = test::radiance_of_vertices(mesh, shader, constants, language, source);
        const auto expected = radiance_of(mesh, instances[i].placed, lighting);
        for (std::size_t v = 0; v < kVertices; ++v)
            EXPECT_LT(glm::distance(expected[v], measured[v]),
                      2e-4f * std::max(1.0f, glm::length(expected[v])))
                << i << " " << v;
    }
}

TEST(InstanceShader, MatchesCppForEveryModeAndRotation) {
    std::string why;
    const auto context = GlContext::create(GlDevice::any, &why);
    ASSERT_TRUE(context) << why;
    expect_agreement(ShaderLanguage::glsl450, ConstantSource::buffer);
    expect_agreement(ShaderLanguage::glsl330, ConstantSource::texture);
}

TEST(InstanceShader, MatchesCppInEs) {
    const test::EsContext context;
    if (!context.current())
        GTEST_SKIP() << "no OpenGL ES 3.0";
    expect_agreement(ShaderLanguage::essl300, ConstantSource::texture);
}

TEST(InstanceShader, BlocksAndManyWeightsAreRejected) {
    std::mt19937 random(3);
    ClusteredTransfer mesh = random_mesh(random);
    EXPECT_THROW(instance_shader(mesh, ConstantSource::block), Error);
    EXPECT_THROW(instance_shader(mesh, ConstantSource::buffer, ShaderLanguage::essl300), Error);
    mesh.receivers.format = WeightFormat::float32;
    mesh.bases.components.front() = 25;
    EXPECT_THROW(instance_shader(mesh), Error);
}

} // namespace instances_in_shaders
} // namespace prt
