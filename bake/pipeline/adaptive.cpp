// Distributes rays to the receivers where they are most effective (docs/math.md, section 9). Two scrambles
// with few rays predict the error; a sample of the receivers measures the error that was reached.

#include "bake/pipeline/adaptive.h"

#include "bake/trace/scrambles.h"
#include "bake/trace/trace_receivers.h"
#include "prt/bake/bake.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

namespace prt {
namespace {

constexpr std::uint32_t kFirstRays = 32;       ///< rays of each of the two initial scrambles
constexpr std::size_t kCheckedReceivers = 128; ///< number of receivers that are sampled again to measure the
                                               ///< error
/// Number of receivers that look dark and are traced again with many rays, and their rays.
constexpr std::size_t kCheckedDark = 512, kDarkRays = 4096;
/// Exponent of the squared error over the number of rays. A scrambled net has n^-1.5 where visibility has
/// edges: measured n^-1.52 on the knot between 1 024 and 2 048 rays.
constexpr double kExponent = 1.5;

class AdaptiveSampler {
public:
    AdaptiveSampler(Tracer& tracer, const Receivers& receivers, std::span<const float> left,
                    const TraceOptions& options, const Progress& progress)
        : tracer_(tracer), receivers_(receivers), left_(left), options_(options), progress_(progress),
          indices_(receivers_on_surfaces(receivers)), rays_(receivers.size(), 0),
          planned_(receivers.size(), 0),
          error_(receivers.size(), 0), light_{empty_transfer(), empty_transfer()} {}

    AdaptiveResult run(const MeshNeighbours& neighbours, double target) {
        estimate_errors(neighbours);
        AdaptiveResult result;
        double correction = 1; // measured squared error over the squared error that the first rays predict
        for (double share = 0;; share = 0.5 * (1 + share)) {
            const bool enough = plan(target * target * squares_.norm / correction);
            progress_.update(share);
            extend();
            correction = check(result.rays_checked);
            result.error = squares_.norm > 0 ? std::sqrt(correction * squares_.predicted / squares_.norm) : 0;
            result.reached = result.error <= target;
            if (result.reached || !enough)
                break;
        }
        result.transfer = std::move(light_.all);
        result.half = std::move(light_.first_half);
        result.rays = rays_;
        result.rays_checked += kFirstRays * indices_.size() + rays_on_dark_; // rays of the second scramble
        progress_.update(1);
        return result;
    }

private:
    /// Traces receivers; can also stop in the middle of a round.
    void trace(std::span<const std::uint32_t> indices, const TraceOptions& options, Transfer& transfer) {
        trace_receivers(tracer_, receivers_, indices, options, transfer, {{}, progress_.stop});
    }

    Transfer empty_transfer() const { return zero_transfer(options_.order, 1, receivers_.size()); }

    double area(std::uint32_t p) const { return static_cast<double>(receivers_.areas[p]); }

    /// Contribution of a receiver to the squared error with `rays`, predicted from the first rays.
    double predicted(std::uint32_t p, std::uint32_t rays) const {
        return area(p) * static_cast<double>(left_[p]) * error_[p] *
               std::pow(static_cast<double>(rays) / kFirstRays, -kExponent);
    }

    /// Estimates the error of each receiver from two independent scrambles with few rays. The estimate is a
    /// mean over the receiver and its neighbours: single receivers may agree by chance and would get too few
    /// rays.
    void estimate_errors(const MeshNeighbours& neighbours) {
        TraceOptions options = options_;
        options.rays = static_cast<int>(kFirstRays);
        trace_in_halves(tracer_, receivers_, indices_, options, {light_.all, light_.first_half},
                        {{}, progress_.stop});
        options.seed += kSecondScramble;
        Transfer second = empty_transfer();
        trace(indices_, options, second);
        std::vector<double> own(receivers_.size(), 0);
        for (const std::uint32_t p : indices_) {
            rays_[p] = planned_[p] = kFirstRays;
            own[p] = 0.5 * squared_distance(light_.all.vector(p), second.vector(p));
            squares_.norm +=
                area(p) * product(light_.all.vector(p), second.vector(p)); // independent, so that
                                                                           // their noise cancels
        }
        add_missed_light(second, own);
        for (const std::uint32_t p : indices_) {
            double sum = own[p];
            int count = 1;
            for (const std::uint32_t q : neighbours.of(p))
                if (rays_[q] > 0) {
                    sum += own[q];
                    ++count;
                }
            error_[p] = sum / count;
        }
    }

    /// Adds the light that dark receivers may have missed to `errors` [receivers]. Receivers that no light
    /// reached in either scramble agree on darkness, and in a room with a small window all of them are wrong.
    /// Some of them are traced with many rays; their mean is the estimate for the others.
    void add_missed_light(const Transfer& second, std::vector<double>& errors) {
        std::vector<std::uint32_t> dark;
        for (const std::uint32_t p : indices_)
            if (squared_norm(light_.all.vector(p)) + squared_norm(second.vector(p)) == 0)
                dark.push_back(p);
        std::vector<std::uint32_t> some;
        const std::size_t count = std::min(kCheckedDark, dark.size());
        for (std::size_t i = 0; i < count; ++i)
            some.push_back(dark[i * dark.size() / count]);
        TraceOptions options = options_;
        options.rays = static_cast<int>(kDarkRays);
        options.seed += 3 * kSecondScramble;
        Transfer light = empty_transfer();
        trace(some, options, light);
        rays_on_dark_ = some.size() * kDarkRays;
        double missed = 0, areas = 0;
        for (const std::uint32_t p : some) {
            missed += area(p) * squared_norm(light.vector(p));
            areas += area(p);
        }
        double dark_norm = 0; // if almost nothing is lit, the first rays do not determine the norm
        for (const std::uint32_t p : dark) {
            errors[p] = missed > 0 ? missed / areas : 0;
            dark_norm += area(p) * errors[p];
        }
        squares_.norm = std::max(squares_.norm, dark_norm);
    }

