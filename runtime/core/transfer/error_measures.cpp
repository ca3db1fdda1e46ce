// The measures of docs/math.md, section 6: errors of transfer, and of exit radiance under a light.
#include "prt/core/error_measures.h"

#include "prt/core/error.h"
#include "prt/core/light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace prt {
namespace {

double ratio(double error, double reference) {
    if (reference > 0)
        return error / reference;
    return error > 0 ? std::numeric_limits<double>::infinity() : 0;
}

void check_finite(std::span<const glm::vec3> radiance) {
    for (const glm::vec3& r : radiance)
        if (!std::isfinite(r.x) || !std::isfinite(r.y) || !std::isfinite(r.z))
            throw Error("the error cannot be measured: exit radiance is not finite");
}

void check_finite(std::span<const float> numbers, const char* what) {
    if (!std::all_of(numbers.begin(), numbers.end(), [](float v) { return std::isfinite(v); }))
        throw Error(std::string("the error cannot be measured: ") + what + " are not finite");
}

/// Returns whether the terms have the same kinds and names; the number of channels may differ.
bool same_terms(const TransferLayout& a, const TransferLayout& b) {
    return std::equal(
        a.terms.begin(), a.terms.end(), b.terms.begin(), b.terms.end(),
        [](const TransferTerm& p, const TransferTerm& q) { return p.kind == q.kind && p.name == q.name; });
}

/// Throws `Error` if an input of a measure of exit radiance is not finite.
void check_lit(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
               std::span<const float> areas) {
    check_finite(reference);
    check_finite(approximation);
    check_finite(areas, "areas of receivers");
}

/// Squared error and squared norm of one receiver, summed over the colors.
struct VectorSquares {
    double error = 0, norm = 0;
};

VectorSquares squares_of(const float* reference, const TransferLayout& layout, const float* approximation,
                         const TransferLayout& other) {
    VectorSquares squares;
    const int channels = std::max(layout.channels(), other.channels());
    for (std::size_t term = 0; term < layout.terms.size(); ++term) {
        const int stored = layout.terms[term].channels, stored_other = other.terms[term].channels;
        const std::size_t count = layout.columns_of(layout.terms[term]);
        for (int c = 0; c < channels; ++c) {
            const float* t = reference + count * static_cast<std::size_t>(std::min(c, stored - 1));
            const float* a = approximation + count * static_cast<std::size_t>(std::min(c, stored_other - 1));
            for (std::size_t i = 0; i < count; ++i) {
                const double difference = static_cast<double>(t[i]) - static_cast<double>(a[i]);
                squares.error += difference * difference;
                squares.norm += static_cast<double>(t[i]) * static_cast<double>(t[i]);
            }
        }
        reference += count * static_cast<std::size_t>(stored);
        approximation += count * static_cast<std::size_t>(stored_other);
    }
    return squares;
}

} // namespace

namespace {

/// Calls `see(receiver, squares)` for all receivers in order. Throws `Error` as `relative_l2`.
template <class See>
void for_squares(const TransferView& reference, const TransferView& approximation,
                 std::span<const float> areas, See&& see) {
    const TransferLayout &layout = reference.layout(), &other = approximation.layout();
    if (layout.order != other.order || reference.receivers() != approximation.receivers())
        throw Error("the transfers have different orders or numbers of receivers");
    if (!same_terms(layout, other)) {
        if (!same_terms(as_combined(layout), as_combined(other)))
            throw Error("the transfers have different lamps");
        return for_squares(as_combined(reference), as_combined(approximation), areas, see);
    }
    check_finite(areas, "areas of receivers");
    constexpr std::size_t kBlock = 256;
    std::vector<float> of_reference, of_other;
    for (std::size_t begin = 0; begin < reference.receivers(); begin += kBlock) {
        const std::size_t count = std::min(kBlock, reference.receivers() - begin);
        of_reference.resize(count * reference.dimension());
        of_other.resize(count * approximation.dimension());
        reference.read(begin, of_reference);
        approximation.read(begin, of_other);
        check_finite(of_reference, "transfer vectors");
        check_finite(of_other, "transfer vectors");
        for (std::size_t p = 0; p < count; ++p)
            see(begin + p, squares_of(&of_reference[p * reference.dimension()], layout,
                                      &of_other[p * approximation.dimension()], other));
    }
}

} // namespace

double relative_l2(const TransferView& reference, const TransferView& approximation,
                   std::span<const float> areas) {
    double error = 0, norm = 0;
    for_squares(reference, approximation, areas, [&](std::size_t p, const VectorSquares& squares) {
        error += static_cast<double>(areas[p]) * squares.error;
        norm += static_cast<double>(areas[p]) * squares.norm;
    });
    return std::sqrt(ratio(error, norm));
}

