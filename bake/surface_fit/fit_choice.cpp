// Compares interpolation between vertices with rays from points between them.

#include "bake/surface_fit/fit_choice.h"

#include "bake/surface_fit/surface_samples.h"
#include "bake/surface_fit/varied_samples.h"
#include "bake/trace/scrambles.h"
#include "bake/trace/sealed.h"
#include "bake/trace/trace_receivers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

/// One test point per kReceiversPerPoint receivers, within these limits.
constexpr std::size_t kReceiversPerPoint = 100, kMinTestPoints = 16, kMaxTestPoints = 256;
/// All vertices first trace this share of their rays, with a maximum.
constexpr int kShareOfFirstLook = 32, kMaxFirstRays = 64;
/// Maximum rays of a half: more rays would give no additional information.
constexpr int kMaxHalfRays = 4096;

/// Light at receivers from two independent scrambles with half of a receiver's rays each.
struct Halves {
    Transfer first, second;
};

class Trial {
public:
    Trial(const BakePlan& plan, Tracer& tracer, const Progress& progress)
        : plan_(plan), tracer_(tracer), progress_(progress), samples_(points()) {}

    FitTrial run() {
        const Receivers& vertices = plan_.transport->measured();
        std::vector<std::uint32_t> corners, all(samples_.size());
        std::iota(all.begin(), all.end(), 0u);
        for (const SamplePosition& position : samples_.positions)
            for (int i = 0; i < 3; ++i)
                if (const std::uint32_t p = corners_of(position)[i]; p != kNoReceiver)
                    corners.push_back(p);
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        const Halves at_points = trace(samples_.receivers, all), at_vertices = trace(vertices, corners);
        const std::vector<bool> sealed_points = sealed(samples_.receivers, all, at_points),
                                sealed_vertices = sealed(vertices, corners, at_vertices);
        double second_differences = 0, noise = 0, norm = 0;
        for (std::uint32_t s = 0; s < samples_.size(); ++s) {
            const glm::uvec3 c = corners_of(samples_.positions[s]);
            bool tells = !sealed_points[s];
            for (int i = 0; i < 3; ++i)
                tells = tells && c[i] != kNoReceiver && !sealed_vertices[c[i]];
            if (!tells)
                continue;
            const std::span<const float> a = at_points.first.vector(s), b = at_points.second.vector(s);
            const auto weight = static_cast<double>(samples_.receivers.areas[s]);
            second_differences +=
                weight * product(missing(at_vertices.first, c, s, a), missing(at_vertices.second, c, s, b));
            noise += weight * squared_distance(a, b) / 2;
            norm += weight * product(a, b);
        }
        if (norm > 0) {
            result_.between = std::sqrt(std::max(0.0, second_differences) / norm);
            // The squared noise of nets of n rays falls as n^-1.5.
            const double times = static_cast<double>(plan_.options.rays) / rays_of_half();
            result_.sampling = std::sqrt(noise * std::pow(times, -1.5) / norm);
        }
        return result_;
    }

private:
    /// Share of a uniform sky that arrives at vertices, measured with few rays.
    std::vector<float> first_look() {
        const std::vector<std::uint32_t> indices = receivers_on_surfaces(plan_.receivers());
        const TraceOptions options{.order = 1,
                                   .rays =
                                       std::clamp(plan_.options.rays / kShareOfFirstLook, 1, kMaxFirstRays),
                                   .seed = plan_.options.seed + 4 * kSecondScramble};
        Transfer light = zero_transfer(1, 1, plan_.receivers().size());
        trace_receivers(tracer_, plan_.transport->measured(), indices, options, light, {{}, progress_.stop});
        result_.rays += indices.size() * static_cast<std::size_t>(options.rays);
        return std::move(light.vectors);
    }

