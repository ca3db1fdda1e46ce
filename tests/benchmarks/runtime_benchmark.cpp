// Measures the speed of the runtime library: runtime_benchmark [--benchmark_filter=REGEX]. Uses one thread
// unless noted.

#include "prt/core/cluster_lighting.h"
#include "prt/core/dering.h"
#include "prt/core/environment.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "prt/core/texture_relighter.h"

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstring>
#include <random>
#include <string>

namespace prt {
namespace {

using benchmark::State;

constexpr int kOrder = 6;
constexpr std::size_t kCount = static_cast<std::size_t>(coefficient_count(kOrder));

std::vector<glm::vec3> random_directions(std::size_t count) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    std::vector<glm::vec3> directions(count);
    for (glm::vec3& d : directions)
        d = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    return directions;
}

std::vector<float> random_values(std::size_t count) {
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    std::vector<float> values(count);
    for (float& v : values)
        v = normal(random);
    return values;
}

std::vector<glm::vec3> random_light() {
    return random_directions(kCount);
}

void basis_one_by_one(State& state) {
    const auto directions = random_directions(1024);
    std::vector<float> basis(kCount);
    for (auto _ : state)
        for (const glm::vec3& d : directions) {
            evaluate_sh(kOrder, d, std::span<float>(basis));
            benchmark::DoNotOptimize(basis.data());
            benchmark::ClobberMemory();
        }
    state.SetItemsProcessed(state.iterations() * 1024);
}
BENCHMARK(basis_one_by_one);

void basis_in_batches(State& state) {
    const auto directions = random_directions(64);
    std::vector<float> basis(kCount * directions.size());
    for (auto _ : state) {
        evaluate_sh(kOrder, directions, basis);
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * 64);
}
BENCHMARK(basis_in_batches);

/// Measures rotation of RGB coefficients, from a matrix.
void rotate_rgb(State& state) {
    const glm::dmat3 rotation = glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))));
    auto light = random_light();
    for (auto _ : state) {
        ShRotation(kOrder, rotation).apply(std::span<glm::vec3>(light));
        benchmark::ClobberMemory();
    }
}
BENCHMARK(rotate_rgb);

void rotate_rgb_prepared(State& state) {
    const ShRotation rotation(kOrder, glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))));
    auto light = random_light();
    for (auto _ : state) {
        rotation.apply(std::span<glm::vec3>(light));
        benchmark::ClobberMemory();
    }
}
BENCHMARK(rotate_rgb_prepared);

/// Measures rotation of one function, from a matrix, like DirectXMath's XMSHRotate.
void rotate_one(State& state) {
    const int order = static_cast<int>(state.range(0));
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    const glm::dmat3 rotation = glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))));
    const auto in = random_values(count);
    std::vector<float> out(count);
    for (auto _ : state) {
        ShRotation(order, rotation).apply(std::span<const float>(in), std::span<float>(out));
        benchmark::ClobberMemory();
    }
}
BENCHMARK(rotate_one)->ArgName("order")->Arg(3)->Arg(6);

void product(State& state) {
    const int order = static_cast<int>(state.range(0));
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    const auto a = random_values(count), b = random_values(count);
    std::vector<float> out(count);
    for (auto _ : state) {
        sh_product(order, a, b, out);
        benchmark::ClobberMemory();
    }
}
BENCHMARK(product)->ArgName("order")->Arg(3)->Arg(6);

/// Measures the cost of a new sky: a sun over a sky.
void dering(State& state) {
    const int order = static_cast<int>(state.range(0));
    const Light light = sum(directional_light(order, glm::normalize(glm::vec3(1, 2, 3)), glm::vec3(3)),
                            constant_light(order, glm::vec3(0.1f)));
    for (auto _ : state)
        benchmark::DoNotOptimize(dering_factors(light));
}
BENCHMARK(dering)->ArgName("order")->Arg(3)->Arg(6)->Arg(10)->Unit(benchmark::kMicrosecond);

/// `run`: number of consecutive receivers of one cluster: all with --reorder, otherwise a few.
ClusteredTransfer clustered(int clusters, int components, const TransferLayout& layout, std::size_t receivers,
                            std::size_t run) {
    ClusteredTransfer t;
    t.bases.layout = layout;
    t.bases.components.assign(static_cast<std::size_t>(clusters), components);
    t.bases.rows = random_values(static_cast<std::size_t>(clusters * (1 + components)) * t.bases.dimension());
    t.bases.bits.assign(static_cast<std::size_t>(clusters * components), 7);
    t.receivers.format = WeightFormat::packed;
    t.receivers.cluster_bits = 8;
    t.receivers.words = (8 + 7 * components + 31) / 32;
    std::mt19937 random(3);
    t.receivers.weights.resize(receivers * t.receivers.stride());
    for (std::byte& b : t.receivers.weights)
        b = static_cast<std::byte>(random());
    for (std::size_t p = 0; p < receivers; ++p)
        t.receivers.weights[p * t.receivers.stride()] =
            static_cast<std::byte>(p / run * 97 % static_cast<std::size_t>(clusters));
    return t;
}

