// The GPU baker against the CPU baker. Here OpenGL is Mesa's software rasteriser; scenes are small.

#include "prt/bake.h"
#include "prt/error_measures.h"
#include "prt/support/error.h"
#include "support/bounce_off_triangle.h"
#include "support/scene_builder.h"
#include "support/traced.h"
#include "trace/embree_tracer.h"
#include "trace/gpu/gl_rasterizer.h"
#include "trace/gpu/gl_tracer.h"
#include "trace/gpu/wide_bvh.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace prt {
namespace {

using test::SceneBuilder;

Scene balls_over_floor() {
    return SceneBuilder()
        .floor({0, 0, 0}, 2, 8)
        .sphere({0, 0.8f, 0}, 0.5f, 12)
        .sphere({0.9f, 0.4f, 0.2f}, 0.3f, 8)
        .build();
}

/// A ceiling over a floor that is blended, cut out by a texture, or a leaf.
Scene under_a_ceiling(AlphaMode mode) {
    Scene ceiling = SceneBuilder().floor({0, 0.7f, 0}, 1, 3).build();
    VertexArray& v = ceiling.vertex_arrays[0];
    v.texcoords.resize(1);
    for (const glm::vec3& p : v.positions)
        v.texcoords[0].emplace_back(1.7f * p.x + 0.3f, 0.9f * p.z - 0.4f);
    Material& m = ceiling.materials[0];
    m.base_color = {0.7f, 0.4f, 0.3f, 0.8f};
    m.base_color_texture.image = 0;
    m.base_color_texture.wrap_v = Wrap::mirror;
    m.alpha_mode = mode;
    m.double_sided = true;
    return test::join({SceneBuilder().floor({0, 0, 0}, 1, 6).build(), ceiling,
                       SceneBuilder().sphere({0.2f, 0.3f, 0}, 0.2f, 8).build()});
}

Texture dotted_texture() {
    Image8 image{32, 16, {}};
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            image.pixels.emplace_back(200, 220, 180, std::hypot(x - 16, y - 8) < 6 ? 30 : 255);
    return make_texture(image);
}

/// Both tracers on one scene.
class Pair {
public:
    explicit Pair(Scene scene, std::vector<Texture> textures = {})
        : scene_(std::move(scene)), trace_(scene_, std::move(textures)), receivers_(vertex_receivers(scene_)),
          cpu_(trace_) {}

    std::unique_ptr<GlTracer> gpu(std::size_t hit_bytes = 96 << 20) {
        return std::make_unique<GlTracer>(GlContext::create(GlDevice::any), trace_, hit_bytes);
    }
    std::unique_ptr<GlRasterizer> rasterizer(int resolution) {
        return std::make_unique<GlRasterizer>(GlContext::create(GlDevice::any), trace_, resolution);
    }
    Transfer trace(Tracer& tracer, const TraceOptions& options, const ReceiverSink& sink = {}) {
        return test::traced(tracer, receivers_, options, sink);
    }
    Transfer on_cpu(const TraceOptions& options) { return trace(cpu_, options); }
    double distance(const Transfer& a, const Transfer& b) const {
        return relative_l2(a, b, receivers_.areas);
    }
    EmbreeTracer& cpu() { return cpu_; }
    const Receivers& receivers() const { return receivers_; }

private:
    Scene scene_;
    TraceScene trace_;
    Receivers receivers_;
    EmbreeTracer cpu_;
};

/// So many small triangles, in the plane z = 0 where `depth` is 0.
struct ScatteredTriangles {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> corners;

