#pragma once

// Measures the error of a bake at points over the surface.

#include "bake/pipeline/direct_transfer.h"
#include "bake/pipeline/error_sums.h"
#include "bake/plan/plan.h"
#include "bake/surface_fit/surface_samples.h"

#include <array>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace prt {

/// Points between vertices whose light is traced again in two independent halves: the product of their
/// differences from the interpolated light has no noise of these rays in its mean (docs/math.md, section 9).
/// Points inside geometry, where no light arrives, and points on media are excluded.
class ErrorCheck {
public:
    /// Chooses points where measured light varies, and traces them. Keeps a reference to `plan`.
    ErrorCheck(const BakePlan& plan, Tracer& tracer, const Measured& measured, const std::stop_token& stop);

    /// Operator that gathers exit light at the points; null if no light bounces.
    const GatherOperator* gather() const { return gather_ ? &*gather_ : nullptr; }
    std::size_t rays() const { return rays_; }

    /// Relative L2 error of direct light with the number of rays of a receiver.
    double sampling_error() const;

    /// Light at the rows of `gather` after a bounce, [rows][channels][columns]; empty: no such light.
    struct Bounced {
        std::vector<float> sky, lamps;
    };
    /// Compares the baked transfer with the light at the points.
    BakeErrors compare(const Transfer& baked, const Bounced& bounced) const;

private:
    struct Point {
        SamplePosition position;
        double area;                       ///< m² that the point represents
        std::uint32_t front;               ///< row of the front side
        std::optional<std::uint32_t> back; ///< row of the back side, if the back scatters light
    };
    /// Light of one side without a bounce, and all light, [channels][columns].
    struct Light {
        std::vector<float> unbounced, all;
    };
    using Halves = std::array<Light, 2>;
    /// Interpolated transfer: [channels][columns]; `lamps` [lamps][channels].
    struct Value {
        std::vector<float> direct, indirect, lamps, sky;
    };
    struct Square {
        double error = 0, norm = 0;
    };
    struct Sums {
        struct Node {
            ErrorSums sky, lamps, backs, backs_by_lamps;
        };
        ErrorSums sky, direct, indirect, lamps, backs, backs_by_lamps;
        std::vector<ErrorSums> each_lamp;
        std::map<int, Node> nodes;
    };

    void choose_points(Tracer& tracer, const Measured& measured, const std::stop_token& stop);
    /// Selects about `count` of `many`, with a higher probability where a few rays differ from the
    /// interpolated `sky`.
    SurfaceSamples look(Tracer& tracer, const Transfer& sky, const SurfaceSamples& many, std::size_t count,
                        const std::stop_token& stop);
    void add_backs();
    void trace(Tracer& tracer, double rays, const std::stop_token& stop);
    void leave_out_sealed(Tracer& tracer, const std::stop_token& stop);
    Light light(const Point& point, bool back, std::size_t half, const Transfer& unbounced,
                std::span<const float> bounced, std::size_t channels) const;
    Halves halves(const Point& point, bool back, const std::array<Transfer, 2>& unbounced,
                  std::span<const float> bounced, int channels) const;
    int node_of(const Point& point) const;
    Value interpolated(const Point& point, const Transfer& baked) const;
    std::vector<Square> lamp_squares(const Value& x, const Halves& halves) const;
    void add_sky(const Point& point, const Value& x, const Halves& halves, Sums& sums) const;
    void add_lamps(const Point& point, const Value& x, const Halves& halves, Sums& sums) const;
    void add_back(const Point& point, const Value& x, const Bounced& bounced, Sums& sums) const;

    const BakePlan& plan_;
    std::vector<Point> points_;
    Receivers rows_;                       ///< front sides, then back sides
    std::array<Transfer, 2> sky_, lamps_;  ///< light at the rows without a bounce, from each half
    std::optional<GatherOperator> gather_; ///< rows of the first half, then of the second
    double half_share_ = 1;                ///< rays of a half, relative to those of a receiver
    std::size_t rays_ = 0;
};

} // namespace prt
