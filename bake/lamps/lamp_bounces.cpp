#include "lamps/lamp_bounces.h"

#include <utility>

namespace prt {
namespace {

/// Light that goes through a medium is not what rays gathered.
std::vector<bool> with_media(const BakePlan& plan, std::vector<bool> left_out) {
    for (const DiffusionOperator& body : plan.diffusion)
        for (const std::uint32_t p : body.members())
            left_out[p] = true;
    return left_out;
}

} // namespace

LampBounces::LampBounces(const BakePlan& plan, const SharedPlaces& shared, std::vector<bool> left_out,
                         std::size_t first_row)
    : left_out_(with_media(plan, std::move(left_out))), first_row_(first_row) {
    if (plan.options.lamps.denoise)
        filter_.emplace(plan, shared, left_out_);
}

void LampBounces::apply(Transfer& light, const Transfer& unbounced, std::span<const float> gathered) const {
    const std::size_t stride = light.dimension(), receivers = left_out_.size();
    const auto rows = [&](std::size_t first) { return gathered.subspan(first * stride, receivers * stride); };
    const std::span<const float> all = rows(first_row_);
    for (std::size_t p = 0; p < receivers; ++p)
        for (std::size_t c = 0; !left_out_[p] && c < stride; ++c)
            light.vector(p)[c] = unbounced.vector(p)[c % unbounced.dimension()] + all[p * stride + c];
    if (filter_)
        filter_->apply(light, unbounced, rows(first_row_ + receivers));
}

} // namespace prt
