#include "adaptive.h"

#include "prt/sh_basis.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace prt {
namespace {

constexpr int kFirstRays = 64; ///< of each of the two scrambles
constexpr std::uint32_t kMostRaysEach = kMostRays / 2;
constexpr std::uint64_t kSecondScramble = 0x9e3779b97f4a7c15;
/// The squared error of a scrambled net falls as n^-1.5 where visibility has edges (measured: n^-1.4 to
/// n^-1.6 on the knot and the bunny); doubling leaves this share.
const double kAfterDoubling = std::pow(2.0, -1.5);

double squared_distance(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        sum += static_cast<double>((a[k] - b[k]) * (a[k] - b[k]));
    return sum;
}

double squared_norm(std::span<const float> a) {
    double sum = 0;
    for (const float v : a)
        sum += static_cast<double>(v * v);
    return sum;
}

class AdaptiveSampler {
public:
    AdaptiveSampler(Tracer& tracer, const Receivers& receivers, const MeshNeighbours& neighbours,
                    const TraceOptions& options)
        : tracer_(tracer), receivers_(receivers), neighbours_(neighbours), options_(options),
          indices_(receivers_on_surfaces(receivers)), rays_(receivers.size(), 0),
          error_(receivers.size(), 0) {
        for (Transfer* t : {&first_, &second_, &added_}) {
            *t = {options.order, 1, {}};
            t->vectors.resize(receivers.size() * t->dimension());
        }
    }

    AdaptiveResult run(double target, const Progress& progress) {
        extend(indices_);
        AdaptiveResult result;
        double start = 0;
        for (;;) {
            result.error = estimate();
            result.reached = result.error <= target;
            if (start == 0)
                start = result.error;
            if (result.reached)
                break;
            const std::vector<std::uint32_t> chosen = choose(target);
            if (chosen.empty()) // all have as many rays as can be
                break;
            progress.update(
                start > target
                    ? std::clamp(std::log(start / result.error) / std::log(start / target), 0.0, 1.0)
                    : 0.0);
            stop_ = {{}, progress.stop};
            extend(chosen);
        }
        result.transfer = first_;
        for (std::size_t i = 0; i < first_.vectors.size(); ++i)
            result.transfer.vectors[i] = 0.5f * (first_.vectors[i] + second_.vectors[i]);
        for (const std::uint32_t n : rays_)
            result.rays.push_back(2 * n);
        progress.update(1);
        return result;
    }

private:
    /// Doubles the rays of `chosen` (from none: kFirstRays).
    void extend(std::span<const std::uint32_t> chosen) {
        std::map<std::uint32_t, std::vector<std::uint32_t>> by_rays;
        for (const std::uint32_t p : chosen)
            by_rays[rays_[p]].push_back(p);
        for (const auto& [rays, members] : by_rays) {
            TraceOptions options = options_;
            options.first_ray = rays;
            options.rays = rays == 0 ? kFirstRays : static_cast<int>(rays);
            for (Transfer* scramble : {&first_, &second_}) {
                options.seed = options_.seed + (scramble == &second_ ? kSecondScramble : 0);
                trace_receivers(tracer_, receivers_, members, options, added_, stop_);
                const float kept = rays == 0 ? 0.0f : 0.5f;
                for (const std::uint32_t p : members)
                    for (std::size_t k = 0; k < added_.dimension(); ++k) {
                        float& value = scramble->vector(p)[k];
                        value = kept * value + (1 - kept) * added_.vector(p)[k];
                    }
            }
            for (const std::uint32_t p : members) {
                rays_[p] = rays == 0 ? kFirstRays : 2 * rays;
                error_[p] = 0.25 * squared_distance(first_.vector(p), second_.vector(p));
            }
        }
    }

    double estimate() {
        double error = 0;
        norm_ = 0;
        for (const std::uint32_t p : indices_) {
            error += area(p) * error_[p];
            norm_ += area(p) * squared_norm(first_.vector(p));
        }
        return norm_ > 0 ? std::sqrt(error / norm_) : 0;
    }