    /// Doubles planned rays until the predicted squared error is at most `wanted`, first for the receivers
    /// where this lowers the error by the largest amount per ray. Uses only powers of two: nets of other
    /// sizes are uneven and have larger errors. Returns false if all receivers have the maximum number of
    /// rays.
    bool plan(double wanted) {
        struct Candidate {
            double gain_per_ray;
            std::uint32_t receiver;
            bool operator<(const Candidate& other) const {
                return gain_per_ray != other.gain_per_ray ? gain_per_ray < other.gain_per_ray
                                                          : receiver > other.receiver;
            }
        };
        const auto candidate = [&](std::uint32_t p) {
            return Candidate{(predicted(p, planned_[p]) - predicted(p, 2 * planned_[p])) / planned_[p], p};
        };
        squares_.predicted = 0;
        std::priority_queue<Candidate> queue;
        for (const std::uint32_t p : indices_) {
            squares_.predicted += predicted(p, planned_[p]);
            if (error_[p] > 0 && planned_[p] < static_cast<std::uint32_t>(kMaxRays))
                queue.push(candidate(p));
        }
        while (squares_.predicted > wanted && !queue.empty()) {
            const Candidate best = queue.top();
            queue.pop();
            const std::uint32_t p = best.receiver;
            squares_.predicted -= best.gain_per_ray * planned_[p];
            planned_[p] *= 2;
            if (planned_[p] < static_cast<std::uint32_t>(kMaxRays))
                queue.push(candidate(p));
        }
        return squares_.predicted <= wanted;
    }

    /// Traces the sequences up to the planned number of rays.
    void extend() {
        Transfer added = empty_transfer();
        for (std::uint32_t rays = kFirstRays; rays < static_cast<std::uint32_t>(kMaxRays); rays *= 2) {
            std::vector<std::uint32_t> members;
            for (const std::uint32_t p : indices_)
                if (rays_[p] == rays && planned_[p] > rays)
                    members.push_back(p);
            TraceOptions options = options_;
            options.first_ray = rays;
            options.rays = static_cast<int>(rays);
            trace(members, options, added);
            for (const std::uint32_t p : members) {
                std::ranges::copy(light_.all.vector(p), light_.first_half.vector(p).begin());
                for (std::size_t k = 0; k < added.dimension(); ++k)
                    light_.all.vector(p)[k] = 0.5f * (light_.all.vector(p)[k] + added.vector(p)[k]);
                rays_[p] = 2 * rays;
            }
        }
    }

    /// Samples some receivers again with an independent scramble, chosen by their predicted contribution to
    /// the error. Returns the mean of the squared error over its prediction.
    double check(std::size_t& rays_checked) {
        std::map<std::uint32_t, std::vector<std::uint32_t>> by_rays;
        const double step = squares_.predicted / kCheckedReceivers;
        double sum = 0, next = 0.5 * step;
        for (const std::uint32_t p : indices_) {
            sum += predicted(p, rays_[p]);
            if (sum <= next || step <= 0)
                continue;
            by_rays[rays_[p]].push_back(p);
            while (next < sum)
                next += step;
        }
        Transfer again = empty_transfer();
        double ratios = 0;
        std::size_t count = 0;
        for (const auto& [rays, members] : by_rays) {
            TraceOptions options = options_;
            options.rays = static_cast<int>(rays);
            options.seed += 2 * kSecondScramble;
            trace(members, options, again);
            rays_checked += rays * members.size();
            for (const std::uint32_t p : members)
                ratios += 0.5 * area(p) * static_cast<double>(left_[p]) *
                          squared_distance(light_.all.vector(p), again.vector(p)) / predicted(p, rays);
            count += members.size();
        }
        return count > 0 ? ratios / static_cast<double>(count) : 1;
    }

    Tracer& tracer_;
    const Receivers& receivers_;
    std::span<const float> left_; ///< [receivers] factor on squared errors
    TraceOptions options_;
    const Progress& progress_;
    std::vector<std::uint32_t> indices_;
    std::vector<std::uint32_t> rays_, planned_; ///< [receivers]
    std::vector<double> error_;                 ///< [receivers] squared error, predicted for kFirstRays
    struct Squares {
        double norm = 0, predicted = 0;
        /// Sums weighted by area.
    };
    Squares squares_;
    std::size_t rays_on_dark_ = 0;
    struct Light {
        Transfer all, first_half; ///< light from all rays, and from the first half of them
    } light_;
};

} // namespace

AdaptiveResult adaptive_transfer(Tracer& tracer, const Receivers& receivers, const MeshNeighbours& neighbours,
                                 std::span<const float> left, const TraceOptions& options, double target,
                                 const Progress& progress) {
    return AdaptiveSampler(tracer, receivers, left, options, progress).run(neighbours, target);
}

} // namespace prt
