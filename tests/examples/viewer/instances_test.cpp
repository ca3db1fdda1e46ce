// Compares instances that share transfer in the viewer with transfer of individual vertices.

#include "gpu/offscreen.h"
#include "pictures/frame_renderer.h"

#include "prt/gl/gl_renderer.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/instanced_model.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace viewer {
namespace instances_shown {

constexpr int kWidth = 192, kHeight = 108;

class ViewerInstances : public testing::Test {
protected:
    void SetUp() override {
        std::string why;
        context = prt::GlContext::create(prt::GlDevice::any, &why);
        ASSERT_TRUE(context) << why;
        prt::test::instanced_triangles().write(path);
        loaded = load_model(path);
        renderer = std::make_unique<FrameRenderer>();
        renderer->resize({kWidth, kHeight, 1});
        settings.drawing.background = false;
        gpu = std::make_unique<GpuModel>(loaded.model);
        view.camera = prt::automatic_camera(loaded.model->scene, float{kWidth} / float{kHeight}, 0.6f);
        light = prt::sum(prt::constant_light(3, glm::vec3(0.5f)),
                         prt::cone_light(3, glm::normalize(glm::vec3(1, 2, 0.5f)), 0.6, {3, 2.5f, 2}));
    }
    void TearDown() override {
        gpu.reset();
        renderer.reset();
    }
    prt::Image drawn(PictureKind kind) {
        renderer->draw(1, kind, *gpu, settings.drawing, view, {0, kWidth});
        alpha.clear();
        return renderer->read(1, &alpha);
    }
    /// Transfer of all vertices, as the file has it for instances.
    prt::Transfer expanded_transfer() const {
        const prt::GltfDocument document = prt::load_gltf(path);
        const prt::Scene scene = prt::extract_scene(document);
        const prt::InstancedModel model = prt::read_instanced(document, scene, path);
        return prt::expanded(document, scene, model.stored, prt::decode(model.compressed->transfer));
    }

    prt::test::TemporaryFolder folder;
    std::filesystem::path path = folder / "instances.glb";
    std::unique_ptr<prt::GlContext> context;
    LoadedModel loaded;
    std::unique_ptr<FrameRenderer> renderer;
    std::unique_ptr<GpuModel> gpu;
    Settings settings;
    FrameView view;
    prt::Light light;
    std::vector<float> alpha;
};

/// Returns the relative L2 difference over all pixels; positions differ by the rounding of a matrix, and so
/// do pixels at borders.
double difference(const prt::Image& a, const prt::Image& b) {
    double wrong = 0, all = 1e-30;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 off(a.pixels[i] - b.pixels[i]), of(b.pixels[i]);
        wrong += glm::dot(off, off);
        all += glm::dot(of, of);
    }
    return std::sqrt(wrong / all);
}

TEST_F(ViewerInstances, MatchTheirTransferPerVertex) {
    ASSERT_TRUE(loaded.instanced);
    EXPECT_FALSE(loaded.compressed);
    gpu->set_instanced(loaded.instanced);
    gpu->set_raw(expanded_transfer());
    gpu->set_light(light);
    ASSERT_TRUE(gpu->can_draw(PictureKind::prt_compressed));
    const prt::Image one_by_one = drawn(PictureKind::prt);
    EXPECT_GT(std::ranges::count_if(alpha, [](float a) { return a > 0; }), 300);
    const prt::Image instanced = drawn(PictureKind::prt_compressed);
    EXPECT_EQ(gpu->drawn_triangles(), 4u);
    EXPECT_LT(difference(instanced, one_by_one), 2e-3); // half precision
    ASSERT_TRUE(gpu->instances());
    EXPECT_EQ(gpu->instances()->figures().instances, 3u);
    EXPECT_EQ(gpu->instances()->figures().meshes, 1u);
}

TEST_F(ViewerInstances, AreRelitAfterChangesOfLight) {
    gpu->set_instanced(loaded.instanced);
    gpu->set_raw(expanded_transfer());
    gpu->set_light(light);
    const prt::Image before = drawn(PictureKind::prt_compressed);
    gpu->set_light(prt::cone_light(3, glm::normalize(glm::vec3(-1, 2, -2)), 0.4, {1, 2, 4}));
    const prt::Image after = drawn(PictureKind::prt_compressed);
    EXPECT_LT(difference(after, drawn(PictureKind::prt)), 2e-3);
    EXPECT_GT(difference(after, before), 0.1);
}

TEST_F(ViewerInstances, AreLitByRotatedNormalsWithoutTransfer) {
    gpu->set_light(light);
    const prt::Image one_by_one = drawn(PictureKind::unshadowed);
    gpu->set_instanced(loaded.instanced);
    gpu->set_light(light);
    EXPECT_LT(difference(drawn(PictureKind::unshadowed), one_by_one), 2e-3);
}

TEST_F(ViewerInstances, OutsideTheViewAreNotDrawn) {
    gpu->set_instanced(loaded.instanced);
    gpu->set_light(light);
    view.camera.position += 100.0f * (view.camera.position - view.camera.target);
    view.camera.target = 2.0f * view.camera.position - view.camera.target; // away from all
    drawn(PictureKind::prt_compressed);
    EXPECT_EQ(gpu->drawn_triangles(), 0u);
}

} // namespace instances_shown
} // namespace viewer
