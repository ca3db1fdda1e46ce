// Plans how values fill sealed receivers, ring by ring from the outside.

#include "bake/scene/refill.h"

namespace prt {

Refill::Refill(const MeshNeighbours& neighbours, const std::vector<bool>& sealed) {
    std::vector<bool> known(sealed.size());
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t p = 0; p < sealed.size(); ++p) {
        known[p] = !sealed[p];
        if (sealed[p])
            waiting.push_back(p);
    }
    while (!waiting.empty()) {
        const std::size_t before = steps_.size();
        std::vector<std::uint32_t> still;
        for (const std::uint32_t p : waiting) {
            Step step{p, {}};
            for (const std::uint32_t q : neighbours.of(p))
                if (known[q])
                    step.sources.push_back(q);
            if (step.sources.empty())
                still.push_back(p);
            else
                steps_.push_back(std::move(step));
        }
        if (steps_.size() == before)
            return;
        for (std::size_t s = before; s < steps_.size(); ++s)
            known[steps_[s].receiver] = true; // only now: a ring is filled from the previous one
        waiting = std::move(still);
    }
}

} // namespace prt
