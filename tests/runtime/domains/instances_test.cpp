// Tests modes and factors of instances, against quadrature, rotated lighting, and each other.

#include "prt/core/instances.h"

#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/sh.h"
#include "support/quadrature.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace prt {
namespace of_instances {

constexpr int kOrder = 5;

struct Draw {
    std::mt19937 random{7};
    std::normal_distribution<float> normal;

    float number() { return normal(random); }
    glm::vec3 vector() {
        const float x = number(), y = number(), z = number();
        return {x, y, z};
    }
    Light light() {
        Light result{kOrder, {}};
        for (int i = 0; i < coefficient_count(kOrder); ++i)
            result.coefficients.push_back(vector());
        return result;
    }
    Transfer transfer(std::size_t receivers) {
        Transfer result =
            zero_transfer({kOrder, {{TermKind::direct, 1}, {TermKind::indirect, 3}}}, receivers);
        for (float& value : result.vectors)
            value = number();
        return result;
    }
    InstanceFactors factors() {
        std::array<float, kInstanceNumbers> numbers;
        for (float& value : numbers)
            value = number();
        return factors_of(numbers);
    }
    InstanceLampLight lamp() {
        InstanceLampLight light;
        for (auto& colors : light.functions)
            for (glm::vec4& color : colors)
                color = {vector(), number()};
        return light;
    }
    glm::dmat3 rotation() {
        const glm::dvec3 axis = glm::normalize(glm::dvec3(vector()));
        return glm::dmat3(glm::angleAxis(2.0 * static_cast<double>(number()), axis));
    }
};

/// Exit radiance of vectors.
std::vector<glm::vec3> lit(const TransferLayout& layout, std::vector<float> vectors,
                           const Lighting& lighting) {
    return exit_radiance(Transfer{layout, std::move(vectors)}, lighting);
}

std::vector<float> expanded_vectors(const Transfer& transfer, const PlacedInstance& placed,
                                    const std::vector<glm::vec3>& positions) {
    const SharedTransfer shared(transfer, glm::transpose(placed.rotation) * glm::dvec3(0, 1, 0));
    std::vector<float> vectors(transfer.vectors.size());
    expand_instance(shared, transfer.layout, placed, positions, vectors);
    return vectors;
}

void expect_near(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b, float tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_LT(glm::distance(a[i], b[i]), tolerance * std::max(1.0f, glm::length(a[i]))) << i;
}

TEST(Instances, UnoccludedInstancesMatchTheirMesh) {
    Draw draw;
    const Transfer transfer = draw.transfer(5);
    const std::vector<float> vectors =
        expanded_vectors(transfer, {open_factors(), glm::dmat3(1), {}}, std::vector<glm::vec3>(5));
    for (std::size_t i = 0; i < vectors.size(); ++i)
        EXPECT_NEAR(vectors[i], transfer.vectors[i], 1e-5f);
}

TEST(Instances, RotatedInstancesMatchTheMeshInRotatedLight) {
    Draw draw;
    const Transfer transfer = draw.transfer(6);
    const glm::dmat3 rotation = draw.rotation();
    Lighting lighting{draw.light(), draw.light()};
    const auto rotated_mesh =
        lit(transfer.layout,
            expanded_vectors(transfer, {open_factors(), rotation, {}}, std::vector<glm::vec3>(6)), lighting);
    const ShRotation back(kOrder, glm::transpose(rotation));
    back.apply(std::span(lighting.sky.coefficients));
    back.apply(std::span(lighting.suns->coefficients));
    expect_near(rotated_mesh, exit_radiance(transfer, lighting), 1e-4f);
}

/// Lightings of modes, as in a shader, agree with modes of transfer, as defined by the file.
TEST(Instances, ModesOfLightEqualModesOfTransfer) {
    Draw draw;
    const Transfer transfer = draw.transfer(7);
    const Lighting lighting{draw.light(), draw.light()};
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 7; ++i)
        positions.push_back(draw.vector());
    const PlacedInstance placed{draw.factors(), draw.rotation(), bounding_box(positions)};
    const auto by_transfer = lit(transfer.layout, expanded_vectors(transfer, placed, positions), lighting);

    const auto lightings = rotated_into(placed.rotation, InstanceModes(kOrder).lightings(lighting));
    std::array<std::vector<glm::vec3>, kInstanceModes> of_modes;
    for (std::size_t m = 0; m < kInstanceModes; ++m)
        of_modes[m] = exit_radiance(transfer, lightings[m]);
    std::vector<glm::vec3> by_light;
    for (std::size_t r = 0; r < positions.size(); ++r) {
        std::array<glm::vec3, kInstanceModes> of_receiver;
        for (std::size_t m = 0; m < kInstanceModes; ++m)
            of_receiver[m] = of_modes[m][r];
        by_light.push_back(exit_radiance(placed.factors, placed.box.position_of(positions[r]), of_receiver));
    }
    expect_near(by_transfer, by_light, 2e-4f);
}

