// Finds vertices at one position with different light.

#include "bake/surface_fit/separated_receivers.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// A receiver at a position, with the range of its samples.
struct Member {
    std::uint32_t receiver;
    float low, high; ///< range of a test value
};

/// Finds steps of a test value that exceed its noise.
class Step {
public:
    explicit Step(int rays) : rays_(static_cast<float>(rays)) {}

    /// Returns the number of `members` below the largest step; 0: no step. `members` are sorted by value.
    std::size_t find(std::span<const Member> members) const {
        std::size_t best = 0;
        float widest = 0, high = members[0].high;
        for (std::size_t i = 1; i < members.size(); ++i) {
            if (const float gap = members[i].low - high; gap > widest) {
                widest = gap;
                best = i;
            }
            high = std::max(high, members[i].high);
        }
        return best > 0 && is_step(members.first(best), members.subspan(best)) ? best : 0;
    }

private:
    /// Whether the light of both sides differs by more than its variation on either side, by more than noise,
    /// and visibly. If one side is dark, any light on the other is a step.
    bool is_step(std::span<const Member> below, std::span<const Member> above) const {
        const auto low = [](std::span<const Member> side) {
            return std::ranges::min(side, {}, &Member::low).low;
        };
        const auto high = [](std::span<const Member> side) {
            return std::ranges::max(side, {}, &Member::high).high;
        };
        if (high(below) == 0)
            return low(above) > 0;
        constexpr float kDeviations = 3, kVisible = 0.3f;
        const float gap = low(above) - high(below), most = high(above),
                    noise = std::sqrt(std::clamp(most * (1 - most), 0.0f, 0.25f) / rays_);
        return gap >
               std::max({high(below) - low(below), most - low(above), kDeviations * noise, kVisible * most});
    }

    float rays_;
};

/// Splits the receivers at one position until no test value has a step between them.
class Separation {
public:
    Separation(const ValueRanges& ranges, std::size_t tests, const FitEquations& equations, int rays)
        : ranges_(ranges), tests_(tests), equations_(equations), step_(rays) {}

    void separate(std::span<std::uint32_t> position, std::vector<std::uint32_t>& alike) const {
        for (std::size_t t = 0; t < tests_; ++t) {
            const std::vector<Member> members = members_of(position, t);
            if (members.size() < 2)
                return;
            const std::size_t below = step_.find(members);
            if (below == 0)
                continue;
            const auto is_above = [&](std::uint32_t p) {
                return std::any_of(members.begin() + static_cast<std::ptrdiff_t>(below), members.end(),
                                   [&](const Member& m) { return m.receiver == p; });
            };
            const auto middle = std::stable_partition(position.begin(), position.end(),
                                                      [&](std::uint32_t p) { return !is_above(p); });
            const auto first = static_cast<std::size_t>(middle - position.begin());
            for (const std::span<std::uint32_t> side : {position.first(first), position.subspan(first)}) {
                for (const std::uint32_t p : side)
                    alike[p] = side[0];
                separate(side, alike);
            }
            return;
        }
    }

private:
    /// Receivers with samples, sorted by value.
    std::vector<Member> members_of(std::span<const std::uint32_t> position, std::size_t test) const {
        std::vector<Member> members;
        for (const std::uint32_t p : position) {
            const std::size_t i = equations_.unknown_of[p] * tests_ + test;
            if (ranges_.low[i] <= ranges_.high[i])
                members.push_back({p, ranges_.low[i], ranges_.high[i]});
        }
        std::ranges::stable_sort(members, {}, [](const Member& m) { return m.low + m.high; });
        return members;
    }

    const ValueRanges& ranges_;
    std::size_t tests_;
    const FitEquations& equations_;
    Step step_;
};

} // namespace

std::vector<std::uint32_t> separated(std::vector<std::uint32_t> alike, const FitEquations& equations,
                                     const TestValues& tests, std::span<const float> values, int rays) {
    const ValueRanges ranges = value_ranges(equations, values, tests.count());
    const Separation separation(ranges, tests.count(), equations, rays);
    std::vector<std::uint32_t> order;
    for (std::uint32_t p = 0; p < alike.size(); ++p)
        if (equations.unknown_of[p] != kNoReceiver)
            order.push_back(p);
    const std::vector<std::uint32_t> together = alike;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return together[a] < together[b]; });
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && together[order[end]] == together[order[begin]])
            ++end;
        if (end > begin + 1)
            separation.separate(std::span(order).subspan(begin, end - begin), alike);
    }
    return alike;
}

} // namespace prt
