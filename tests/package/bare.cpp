// The bare runtime: GLM and the standard library.

#include "prt/core/cluster_lighting.h"
#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"

#include <cmath>
#include <cstdio>

int main() {
    prt::ClusteredTransfer transfer; // one cluster without components: an open receiver that faces +Y
    transfer.bases.layout = prt::layout_of_one(4, 1);
    transfer.bases.components = {0};
    std::vector<double> lobe(16);
    prt::clamped_cosine_lobe(4, {0, 1, 0}, lobe);
    transfer.bases.rows.assign(lobe.begin(), lobe.end());
    const prt::ClusterLighting relighter(transfer);
    const prt::Light light = prt::sky_light(4, prt::PreethamSky(3, {0, 1, 0}));
    std::vector<glm::vec4> constants(relighter.rows());
    relighter.update(light.coefficients, constants);
    const float before = constants[0].g;
    prt::Light rotated = light;
    prt::ShRotation::about_y(4, 1).apply(rotated.coefficients); // +Y does not notice
    relighter.update(rotated.coefficients, constants);
    std::printf("%g %g\n", static_cast<double>(before), static_cast<double>(constants[0].g));
    return before > 0 && std::abs(constants[0].g - before) < 1e-5f * before ? 0 : 1;
}