double transfer_contrast(const TransferView& reference, const TransferView& approximation,
                         std::span<const float> areas) {
    std::vector<double> errors(reference.receivers()), lengths(reference.receivers());
    for_squares(reference, approximation, areas, [&](std::size_t p, const VectorSquares& squares) {
        errors[p] = std::sqrt(squares.error);
        lengths[p] = std::sqrt(squares.norm);
    });
    const double adaptation = adaptation_luminance(lengths, areas);
    double sum = 0, area = 0;
    for (std::size_t p = 0; p < errors.size(); ++p) {
        const double contrast = ratio(errors[p], lengths[p] + adaptation);
        sum += areas[p] > 0 ? static_cast<double>(areas[p]) * contrast * contrast : 0;
        area += static_cast<double>(areas[p]);
    }
    return std::sqrt(ratio(sum, area));
}

namespace {

double largest_of(const glm::dvec3& v) {
    const glm::dvec3 a = glm::abs(v);
    return std::max({a.x, a.y, a.z});
}

/// Returns the percentile of `values`: a fraction `share` of them is smaller.
double percentile(std::vector<double>& values, double share) {
    if (values.empty())
        return 0;
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double darker_half(std::span<const glm::vec3> reference, std::span<const glm::dvec3> differences,
                   std::span<const float> areas, double area) {
    std::vector<std::uint32_t> order(reference.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return reference[a].x + reference[a].y + reference[a].z <
               reference[b].x + reference[b].y + reference[b].z;
    });
    double error = 0, norm = 0, seen = 0;
    for (const std::uint32_t p : order) {
        const double a = static_cast<double>(areas[p]);
        if (seen >= 0.5 * area)
            break;
        seen += a;
        error += a * glm::dot(differences[p], differences[p]);
        norm += a * glm::dot(glm::dvec3(reference[p]), glm::dvec3(reference[p]));
    }
    return std::sqrt(ratio(error, norm));
}

/// Returns the percentile by area: receivers with a fraction `share` of the area have smaller values.
double percentile_by_area(std::span<const double> values, std::span<const float> areas, double area,
                          double share) {
    std::vector<std::uint32_t> order(values.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [&](std::uint32_t p) { return values[p]; });
    double seen = 0;
    for (const std::uint32_t p : order)
        if (seen += static_cast<double>(areas[p]); seen >= share * area)
            return values[p];
    return values.empty() ? 0 : values[order.back()];
}

/// Returns the jumps of `values` along `edges`.
template <class Value, class Size>
std::vector<double> jumps_along(std::span<const Edge> edges, const std::vector<Value>& values, Size size) {
    std::vector<double> jumps(edges.size());
    std::ranges::transform(edges, jumps.begin(),
                           [&](const Edge& edge) { return size(values[edge.first] - values[edge.second]); });
    return jumps;
}

/// Divides the statistics of `jumps` by `mean`.
EdgeJumps relative_to(double mean, EdgeJumps jumps) {
    for (double* value : {&jumps.rms, &jumps.percentile_99, &jumps.max})
        *value = ratio(*value, mean);
    return jumps;
}

VisibleError visible_error(const ContrastErrors& errors, std::span<const float> areas,
                           std::span<const Edge> edges) {
    const std::vector<double>&contrast = errors.magnitudes, &sign = errors.luminances;
    VisibleError result;
    result.adaptation = errors.adaptation;
    double area = 0, squares = 0;
    for (std::size_t p = 0; p < contrast.size(); ++p) {
        const double a = static_cast<double>(areas[p]);
        area += a;
        if (!(a > 0))
            continue;
        result.mean += a * contrast[p];
        squares += a * contrast[p] * contrast[p];
        result.area_above_5_percent += contrast[p] > 0.05 ? a : 0;
    }
    if (!(area > 0))
        return result;
    result.mean /= area;
    result.rms = std::sqrt(squares / area);
    result.area_above_5_percent /= area;
    result.percentile_95 = percentile_by_area(contrast, areas, area, 0.95);
    result.percentile_99 = percentile_by_area(contrast, areas, area, 0.99);
    result.jumps_99 = edge_jumps(edges, jumps_along(edges, sign, [](double v) { return std::abs(v); }), areas)
                          .percentile_99;
    return result;
}

} // namespace

double adaptation_luminance(std::span<const double> luminances, std::span<const float> areas) {
    double largest = 0, sum = 0, area = 0;
    for (std::size_t p = 0; p < luminances.size(); ++p)
        if (areas[p] > 0)
            largest = std::max(largest, luminances[p]);
    for (std::size_t p = 0; p < luminances.size(); ++p)
        if (luminances[p] > 0 && areas[p] > 0) {
            sum += static_cast<double>(areas[p]) * std::log(std::max(luminances[p], 1e-6 * largest));
            area += static_cast<double>(areas[p]);
        }
    return area > 0 ? kAdaptationShare * std::exp(sum / area) : 0;
}