    ScatteredTriangles(std::size_t count, float depth) {
        std::mt19937 random(5);
        std::normal_distribution<float> normal(0, 100);
        for (unsigned t = 0; t < count; ++t) {
            const glm::vec3 a(normal(random), normal(random), 1e-3f * normal(random));
            for (int i = 0; i < 3; ++i)
                positions.push_back((a + glm::vec3(normal(random), normal(random), normal(random)) * 0.01f) *
                                    glm::vec3(1, 1, depth));
            corners.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
        }
    }
};

TEST(WideBvh, HoldsEveryTriangleOnceInsideItsBoxes) {
    for (const auto& [count, depth] : {std::pair(1u, 1.0f),
                                       {2u, 1.0f},
                                       {9u, 1.0f},
                                       {500u, 1.0f},
                                       {3000u, 1.0f},
                                       {1u, 0.0f},
                                       {500u, 0.0f}}) {
        const ScatteredTriangles mesh(count, depth);
        const WideBvh bvh = build_wide_bvh(mesh.positions, mesh.corners, 2);
        std::set<std::uint32_t> seen(bvh.triangles.begin(), bvh.triangles.end());
        EXPECT_EQ(bvh.triangles.size(), count);
        EXPECT_EQ(seen.size(), count);
        std::size_t in_leaves = 0;
        for (const gpu::WideNode& node : bvh.nodes)
            for (unsigned slot = 0; slot < 8; ++slot) {
                const unsigned meta = gpu::byte_of(node.meta, slot);
                if (meta == 0 || PRT_IS_INNER(meta))
                    continue;
                for (unsigned i = 0; i < PRT_LEAF_COUNT(meta); ++i) {
                    ++in_leaves;
                    const std::uint32_t t = bvh.triangles[node.first_triangle + PRT_LEAF_FIRST(meta) + i];
                    for (int corner = 0; corner < 3; ++corner)
                        for (unsigned axis = 0; axis < 3; ++axis) {
                            const float step = std::bit_cast<float>(gpu::step_bits(node.exponents, axis)),
                                        origin = node.origin[static_cast<int>(axis)];
                            const auto low = static_cast<float>(gpu::byte_of(node.low[axis], slot)),
                                       high = static_cast<float>(gpu::byte_of(node.high[axis], slot));
                            const float value =
                                mesh.positions[mesh.corners[t][corner]][static_cast<int>(axis)];
                            EXPECT_TRUE(std::isnormal(step)); // GPUs take smaller numbers for 0
                            EXPECT_LE(origin + low * step, value);
                            EXPECT_GE(origin + high * step, value);
                        }
                }
            }
        EXPECT_EQ(in_leaves, count);
    }
}

/// A number of a buffer's variable, as the driver lays it out; -1 where there is none.
int layout_of(const GlObject& program, const char* variable, GLenum property) {
    const GLuint index = glGetProgramResourceIndex(program.name(), GL_BUFFER_VARIABLE, variable);
    GLint value = -1;
    if (index != GL_INVALID_INDEX)
        glGetProgramResourceiv(program.name(), GL_BUFFER_VARIABLE, index, 1, &property, 1, nullptr, &value);
    return value;
}

TEST(GpuStructs, LieInMemoryAsTheDriverReadsThem) {
    const auto context = GlContext::create(GlDevice::any);
    const GlObject
        trace = make_compute_program(
            "bake_trace.comp",
            "#define PRT_STACK_SIZE 9\n#define PRT_ORDER 2\n#define PRT_ALPHA\n#define PRT_HITS\n"),
        raster = make_compute_program("bake_raster.comp", "#define PRT_ORDER 2\n"),
        lamps = make_compute_program("bake_lamps.comp", "#define PRT_STACK_SIZE 9\n#define PRT_ALPHA\n");
    const auto expect = [](const GlObject& program, const char* last, std::size_t offset, std::size_t size) {
        EXPECT_EQ(layout_of(program, last, GL_OFFSET), static_cast<int>(offset)) << last;
        EXPECT_EQ(layout_of(program, last, GL_TOP_LEVEL_ARRAY_STRIDE), static_cast<int>(size)) << last;
    };
    expect(trace, "receivers[0].normal", offsetof(gpu::Receiver, normal), sizeof(gpu::Receiver));
    expect(trace, "hits[0].footprint", offsetof(gpu::HitRecord, footprint), sizeof(gpu::HitRecord));
    expect(trace, "alpha_triangles[0].next", offsetof(gpu::AlphaTriangle, next), sizeof(gpu::AlphaTriangle));
    expect(trace, "alpha_materials[0].wrap", offsetof(gpu::AlphaMaterial, wrap), sizeof(gpu::AlphaMaterial));
    expect(trace, "nodes[0].high[0]", offsetof(gpu::WideNode, high), sizeof(gpu::WideNode));
    expect(lamps, "receivers[0].position", offsetof(gpu::LampReceiver, position), sizeof(gpu::LampReceiver));
    expect(lamps, "lights[0].outer_cosine", offsetof(gpu::PunctualLight, outer_cosine),
           sizeof(gpu::PunctualLight));
    expect(lamps, "shining[0].image", offsetof(gpu::ShiningTriangle, image), sizeof(gpu::ShiningTriangle));
    expect(lamps, "emission_images[0].linear", offsetof(gpu::EmissionImage, linear),
           sizeof(gpu::EmissionImage));
    expect(raster, "directions[0].basis[0]", offsetof(gpu::Direction, basis), sizeof(gpu::Direction));
}

TEST(GpuTrace, IsTheCpusToWhatGrazes) {
    Pair pair(balls_over_floor());
    const auto gpu = pair.gpu();
    for (const auto& [order, rays] : {std::pair{1, 64}, {3, 100}, {6, 256}, {10, 64}, {4, 1500}}) {
        const TraceOptions options{order, rays, 7, 0};
        // 3e-3 is what 0.2 % of grazing rays could make.
        EXPECT_LT(pair.distance(pair.on_cpu(options), pair.trace(*gpu, options)), 3e-3)
            << order << " " << rays;
    }
}

TEST(GpuTrace, MeetsWhatTheCpuMeets) {
    Pair pair(balls_over_floor());
    const auto gpu = pair.gpu();
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
        pair.trace(*gpu, options, into(gpu_hits));
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
        EXPECT_LT(different, 0.004 * all) << stride; // a ray that goes astray counts twice
    }
}

