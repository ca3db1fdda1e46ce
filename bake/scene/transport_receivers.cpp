// Adds back sides to receivers on surfaces that scatter light there.

#include "bake/scene/transport_receivers.h"

#include "bake/scene/ray_starts.h"

namespace prt {

TransportReceivers without_back_sides(Receivers fronts) {
    const std::size_t count = fronts.size();
    return {std::move(fronts), {}, count};
}

TransportReceivers measured_on(const DetailedSurface* detail, TransportReceivers receivers) {
    receivers.detail = detail;
    if (detail) {
        receivers.moved = receivers.receivers;
        detail->move(receivers.moved);
    }
    return receivers;
}

TransportReceivers with_back_sides(Receivers fronts, const Surfaces& surfaces) {
    TransportReceivers result = without_back_sides(std::move(fronts));
    Receivers& all = result.receivers;
    std::vector<glm::vec3> starts;
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        if (!surfaces.two_sided(t))
            continue;
        if (result.back.empty()) {
            result.back.assign(result.fronts, kNoReceiver);
            if (!all.starts.empty())
                starts = ray_starts(surfaces.scene(), Side::back);
        }
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t front = surfaces.corners(t)[corner];
            if (result.back[front] != kNoReceiver)
                continue;
            result.back[front] = static_cast<std::uint32_t>(all.size());
            all.positions.push_back(all.positions[front]);
            all.normals.push_back(-all.normals[front]);
            all.areas.push_back(all.areas[front]);
            if (!starts.empty())
                all.starts.push_back(starts[front]);
        }
    }
    return result;
}

} // namespace prt
