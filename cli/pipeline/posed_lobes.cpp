// Lights lobes in a pose.

#include "cli/pipeline/posed_lobes.h"

namespace prt::pipeline {

std::array<Lobe, kMaxLobes> lobes_in_pose(const LobeModel& lobes, const VertexFrames& frames,
                                          std::size_t vertex) {
    std::array<Lobe, kMaxLobes> of_vertex;
    lobes.decode(vertex, of_vertex);
    for (Lobe& lobe : of_vertex)
        lobe.axis = rotated_axis(lobe.axis, axis_rotation(glm::mat3(frames.matrix(vertex))));
    return of_vertex;
}

void light_lobes(const SceneFile& model, const Lighting& lighting, std::span<glm::vec3> radiance) {
    if (!model.lobes)
        return;
    const LobeModel& lobes = model.lobes->model;
    const Light light = lighting.suns ? sum(lighting.sky, *lighting.suns) : lighting.sky;
    const AnimatedScene animated(model.document);
    const VertexFrames frames(animated, {"", 0, animated.rest()});
    for (const VertexArray& vertices : model.scene.vertex_arrays)
        for (std::size_t v = vertices.first_receiver;
             vertices.lobes && v < vertices.first_receiver + vertices.size(); ++v)
            radiance[v] = lobe_radiance(lobes_in_pose(lobes, frames, v), light.coefficients, light.order);
}

} // namespace prt::pipeline
