// Replaces the last bounce of lamps and filters it.

#include "bake/pipeline/lamp_bounces.h"

namespace prt {
namespace {

RepresentativeColumns columns_of_lamp(const TransferLayout& layout, std::size_t lamp) {
    const auto channels = static_cast<std::size_t>(layout.channels());
    RepresentativeColumns columns;
    for (std::size_t c = 0; c < channels; ++c)
        columns.columns.push_back(c * (layout.dimension() / channels) + lamp);
    columns.factors.assign(channels, 1.0f);
    return columns;
}

} // namespace

std::vector<double> take_last_of_lamps(const LastOfLampsGathered& gathered, const std::vector<bool>& left_out,
                                       const NoiseFilter* filter, std::size_t lamps,
                                       const Transfer& unbounced, Transfer& light) {
    const std::size_t stride = light.dimension();
    for (std::size_t p = 0; p < light.receivers(); ++p)
        for (std::size_t c = 0; c < stride; ++c)
            light.vector(p)[c] =
                left_out[p] ? light.vector(p)[c] - unbounced.vector(p)[c] : gathered.all[p * stride + c];
    std::vector<double> noise_left;
    if (filter && !gathered.half.empty()) {
        const auto value = [&](std::uint32_t p, std::size_t c) { return light.vector(p)[c]; };
        const auto noise = [&](std::uint32_t p, std::size_t c) {
            return gathered.half[p * stride + c] - gathered.all[p * stride + c];
        };
        const FitSolver solver = filter->fit(value, filter->brightest(value, stride), noise);
        for (std::size_t k = 0; k < lamps; ++k)
            noise_left.push_back(filter->norm(solver, columns_of_lamp(light.layout, k), noise));
        filter->apply(solver, light);
    }
    for (std::size_t i = 0; i < light.vectors.size(); ++i)
        light.vectors[i] += unbounced.vectors[i];
    return noise_left;
}

} // namespace prt
