// Loads a compressed model and relights it; links prt::load and prt::shader alone.

#include "prt/core/cluster_lighting.h"
#include "prt/load/model.h"
#include "prt/shader/shader_source.h"

#include <cstdio>

int main(int count, char** arguments) {
    if (count != 2)
        return 2;
    prt::Model model = prt::load_model(arguments[1]);
    prt::add_coordinates(model); // for exit_radiance
    const prt::ClusteredTransfer& transfer = model.vertices->transfer;
    const auto radiance =
        prt::exit_radiance(transfer, prt::constant_light(transfer.bases.layout.order, glm::vec3(1)));
    double mean = 0;
    for (const glm::vec3& r : radiance)
        mean += static_cast<double>(r.g) / static_cast<double>(radiance.size());
    const auto shader =
        prt::relight_shader(transfer, prt::ConstantSource::texture, prt::ShaderLanguage::essl300);
    std::printf("%zu receivers, mean radiance %g, a shader of %zu bytes\n", radiance.size(), mean,
                shader.size());
    return mean > 0.1 && mean < 1.1 && shader.starts_with("#version 300 es") ? 0 : 1;
}
