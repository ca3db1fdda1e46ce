// Estimates the sampling error of direct light from a second, independent scramble of a few receivers, chosen
// by importance (docs/math.md, section 9).

#include "bake/pipeline/sampling_error.h"

#include "bake/trace/picked.h"
#include "bake/trace/scrambles.h"
#include "bake/trace/trace_receivers.h"
#include "prt/core/sh_basis.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace prt {
namespace {

/// One of kReceiversPerCheck receivers is sampled again to estimate the error of a bake, within these limits.
constexpr std::size_t kReceiversPerCheck = 32, kMinChecked = 256, kMaxChecked = 1024;

double area_of(const Receivers& receivers, std::uint32_t p) {
    return static_cast<double>(receivers.areas[p]);
}

/// Returns the receivers to sample again, and the weight of each. Few receivers carry most of the error, so
/// they are chosen by their likely contribution. Half-open receivers have the largest errors; a constant term
/// covers errors that visibility does not predict.
std::map<std::uint32_t, double> choose_receivers(const Receivers& receivers, const Transfer& transfer,
                                                 std::span<const std::uint32_t> all) {
    const auto likely = [&](std::uint32_t p) {
        const double visible = static_cast<double>(transfer.vector(p)[0]) / kY00;
        return area_of(receivers, p) * (0.02 + std::clamp(visible * (1 - visible), 0.0, 0.25));
    };
    const std::size_t wanted = std::clamp(all.size() / kReceiversPerCheck, kMinChecked, kMaxChecked);
    std::map<std::uint32_t, double> weights;
    for (const Picked& picked : pick(all.size(), wanted, [&](std::size_t i) { return likely(all[i]); }))
        weights[all[picked.index]] = picked.weight;
    return weights;
}

} // namespace

SamplingError sampling_error(Tracer& tracer, const Receivers& receivers, const TraceOptions& options,
                             const Transfer& transfer, const std::stop_token& stop) {
    const std::vector<std::uint32_t> all = receivers_on_surfaces(receivers);
    double norm = 0;
    for (const std::uint32_t p : all)
        norm += area_of(receivers, p) * squared_norm(transfer.vector(p));
    if (!(norm > 0))
        return {};
    const std::map<std::uint32_t, double> weights = choose_receivers(receivers, transfer, all);
    std::vector<std::uint32_t> some;
    for (const auto& [p, weight] : weights)
        some.push_back(p);
    TraceOptions other = options;
    other.seed += kSecondScramble;
    Transfer again = zero_transfer(options.order, 1, receivers.size());
    trace_receivers(tracer, receivers, some, other, again, {{}, stop});
    double error = 0;
    for (const auto& [p, weight] : weights) // both have the error
        error += weight * area_of(receivers, p) * squared_distance(transfer.vector(p), again.vector(p)) / 2;
    // The sampled norm contains the error, which matters where hardly any ray finds the light.
    return {std::sqrt(error / std::max(norm - error, 0.1 * norm)),
            some.size() * static_cast<std::size_t>(options.rays)};
}

} // namespace prt
