// Depth maps on the GPU against rays of the CPU. Here OpenGL is Mesa's software rasteriser; scenes are small.

#include "bake/raster/gl_rasterizer.h"
#include "bake/trace/embree_tracer.h"
#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "support/gpu_scenes.h"
#include "support/scene_builder.h"
#include "support/traced.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

using namespace test;

/// Rays and depth maps on one scene.
class Drawn {
public:
    explicit Drawn(Scene scene, std::vector<Texture> textures = {})
        : scene_(std::move(scene)), trace_(scene_, std::move(textures)), receivers_(vertex_receivers(scene_)),
          cpu_(trace_) {}

    Transfer by_rays(const TraceOptions& options) { return traced(cpu_, receivers_, options); }
    Transfer by_maps(int resolution, const TraceOptions& options) {
        GlRasterizer rasterizer(GlContext::create(GlDevice::any), trace_, resolution,
                                [this] { return std::make_unique<EmbreeTracer>(trace_); });
        return traced(rasterizer, receivers_, options);
    }
    double distance(const Transfer& a, const Transfer& b) const {
        return relative_l2(a, b, receivers_.areas);
    }
    const Receivers& receivers() const { return receivers_; }

private:
    Scene scene_;
    TraceScene trace_;
    Receivers receivers_;
    EmbreeTracer cpu_;
};

/// Returns a layout property of a buffer variable from the driver; -1 if there is no such variable.
int layout_of(const GlObject& program, const char* variable, GLenum property) {
    const GLuint index = glGetProgramResourceIndex(program.name(), GL_BUFFER_VARIABLE, variable);
    GLint value = -1;
    if (index != GL_INVALID_INDEX)
        glGetProgramResourceiv(program.name(), GL_BUFFER_VARIABLE, index, 1, &property, 1, nullptr, &value);
    return value;
}

TEST(GpuRaster, ReadsStructsInMemoryLayout) {
    const auto context = GlContext::create(GlDevice::any);
    const GlObject raster = make_compute_program("bake_raster.comp", "#define PRT_ORDER 2\n");
    const auto expect = [&](const char* last, std::size_t offset, std::size_t size) {
        EXPECT_EQ(layout_of(raster, last, GL_OFFSET), static_cast<int>(offset)) << last;
        EXPECT_EQ(layout_of(raster, last, GL_TOP_LEVEL_ARRAY_STRIDE), static_cast<int>(size)) << last;
    };
    expect("receivers[0].normal", offsetof(gpu::Receiver, normal), sizeof(gpu::Receiver));
    expect("directions[0].basis[0]", offsetof(gpu::Direction, basis), sizeof(gpu::Direction));
}

TEST(GpuRaster, ConvergesToTraceWithResolutionAndDirections) {
    Drawn pair(balls_over_floor());
    const Transfer reference = pair.by_rays({4, 1 << 15, 99, 0});
    const auto error = [&](int resolution, int directions) {
        return pair.distance(reference, pair.by_maps(resolution, {4, directions, 1, 0}));
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

TEST(GpuRaster, DoesNotLeakAtTheFootOfWalls) {
    Drawn pair(room_with_a_hole());
    const Transfer reference = pair.by_rays({3, 4096, 99, 0});
    const double raster = pair.distance(reference, pair.by_maps(512, {3, 512, 1, 0}));
    EXPECT_LT(raster, 0.25);      // 512 directions over the sphere find the hole some twenty times
    double inside = 0, truth = 0; // mean visibility of the floor's edge
    const Transfer maps = pair.by_maps(256, {1, 512, 1, 0});
    for (std::size_t p = 0; p < 6 * 6 * 6; ++p) {
        const glm::vec3& at = pair.receivers().positions[p];
        if (std::max(std::abs(at.x), std::abs(at.z)) > 0.99f) {
            inside += static_cast<double>(maps.vector(p)[0]);
            truth += static_cast<double>(reference.vector(p)[0]);
        }
    }
    EXPECT_NEAR(inside, truth, 0.15 * truth);
}

TEST(GpuRaster, PeelsCutOutGlass) {
    Drawn pair(under_glass(AlphaMode::mask), glass_textures());
    const Transfer reference = pair.by_rays({2, 1024, 99, 0});
    const double error = pair.distance(reference, pair.by_maps(128, {2, 128, 1, 0}));
    Drawn clay(under_a_ceiling(AlphaMode::mask), glass_textures());
    EXPECT_LT(error, 0.5 * pair.distance(reference, clay.by_rays({2, 1024, 99, 0})));
}

TEST(GpuRaster, PeelsBlendedSurfacesAndDropsCutOuts) {
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
        Drawn pair(under_a_ceiling(mode), {dotted_texture()});
        const Transfer reference = pair.by_rays({3, 4096, 99, 0});
        const Transfer raster = pair.by_maps(512, {3, 256, 1, 0});
        Drawn opaque(under_a_ceiling(AlphaMode::opaque), {dotted_texture()});
        const double error = pair.distance(reference, raster);
        EXPECT_LT(error, 0.06);
        EXPECT_LT(error, 0.5 * pair.distance(reference, opaque.by_rays({3, 4096, 99, 0})));
    }
}

TEST(GpuRaster, KeepsTheLobeOfOpenReceivers) {
    Drawn pair(SceneBuilder().floor({0, 0, 0}, 1, 4).build());
    const Transfer raster = pair.by_maps(64, {6, 64, 1, 0}), cpu = pair.by_rays({6, 64, 1, 0});
    EXPECT_LT(pair.distance(cpu, raster), 1e-6);
}

TEST(GpuRaster, PassesSurfacesWithoutShadow) {
    Scene shell = SceneBuilder().sphere({0, 0, 0}, 5, 8).build();
    shell.materials[0].casts_shadow = false;
    Drawn alone(balls_over_floor()), inside(join({balls_over_floor(), shell}));
    const TraceOptions options{3, 128, 1, 0};
    const Transfer expected = alone.by_rays(options);
    Transfer drawn = inside.by_maps(256, options);
    drawn.vectors.resize(expected.vectors.size());
    EXPECT_LT(relative_l2(expected, drawn, alone.receivers().areas), 0.2); // 128 directions over the sphere
}

TEST(GpuRaster, StopsWhenAsked) {
    std::stop_source stop;
    BakeOptions options;
    options.tracer.backend = Backend::gpu;
    options.tracer.method = BakeMethod::raster;
    options.rays = 1 << 20;
    const Progress progress{[&](double fraction) {
                                if (fraction > 0)
                                    stop.request_stop();
                            },
                            stop.get_token()};
    EXPECT_THROW(bake(balls_over_floor(), options, progress), Cancelled);
}

TEST(GpuRaster, RejectsOptionsBeyondDepthMaps) {
    BakeOptions options;
    options.tracer.method = BakeMethod::raster;
    options.tracer.backend = Backend::gpu;
    options.tracer.falloff.farthest = 1;
    EXPECT_THROW(bake(balls_over_floor(), options), Error);
    options.tracer.falloff = {};
    options.tracer.backend = Backend::cpu;
    EXPECT_THROW(bake(balls_over_floor(), options), Error);
}

} // namespace
} // namespace prt
