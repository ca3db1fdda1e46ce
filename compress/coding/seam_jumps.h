#pragma once

// Jumps of light across UV seams of lightmaps, while codes change.

#include "prt/core/lightmap.h"

#include <Eigen/Dense>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct JumpWeights {
    double square = 0; ///< multiplier of a squared jump
    double border = 0; ///< multiplier of a receiver in another cluster, for each receiver that a jump reads
                       ///< together with it
};

/// Jumps of the error: weighted sums of the errors of receivers. Baked light has no jumps, so these are the
/// visible ones. A jump costs its multiplier times its square.
class SeamJumps {
public:
    /// Keeps a reference.
    SeamJumps(std::span<const SeamJump> jumps, const JumpWeights& multipliers);

    /// Receivers that jumps read, in ascending order.
    std::span<const std::uint32_t> receivers() const { return receivers_; }
    /// Calls `see` with the receivers that jumps read together with p, once per occurrence.
    template <class See>
    void see_partners(std::size_t p, See&& see) const {
        for (const Part& part : parts_of(p))
            for (std::size_t i = 0; i < jumps_[part.jump].receivers.size(); ++i)
                if (const std::uint32_t q = jumps_[part.jump].receivers[i];
                    q != p && jumps_[part.jump].weights[i] != 0)
                    see(q);
    }

    /// Returns the border cost of p: for each receiver that does not share its cluster, `separate(q)`.
    template <class Separate>
    double borders(std::size_t p, Separate&& separate) const {
        double cost = 0;
        see_partners(p, [&](std::uint32_t q) { cost += separate(q) ? multipliers_.border : 0; });
        return cost;
    }

    /// Returns whether jumps have been summed; they count from then on.
    bool measured() const { return sums_.cols() > 0; }
    /// Recomputes all jumps. `error_of(p)`: code minus point.
    template <class ErrorOf>
    void measure(Eigen::Index dimension, ErrorOf&& error_of) {
        sums_.setZero(dimension, static_cast<Eigen::Index>(jumps_.size()));
        for (const std::uint32_t p : receivers_)
            move(p, error_of(p));
    }
    /// Applies a change of the error of receiver p.
    void move(std::size_t p, const Eigen::VectorXf& by);

    /// With all other errors fixed, jumps cost curvature |e|² - 2 slope · e plus a constant, with e the error
    /// of p, currently `now`. Adds to `slope`, and returns the curvature.
    double pull(std::size_t p, const Eigen::VectorXf& now, Eigen::VectorXf& slope) const;

private:
    struct Part {
        std::uint32_t receiver, jump;
        float weight;
    };
    std::span<const Part> parts_of(std::size_t p) const;
    void unite_parts();

    std::span<const SeamJump> jumps_;
    JumpWeights multipliers_;
    std::vector<Part> parts_; ///< sorted by receiver
    std::vector<std::uint32_t> receivers_;
    std::vector<std::size_t> first_; ///< [receivers_ + 1] index into parts_
    Eigen::MatrixXf sums_;           ///< [dimension][jumps]
};

} // namespace prt
