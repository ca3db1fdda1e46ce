// Records the options of a bake, and selects the smallest storage format that its noise permits.

#include "bake/pipeline/record.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"

#include <fmt/core.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Number of receivers of the scene that rays were traced from.
std::size_t traced_fronts(const BakePlan& plan) {
    const std::vector<std::uint32_t> indices = receivers_on_surfaces(plan.receivers());
    return static_cast<std::size_t>(std::lower_bound(indices.begin(), indices.end(), plan.transport->fronts) -
                                    indices.begin());
}

/// Returns all notices in the order in which they occurred.
std::vector<std::string> notices_of(const BakePlan& plan, const DirectLight& direct, const SealedIn& sealed,
                                    const Propagated& exit) {
    std::vector<std::string> notices = plan.notices;
    notices.insert(notices.end(), direct.notices.begin(), direct.notices.end());
    const std::size_t refilled = sealed.refill.size(plan.transport->fronts);
    if (!sealed.receivers.empty())
        notices.push_back(fmt::format("{} inside solid geometry; {} from neighbours{}",
                                      counted(sealed.receivers.size(), "vertex is", "vertices are"),
                                      counted(refilled, "is filled", "are filled"),
                                      refilled < sealed.receivers.size() ? ", the others stay dark" : ""));
    if (!exit.converged)
        notices.push_back(
            fmt::format("the sum over all bounces has not converged: it changes by {:.2g} after {}",
                        exit.remaining, counted(exit.bounces, "step")));
    return notices;
}

BakeStatistics statistics_of(const BakePlan& plan, const DirectLight& direct, const SealedIn& sealed,
                             const Propagated& exit) {
    BakeStatistics s;
    const std::size_t fronts = plan.transport->fronts;
    s.receivers = {.all = fronts,
                   .traced = traced_fronts(plan),
                   .back_sides = plan.receivers().size() - fronts,
                   .sealed = sealed.receivers.size(),
                   .refilled = sealed.refill.size(fronts)};
    s.rays = direct.rays + sealed.rays;
    s.mean_visibility = direct.mean_visibility;
    s.sampling_error = direct.sampling_error;
    s.rounding_error = float16_rounding_error(exit.transfer, plan.areas());
    s.remaining_energy = exit.remaining;
    for (const Lamp& lamp : plan.lamps)
        s.lamps = {s.lamps.count + 1, s.lamps.lights + lamp.lights.size(),
                   s.lamps.triangles + lamp.triangles.size()};
    if (direct.gather)
        s.gather = {.entries = direct.gather->entries(), .bytes = direct.gather->bytes()};
    s.notices = notices_of(plan, direct, sealed, exit);
    return s;
}

} // namespace

double float16_rounding_error(const Transfer& transfer, std::span<const float> areas) {
    double error = 0, norm = 0;
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        double point_error = 0, point_norm = 0;
        for (const float value : transfer.vector(p)) {
            const auto lost = static_cast<double>(value - glm::unpackHalf1x16(glm::packHalf1x16(value)));
            point_error += lost * lost;
            point_norm += static_cast<double>(value * value);
        }
        error += static_cast<double>(areas[p]) * point_error;
        norm += static_cast<double>(areas[p]) * point_norm;
    }
    return norm > 0 ? std::sqrt(error / norm) : 0;
}

void check_float16(double rounding_error) {
    if (!std::isfinite(rounding_error))
        throw Error("float16 cannot store coefficients above 65504; store the transfer as float32");
}

TransferStorage storage_for(const std::optional<TransferStorage>& asked, const StorageErrors& errors,
                            std::vector<std::string>& notices) {
    if (asked == TransferStorage::float16)
        check_float16(errors.rounding);
    if (asked)
        return *asked;
    if (!(errors.rounding < 0.1 * errors.sampling))
        return TransferStorage::float32;
    notices.push_back(fmt::format(
        "stored as float16: the rounding error, {:.2g} %, is below a tenth of the sampling error, {:.2g} %",
        100 * errors.rounding, 100 * errors.sampling));
    return TransferStorage::float16;
}

BakeResult record(const BakePlan& plan, const Tracer& tracer, const DirectLight& direct,
                  const SealedIn& sealed, Propagated exit) {
    BakeResult result;
    result.sealed = sealed.receivers;
    result.statistics = statistics_of(plan, direct, sealed, exit);
    result.statistics.device = tracer.device();
    BakedTransfer& baked = result.baked;
    BakeStatistics& s = result.statistics;
    baked.storage = storage_for(plan.options.memory.storage,
                                {.rounding = s.rounding_error, .sampling = s.sampling_error}, s.notices);
    baked.record = {.bounces = exit.bounces,
                    .endless = plan.bounces == kEndlessBounces,
                    .rays = direct.mean_rays,
                    .seed = plan.options.seed,
                    .method = tracer.method(),
                    .backend = tracer.backend(),
                    .receivers = receivers_id(plan.scene.scene()),
                    .sampling_error = direct.sampling_error};
    baked.transfer = std::move(exit.transfer);
    return result;
}

} // namespace prt