/// Layout of four channels: grey direct light, and three of indirect light. Lamps have three channels each.
void constants(State& state) {
    const auto channels = static_cast<int>(state.range(0));
    TransferLayout layout = channels == 4
                                ? TransferLayout{kOrder, {{TermKind::direct, 1}, {TermKind::indirect, 3}}}
                                : layout_of_one(kOrder, channels);
    for (int lamp = 0; lamp < state.range(1); ++lamp)
        layout.terms.push_back({TermKind::lamp, 3, std::to_string(lamp)});
    const ClusterLighting relighter(clustered(256, 8, layout, 256, 1));
    const auto light = random_light();
    std::vector<glm::vec4> out(relighter.rows());
    for (auto _ : state) {
        relighter.update(light, out);
        benchmark::ClobberMemory();
    }
}
BENCHMARK(constants)->ArgNames({"channels", "lamps"})->Args({1, 0})->Args({3, 0})->Args({4, 0})->Args({4, 3});

constexpr std::size_t kVertices = 1'000'000;

void evaluate_vertices(State& state) {
    const ClusteredTransfer transfer =
        clustered(256, 8, layout_of_one(kOrder, 1), kVertices, static_cast<std::size_t>(state.range(0)));
    const ClusterLighting relighter(transfer);
    const auto light = random_light();
    std::vector<glm::vec4> out(relighter.rows());
    relighter.update(light, out);
    std::vector<glm::vec3> radiance(kVertices);
    for (auto _ : state) {
        evaluate(transfer, out, radiance, 1);
        benchmark::ClobberMemory();
    }
    // Bytes read (cluster and weights) and written (radiance).
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(kVertices * (2 + 8 + 12)));
}
BENCHMARK(evaluate_vertices)->ArgName("run")->Arg(4000)->Arg(4);

/// Returns a map of 1 024² texels, two words each, in squares of `side` texels of one cluster.
CompressedLightmap lightmap_of(int side) {
    constexpr int kSide = 1024;
    CompressedLightmap lightmap{{{{kSide, kSide}}, {}}, {}};
    ClusteredTransfer& t = lightmap.compressed.transfer;
    t = clustered(256, 8, layout_of_one(kOrder, 1), 1, 1);
    t.receivers = {.format = WeightFormat::packed,
                   .cluster_bits = 8,
                   .words = 2,
                   .clusters = {},
                   .weights = {},
                   .predictors = {}};
    std::mt19937 random(1);
    std::vector<std::uint32_t> words;
    for (int i = 0; i < kSide * kSide; ++i) {
        const int x = i % kSide / side, y = i / kSide / side;
        const auto cluster = static_cast<std::uint32_t>((x * 131 + y * 71) % 256);
        words.push_back((static_cast<std::uint32_t>(random()) & ~255u) | cluster);
        words.push_back(static_cast<std::uint32_t>(random()));
    }
    t.receivers.weights.resize(words.size() * 4);
    std::memcpy(t.receivers.weights.data(), words.data(), t.receivers.weights.size());
    return lightmap;
}

