// Prepares a scene and a tracer for ambient occlusion.

#include "bake/products/occlusion/occlusion_scene.h"

#include "bake/plan/check_options.h"
#include "bake/plan/plan.h"
#include "bake/tracers/make_tracer.h"

namespace prt {
namespace {

BakeOptions checked(BakeOptions options) {
    check_options(options);
    return options;
}

} // namespace

BakeOptions bake_options(const OcclusionOptions& options) {
    BakeOptions result;
    result.order = 2;
    result.rays = options.rays;
    result.target_error = options.target_error;
    result.fit = options.fit;
    result.tracer = options.tracer;
    result.lamps.mode = LampMode::none;
    result.repairs = options.repairs;
    result.memory = options.memory;
    result.memory.storage = TransferStorage::float32;
    result.threads = options.threads;
    result.seed = options.seed;
    return result;
}

OcclusionScene::OcclusionScene(const Scene& scene, const OcclusionOptions& options)
    : options_(checked(bake_options(options))),
      scene_(trace_scene(scene, choose_media(scene, options_), options_)),
      tracer_(make_tracer(scene_, options_.tracer)), notices_(scene_notices(scene_, options_)) {}

} // namespace prt
