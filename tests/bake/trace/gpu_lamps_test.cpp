// Tests light of lamps on the GPU: against closed forms, and against the CPU for every lamp at every
// receiver. Both use equal samples, so that only grazing rays differ.

#include "bake/trace/embree_tracer.h"
#include "bake/trace/lamp_light.h"
#include "bake/trace_gpu/vulkan_tracer.h"
#include "prt/bake/bake.h"
#include "support/scene_builder.h"
#include "support/vulkan_choice.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace prt {
namespace {

using test::SceneBuilder;

PunctualLight bulb(const std::string& name, const glm::vec3& position,
                   const glm::vec3& intensity = glm::vec3(1)) {
    PunctualLight light;
    light.name = name;
    light.position = position;
    light.intensity = intensity;
    return light;
}

PunctualLight spot(const std::string& name, const glm::vec3& position) {
    PunctualLight light = bulb(name, position, {1, 2, 3});
    light.kind = PunctualKind::spot;
    light.direction = glm::normalize(glm::vec3(0.2f, -1, 0.1f));
    light.range = 4;
    light.inner_cone = 0.3f;
    light.outer_cone = 0.7f;
    return light;
}

PunctualLight far_away(const std::string& name) {
    PunctualLight light = bulb(name, {0, 0, 0}, {3, 2, 1});
    light.kind = PunctualKind::directional;
    light.direction = glm::normalize(glm::vec3(0.5f, -1, 0.3f));
    return light;
}

/// A scene, and the light of its lamps by both tracers.
class LitScene {
public:
    explicit LitScene(Scene scene, std::vector<Texture> textures = {})
        : scene_(std::move(scene)), trace_(scene_, std::move(textures)), receivers_(vertex_receivers(scene_)),
          cpu_(trace_), gpu_(trace_, test::vulkan_choice()) {}
    ~LitScene() { test::expect_valid(gpu_.vulkan()); }

    LampLight light(Tracer& tracer, const LampOptions& options) {
        lamps_ = choose_lamps(trace_.surfaces(), options);
        return tracer.lamp_light({trace_, receivers_, lamps_, options, 3, 5, 0}, {});
    }
    LampLight on_cpu(const LampOptions& options = {}) { return light(cpu_, options); }
    LampLight on_gpu(const LampOptions& options = {}) { return light(gpu_, options); }

    const std::vector<Lamp>& lamps() const { return lamps_; } ///< lamps of the last call
    const Receivers& receivers() const { return receivers_; }

private:
    Scene scene_;
    TraceScene trace_;
    Receivers receivers_;
    EmbreeTracer cpu_;
    VulkanTracer gpu_;
    std::vector<Lamp> lamps_;
};

glm::dvec3 radiance(const LampLight& light, std::size_t receiver, std::size_t lamp) {
    const auto vector = light.transfer.vector(receiver);
    const std::size_t stride = vector.size() / 3;
    return {vector[lamp], vector[stride + lamp], vector[2 * stride + lamp]};
}

/// Expects that every lamp gives some light, and that CPU and GPU differ by at most `tolerance` of the
/// maximum, except where a ray grazes a surface: at so few receivers that any other error would affect more.
void expect_equal(LitScene& scene, const LampOptions& options, double tolerance = 1e-3) {
    constexpr std::size_t kGrazing = 4;
    const LampLight cpu = scene.on_cpu(options), gpu = scene.on_gpu(options);
    EXPECT_NEAR(static_cast<double>(gpu.rays), static_cast<double>(cpu.rays),
                1e-3 * static_cast<double>(cpu.rays)); // except for lights on the horizon
    for (std::size_t k = 0; k < scene.lamps().size(); ++k) {
        double brightest = 0, largest = 0;
        for (std::size_t p = 0; p < scene.receivers().size(); ++p)
            brightest = std::max(brightest, glm::length(radiance(cpu, p, k)));
        EXPECT_GT(brightest, 1e-5) << scene.lamps()[k].name;
        std::size_t different = 0;
        for (std::size_t p = 0; p < scene.receivers().size(); ++p) {
            const double d = glm::distance(radiance(cpu, p, k), radiance(gpu, p, k)) / brightest;
            different += d > tolerance;
            largest = std::max(largest, d);
        }
        EXPECT_LE(different, kGrazing) << scene.lamps()[k].name << ", largest difference " << largest;
    }
}

/// A quad of this material with texture coordinates beyond 0..1, about the height `y`.
Scene textured_quad(float y, const Material& material) {
    Scene scene = SceneBuilder().floor({0.2f, y, 0.1f}, 0.6f, 2).build();
    VertexArray& v = scene.vertex_arrays[0];
    v.texcoords.resize(1);
    for (const glm::vec3& p : v.positions)
        v.texcoords[0].emplace_back(1.7f * p.x + 0.3f, 1.9f * p.z - 0.4f);
    scene.materials[0] = material;
    return scene;
}

Texture dots() {
    Image8 image{16, 8, {}};
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x)
            image.pixels.emplace_back(20 + 14 * x, 220 - 20 * y, 180,
                                      std::hypot(x - 8, 2 * (y - 4)) < 5 ? 30 : 255);
    return make_texture(image);
}