TEST(GpuTrace, PassesSurfacesThatCastNoShadow) {
    Scene shell = SceneBuilder().sphere({0, 0, 0}, 5, 8).build();
    shell.materials[0].casts_shadow = false;
    Pair alone(balls_over_floor()), inside(test::join({balls_over_floor(), shell}));
    const TraceOptions options{3, 128, 1, 0};
    Transfer traced = inside.trace(*inside.gpu(), options);
    const Transfer expected = alone.on_cpu(options);
    traced.vectors.resize(expected.vectors.size());
    EXPECT_LT(relative_l2(expected, traced, alone.receivers().areas), 3e-3);
    Transfer drawn = inside.trace(*inside.rasterizer(256), options);
    drawn.vectors.resize(expected.vectors.size());
    EXPECT_LT(relative_l2(expected, drawn, alone.receivers().areas), 0.2); // 128 directions over the sphere
}

TEST(GpuTrace, SizesBatchesByHitsAndTracesNothingTwice) {
    // A hundredth of the room that all hits at once would take.
    constexpr std::size_t kHitBytes = 64 << 10;
    const auto weight = [](Pair& pair, Tracer& tracer, int stride, int rays = 200) {
        TraceOptions options{2, rays, 1, 0};
        options.hit_stride = stride;
        std::vector<double> sums(pair.receivers().size(), 0);
        pair.trace(tracer, options, [&](std::uint32_t p, std::span<const Hit> hits) {
            for (const Hit& hit : hits)
                sums[p] += static_cast<double>(hit.weight);
        });
        return std::accumulate(sums.begin(), sums.end(), 0.0);
    };
    Pair opaque(balls_over_floor());
    const auto gpu = opaque.gpu(kHitBytes);
    const double expected = weight(opaque, opaque.cpu(), 4);
    EXPECT_NEAR(weight(opaque, *gpu, 4), expected, 0.002 * expected);
    EXPECT_EQ(gpu->traced_again(), 0u);
    // Nor inside of a ball, where every ray hits.
    Pair closed(SceneBuilder().bowl({0, 0, 0}, 1, 8, 0).build());
    const auto inside = closed.gpu();
    for (const int stride : {1, 3}) {
        const double all = weight(closed, closed.cpu(), stride, 512);
        EXPECT_NEAR(weight(closed, *inside, stride, 512), all, 0.002 * all);
        EXPECT_EQ(inside->traced_again(), 0u) << stride;
    }
    // Blended surfaces are learnt of once.
    Pair blended(under_a_ceiling(AlphaMode::blend), {dotted_texture()});
    const auto other = blended.gpu(kHitBytes);
    weight(blended, *other, 1);
    const std::size_t learnt = other->traced_again();
    EXPECT_LE(learnt, 2u);
    weight(blended, *other, 1);
    EXPECT_EQ(other->traced_again(), learnt);
}

