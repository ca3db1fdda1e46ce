#include "inputs.h"

#include "prt/error.h"
#include "report.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <fmt/core.h>

namespace prt::cli {

int Model::order() const {
    if (compressed)
        return compressed->transfer.bases.order;
    return baked ? baked->transfer.order : 0;
}

Model load_model(const Path& path) {
    GltfDocument document = load_gltf(path);
    Scene scene = extract_scene(document);
    auto baked = read_transfer(document, scene);
    auto compressed = read_clustered(document, scene);
    if (!baked && !compressed) // else they were given when it was baked
        print_notices(path.string(), scene.notices);
    return {std::move(document), std::move(scene), std::move(baked), std::move(compressed)};
}

LoadedLight load_light(const Path& path, int order, const LightOptions& options, int threads) {
    LoadedLight result;
    result.name = path.filename().string();
    if (path.extension() == ".json") {
        const Light light = read_light_json(path);
        if (light.order < order)
            throw Error(
                fmt::format("{}: has order {}, but order {} is needed", path.string(), light.order, order));
        result.light = truncated(light, order);
    } else {
        EnvironmentFile file = load_environment(path, options.environment);
        if (file.repaired_pixels > 0)
            print_notices(path.string(), {fmt::format("{} bad pixels were repaired", file.repaired_pixels)});
        result.light = project(file.environment, order, threads);
        result.environment = std::move(file.environment);
    }
    result.light = windowed(result.light, options.window);
    if (options.rotation_degrees != 0)
        result.light = rotated_about_y(result.light, glm::radians(options.rotation_degrees));
    return result;
}

std::vector<LoadedLight> default_lights(int order) {
    return {{"uniform", constant_light(order, glm::vec3(1)), {}},
            {"overcast sky", overcast_sky(order, glm::vec3(1)), {}},
            {"sun", directional_light(order, glm::normalize(glm::vec3(0.5f, 1, 0.7f)), glm::vec3(1)), {}}};
}

} // namespace prt::cli
