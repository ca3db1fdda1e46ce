#pragma once

// Gathers the light of lamps, which comes from few and small places, with connections to them.

#include "lamps/bright_patches.h"
#include "prt/tracer.h"
#include "transport/gather.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Rays of a receiver to patches that lamps light.
class LampConnections {
public:
    /// `light`: as for BrightPatches. Keeps a reference to `plan`.
    LampConnections(const BakePlan& plan, const Transfer& light) : plan_(plan), patches_(plan, light) {}

    /// Appends hits of connections to `hits`, the hits of the receiver's hemisphere rays, which `options`
    /// traced. Both get weights by the balance heuristic (E. Veach and L. Guibas, SIGGRAPH 1995).
    /// Thread-safe.
    struct Joined {
        std::vector<Hit> all;
        std::vector<Hit> half; ///< every other one, weighted to stand for all
    };
    Joined join(const Receivers& receivers, std::uint32_t p, std::span<const Hit> hits,
                const TraceOptions& options) const;

private:
    struct Sampled;
    struct Start {
        glm::vec3 origin; ///< of rays
        std::uint32_t seed;
    };
    glm::dvec3 normal(std::uint32_t triangle, bool back) const;
    std::vector<Hit> connect(const Sampled& sampled, const Start& start, const TraceOptions& options) const;
    float share_of_rays(const Sampled& sampled, const Start& start, const Hit& hit) const;

    const BakePlan& plan_;
    BrightPatches patches_;
};

/// Whether the last bounce of lamps is gathered by rows of its own.
enum class LastOfLamps { as_others, connected };

/// Connections for the last bounce of lamps, where `last` asks for them and there is such light.
std::optional<LampConnections> connections_to(const BakePlan& plan, LastOfLamps last, const Transfer& light);

/// Rows that gather the light of lamps at receivers.
struct LampRows {
    GatherOperator all;
    std::optional<GatherOperator> half; ///< of half of its rays, which tells their noise

    /// `halves`: with `half`.
    LampRows(const BakePlan& plan, std::size_t rows, bool halves);
    /// Thread-safe.
    void set(std::size_t row, const LampConnections::Joined& joined, int rays);

    /// Its memory over that of a gather operator of the hemisphere rays alone, at most.
    static constexpr double kCopies = 1.5 * 1.25;
};

} // namespace prt
