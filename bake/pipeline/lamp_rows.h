#pragma once

// Gathers the light of lamps, which comes from few and small areas, with connections to these areas.

#include "bake/pipeline/bright_patches.h"
#include "bake/trace/gather.h"
#include "bake/trace/tracer.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Connections of a receiver to patches that lamps light.
class LampConnections {
public:
    /// `light`: see BrightPatches. Keeps a reference to `plan`.
    LampConnections(const BakePlan& plan, const Transfer& light) : plan_(plan), patches_(plan, light) {}

    /// Appends hits of connections to `hits`, the hits of the receiver's hemisphere rays that were traced
    /// with `options`. Both kinds get weights by the balance heuristic (E. Veach and L. Guibas, SIGGRAPH
    /// 1995). Thread-safe.
    struct Joined {
        std::vector<Hit> all;
        std::vector<Hit> half; ///< every second hit, weighted to represent all of them
    };
    Joined join(const Receivers& receivers, std::uint32_t p, std::span<const Hit> hits,
                const TraceOptions& options) const;

private:
    struct Sampled;
    struct Start {
        glm::vec3 origin; ///< origin of the rays
        std::uint32_t seed;
    };
    glm::dvec3 normal(std::uint32_t triangle, bool back) const;
    std::vector<Hit> connect(const Sampled& sampled, const Start& start, const TraceOptions& options) const;
    float share_of_rays(const Sampled& sampled, const Start& start, const Hit& hit) const;

    const BakePlan& plan_;
    BrightPatches patches_;
};

/// Whether the last bounce of lamps uses separate rows with connections.
enum class LastOfLamps { as_others, connected };

/// Creates connections for the last bounce of lamps, if `last` requests them and `plan` has lamps and
/// bounces, and light bounces between its receivers.
std::optional<LampConnections> connections_to(const BakePlan& plan, LastOfLamps last, const Transfer& light);

/// Rows that gather the light of lamps at receivers.
struct LampRows {
    GatherOperator all;
    std::optional<GatherOperator> half; ///< rows from half of the hits, for estimating the noise

    /// `halves`: create `half`.
    LampRows(const BakePlan& plan, std::size_t rows, bool halves);
    /// Sets a row. Thread-safe.
    void set(std::size_t row, const LampConnections::Joined& joined, int rays);

    /// Maximum memory relative to a gather operator of only the hemisphere rays.
    static constexpr double kCopies = 1.5 * 1.25;
};

} // namespace prt