/// Measures all levels, from given constants.
void relight_lightmap(State& state) {
    const CompressedLightmap lightmap = lightmap_of(static_cast<int>(state.range(0)));
    const TextureRelighter relighter(lightmap, static_cast<TexelFormat>(state.range(2)));
    std::vector<glm::vec4> computed(relighter.rows());
    relighter.update_constants(random_light(), {}, computed);
    std::vector<std::byte> texels(relighter.bytes(0));
    for (auto _ : state) {
        relighter.update(0, computed, texels, static_cast<int>(state.range(1)));
        benchmark::ClobberMemory();
    }
}
BENCHMARK(relight_lightmap)
    ->ArgNames({"square", "threads", "format"})
    ->ArgsProduct({{1, 8, 64}, {1, 2}, {0, 1, 2, 3}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Returns 21 025 probes of sixteen bytes: 256 clusters of twelve directions, lit by a sky of order 6, with
/// separate direct and indirect terms.
CompressedVolume volume_of() {
    CompressedVolume volume{{{.spacing = 1, .size = {7, 7, 6}, .bricks = {}}, 3, {}}, {}};
    for (int i = 0; i < 7 * 7 * 6; ++i)
        volume.grid.bricks.push_back({{i % 7, i / 7 % 7, i / 49}, 0});
    volume.visibility.resize(probes_of(volume.grid).size());
    ClusteredTransfer& t = volume.compressed.transfer;
    t.bases.layout = {kOrder, {{TermKind::direct, 1}, {TermKind::indirect, 3}}, 9};
    t.bases.components.assign(256, 12);
    t.bases.bits.assign(256u * 12, 10);
    t.bases.rows = random_values(256u * 13 * t.bases.dimension());
    t.receivers = {.format = WeightFormat::packed,
                   .components = 12,
                   .cluster_bits = 8,
                   .words = 4,
                   .clusters = {},
                   .weights = {},
                   .predictors = {}};
    std::mt19937 random(1);
    t.receivers.weights.resize(16 * volume.visibility.size());
    for (std::byte& b : t.receivers.weights)
        b = static_cast<std::byte>(random());
    for (std::size_t p = 0; p < volume.visibility.size(); ++p)
        t.receivers.weights[16 * p] = static_cast<std::byte>(p * 256 / volume.visibility.size());
    return volume;
}

/// Measures the update of constants and of all texels.
void relight_volume(State& state) {
    const CompressedVolume volume = volume_of();
    const TextureRelighter relighter(volume);
    std::vector<glm::vec4> constants(relighter.rows());
    std::vector<std::byte> texels(relighter.bytes(0));
    const auto light = random_light();
    const bool both = state.range(0) == 0;
    for (auto _ : state) {
        if (both || state.range(0) == 1)
            relighter.update_constants(light, glm::vec3(0, 1, 0), constants);
        if (both || state.range(0) == 2)
            relighter.update(0, constants, texels, static_cast<int>(state.range(1)));
        benchmark::ClobberMemory();
    }
}
BENCHMARK(relight_volume)
    ->ArgNames({"both_constants_texels", "threads"})
    ->ArgsProduct({{0, 1, 2}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Measures lookups at positions distributed over the volume, one by one.
void look_up_volume(State& state) {
    const CompressedVolume volume = volume_of();
    const VolumeLookup lookup(volume.grid, volume.visibility);
    const std::vector<glm::vec3> incident(9 * volume.visibility.size(), glm::vec3(1));
    const auto directions = random_directions(1024);
    std::array<glm::vec3, 9> light{};
    for (auto _ : state)
        for (const glm::vec3& d : directions) {
            mix_incident(lookup.find(12.0f + 12.0f * d, d), incident, light);
            benchmark::DoNotOptimize(irradiance_of(light, d));
        }
    state.SetItemsProcessed(state.iterations() * 1024);
}
BENCHMARK(look_up_volume);

/// Measures memory bandwidth: a copy larger than any cache, bytes read and written.
void plain_copy(State& state) {
    constexpr std::size_t kBytes = 512u << 20;
    std::vector<std::byte> from(kBytes), to(kBytes);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), from.size());
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(2 * from.size()));
}
BENCHMARK(plain_copy);

void project_lat_long(State& state) {
    Environment environment;
    environment.image = {2048, 1024, {}};
    for (std::size_t i = 0; i < 2048 * 1024; ++i)
        environment.image.pixels.emplace_back(static_cast<float>(i % 97), 1, static_cast<float>(i % 13));
    for (auto _ : state)
        benchmark::DoNotOptimize(project(environment, kOrder, static_cast<int>(state.range(0))));
}
BENCHMARK(project_lat_long)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Measures the projection per pixel, by layout: 0 lat-long, 1 cube, 2 cube-faces, 3 angular.
void project_pixels(State& state) {
    const auto layout = static_cast<EnvironmentLayout>(state.range(0));
    const int width = layout == EnvironmentLayout::lat_long  ? 1024
                      : layout == EnvironmentLayout::angular ? 512
                                                             : 256;
    const int height =
        layout == EnvironmentLayout::lat_long || layout == EnvironmentLayout::angular ? 512 : 1536;
    Environment environment{{width, height, {}}, layout};
    for (int i = 0; i < width * height; ++i)
        environment.image.pixels.emplace_back(static_cast<float>(i % 97), 1, static_cast<float>(i % 13));
    for (auto _ : state)
        benchmark::DoNotOptimize(project(environment, static_cast<int>(state.range(1)), 1));
    state.SetItemsProcessed(state.iterations() * width * height);
}
BENCHMARK(project_pixels)
    ->ArgNames({"layout", "order"})
    ->ArgsProduct({{0, 1, 2, 3}, {3, 6, 10}})
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace prt

BENCHMARK_MAIN();