    SurfaceSamples points() {
        const std::size_t count =
            std::clamp(plan_.receivers().size() / kReceiversPerPoint, kMinTestPoints, kMaxTestPoints);
        const std::vector<float> light = first_look();
        return sample_varied(plan_.scene.surfaces(), *plan_.transport, {light},
                             {.count = count, .seed = plan_.options.seed + 1});
    }

    glm::uvec3 corners_of(const SamplePosition& position) const {
        return corner_receivers(plan_.scene.surfaces(), *plan_.transport, position.triangle, position.back);
    }

    int rays_of_half() const { return std::clamp(plan_.options.rays / 2, 1, kMaxHalfRays); }

    Halves trace(const Receivers& receivers, std::span<const std::uint32_t> indices) {
        TraceOptions options{.order = plan_.options.order,
                             .rays = rays_of_half(),
                             .seed = plan_.options.seed + 5 * kSecondScramble};
        Halves halves{zero_transfer(options.order, 1, receivers.size()),
                      zero_transfer(options.order, 1, receivers.size())};
        trace_receivers(tracer_, receivers, indices, options, halves.first, {{}, progress_.stop});
        options.seed += kSecondScramble;
        trace_receivers(tracer_, receivers, indices, options, halves.second, {{}, progress_.stop});
        result_.rays += 2 * indices.size() * static_cast<std::size_t>(options.rays);
        return halves;
    }

    std::vector<bool> sealed(const Receivers& receivers, std::span<const std::uint32_t> indices,
                             const Halves& light) {
        std::vector<std::uint32_t> dark;
        for (const std::uint32_t p : indices)
            if (light.first.vector(p)[0] <= 0 && light.second.vector(p)[0] <= 0)
                dark.push_back(p);
        const Sealed found = find_sealed(tracer_, plan_.traced().scene, receivers, std::move(dark),
                                         plan_.options.seed, progress_.stop);
        result_.rays += found.rays;
        return found.receivers;
    }

    /// Difference between the interpolation of vertices `c` and the light `here` at point `s`.
    std::vector<float> missing(const Transfer& vertices, const glm::uvec3& c, std::uint32_t s,
                               std::span<const float> here) const {
        std::vector<float> difference = interpolated(vertices, c, samples_.positions[s]);
        for (std::size_t k = 0; k < here.size(); ++k)
            difference[k] -= here[k];
        return difference;
    }

    const BakePlan& plan_;
    Tracer& tracer_;
    const Progress& progress_;
    FitTrial result_;
    SurfaceSamples samples_;
};

} // namespace

FitTrial try_fit(const BakePlan& plan, Tracer& tracer, const Progress& progress) {
    return Trial(plan, tracer, progress).run();
}

FitChoice choose_fit(const FitTrial& trial, int rays, bool filtered) {
    // Measured on nine scenes: the best fit has 0.7 of the interpolation error, and a fit of few samples has
    // more. The noise of rays falls faster than the number of samples grows (n^-1.5 against n^-1), and
    // between vertices half of its square remains, or an eighth if it is filtered.
    constexpr double kBestFit = 0.5, kOfFewSamples = 0.6, kNoise = 0.75, kVertexNoise = 0.5,
                     kFiltered = 0.125;
    constexpr double kNothing = 1e-3;               // invisible
    constexpr int kMaxSamples = 16, kMinRays = 128; // rays per sample: fewer rays take longer
    const double between = trial.between * trial.between, noise = trial.sampling * trial.sampling;
    FitChoice best;
    double least = 0;
    for (int samples = 2; samples <= kMaxSamples; samples *= 2) {
        const double error =
            kBestFit * between * (1 + kOfFewSamples / samples) + kNoise * std::sqrt(samples) * noise;
        if (samples > 2 && (rays / samples < kMinRays || error >= least))
            break;
        best.samples = samples;
        least = error;
    }
    best.better = trial.between > kNothing && least < between + (filtered ? kFiltered : kVertexNoise) * noise;
    return best;
}

} // namespace prt
