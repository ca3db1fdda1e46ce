#include "surface/surface_fit.h"

namespace prt {

void SurfaceFit::apply(std::span<const float> at_samples, std::span<float> at_receivers, std::size_t stride,
                       int threads) const {
    std::vector<float> x(equations.unknowns * stride);
    add_samples(equations, 0, at_samples, stride, std::span(x));
    solver.solve(x, stride, threads);
    spread_unknowns(equations, std::span<const float>(x), stride, at_receivers);
}

} // namespace prt
