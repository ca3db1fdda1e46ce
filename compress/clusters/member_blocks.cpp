// Sorts points by cluster and splits them into blocks.

#include "compress/clusters/member_blocks.h"

#include <algorithm>

namespace prt {

MemberBlocks::MemberBlocks(std::span<const std::uint32_t> clusters) : points_(clusters.size()) {
    const std::size_t count =
        clusters.empty() ? 0 : std::size_t{1} + *std::max_element(clusters.begin(), clusters.end());
    std::vector<std::uint32_t> next(count + 1, 0);
    for (const std::uint32_t k : clusters)
        ++next[k + 1];
    for (std::uint32_t k = 0, first = 0; k < count; ++k) {
        const std::uint32_t members = next[k + 1];
        for (std::uint32_t done = 0; done < members; done += kLanes)
            blocks_.push_back(
                {k, first + done, std::min(static_cast<std::uint32_t>(kLanes), members - done)});
        next[k] = first;
        first += members;
    }
    for (std::uint32_t p = 0; p < clusters.size(); ++p)
        points_[next[clusters[p]]++] = p;
}

} // namespace prt