TEST(GpuTrace, PassesCutOutsAndBlendedSurfacesAsTheCpuDoes) {
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
        Pair pair(under_a_ceiling(mode), {dotted_texture()});
        const auto gpu = pair.gpu();
        const TraceOptions options{4, 256, 1, 0};
        const Transfer cpu = pair.on_cpu(options);
        EXPECT_LT(pair.distance(cpu, pair.trace(*gpu, options)), 3e-3);
        // And the ceiling does let light through.
        Pair opaque(under_a_ceiling(AlphaMode::opaque), {dotted_texture()});
        EXPECT_GT(pair.distance(cpu, opaque.on_cpu(options)), 0.02);
    }
}

/// The ceiling of glass with a texture, cut out, blended or neither.
Scene under_glass(AlphaMode mode) {
    Scene scene = under_a_ceiling(mode);
    Material& m = scene.materials[1];
    m.base_color = {0.9f, 0.8f, 1, 0.8f};
    m.glass = {0.7f, {.image = 1, .texcoord = 0, .transform = {2, 0, 0, 3, 0.1f, 0}}};
    return scene;
}

std::vector<Texture> glass_textures() {
    Image8 image{8, 8, {}};
    for (int i = 0; i < 64; ++i)
        image.pixels.emplace_back(4 * i, 0, 0, 255);
    return {dotted_texture(), make_texture(image, TextureEncoding::linear)};
}

TEST(GpuTrace, PassesGlassAsTheCpuDoes) {
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
        Pair pair(under_glass(mode), glass_textures());
        const TraceOptions options{4, 256, 1, 0};
        const Transfer cpu = pair.on_cpu(options);
        EXPECT_LT(pair.distance(cpu, pair.trace(*pair.gpu(), options)), 3e-3);
        Pair clay(under_a_ceiling(mode), glass_textures());
        EXPECT_GT(pair.distance(cpu, clay.on_cpu(options)), 0.02);
    }
}

BakeResult bake_on(Backend backend, const Scene& scene, BakeOptions options) {
    options.tracer.backend = backend;
    return bake(scene, options);
}

TEST(GpuBake, OfEveryTransportIsTheCpus) {
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
        return relative_l2(cpu.baked.transfer, gpu.baked.transfer, areas);
    };
    EXPECT_LT(difference(options), 3e-3);
    options.fit = FitMode::surface;
    EXPECT_LT(difference(options), 3e-3);
    options.fit = FitMode::vertex;
    options.subsurface.media = {{"", {glm::dvec3(20, 30, 40), glm::dvec3(0.5), 1.3}}};
    EXPECT_LT(difference(options), 3e-3);
    options.subsurface.media.clear();
    options.bounces = 0;
    options.target_error = 0.05;
    EXPECT_LT(difference(options), 3e-3);
}

TEST(GpuBake, OfATriangleThatVariesSendsWhatIsThere) {
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
    EXPECT_LT(relative_l2(cpu.baked.transfer, gpu.baked.transfer, receiver_areas(scene)), 3e-3);
}

TEST(GpuRaster, ConvergesToTraceWithResolutionAndDirections) {
    Pair pair(balls_over_floor());
    const Transfer reference = pair.on_cpu({4, 1 << 15, 99, 0});
    const auto error = [&](int resolution, int directions) {
        return pair.distance(reference, pair.trace(*pair.rasterizer(resolution), {4, directions, 1, 0}));
    };
    const double few = error(256, 64), many = error(256, 1024);
    EXPECT_LT(many, 0.5 * few);
    EXPECT_LT(many, 0.03);
    EXPECT_LT(error(1024, 1024), error(64, 1024));
}

/// A room of quads that share no vertices: floor and walls meet, and the ceiling has a hole.
Scene room_with_a_hole() {
    SceneBuilder builder;
    builder.floor({0, 0, 0}, 1, 6);
    const glm::vec3 corners[] = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    for (int side = 0; side < 4; ++side) {
        const glm::vec3 a = corners[side], along = (corners[(side + 1) % 4] - a) / 6.0f;
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 4; ++j) {
                const auto at = [&](int u, int v) {
                    return a + along * static_cast<float>(u) + glm::vec3(0, 0.5f * static_cast<float>(v), 0);
                };
                builder.quad(at(i, j + 1), at(i + 1, j + 1), at(i + 1, j), at(i, j));
            }
    }
    const auto roof = [&](float x0, float z0, float x1, float z1) {
        builder.quad({x0, 2, z0}, {x1, 2, z0}, {x1, 2, z1}, {x0, 2, z1});
    };
    roof(-1, -1, 1, -0.4f);
    roof(-1, 0.4f, 1, 1);
    roof(-1, -0.4f, -0.4f, 0.4f);
    roof(0.4f, -0.4f, 1, 0.4f);
    return builder.build();
}