Material material(AlphaMode mode) {
    Material m;
    m.name = "screen";
    m.alpha_mode = mode;
    m.base_color = {1, 1, 1, 0.8f};
    m.base_color_texture.image = 0;
    m.base_color_texture.wrap_v = Wrap::mirror;
    m.double_sided = true;
    return m;
}

/// Returns all kinds of lamps over a floor with a ball and a screen of material `screen`.
Scene all_kinds(const Material& screen) {
    Material sign;
    sign.name = "sign";
    sign.emission.radiance = {3, 2, 1};
    sign.emission.texture.image = 0;
    sign.emission.texture.wrap_u = Wrap::clamp;
    sign.double_sided = true;
    Scene globe = SceneBuilder().sphere({-1.1f, 0.5f, -0.8f}, 0.25f, 8).build();
    globe.materials[0].name = "globe";
    globe.materials[0].emission.radiance = {1, 4, 2};
    Scene scene = test::join({SceneBuilder().floor({0, 0, 0}, 2, 16).build(), textured_quad(0.6f, screen),
                              textured_quad(1.4f, sign), globe,
                              SceneBuilder().sphere({0.9f, 0.4f, 0.2f}, 0.3f, 8).build()});
    scene.lights = {bulb("bulb", {0.3f, 1.1f, -0.2f}), spot("spot", {-0.4f, 2, 0.1f}), far_away("moon"),
                    bulb("left", {-1.5f, 0.9f, 0.7f}, {2, 1, 0}), bulb("right", {1.4f, 0.8f, -0.9f})};
    return scene;
}

TEST(GpuLamps, PointsFollowTheInverseSquareLaw) {
    Scene floor = SceneBuilder().floor({0, 0, 0}, 2, 8).build();
    floor.lights = {bulb("bulb", {0.3f, 1.5f, -0.2f}, {2, 1, 0.5f})};
    LitScene scene(floor);
    // a sphere lights points outside it like a point light at its center
    for (const double radius : {0.0, 0.4}) {
        LampOptions options;
        options.radius = radius;
        const LampLight light = scene.on_gpu(options);
        for (std::size_t p = 0; p < scene.receivers().size(); ++p) {
            const glm::dvec3 to = glm::dvec3(0.3, 1.5, -0.2) - glm::dvec3(scene.receivers().positions[p]);
            const double right = to.y / (std::numbers::pi * std::pow(glm::length(to), 3));
            EXPECT_LT(glm::distance(radiance(light, p, 0), right * glm::dvec3(2, 1, 0.5)),
                      radius > 0 ? 4e-4 : 2e-6) // 64 points of a spiral; rounding
                << p;
        }
    }
}

