#pragma once

// Fits the light of surfaces that are drawn once, in a scene of instances, to samples between their vertices.

#include "bake/pipeline/direct_transfer.h"
#include "bake/products/instances/instance_receivers.h"

#include <memory>
#include <vector>

namespace prt {

/// Exit transfer on both sides of surfaces, fitted to samples of `measured` light of `plan`. `direct`: light
/// without a bounce, one channel.
struct FittedTransfer {
    Transfer direct, all;
};
/// Fits all light of a plan, if it is propagated by its own receivers.
FittedTransfer fitted_transfer(const BakePlan& plan, const Measured& measured, const Progress& progress);

/// Light of surfaces that are drawn once at samples between vertices. References to the plan remain.
class OwnFit {
public:
    /// Traces the samples. `plan`: the flat scene; `receivers`: the receivers that are drawn once.
    OwnFit(const BakePlan& plan, Tracer& tracer, const InstanceReceivers& receivers,
           const Progress& progress);

    /// Fits receivers that are drawn once; the others are zero. `exit`: exit transfer of all receivers before
    /// the last bounce, [receivers][channels][order²]; empty: no bounces. `media`: operators of media on
    /// these surfaces.
    FittedTransfer light(std::vector<float> exit, std::span<const DiffusionOperator* const> media,
                         const Progress& progress) const;
    std::size_t rays() const;
    double sampling_error() const { return measured_.direct.sampling_error; }

private:
    BakePlan plan_; ///< the plan of the flat scene with receivers that are drawn once
    BakeStatistics asked_;
    Measured measured_;
};

} // namespace prt
