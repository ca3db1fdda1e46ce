// Links every library, and checks that the runtime returns the known radiance of an open receiver under
// uniform light 1.

#include "prt/bake/bake.h"
#include "prt/compress/compress.h"
#include "prt/core/clustered_transfer.h"
#include "prt/core/sh.h"
#include "prt/gl/gl_context.h"

#include <cmath>
#include <cstdio>

int main() {
    prt::Transfer transfer{prt::layout_of_one(4, 1), {}};
    std::vector<double> lobe(transfer.dimension());
    prt::clamped_cosine_lobe(4, {0, 1, 0}, lobe);
    transfer.vectors.assign(lobe.begin(), lobe.end());
    prt::CompressOptions options;
    options.clusters = 1;
    const auto compressed = prt::compress(transfer, {std::vector<float>{1.0f}}, options);
    const auto radiance = prt::exit_radiance(compressed.transfer, prt::constant_light(4, glm::vec3(1)));
    const auto context = prt::GlContext::create(prt::GlDevice::any);
    std::printf("%g, %s\n", static_cast<double>(radiance[0].r),
                context ? context->renderer().c_str() : "no OpenGL");
    try {
        prt::bake(prt::Scene{}, {.order = 0});
        return 1;
    } catch (const prt::Error&) {
    }
    return std::abs(radiance[0].r - 1) < 1e-6f ? 0 : 1;
}