TEST(Instances, TransmittedModesAreIntegralsOverHalfSpheres) {
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
    const InstanceModes modes(3, up);
    // Midpoints of a fine grid, because no quadrature is exact for a step.
    constexpr int kSteps = 400;
    std::array<double, kPassingModes> sums{};
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const double z = 2 * (i + 0.5) / kSteps - 1, angle = 2 * M_PI * (j + 0.5) / kSteps;
            const double r = std::sqrt(1 - z * z);
            const glm::dvec3 d(r * std::cos(angle), r * std::sin(angle), z);
            std::array<double, 9> basis;
            evaluate_sh(3, d, basis);
            const bool above = glm::dot(d, up) > 0;
            const double product = basis[2] * basis[7] * 4 * M_PI / (kSteps * kSteps);
            sums[0] += above ? product : 0;
            sums[1] += above ? -std::sqrt(3.0) * d.y * product : 0;
            sums[6] += above ? 0.5 * std::sqrt(5.0) * (3 * d.z * d.z - 1) * product : 0;
            sums[8] += above ? 0.5 * std::sqrt(15.0) * (d.x * d.x - d.y * d.y) * product : 0;
            sums[9] += above ? 0 : product;
        }
    for (const std::size_t m : {0u, 1u, 6u, 8u, 9u})
        EXPECT_NEAR(modes.matrix(m)[2 * 9 + 7], sums[m], 2e-4) << m;
}

TEST(Instances, ReflectedLightIsThatOfLevelGround) {
    const auto lightings = InstanceModes(kOrder).lightings({constant_light(kOrder, glm::vec3(2, 1, 0.5f))});
    const glm::vec3 everywhere = radiance(lightings[kPassingModes].sky, glm::vec3(0, 0, 1));
    EXPECT_LT(glm::distance(everywhere, glm::vec3(2, 1, 0.5f)), 1e-5f);
    const glm::vec3 from_x = radiance(lightings[kPassingModes + 3].sky, glm::vec3(1, 0, 0));
    EXPECT_NEAR(from_x.y, -std::sqrt(3.0f), 1e-5f);
}

TEST(Instances, FactorRotationsAreInvertible) {
    Draw draw;
    const InstanceFactors factors = draw.factors();
    const glm::dmat3 rotation = draw.rotation();
    const auto again = numbers_of(in_axes_of_world(in_axes_of_mesh(factors, rotation), rotation));
    const auto before = numbers_of(factors);
    for (std::size_t i = 0; i < kInstanceNumbers; ++i)
        EXPECT_NEAR(again[i], before[i], 1e-5f);
}

TEST(Instances, ByteFactorsAreCloseAndExactIfUnoccluded) {
    Draw draw;
    std::vector<InstanceFactors> factors = {open_factors()};
    for (int i = 0; i < 50; ++i)
        factors.push_back(draw.factors());
    const CodedFactors bytes = coded(factors);
    EXPECT_EQ(bytes.bytes.size(), 51 * kInstanceNumbers);
    const std::vector<InstanceFactors> again = decoded(bytes);
    EXPECT_EQ(again.front(), open_factors());
    for (std::size_t i = 0; i < factors.size(); ++i)
        for (std::size_t j = 0; j < kInstanceNumbers; ++j)
            EXPECT_NEAR(numbers_of(again[i])[j], numbers_of(factors[i])[j], 0.5001f * bytes.scales[j]) << j;
    for (const float scale : bytes.scales)
        EXPECT_LT(scale, 5.0f / 127);
    factors.back().added[2].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(coded(factors), Error);
    factors.back().added[2].y = 1e6f;
    EXPECT_THROW(coded(factors), Error);
}