/// E = pi L sin² of the half angle times the cosine.
TEST(GpuLamps, SpheresFollowTheirSolidAngle) {
    Scene ball = SceneBuilder().sphere({0, 1.2f, 0}, 0.5f, 20).build();
    ball.materials[0].emission.radiance = glm::vec3(4, 2, 1);
    LitScene scene(test::join({SceneBuilder().floor({0, 0, 0}, 2, 4).build(), ball}));
    LampOptions options;
    options.rays = 300; // in two dispatches
    const LampLight light = scene.on_gpu(options);
    for (std::size_t p = 0; p < 25; ++p) {
        const glm::dvec3 to = glm::dvec3(0, 1.2, 0) - glm::dvec3(scene.receivers().positions[p]);
        const double square = glm::dot(to, to);
        // The polyhedron is 1.2 % smaller, the rest is sampling.
        EXPECT_LT(glm::distance(radiance(light, p, 0),
                                glm::dvec3(4, 2, 1) * (0.25 / square * to.y / std::sqrt(square))),
                  0.025)
            << p;
    }
    expect_equal(scene, options);
}

TEST(GpuLamps, MatchCpuForAllKinds) {
    std::vector<double> lit; // light through the screen
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
        LitScene scene(all_kinds(material(mode)), {dots()});
        expect_equal(scene, {});
        const LampLight light = scene.on_gpu();
        lit.push_back(std::accumulate(light.transfer.vectors.begin(), light.transfer.vectors.end(), 0.0));
    }
    EXPECT_GT(lit[1], 1.005 * lit[0]);
    EXPECT_GT(lit[2], 1.005 * lit[0]);
    EXPECT_GT(std::abs(lit[2] - lit[1]), 0.005 * lit[0]);
}

TEST(GpuLamps, MatchCpuForRadiiAndGroups) {
    LitScene scene(all_kinds(material(AlphaMode::mask)), {dots()});
    LampOptions options;
    options.radius = 0.15;
    options.rays = 48;
    options.groups = {{"both", "left"}, {"both", "right"}, {"shining", "s*"}};
    expect_equal(scene, options);
}

/// A sign that is blended or glass shines by as much of it as is there, and lets light of others through.
TEST(GpuLamps, MatchCpuForBlendedEmitters) {
    Material screen = material(AlphaMode::blend);
    screen.emission.radiance = {2, 1, 1};
    screen.glass = {0.6f, {}};
    LitScene scene(all_kinds(screen), {dots()});
    expect_equal(scene, {});
}

/// A floor meets a wall that shines: at the edge half of the sky of a vertex is wall, which it sees edge on,
/// from a hair before it.
TEST(GpuLamps, LightReceiversInTheirPlane) {
    for (const float rotation : {0.0f, 0.4f}) {
        const auto rotated = [rotation](const glm::vec3& p) {
            return glm::vec3(std::cos(rotation) * p.x + std::sin(rotation) * p.z, p.y,
                             std::cos(rotation) * p.z - std::sin(rotation) * p.x);
        };
        Scene wall = SceneBuilder()
                         .quad({-50, 0, 0}, {50, 0, 0}, {50, 100, 0}, {-50, 100, 0})
                         .transform(rotated)
                         .build();
        wall.materials[0].emission.radiance = glm::vec3(1);
        LitScene scene(test::join(
            {SceneBuilder().quad({-1, 0, 0}, {-1, 0, 2}, {1, 0, 2}, {1, 0, 0}).transform(rotated).build(),
             wall}));
        LampOptions options;
        options.rays = 1024;
        const LampLight light = scene.on_gpu(options);
        for (const std::size_t p : {0u, 3u})
            EXPECT_NEAR(radiance(light, p, 0).x, 0.5, 0.02) << rotation << " " << p;
    }
}

