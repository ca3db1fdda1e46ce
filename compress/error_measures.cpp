#include "prt/error_measures.h"

#include "prt/error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {
namespace {

double ratio(double error, double reference) {
    if (reference > 0)
        return error / reference;
    return error > 0 ? std::numeric_limits<double>::infinity() : 0;
}

} // namespace

double relative_l2(const Transfer& reference, const Transfer& approximation, std::span<const float> areas) {
    if (reference.order != approximation.order || reference.receivers() != approximation.receivers())
        throw Error("the transfers have different orders or numbers of receivers");
    const int channels = std::max(reference.channels, approximation.channels);
    const auto count = static_cast<std::size_t>(coefficient_count(reference.order));
    double error = 0, norm = 0;
    for (std::size_t p = 0; p < reference.receivers(); ++p) {
        double receiver_error = 0, receiver_norm = 0;
        for (int c = 0; c < channels; ++c) {
            const float* t =
                &reference.vector(p)[count * static_cast<std::size_t>(std::min(c, reference.channels - 1))];
            const float* a = &approximation.vector(
                p)[count * static_cast<std::size_t>(std::min(c, approximation.channels - 1))];
            for (std::size_t i = 0; i < count; ++i) {
                const double difference = static_cast<double>(t[i]) - static_cast<double>(a[i]);
                receiver_error += difference * difference;
                receiver_norm += static_cast<double>(t[i]) * static_cast<double>(t[i]);
            }
        }
        error += static_cast<double>(areas[p]) * receiver_error;
        norm += static_cast<double>(areas[p]) * receiver_norm;
    }
    return std::sqrt(ratio(error, norm));
}

LitError lit_error(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                   std::span<const float> areas, const Scene& scene,
                   std::optional<std::span<const std::uint16_t>> clusters) {
    double error = 0, norm = 0, sum = 0, area = 0, largest = 0;
    std::vector<glm::dvec3> differences(reference.size());
    for (std::size_t p = 0; p < reference.size(); ++p) {
        const double a = static_cast<double>(areas[p]);
        const glm::dvec3 r(reference[p]);
        differences[p] = r - glm::dvec3(approximation[p]);
        error += a * glm::dot(differences[p], differences[p]);
        norm += a * glm::dot(r, r);
        sum += a * (r.x + r.y + r.z) / 3;
        area += a;
        if (a > 0)
            for (int c = 0; c < 3; ++c)
                largest = std::max(largest, std::abs(differences[p][c]));
    }
    LitError result;
    result.rms = std::sqrt(ratio(error, norm));
    result.mean = ratio(sum, area);
    result.max = ratio(largest, std::abs(result.mean));
    if (!clusters)
        return result;
    double jump = 0;
    for (const Primitive& primitive : scene.primitives) {
        const std::size_t first = scene.vertex_arrays[primitive.vertices].first_receiver;
        for (const glm::uvec3& t : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner) {
                const std::size_t i = first + t[corner], j = first + t[(corner + 1) % 3];
                if ((*clusters)[i] == (*clusters)[j])
                    continue;
                const glm::dvec3 d = glm::abs(differences[i] - differences[j]);
                jump = std::max({jump, d.x, d.y, d.z});
            }
    }
    result.seam = ratio(jump, std::abs(result.mean));
    return result;
}

} // namespace prt