TEST(Instances, UprightInstancesShareRotationsOfFewYaws) {
    std::vector<glm::dmat3> rotations;
    for (int i = 0; i < 100; ++i)
        rotations.push_back(glm::dmat3(glm::angleAxis(0.37 * i, glm::dvec3(0, 1, 0))));
    rotations.push_back(glm::dmat3(glm::angleAxis(0.5, glm::dvec3(1, 0, 0))));
    const InstanceRotations shared = instance_rotations(rotations, 16);
    EXPECT_EQ(shared.rotations.size(), 17u);
    EXPECT_LE(shared.max_degrees, 11.26);
    EXPECT_GT(shared.max_degrees, 8);
    const InstanceRotations exact = instance_rotations(rotations, 0);
    EXPECT_LT(exact.max_degrees, 0.011);
    for (std::size_t i = 0; i < rotations.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_LT(glm::distance(exact.rotations[exact.of[i]][c], rotations[i][c]), 3e-4);
}

/// Returns random weights: three clusters of four receivers each, the last with three components.
ClusteredTransfer clustered_mesh(Draw& draw) {
    ClusteredTransfer mesh;
    mesh.bases.layout = {kOrder,
                         {{TermKind::direct, 1},
                          {TermKind::indirect, 3},
                          {TermKind::lamp, 3, "Lantern"},
                          {TermKind::lamp, 3, "Fire"}}};
    mesh.bases.components = {2, 1, 3};
    for (std::size_t i = 0; i < (3 + 6) * mesh.bases.dimension(); ++i)
        mesh.bases.rows.push_back(draw.number());
    mesh.receivers.format = WeightFormat::float32;
    mesh.receivers.components = 4;
    for (std::uint16_t p = 0; p < 12; ++p)
        mesh.receivers.clusters.push_back(p / 4);
    std::vector<float> weights;
    for (int i = 0; i < 12 * 4; ++i)
        weights.push_back(draw.number());
    const auto bytes = std::as_bytes(std::span(weights));
    mesh.receivers.weights.assign(bytes.begin(), bytes.end());
    return mesh;
}

/// Returns the constants at a position: those of a lighting, for all clusters.
std::vector<glm::vec4> constants_at(std::span<const glm::vec4> computed, const glm::vec4& table_0,
                                    const glm::vec4& table_1, const glm::vec3& position,
                                    const ConstantRows& rows) {
    const std::uint32_t offset =
        static_cast<std::uint32_t>(table_0.w) + (static_cast<std::uint32_t>(table_1.w) << 16);
    const glm::vec4 point((position - glm::vec3(table_0)) * glm::vec3(table_1), 1);
    std::vector<glm::vec4> constants(rows.first + rows.count, glm::vec4(0));
    for (std::uint32_t row = rows.first; row < rows.first + rows.count; ++row)
        for (std::uint32_t c = 0; c < 3; ++c)
            constants[row][static_cast<int>(c)] = glm::dot(computed[3 * (offset + row) + c], point);
    return constants;
}

TEST(Instances, ConstantsAreModesTimesFactors) {
    Draw draw;
    const ClusteredTransfer mesh = clustered_mesh(draw);
    const Lighting lighting{draw.light(), draw.light(), {draw.vector(), draw.vector()}};
    std::vector<RelitInstance> instances;
    for (const std::size_t first : {0u, 4u, 8u, 0u}) // first receiver of a mesh with one cluster, or with all
        instances.push_back({{draw.factors(),
                              draw.rotation(),
                              {draw.vector(), glm::abs(draw.vector()) + 0.1f},
                              {draw.lamp(), draw.lamp()}},
                             rows_of(mesh, first, instances.size() == 3 ? 12 : 4)});
    EXPECT_EQ(instances[1].rows.first, 3u);
    EXPECT_EQ(instances[1].rows.count, 2u);
    EXPECT_EQ(joined(instances[0].rows, instances[2].rows).count, instances[3].rows.count);
    const InstanceRelighter relighter(mesh, instances, 0);
    EXPECT_EQ(relighter.size(), 3u * (3 + 2 + 4 + 9));
    std::vector<glm::vec4> computed(relighter.size());
    relighter.update(lighting, computed);
    const std::vector<glm::vec4> table = relighter.table();
    const Transfer decoded = decode(mesh);
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const PlacedInstance& placed = instances[i].placed;
        const SharedTransfer shared(decoded, glm::transpose(placed.rotation) * glm::dvec3(0, 1, 0));
        const std::vector<glm::vec3> positions(12, draw.vector());
        std::vector<float> vectors(decoded.vectors.size());
        expand_instance(shared, decoded.layout, placed, positions, vectors);
        const std::vector<glm::vec3> expected = lit(decoded.layout, vectors, lighting);
        const std::size_t first = i == 3 ? 0 : 4 * i, count = i == 3 ? 12 : 4;
        std::vector<glm::vec4> constants =
            constants_at(computed, table[2 * i], table[2 * i + 1], positions.front(), instances[i].rows);
        constants.resize(constant_rows(mesh.bases));
        std::vector<glm::vec3> measured(12);
        evaluate(mesh, constants, measured);
        for (std::size_t v = first; v < first + count; ++v)
            EXPECT_LT(glm::distance(measured[v], expected[v]), 2e-3f * (1 + glm::length(expected[v])))
                << i << " " << v;
    }
}

