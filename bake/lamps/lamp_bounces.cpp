#include "lamps/lamp_bounces.h"

namespace prt {

double take_last_of_lamps(const LastOfLampsGathered& gathered, const std::vector<bool>& left_out,
                          const NoiseFilter* filter, const Transfer& unbounced, Transfer& light) {
    const std::size_t stride = light.dimension();
    for (std::size_t p = 0; p < light.receivers(); ++p)
        for (std::size_t c = 0; c < stride; ++c)
            light.vector(p)[c] =
                left_out[p] ? light.vector(p)[c] - unbounced.vector(p)[c] : gathered.all[p * stride + c];
    double noise = 0;
    if (filter && !gathered.half.empty()) {
        const auto value = [&](std::uint32_t p, std::size_t c) { return light.vector(p)[c]; };
        const NoiseFilter::Fitted fitted =
            filter->fit(value, filter->brightest(value, stride), [&](std::uint32_t p, std::size_t c) {
                return gathered.half[p * stride + c] - gathered.all[p * stride + c];
            });
        filter->apply(fitted.solver, light);
        noise = fitted.noise;
    }
    for (std::size_t i = 0; i < light.vectors.size(); ++i)
        light.vectors[i] += unbounced.vectors[i];
    return noise;
}

} // namespace prt
