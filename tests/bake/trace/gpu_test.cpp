// The GPU baker against the CPU baker, on a software device; scenes are small.

#include "bake/trace/embree_tracer.h"
#include "bake/trace_gpu/vulkan_tracer.h"
#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/sh_basis.h"
#include "support/bounce_off_triangle.h"
#include "support/gpu_scenes.h"
#include "support/scene_builder.h"
#include "support/traced.h"
#include "support/vulkan_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <mutex>
#include <numeric>

namespace prt {
namespace {

using namespace test;

/// Relative L2 error by one or two grazing rays in so small scenes.
constexpr double kGrazing = 3e-4;

/// Both tracers on one scene. The GPU must be used without validation errors.
class Pair {
public:
    explicit Pair(Scene scene, std::vector<Texture> textures = {}, std::size_t piece_bytes = 64 << 20)
        : scene_(std::move(scene)), trace_(scene_, std::move(textures)), receivers_(vertex_receivers(scene_)),
          cpu_(trace_), gpu_(trace_, vulkan_choice(), piece_bytes) {}
    ~Pair() { expect_valid(gpu_.vulkan()); }

    Transfer trace(Tracer& tracer, const TraceOptions& options, const ReceiverSink& sink = {}) {
        return test::traced(tracer, receivers_, options, sink);
    }
    Transfer on_cpu(const TraceOptions& options) { return trace(cpu_, options); }
    Transfer on_gpu(const TraceOptions& options) { return trace(gpu_, options); }
    double distance(const Transfer& a, const Transfer& b) const {
        return relative_l2(a, b, receivers_.areas);
    }
    double difference(const TraceOptions& options) { return distance(on_cpu(options), on_gpu(options)); }
    EmbreeTracer& cpu() { return cpu_; }
    VulkanTracer& gpu() { return gpu_; }
    const Receivers& receivers() const { return receivers_; }

private:
    Scene scene_;
    TraceScene trace_;
    Receivers receivers_;
    EmbreeTracer cpu_;
    VulkanTracer gpu_;
};

TEST(GpuTrace, MatchesCpuExceptGrazingRays) {
    Pair pair(balls_over_floor());
    for (const auto& [order, rays] : {std::pair{1, 64}, {3, 100}, {6, 256}, {10, 64}, {4, 1500}, {3, 1}}) {
        const TraceOptions options{order, rays, 7, 0};
        EXPECT_LT(pair.difference(options), kGrazing) << order << " " << rays;
    }
}

TEST(GpuTrace, HitsTheTrianglesOfTheCpu) {
    Pair pair(balls_over_floor());
    TraceOptions options{2, 96, 3, 0};
    for (const int stride : {1, 3}) {
        options.hit_stride = stride;
        using Key = std::pair<std::uint32_t, bool>;
        std::vector<std::map<Key, float>> cpu_hits(pair.receivers().size()),
            gpu_hits(pair.receivers().size());
        const auto into = [](std::vector<std::map<Key, float>>& all) {
            return [&all](std::uint32_t p, std::span<const Hit> hits) {
                for (const Hit& hit : hits) {
                    EXPECT_GE(hit.u, -1e-5f);
                    EXPECT_LE(hit.u + hit.v, 1 + 1e-5f);
                    all[p][{hit.triangle, hit.back}] += hit.weight;
                }
            };
        };
        pair.trace(pair.cpu(), options, into(cpu_hits));
        pair.trace(pair.gpu(), options, into(gpu_hits));
        double different = 0, all = 0;
        for (std::size_t p = 0; p < cpu_hits.size(); ++p) {
            for (const auto& [key, weight] : cpu_hits[p]) {
                all += static_cast<double>(weight);
                const auto found = gpu_hits[p].find(key);
                different +=
                    std::abs(static_cast<double>(weight - (found == gpu_hits[p].end() ? 0 : found->second)));
            }
        }
        EXPECT_GT(all, 1000);
        EXPECT_LT(different, 0.004 * all) << stride; // a ray with another hit counts twice
    }
}

TEST(GpuTrace, PassesSurfacesWithoutShadow) {
    Scene shell = SceneBuilder().sphere({0, 0, 0}, 5, 8).build();
    shell.materials[0].casts_shadow = false;
    Pair alone(balls_over_floor()), inside(test::join({balls_over_floor(), shell}));
    const TraceOptions options{3, 128, 1, 0};
    Transfer traced = inside.on_gpu(options);
    const Transfer expected = alone.on_cpu(options);
    traced.vectors.resize(expected.vectors.size());
    EXPECT_LT(relative_l2(expected, traced, alone.receivers().areas), kGrazing);
}

/// Sum of the weights of all hits.
double weight_of_hits(Pair& pair, Tracer& tracer, const TraceOptions& options) {
    std::vector<double> sums(pair.receivers().size(), 0);
    pair.trace(tracer, options, [&](std::uint32_t p, std::span<const Hit> hits) {
        for (const Hit& hit : hits)
            sums[p] += static_cast<double>(hit.weight);
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

TEST(GpuTrace, DoesNotDependOnBatchSize) {
    // A row or a few at a time; chunks of a receiver go to several pieces.
    for (const std::size_t bytes : {1u << 10, 40u << 10}) {
        Pair small(balls_over_floor(), {}, bytes);
        for (const int rays : {200, 3000}) {
            const TraceOptions options{.order = 2, .rays = rays, .seed = 1, .hit_stride = 4};
            EXPECT_LT(small.difference(options), kGrazing) << bytes << " " << rays;
            const double expected = weight_of_hits(small, small.cpu(), options);
            EXPECT_NEAR(weight_of_hits(small, small.gpu(), options), expected, 1e-3 * expected);
        }
    }
    // Inside of a ball every ray hits.
    Pair closed(SceneBuilder().bowl({0, 0, 0}, 1, 8, 0).build());
    for (const int stride : {1, 3}) {
        const TraceOptions options{.order = 2, .rays = 512, .seed = 1, .hit_stride = stride};
        const double all = weight_of_hits(closed, closed.cpu(), options);
        EXPECT_NEAR(weight_of_hits(closed, closed.gpu(), options), all, 1e-3 * all);
    }
}

TEST(GpuTrace, ContinuesAfterHitBufferOverflow) {
    for (const std::size_t bytes : {2u << 10, 64u << 10, 64u << 20}) {
        Pair blended(under_a_ceiling(AlphaMode::blend), {dotted_texture()}, bytes);
        const TraceOptions options{.order = 3, .rays = 200, .seed = 1};
        const double expected = weight_of_hits(blended, blended.cpu(), options);
        Transfer with_hits =
            blended.trace(blended.gpu(), options, [](std::uint32_t, std::span<const Hit>) {});
        EXPECT_LT(blended.distance(blended.on_cpu(options), with_hits), kGrazing) << bytes;
        EXPECT_NEAR(weight_of_hits(blended, blended.gpu(), options), expected, 1e-3 * expected) << bytes;
    }
}

TEST(GpuTrace, PassesCutOutsAndBlendedSurfacesLikeTheCpu) {
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
        Pair pair(under_a_ceiling(mode), {dotted_texture()});
        const TraceOptions options{4, 256, 1, 0};
        const Transfer cpu = pair.on_cpu(options);
        EXPECT_LT(pair.distance(cpu, pair.on_gpu(options)), kGrazing);
        // And the ceiling does let light through.
        Pair opaque(under_a_ceiling(AlphaMode::opaque), {dotted_texture()});
        EXPECT_GT(pair.distance(cpu, opaque.on_cpu(options)), 0.02);
    }
}

TEST(GpuTrace, PassesGlassLikeTheCpu) {
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
        Pair pair(under_glass(mode), glass_textures());
        const TraceOptions options{4, 256, 1, 0};
        const Transfer cpu = pair.on_cpu(options);
        EXPECT_LT(pair.distance(cpu, pair.on_gpu(options)), kGrazing);
        Pair clay(under_a_ceiling(mode), glass_textures());
        EXPECT_GT(pair.distance(cpu, clay.on_cpu(options)), 0.02);
    }
    Pair both(with_opposites(under_glass(AlphaMode::opaque)), glass_textures());
    EXPECT_LT(both.difference({2, 64, 1, 0}), kGrazing);
}

TEST(GpuTrace, StoresCopiesOfAMeshOnce) {
    const TraceOptions options{.order = 4, .rays = 256, .seed = 1};
    constexpr int kCopies = 12;
    Pair alone(copies_over_floor(kCopies, true), {dotted_texture()}),
        shared(copies_over_floor(kCopies, false), {dotted_texture()});
    EXPECT_LT(shared.difference(options), kGrazing);
    EXPECT_EQ(alone.on_gpu(options).vectors.size(), shared.on_gpu(options).vectors.size());
    const double hits = weight_of_hits(shared, shared.cpu(), options);
    EXPECT_NEAR(weight_of_hits(shared, shared.gpu(), options), hits, 1e-3 * hits);
    if (vulkan_choice().traversal == Traversal::device) {
        EXPECT_EQ(alone.gpu().copies(), 0u);
        EXPECT_EQ(shared.gpu().copies(), 2u * kCopies - 1); // the squeezed ball is a different mesh
        EXPECT_LT(shared.gpu().scene_bytes(), alone.gpu().scene_bytes());
    }
}

TEST(GpuTrace, MeetsTheSameTrianglesOfCopies) {
    Pair pair(copies_over_floor(6, false), {dotted_texture()});
    const TraceOptions options{.order = 1, .rays = 128, .seed = 2};
    const auto sums = [&](Tracer& tracer) {
        std::map<std::pair<std::uint32_t, bool>, double> weights;
        std::mutex lock;
        pair.trace(tracer, options, [&](std::uint32_t, std::span<const Hit> hits) {
            const std::lock_guard held(lock);
            for (const Hit& hit : hits)
                weights[{hit.triangle, hit.back}] += static_cast<double>(hit.weight * (1 + hit.footprint));
        });
        return weights;
    };
    const auto cpu = sums(pair.cpu()), gpu = sums(pair.gpu());
    double different = 0, all = 0;
    for (const auto& [key, weight] : cpu) {
        all += weight;
        different += std::abs(weight - (gpu.contains(key) ? gpu.at(key) : 0));
    }
    EXPECT_LT(different, 1e-3 * all);
}

TEST(GpuTrace, HandlesDegenerateTrianglesLikeTheCpu) {
    constexpr std::size_t kFloor = 36; // vertices, which precede those of the triangles
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        Pair pair(degenerate_triangles(seed));
        const TraceOptions options{.order = 1, .rays = 1024, .seed = seed};
        const Transfer cpu = pair.on_cpu(options), gpu = pair.on_gpu(options);
        double different = 0; // rays, about
        for (std::size_t p = 0; p < kFloor; ++p)
            different += 1024 * std::abs(static_cast<double>(cpu.vectors[p] - gpu.vectors[p])) / kY00;
        // Decided by rounding: edges, and triangles a kilometre long.
        EXPECT_LT(different, 1e-3 * kFloor * 1024) << seed;
        for (const float v : gpu.vectors)
            EXPECT_TRUE(std::isfinite(v));
    }
}

BakeResult bake_on(Backend backend, const Scene& scene, BakeOptions options) {
    options.tracer.backend = backend;
    options.tracer.traversal = vulkan_choice().traversal;
    return bake(scene, options, {}, MeasureErrors::yes);
}

TEST(GpuBake, MatchesCpuForEveryTransport) {
    Scene leaf = under_a_ceiling(AlphaMode::opaque);
    for (Material& m : leaf.materials)
        m.base_color_texture.image = -1;
    leaf.materials[1].transmission.factor = 0.5f;
    leaf.materials[1].transmission.color = {0.2f, 0.9f, 0.1f};
    BakeOptions options;
    options.order = 4;
    options.rays = 128;
    options.bounces = 3;
    const std::vector<float> areas = receiver_areas(leaf);
    const auto difference = [&](const BakeOptions& o) {
        const BakeResult cpu = bake_on(Backend::cpu, leaf, o), gpu = bake_on(Backend::gpu, leaf, o);
        EXPECT_EQ(gpu.baked.record.backend, Backend::gpu);
        EXPECT_EQ(cpu.baked.transfer.layout.channels(), 3);
        EXPECT_NEAR(gpu.errors->sky.relative_l2, cpu.errors->sky.relative_l2, 2e-3);
        return relative_l2(cpu.baked.transfer, gpu.baked.transfer, areas);
    };
    EXPECT_LT(difference(options), kGrazing);
    options.fit = FitMode::surface;
    EXPECT_LT(difference(options), kGrazing);
    options.fit = FitMode::vertex;
    options.subsurface.media = {{"", {glm::dvec3(20, 30, 40), glm::dvec3(0.5), 1.3}}};
    EXPECT_LT(difference(options), kGrazing);
    options.subsurface.media.clear();
    options.bounces = 0;
    options.target_error = 0.05;
    EXPECT_LT(difference(options), kGrazing);
}

/// Walls that are there twice show their fronts on both sides.
TEST(GpuTrace, MeetsTheFrontsOfOppositeTriangles) {
    Pair pair(SceneBuilder()
                  .floor({0, 0, 0}, 1, 3)
                  .quad({-1, 0.5f, -1}, {1, 0.5f, -1}, {1, 0.5f, 1}, {-1, 0.5f, 1})
                  .quad({-1, 0.5f, -1}, {-1, 0.5f, 1}, {1, 0.5f, 1}, {1, 0.5f, -1})
                  .build());
    std::size_t from_below = 0;
    pair.trace(pair.gpu(), {2, 96, 3, 0}, [&](std::uint32_t p, std::span<const Hit> hits) {
        for (const Hit& hit : hits) {
            EXPECT_FALSE(hit.back);
            if (pair.receivers().positions[p].y > 0) {
                EXPECT_LT(hit.triangle, 18u); // the floor
            } else {
                // the triangles that face down
                EXPECT_TRUE(hit.triangle == 18 || hit.triangle == 19) << hit.triangle;
                ++from_below;
            }
        }
    });
    EXPECT_GT(from_below, 100u);
}

TEST(GpuBake, SamplesVaryingTriangles) {
    using test::Varying;
    for (const Varying varying : {Varying::light, Varying::texture, Varying::vertex_colors_of_the_back}) {
        const test::BounceError error = test::bounce_off_triangle(varying, Backend::gpu);
        EXPECT_LT(error.baked, 0.01) << varying; // 4 096 rays, codes of 8 bits
        EXPECT_GT(error.swapped, 0.05) << varying;
    }
}

TEST(GpuBake, MeetsEveryOneOfManyBlendedSheets) {
    std::vector<Scene> sheets = {SceneBuilder().floor({0, 0, 0}, 1, 3).build()};
    for (int i = 1; i <= 12; ++i) {
        Scene sheet = SceneBuilder().floor({0, 0.05f * static_cast<float>(i), 0}, 2).build();
        sheet.materials[0].alpha_mode = AlphaMode::blend;
        sheet.materials[0].base_color.a = 0.05f;
        sheet.materials[0].double_sided = true;
        sheets.push_back(sheet);
    }
    const Scene scene = test::join(sheets);
    BakeOptions options;
    options.order = 2;
    options.rays = 128;
    options.bounces = 1;
    const BakeResult cpu = bake_on(Backend::cpu, scene, options), gpu = bake_on(Backend::gpu, scene, options);
    EXPECT_GT(gpu.statistics.gather.entries, 1000u);
    EXPECT_LT(relative_l2(cpu.baked.transfer, gpu.baked.transfer, receiver_areas(scene)), kGrazing);
}

TEST(GpuBake, StopsWhenAsked) {
    std::stop_source stop;
    BakeOptions options;
    options.tracer.backend = Backend::gpu;
    options.rays = 1 << 20;
    const Progress progress{[&](double fraction) {
                                if (fraction > 0)
                                    stop.request_stop();
                            },
                            stop.get_token()};
    EXPECT_THROW(bake(balls_over_floor(), options, progress), Cancelled);
}

} // namespace
} // namespace prt
