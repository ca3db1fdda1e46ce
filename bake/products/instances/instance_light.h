#pragma once

// Light of a scene in which instances are represented by samples.

#include "bake/products/instances/instance_fit.h"
#include "bake/products/instances/instance_receivers.h"
#include "bake/products/instances/uniform_bound.h"
#include "bake/scene/refill.h"
#include "bake/trace/gather.h"
#include "prt/core/sh_rotation.h"

#include <optional>
#include <vector>

namespace prt {

/// Rotates a vector of one or several channels with `count` coefficients each.
void rotate_all(const ShRotation& rotation, std::size_t count, std::span<const float> from,
                std::span<float> to);

/// Tracers of the flat scene.
struct InstanceTracers {
    Tracer& own;     ///< for surfaces that are drawn once
    Tracer& samples; ///< for samples of instances, by rays
};

/// Traces light, bounces it, and fits the factors of instances.
class InstanceLight {
public:
    /// Keeps references to all arguments except `receivers` and `options`.
    InstanceLight(const BakePlan& plan, const InstanceTracers& tracers,
                  const std::vector<SharedMeshBake>& meshes, InstanceReceivers receivers,
                  const InstanceBakeOptions& options);

    /// Traces direct light of surfaces that are drawn once, and of the samples.
    void trace(const Progress& progress);
    /// Fits the instances, and bounces light as often as the plan requires, with a new fit after each bounce.
    void bounce(const Progress& progress);
    /// Replaces the written light of surfaces that are drawn once by one fitted to samples between vertices.
    void fit_own(const Progress& progress);

    const InstanceReceivers& receivers() const { return receivers_; }
    /// Exit transfer of receivers().own, with fronts as they are stored in files.
    Transfer own_fronts(int direct_channels) const;
    const std::vector<InstanceFactors>& factors() const { return result_.factors; } ///< factors in world axes
    const std::vector<double>& errors() const { return result_.errors; }
    std::size_t rays() const { return result_.rays; }
    /// Number of rays of a receiver of a mesh; the mean with a target error.
    int rays_per_receiver() const;
    /// Relative L2 noise of direct light on surfaces that are drawn once; 0: not measured.
    double sampling_error() const { return result_.sampling_error; }
    int bounces() const { return result_.bounces; }
    /// Number of instances whose rays hit nothing except the instance itself.
    std::size_t alone() const;

private:
    struct Group {
        std::size_t mesh;
        glm::dvec3 up; ///< up direction of the world in the mesh's frame
        std::vector<std::size_t> instances;
    };
    void make_groups();
    void trace_own(const Progress& progress);
    void trace_own(std::span<const std::uint32_t> receivers, std::uint32_t rays, const Progress& progress);
    void trace_own_adaptively(const Progress& progress);
    void trace_samples(const Progress& progress);
    void trace_samples(std::span<const std::uint32_t> receivers, int rays, bool again,
                       const Progress& progress);
    void take_light(std::size_t sample, bool again, std::span<const float> light, std::size_t first);
    void find_sealed_in(const Progress& progress);
    void gather_light();
    template <class Take>
    void gather_rows(std::size_t first, std::size_t rows, const Take& take);
    double take_own();
    void begin_bounces();
    void leave_own();
    void refill_direct();
    void fit(std::size_t step, bool gives);
    void bound_as_stored(const std::vector<UniformBound>& bounds);
    void fit_one(const InstanceFit& fit, const UniformBound& bound, std::size_t instance);
    double error_of(const InstanceFit& fit, const SharedTransfer& shared, std::size_t instance) const;
    InstanceFit::Targets targets_of(std::size_t instance, const std::vector<bool>& left_out) const;
    std::vector<bool> left_out_of(std::size_t instance) const;
    void expand(const SharedTransfer& shared, std::span<const glm::vec3> positions,
                std::span<const std::size_t> instances);
    std::span<float> exit_of(std::size_t receiver) {
        return std::span(bounce_.exit).subspan(receiver * sizes_.stride, sizes_.stride);
    }

    struct Sizes {
        std::size_t count, stride, dimension; ///< number of coefficients; length of bounced light; length of
                                              ///< a target
    };
    /// Light on surfaces that are drawn once.
    struct Own {
        std::vector<float> direct; ///< [own][count]
        std::vector<float>
            scattered;               ///< [own][stride] direct light after media scattered it; empty: no media
        std::vector<float> indirect; ///< [own][stride]
        std::vector<float> next;     ///< [own][stride] next bounce
    };
    struct Samples {
        std::vector<float> light;          ///< [samples][dimension] light in the mesh's frame
        std::vector<float> differences;    ///< differences of repeated traces, see InstanceFit::Noise
        std::vector<bool> left_out;        ///< [samples] true if the sample is sealed in
        std::vector<char> may_be_sealed;   ///< [samples] true if its own rays indicate that it is sealed in
        std::vector<char> met;             ///< [instances] true if a ray hit something else
        std::vector<ShRotation> into_mesh; ///< [instances] rotation into the mesh's frame
    };
    struct Bounce {
        Refill refill;
        std::optional<GatherOperator> gather; ///< rows: own receivers, samples, repeated samples
        std::vector<float> last;              ///< `exit` before the last bounce, for fit_own
        std::vector<float> exit;              ///< [receivers][stride] if light bounces or media scatter it
        std::vector<const DiffusionOperator*> media; ///< of surfaces that are drawn once
    };
    struct Result {
        std::vector<InstanceFactors> factors;
        std::vector<double> errors;
        std::size_t rays = 0;
        double sampling_error = 0;
        int bounces = 0;
    };

    const BakePlan& plan_;
    InstanceTracers tracers_;
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