/// A lamp without an emissive triangle gets no data of the previous one.
TEST(GpuLamps, WithBlackTexturesAreDark) {
    Material black = material(AlphaMode::opaque);
    black.emission.radiance = glm::vec3(1);
    black.emission.texture.image = 0;
    Scene screen = textured_quad(1, black);
    Material white = material(AlphaMode::opaque);
    white.name = "white";
    white.emission.radiance = glm::vec3(1);
    LitScene scene(
        test::join({textured_quad(2, white), screen, SceneBuilder().floor({0, 0, 0}, 1, 2).build()}),
        {make_texture(Image8{1, 1, {{0, 0, 0, 255}}})});
    const LampLight light = scene.on_gpu();
    ASSERT_EQ(scene.lamps().size(), 2u);
    double lit = 0;
    for (std::size_t p = 0; p < scene.receivers().size(); ++p) {
        lit += radiance(light, p, 0).x;
        EXPECT_EQ(radiance(light, p, 1), glm::dvec3(0));
    }
    EXPECT_GT(lit, 0.1);
}

/// Ray indices continue through the dispatches of a lamp with many rays.
TEST(GpuLamps, MatchCpuForManyRays) {
    Scene floors = test::join(
        {SceneBuilder().floor({0, 0, 0}, 1, 2).build(), SceneBuilder().floor({0.1f, 0.3f, 0}, 0.2f).build()});
    floors.lights = {bulb("a", {0.2f, 0.7f, 0}), bulb("b", {-0.5f, 0.6f, 0.3f}, glm::vec3(3))};
    LitScene scene(floors);
    LampOptions options;
    options.radius = 0.2;
    options.rays = 700;
    options.groups = {{"both", "*"}};
    expect_equal(scene, options);
}

TEST(GpuLamps, MatchCpuFarFromTheOriginAndTiny) {
    for (const auto& [size, offset] : {std::pair{1e-4f, 0.0f}, {1e3f, 0.0f}, {1.0f, 1e3f}}) {
        Scene scene = all_kinds(material(AlphaMode::opaque));
        const auto point = [s = size, o = offset](const glm::vec3& p) { return s * p + glm::vec3(o, 0, o); };
        for (VertexArray& v : scene.vertex_arrays)
            for (glm::vec3& p : v.positions)
                p = point(p);
        for (PunctualLight& light : scene.lights) {
            light.position = point(light.position);
            light.range *= size;
            if (light.kind != PunctualKind::directional)
                light.intensity *= size * size;
        }
        LitScene placed(scene, {dots()});
        expect_equal(placed, {}, 5e-3); // a thousand metres away texels are rounded to 1e-3 of them
    }
}

TEST(GpuLamps, AreTracedOnTheGpuInABake) {
    Scene scene = all_kinds(material(AlphaMode::opaque));
    scene.materials[1].base_color_texture.image = -1;
    scene.materials[2].emission.texture.image = -1;
    BakeOptions options;
    options.order = 2;
    options.rays = 32;
    options.lamps.rays = 16;
    const auto baked = [&](Backend backend, BakeMethod method) {
        options.tracer = {.backend = backend, .method = method, .raster_resolution = 64};
        return bake(scene, options);
    };
    const BakeResult cpu = baked(Backend::cpu, BakeMethod::trace);
    for (const BakeMethod method : {BakeMethod::trace, BakeMethod::raster}) {
        const BakeResult gpu = baked(Backend::gpu, method);
        for (const std::string& notice : gpu.statistics.notices)
            EXPECT_EQ(notice.find("CPU"), std::string::npos) << notice;
        Lighting lamps{constant_light(2, glm::vec3(0))};
        const auto a = exit_radiance(cpu.baked.transfer, lamps), b = exit_radiance(gpu.baked.transfer, lamps);
        std::size_t different = 0;
        for (std::size_t p = 0; p < a.size(); ++p)
            different += glm::distance(a[p], b[p]) > 1e-2f * (0.1f + glm::length(a[p]));
        EXPECT_LT(different, 9u);
    }
}

} // namespace
} // namespace prt
