#pragma once

// Light of a scene whose instances are known by samples.

#include "instances/instance_fit.h"
#include "instances/instance_receivers.h"
#include "instances/uniform_bound.h"
#include "prt/sh_rotation.h"
#include "scene/refill.h"
#include "transport/gather.h"

#include <optional>
#include <vector>

namespace prt {

/// Traces, bounces and fits.
class InstanceLight {
public:
    /// Keeps references to what it is made of.
    InstanceLight(const BakePlan& plan, Tracer& tracer, const std::vector<SharedMeshBake>& meshes,
                  InstanceReceivers receivers, const InstanceBakeOptions& options);

    /// Direct light of what is drawn once, and of the samples.
    void trace(const Progress& progress);
    /// Fits the instances, and bounces light as often as the plan says, with a new fit each time.
    void bounce(const Progress& progress);

    const InstanceReceivers& receivers() const { return receivers_; }
    /// Exit transfer of receivers().own, of which fronts are as files have them.
    Transfer own_fronts(int direct_channels) const;
    const std::vector<InstanceFactors>& factors() const { return result_.factors; } ///< in axes of the world
    const std::vector<double>& errors() const { return result_.errors; }
    std::size_t rays() const { return result_.rays; }
    int bounces() const { return result_.bounces; }
    std::size_t alone() const;

private:
    struct Group {
        std::size_t mesh;
        glm::dvec3 up; ///< of the world, in the mesh's frame
        std::vector<std::size_t> instances;
    };
    void make_groups();
    void trace_own(const Progress& progress);
    void trace_samples(const Progress& progress);
    void trace_samples(std::span<const std::uint32_t> receivers, int rays, bool again,
                       const Progress& progress);
    void take_light(std::size_t sample, bool again, std::span<const float> light, std::size_t first);
    void find_sealed_in(const Progress& progress);
    void gather_light();
    template <class Take>
    void gather_rows(std::size_t first, std::size_t rows, const Take& take);
    double take_own();
    void fit(std::size_t step, bool gives);
    void bound_as_stored(const std::vector<UniformBound>& bounds);
    void fit_one(const InstanceFit& fit, const UniformBound& bound, std::size_t instance);
    double error_of(const InstanceFit& fit, const SharedTransfer& shared, std::size_t instance) const;
    InstanceFit::Targets targets_of(std::size_t instance, const std::vector<bool>& left_out) const;
    std::vector<bool> left_out_of(std::size_t instance) const;
    void expand(const SharedTransfer& shared, std::span<const glm::vec3> places,
                std::span<const std::size_t> instances);
    std::span<float> exit_of(std::size_t receiver) {
        return std::span(bounce_.exit).subspan(receiver * sizes_.stride, sizes_.stride);
    }

    struct Sizes {
        std::size_t count, stride, dimension; ///< coefficients; of light that bounces; of a target
    };
    /// Of what is drawn once: [own][count], [own][stride], and the same while others still read it.
    struct Own {
        std::vector<float> direct, indirect, next;
    };
    struct Samples {
        std::vector<float> light;          ///< [samples][dimension], in the mesh's frame
        std::vector<float> differences;    ///< of every so many samples, as InstanceFit::Noise
        std::vector<bool> left_out;        ///< [samples] sealed in
        std::vector<char> may_be_sealed;   ///< [samples] by what their own rays met
        std::vector<char> met;             ///< [instances] a ray met something else
        std::vector<ShRotation> into_mesh; ///< [instances]
    };
    struct Bounce {
        Refill refill;
        std::optional<GatherOperator> gather; ///< rows: own, samples, the noisy again
        std::vector<float> exit;              ///< [receivers][stride] where light bounces
    };
    struct Result {
        std::vector<InstanceFactors> factors;
        std::vector<double> errors;
        std::size_t rays = 0;
        int bounces = 0;
    };

    const BakePlan& plan_;
    Tracer& tracer_;
    const std::vector<SharedMeshBake>& meshes_;
    InstanceReceivers receivers_;
    InstanceBakeOptions options_;
    Sizes sizes_;
    std::vector<Group> groups_;
    Own own_;
    Samples samples_;
    Bounce bounce_;
    Result result_;
};

} // namespace prt