EdgeJumps edge_jumps(std::span<const Edge> edges, std::span<const double> jumps,
                     std::span<const float> areas) {
    EdgeJumps result;
    result.edges = edges.size();
    if (edges.empty())
        return result;
    std::vector<float> weights(edges.size());
    double area = 0, squares = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        weights[e] = areas[edges[e].first] + areas[edges[e].second];
        area += static_cast<double>(weights[e]);
        squares += static_cast<double>(weights[e]) * jumps[e] * jumps[e];
    }
    const auto largest = std::ranges::max_element(jumps);
    result.max = *largest;
    result.worst = edges[static_cast<std::size_t>(largest - jumps.begin())];
    if (area > 0) {
        result.rms = std::sqrt(squares / area);
        result.percentile_99 = percentile_by_area(jumps, weights, area, 0.99);
    }
    return result;
}

ContrastErrors contrast_errors(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                               std::span<const float> areas, std::span<const glm::vec3> shown) {
    if (shown.empty())
        shown = reference;
    ContrastErrors errors;
    std::vector<double> luminances(shown.size());
    std::ranges::transform(shown, luminances.begin(),
                           [](const glm::vec3& r) { return luminance(glm::dvec3(r)); });
    errors.adaptation = adaptation_luminance(luminances, areas);
    for (std::size_t p = 0; p < reference.size(); ++p) {
        const glm::dvec3 difference = glm::dvec3(reference[p]) - glm::dvec3(approximation[p]);
        const double y = std::abs(luminances[p]) + errors.adaptation;
        errors.magnitudes.push_back(ratio(std::sqrt(glm::dot(kLuminance, difference * difference)), y));
        errors.luminances.push_back(y > 0 ? luminance(difference) / y : 0);
    }
    return errors;
}

double lit_rms(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
               std::span<const float> areas) {
    check_lit(reference, approximation, areas);
    double error = 0, norm = 0;
    for (std::size_t p = 0; p < reference.size(); ++p) {
        const double a = static_cast<double>(areas[p]);
        const glm::dvec3 r(reference[p]), d = r - glm::dvec3(approximation[p]);
        error += a * glm::dot(d, d);
        norm += a * glm::dot(r, r);
    }
    return std::sqrt(ratio(error, norm));
}

LitScale lit_scale(std::span<const glm::vec3> reference, std::span<const float> areas) {
    check_lit(reference, {}, areas);
    LitScale scale;
    double area = 0;
    for (std::size_t p = 0; p < reference.size(); ++p) {
        const double a = static_cast<double>(areas[p]);
        const glm::dvec3 r(reference[p]);
        scale.mean_square += a * glm::dot(r, r);
        scale.mean += a * (r.x + r.y + r.z) / 3;
        area += a;
    }
    return {ratio(scale.mean_square, area), ratio(scale.mean, area)};
}

LitError lit_error(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                   std::span<const float> areas, std::span<const Edge> edges,
                   std::optional<std::span<const std::uint16_t>> clusters,
                   const std::optional<LitScale>& scale) {
    check_lit(reference, approximation, areas);
    double area = 0, largest = 0, squares = 0;
    std::vector<glm::dvec3> differences(reference.size());
    std::vector<double> sizes;
    for (std::size_t p = 0; p < reference.size(); ++p) {
        const double a = static_cast<double>(areas[p]);
        differences[p] = glm::dvec3(reference[p]) - glm::dvec3(approximation[p]);
        squares += a * glm::dot(differences[p], differences[p]);
        area += a;
        if (a > 0) {
            sizes.push_back(largest_of(differences[p]));
            largest = std::max(largest, sizes.back());
        }
    }
    const LitScale own = lit_scale(reference, areas), in = scale.value_or(own);
    LitError result;
    result.rms = std::sqrt(ratio(ratio(squares, area), in.mean_square));
    result.mean = own.mean;
    const double mean = std::abs(in.mean);
    result.max = ratio(largest, mean);
    result.percentile_999 = ratio(percentile(sizes, 0.999), mean);
    result.darker_half_rms = darker_half(reference, differences, areas, area);
    const ContrastErrors contrast = contrast_errors(reference, approximation, areas, in.shown);
    result.visible = visible_error(contrast, areas, edges);
    if (!clusters)
        return result;
    std::vector<Edge> across, within;
    for (const Edge& edge : edges)
        ((*clusters)[edge.first] != (*clusters)[edge.second] ? across : within).push_back(edge);
    const auto of_light = [&](const std::vector<Edge>& along) {
        return relative_to(mean, edge_jumps(along, jumps_along(along, differences, largest_of), areas));
    };
    result.crossing = of_light(across);
    result.inner = of_light(within);
    result.visible.seams = edge_jumps(
        across, jumps_along(across, contrast.luminances, [](double v) { return std::abs(v); }), areas);
    return result;
}

} // namespace prt
