// Tests that per-frame functions do not allocate. A separate program, because it counts every allocation.

#include "prt/core/cluster_lighting.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "prt/core/texture_relighter.h"
#include "support/random_lightmap.h"
#include "support/random_volume.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <new>
#include <random>

namespace {
std::atomic<std::size_t> allocations = 0;
}

// Not inlined: otherwise the compiler sees free() for memory from its own operator new.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size))
        return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace prt {
namespace {

TEST(Frame, DoesNotAllocate) {
    ClusteredTransfer transfer;
    transfer.bases.layout = layout_of_one(6, 1);
    transfer.bases.components.assign(40, 5);
    transfer.bases.rows.assign(40 * 6 * 36, 0.5f);
    const ClusterLighting relighter(transfer);
    std::vector<glm::vec4> constants(relighter.rows()), others(relighter.rows());
    const Light light = constant_light(6, {1, 2, 3});
    std::vector<glm::vec3> rotated(36);
    std::array<float, 36> basis{}, product{};
    sh_product(6, basis, basis, product); // its tables are made when they are first wanted

    const std::size_t before = allocations;
    ShRotation(6, glm::dmat3(1)).apply(light.coefficients, rotated);
    relighter.update(rotated, constants);
    relighter.update(rotated, others, 0, 64);
    blend_constants(constants, others, 0.5f, constants);
    evaluate_sh(6, glm::vec3(0, 0, 1), std::span<float>(basis));
    sh_product(6, basis, basis, product);
    EXPECT_EQ(allocations, before);
    EXPECT_GT(constants[0].r, 0);
    const std::vector<int> one(1); // the counter does count
    EXPECT_GT(allocations, before);
}

TEST(Lightmap, IsLitWithoutAllocation) {
    std::mt19937 random(1);
    const CompressedLightmap lightmap = test::random_lightmap({{70, 40}}, 2, false, random);
    const Light light = constant_light(3, {1, 2, 3});
    const TextureRelighter relighter(lightmap, TexelFormat::rgb9e5);
    std::vector<glm::vec4> constants(relighter.rows());
    std::vector<std::byte> texels(relighter.bytes(0));
    const std::size_t before = allocations;
    relighter.update_constants(light, {}, constants);
    relighter.update(0, constants, texels, 1); // several threads have to be started
    EXPECT_EQ(allocations, before);
}

TEST(Volume, IsLitAndLookedUpWithoutAllocation) {
    std::mt19937 random(1);
    const CompressedVolume volume = test::random_volume(3, false, random);
    const TextureRelighter relighter(volume);
    const VolumeLookup lookup(volume.grid, volume.visibility);
    const Light light = constant_light(3, {1, 2, 3});
    std::vector<glm::vec4> constants(relighter.rows());
    std::vector<std::byte> texels(relighter.bytes(0));
    const std::vector<glm::vec3> incident = incident_light(volume, {light}, 1);
    std::array<glm::vec3, 9> mixed{};
    const std::size_t before = allocations;
    relighter.update_constants(light, glm::vec3(0, 1, 0), constants);
    relighter.update(0, constants, texels, 1); // several threads have to be started
    mix_incident(lookup.find({0, 1, 2}, {0, 1, 0}), incident, mixed);
    irradiance_of(mixed, {0, 1, 0});
    EXPECT_EQ(allocations, before);
}

} // namespace
} // namespace prt
