// Lights vertices by transfer, and by rays to suns.

#include "cli/pipeline/relit_vertices.h"

#include "cli/pipeline/posed_lobes.h"

namespace prt::pipeline {

std::vector<glm::vec3> lit_vertices(const SceneFile& model, const Lighting& lighting, int threads) {
    std::vector<glm::vec3> radiance = model.compressed
                                          ? exit_radiance(model.compressed->transfer, lighting, threads)
                                          : exit_radiance(model.baked->transfer, lighting, threads);
    light_lobes(model, lighting, radiance);
    return radiance;
}

void add_direct_suns(const TraceScene& scene, std::span<const Sun> suns, const SunRays& rays,
                     const Progress& progress, std::span<glm::vec3> radiance) {
    const std::vector<glm::vec3> direct = sun_radiance(scene, suns, rays, progress);
    for (std::size_t p = 0; p < radiance.size(); ++p)
        radiance[p] += direct[p];
}

bool suns_stay_in_sky(const SceneFile& model) {
    return model.lobes || layout_of(model).has(TermKind::combined);
}

} // namespace prt::pipeline