    /// Squared error of a receiver: the mean over it and its neighbours, scaled to its number of rays. Of
    /// itself alone, receivers whose two samples happen to agree would be left with too few rays.
    double smoothed_error(std::uint32_t p) const {
        double sum = error_[p];
        int count = 1;
        for (const std::uint32_t q : neighbours_.of(p))
            if (rays_[q] > 0) {
                sum += error_[q] * std::pow(static_cast<double>(rays_[q]) / rays_[p], 1.5);
                ++count;
            }
        return sum / count;
    }

    /// Receivers to double: those with the most error per ray, until what is expected to remain is below the
    /// target. At most half of the error is taken on at a time, as estimates get better with rays.
    std::vector<std::uint32_t> choose(double target) const {
        struct Candidate {
            double error, gain_per_ray;
            std::uint32_t receiver;
        };
        std::vector<Candidate> candidates;
        double error = 0;
        for (const std::uint32_t p : indices_) {
            const double mine = area(p) * smoothed_error(p);
            error += mine;
            if (mine > 0 && rays_[p] < kMostRaysEach)
                candidates.push_back({mine, mine / rays_[p], p});
        }
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            return a.gain_per_ray != b.gain_per_ray ? a.gain_per_ray > b.gain_per_ray
                                                    : a.receiver < b.receiver;
        });
        const double wanted = std::max(target * target * norm_, 0.5 * error);
        std::vector<std::uint32_t> chosen;
        for (const Candidate& candidate : candidates) {
            if (error <= wanted && !chosen.empty())
                break;
            error -= (1 - kAfterDoubling) * candidate.error;
            chosen.push_back(candidate.receiver);
        }
        std::sort(chosen.begin(), chosen.end());
        return chosen;
    }

    double area(std::uint32_t p) const { return static_cast<double>(receivers_.areas[p]); }

    Tracer& tracer_;
    const Receivers& receivers_;
    const MeshNeighbours& neighbours_;
    TraceOptions options_;
    std::vector<std::uint32_t> indices_;
    Transfer first_, second_, added_;
    std::vector<std::uint32_t> rays_; ///< of each scramble
    std::vector<double> error_;       ///< squared, of the mean of both
    double norm_ = 0;
    Progress stop_; ///< to stop in the middle of a round
};

} // namespace

AdaptiveResult adaptive_transfer(Tracer& tracer, const Receivers& receivers, const MeshNeighbours& neighbours,
                                 const TraceOptions& options, double target, const Progress& progress) {
    return AdaptiveSampler(tracer, receivers, neighbours, options).run(target, progress);
}

double sampling_error(Tracer& tracer, const Receivers& receivers, const TraceOptions& options,
                      const Transfer& transfer, std::size_t& rays, const Progress& progress) {
    const std::vector<std::uint32_t> all = receivers_on_surfaces(receivers);
    const std::size_t wanted = std::clamp<std::size_t>(all.size() / 64, 32, 512);
    const std::size_t step = std::max<std::size_t>(1, all.size() / wanted);
    std::vector<std::uint32_t> some;
    for (std::size_t i = step / 2; i < all.size(); i += step)
        some.push_back(all[i]);
    TraceOptions other = options;
    other.seed += kSecondScramble;
    Transfer again{options.order, 1, {}};
    again.vectors.resize(transfer.vectors.size());
    trace_receivers(tracer, receivers, some, other, again, {{}, progress.stop});
    rays += some.size() * static_cast<std::size_t>(options.rays);
    double error = 0, norm = 0;
    for (const std::uint32_t p : some) {
        const auto area = static_cast<double>(receivers.areas[p]);
        error += area * squared_distance(transfer.vector(p), again.vector(p)) / 2; // both have the error
        norm += area * squared_norm(transfer.vector(p));
    }
    return norm > 0 ? std::sqrt(error / norm) : 0;
}

} // namespace prt