TEST(GpuRaster, LeaksNothingWhereWallsMeetTheFloor) {
    Pair pair(room_with_a_hole());
    const Transfer reference = pair.on_cpu({3, 4096, 99, 0});
    const double raster = pair.distance(reference, pair.trace(*pair.rasterizer(512), {3, 512, 1, 0}));
    EXPECT_LT(raster, 0.25);      // 512 directions over the sphere find the hole some twenty times
    double inside = 0, truth = 0; // mean visibility of the floor's edge
    const Transfer maps = pair.trace(*pair.rasterizer(256), {1, 512, 1, 0});
    for (std::size_t p = 0; p < 6 * 6 * 6; ++p) {
        const glm::vec3& at = pair.receivers().positions[p];
        if (std::max(std::abs(at.x), std::abs(at.z)) > 0.99f) {
            inside += static_cast<double>(maps.vector(p)[0]);
            truth += static_cast<double>(reference.vector(p)[0]);
        }
    }
    EXPECT_NEAR(inside, truth, 0.15 * truth);
}

TEST(GpuRaster, PeelsGlassThatIsCutOut) {
    Pair pair(under_glass(AlphaMode::mask), glass_textures());
    const Transfer reference = pair.on_cpu({2, 1024, 99, 0});
    const double error = pair.distance(reference, pair.trace(*pair.rasterizer(128), {2, 128, 1, 0}));
    Pair clay(under_a_ceiling(AlphaMode::mask), glass_textures());
    EXPECT_LT(error, 0.5 * pair.distance(reference, clay.on_cpu({2, 1024, 99, 0})));
}

TEST(GpuRaster, PeelsBlendedSurfacesAndDropsCutOuts) {
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
        Pair pair(under_a_ceiling(mode), {dotted_texture()});
        const Transfer reference = pair.on_cpu({3, 4096, 99, 0});
        const Transfer raster = pair.trace(*pair.rasterizer(512), {3, 256, 1, 0});
        Pair opaque(under_a_ceiling(AlphaMode::opaque), {dotted_texture()});
        const double error = pair.distance(reference, raster);
        EXPECT_LT(error, 0.06);
        EXPECT_LT(error, 0.5 * pair.distance(reference, opaque.on_cpu({3, 4096, 99, 0})));
    }
}

TEST(GpuRaster, LeavesOpenReceiversTheirLobe) {
    Pair pair(SceneBuilder().floor({0, 0, 0}, 1, 4).build());
    const Transfer raster = pair.trace(*pair.rasterizer(64), {6, 64, 1, 0}), cpu = pair.on_cpu({6, 64, 1, 0});
    EXPECT_LT(pair.distance(cpu, raster), 1e-6);
}

TEST(GpuBake, StopsWhenAsked) {
    for (const BakeMethod method : {BakeMethod::trace, BakeMethod::raster}) {
        std::stop_source stop;
        BakeOptions options;
        options.tracer.backend = Backend::gpu;
        options.tracer.method = method;
        options.rays = 1 << 20;
        const Progress progress{[&](double fraction) {
                                    if (fraction > 0)
                                        stop.request_stop();
                                },
                                stop.get_token()};
        EXPECT_THROW(bake(balls_over_floor(), options, progress), Cancelled);
    }
}

TEST(GpuBake, OfRasterRefusesWhatDepthMapsCannotTell) {
    BakeOptions options;
    options.tracer.method = BakeMethod::raster;
    options.tracer.backend = Backend::gpu;
    options.bounces = 1;
    EXPECT_THROW(bake(balls_over_floor(), options), Error);
    options.bounces = 0;
    options.tracer.backend = Backend::cpu;
    EXPECT_THROW(bake(balls_over_floor(), options), Error);
}

} // namespace
} // namespace prt