/// Incident light that is (1 + 2 u_x) (1 + d_y), only in red, on an unoccluded receiver that faces +y:
/// the irradiance over pi is (1 + 2 u_x) (1 + 2/3).
TEST(Instances, LampLightIsIncidentLightThatIsLinearInThePosition) {
    Transfer transfer = zero_transfer({3, {{TermKind::direct, 1}, {TermKind::lamp, 3, "Lantern"}}}, 2);
    std::vector<double> lobe(9);
    clamped_cosine_lobe(3, glm::dvec3(0, 1, 0), lobe);
    for (std::size_t r = 0; r < 2; ++r)
        std::ranges::transform(lobe, transfer.vector(r).begin(),
                               [](double value) { return static_cast<float>(value); });
    InstanceLampLight light;
    light.functions[0][0] = {2, 0, 0, 1};                             // sqrt(4 pi) Y_00 = 1
    light.functions[1][0] = light.functions[0][0] / -std::sqrt(3.0f); // sqrt(4 pi) Y_1-1 = -sqrt(3) y
    const InstanceBox box{glm::vec3(1, 0, 0), glm::vec3(2)};
    const std::vector<glm::vec3> positions = {glm::vec3(1, 0, 0), glm::vec3(3, 0, 0)};
    const std::vector<float> vectors =
        expanded_vectors(transfer, {open_factors(), glm::dmat3(1), box, {light}}, positions);
    EXPECT_NEAR(vectors[9], 5.0f / 3, 1e-5f);
    EXPECT_NEAR(vectors[12 + 9], 5.0f, 1e-5f);
    EXPECT_EQ(vectors[10], 0);
    EXPECT_EQ(vectors[12 + 11], 0);
}

TEST(Instances, BytesOfLampLightAreClose) {
    Draw draw;
    const InstanceLampLight light = draw.lamp();
    const CodedLampLight bytes = coded(light);
    const InstanceLampLight again = decoded(bytes);
    for (std::size_t i = 0; i < kInstanceLampFunctions; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            for (int a = 0; a < 4; ++a)
                EXPECT_NEAR(again.functions[i][c][a], light.functions[i][c][a], 0.5001f * bytes.scale);
    EXPECT_EQ(decoded(coded(InstanceLampLight{})), InstanceLampLight{});
    InstanceLampLight bad = light;
    bad.functions[3][1].z = std::numeric_limits<float>::infinity();
    EXPECT_THROW(coded(bad), Error);
}

/// A mesh that is drawn once has lamp terms in its transfer.
TEST(Instances, MeshesDrawnOnceAreLitByTheirLampTerms) {
    Draw draw;
    const ClusteredTransfer mesh = clustered_mesh(draw);
    const Lighting lighting{draw.light(), draw.light(), {draw.vector(), draw.vector()}};
    const InstanceBox box{draw.vector(), glm::abs(draw.vector()) + 0.1f};
    const RelitInstance once{{open_factors(), glm::dmat3(1), box}, rows_of(mesh, 0, 12)};
    const InstanceRelighter relighter(mesh, std::span(&once, 1), 0);
    std::vector<glm::vec4> computed(relighter.size());
    relighter.update(lighting, computed);
    const std::vector<glm::vec4> table = relighter.table();
    std::vector<glm::vec3> measured(12);
    evaluate(mesh, constants_at(computed, table[0], table[1], draw.vector(), once.rows), measured);
    expect_near(measured, exit_radiance(decode(mesh), lighting), 1e-3f);
}

TEST(Instances, NeedLightOfEachLamp) {
    Draw draw;
    const ClusteredTransfer mesh = clustered_mesh(draw);
    const RelitInstance instance{{draw.factors(), draw.rotation(), {}, {draw.lamp()}}, rows_of(mesh, 0, 4)};
    EXPECT_THROW(InstanceRelighter(mesh, std::span(&instance, 1)), Error);
    std::vector<float> vectors(mesh.bases.dimension() * 12);
    const SharedTransfer shared(decode(mesh), {0, 1, 0});
    EXPECT_THROW(
        expand_instance(shared, mesh.bases.layout, instance.placed, std::vector<glm::vec3>(12), vectors),
        Error);
    EXPECT_THROW(SharedTransfer(zero_transfer({3, {{TermKind::lamp, 1, "Lantern"}}}, 1), {0, 1, 0}), Error);
    EXPECT_THROW(InstanceModes(3).lightings({constant_light(2, glm::vec3(1))}), Error);
    EXPECT_THROW(InstanceModes(0), Error);
}

TEST(Instances, ABoxOfAFlatMeshHasNoZeroWidth) {
    const std::vector<glm::vec3> flat = {{0, 1, 0}, {2, 1, 0}, {0, 1, 4}};
    const InstanceBox box = bounding_box(flat);
    EXPECT_EQ(box.middle, glm::vec3(1, 1, 2));
    EXPECT_GT(box.half.y, 0);
    EXPECT_EQ(box.position_of({2, 1, 4}), glm::vec3(1, 0, 1));
}

} // namespace of_instances
} // namespace prt
