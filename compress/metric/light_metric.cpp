// Cost of a transfer error from second moments of lighting (docs/math.md, eq. 22); natural lighting after
// Dror, Willsky and Adelson (2004, "Statistical characterization of real-world illumination").

#include "prt/compress/light_metric.h"

#include "compress/metric/color_blocks.h"
#include "compress/metric/natural_share.h"
#include "compress/metric/transfer_columns.h"
#include "compress/tuning/tuning.h"
#include "prt/core/error.h"
#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace prt {
namespace {

using Matrix = Eigen::MatrixXd;

Eigen::Index dimension_of(const TransferLayout& layout) {
    return static_cast<Eigen::Index>(layout.dimension());
}

Eigen::Map<Matrix> matrix_of(LightMetric& metric) {
    return {metric.moments.data(), dimension_of(metric.layout), dimension_of(metric.layout)};
}

Eigen::Map<const Matrix> matrix_of(const LightMetric& metric) {
    return {metric.moments.data(), dimension_of(metric.layout), dimension_of(metric.layout)};
}

/// Returns the number of coefficients of distant light in a vector; lamps follow.
Eigen::Index of_sky_in(const TransferLayout& layout) {
    return static_cast<Eigen::Index>(layout.distant_numbers());
}

LightMetric zero_metric(const TransferLayout& layout) {
    check_layout(layout);
    return {layout, std::vector<double>(layout.dimension() * layout.dimension(), 0.0)};
}

/// Returns the weight of one of three colors: if no term has color, the metric is the mean over them.
double color_share(const TransferLayout& layout) {
    return layout.channels() == 3 ? 1 : 1.0 / 3;
}

/// Returns the start of each term's coefficients for color `c`: [terms].
std::vector<Eigen::Index> blocks_of_color(const TransferLayout& layout, int c) {
    const std::vector<std::size_t> numbers = numbers_of_color(layout, c);
    std::vector<Eigen::Index> begins;
    std::size_t column = 0;
    for (const TransferTerm& term : layout.terms) {
        begins.push_back(static_cast<Eigen::Index>(numbers[column]));
        column += layout.columns_of(term);
    }
    return begins;
}

/// Returns a metric of independent bands: two terms of distant light have `power(l, kind, other kind)` in
/// band l. Lamps have strength 1, independent of each other.
template <class Power>
LightMetric banded_metric(const TransferLayout& layout, Power&& power) {
    LightMetric metric = zero_metric(layout);
    Eigen::Map<Matrix> moments = matrix_of(metric);
    for (int c = 0; c < 3; ++c) {
        const std::vector<Eigen::Index> begins = blocks_of_color(layout, c);
        const std::size_t skies = layout.distant_terms().size();
        for (std::size_t a = skies; a < begins.size(); ++a)
            moments(begins[a], begins[a]) += color_share(layout);
        for (std::size_t a = 0; a < skies; ++a)
            for (std::size_t b = 0; b < skies; ++b)
                for (int l = 0; l < layout.order; ++l)
                    for (Eigen::Index i = l * l; i < (l + 1) * (l + 1); ++i)
                        moments(begins[a] + i, begins[b] + i) +=
                            color_share(layout) * power(l, layout.terms[a].kind, layout.terms[b].kind);
    }
    return metric;
}

/// Returns the number of equally spaced rotations that integrates products of two coefficients exactly: their
/// frequencies about the axis are below N each.
int exact_rotations(int order) {
    return 2 * order - 1;
}

/// Adds the cost of `lighting`, times `scale`, for distant light only.
void add_outer_product(const Lighting& lighting, double scale, LightMetric& metric) {
    const TransferLayout& layout = metric.layout;
    const std::vector<glm::vec3> columns = light_columns(layout, lighting);
    for (int c = 0; c < 3; ++c) {
        const std::vector<Eigen::Index> begins = blocks_of_color(layout, c);
        Eigen::VectorXd light = Eigen::VectorXd::Zero(dimension_of(layout));
        const glm::vec3* color = columns.data();
        for (std::size_t term = 0; term < layout.distant_terms().size(); ++term)
            for (std::size_t i = 0; i < layout.columns_of(layout.terms[term]); ++i)
                light[begins[term] + static_cast<Eigen::Index>(i)] = static_cast<double>((*color++)[c]);
        matrix_of(metric) += color_share(layout) * scale * light * light.transpose();
    }
}

double energy(const Lighting& lighting) {
    const auto sum_of = [](const Light& light) {
        double sum = 0;
        for (const glm::vec3& c : light.coefficients)
            sum += static_cast<double>(c.x) * static_cast<double>(c.x) +
                   static_cast<double>(c.y) * static_cast<double>(c.y) +
                   static_cast<double>(c.z) * static_cast<double>(c.z);
        return sum;
    };
    return sum_of(lighting.suns ? sum(lighting.sky, *lighting.suns) : lighting.sky);
}

Lighting changed(const Lighting& lighting, auto&& change) {
    Lighting result{change(lighting.sky)};
    if (lighting.suns)
        result.suns = change(*lighting.suns);
    return result;
}

/// Returns the cost of the full transfer without approximation: of all distant light together, then of each
/// lamp.
std::vector<double> costs_of_terms(LightMetric& metric, const TransferView& transfer,
                                   std::span<const float> areas, int threads) {
    const TransferLayout& layout = metric.layout;
    const Eigen::Index of_sky = of_sky_in(layout);
    constexpr std::size_t kGrain = 1024;
    const std::size_t blocks = (transfer.receivers() + kGrain - 1) / kGrain;
    std::vector<Eigen::VectorXd> of_block(
        blocks, Eigen::VectorXd::Zero(1 + static_cast<Eigen::Index>(layout.lamps())));
    const Eigen::Map<Matrix> moments = matrix_of(metric);
    parallel_for(transfer.receivers(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
        const auto count = static_cast<Eigen::Index>(end - begin);
        const Matrix t = columns_of(transfer, begin, end).cast<double>();
        Eigen::VectorXd& sums = of_block[begin / kGrain];
        for (Eigen::Index p = 0; p < count; ++p) {
            const auto area = static_cast<double>(areas[begin + static_cast<std::size_t>(p)]);
            const auto cost = [&](Eigen::Index first, Eigen::Index size) {
                const auto term = t.col(p).segment(first, size);
                return area * term.dot(moments.block(first, first, size, size) * term);
            };
            sums[0] += cost(0, of_sky);
            Eigen::Index first = of_sky, lamp = 1;
            for (const TransferTerm& term : layout.lamp_terms()) {
                sums[lamp++] += cost(first, term.channels);
                first += term.channels;
            }
        }
    });
    std::vector<double> costs(1 + layout.lamps(), 0);
    for (const Eigen::VectorXd& sums : of_block)
        for (std::size_t i = 0; i < costs.size(); ++i)
            costs[i] += sums[static_cast<Eigen::Index>(i)];
    return costs;
}

} // namespace

LightMetric plain_metric(const TransferLayout& layout) {
    LightMetric metric = zero_metric(layout);
    Eigen::Index at = 0;
    for (const TransferTerm& term : layout.terms)
        for (std::size_t i = 0; i < layout.numbers_of(term); ++i, ++at)
            matrix_of(metric)(at, at) = static_cast<double>(layout.channels()) / term.channels;
    return metric;
}

LightMetric natural_metric(const TransferLayout& layout) {
    const auto falling = [](double power, double fall, int l) {
        return l == 0 ? 1.0 : power * std::pow(l, -fall);
    };
    if (layout.distant_terms().size() == 1)
        return banded_metric(layout, [&](int l, TermKind, TermKind) {
            return falling(tuning::kWholePower, tuning::kWholeFall, l);
        });
    // The direct term is lit by suns in half of the assumed cases (no shadow maps); all other terms always
    // are.
    return banded_metric(layout, [&](int l, TermKind a, TermKind b) {
        const bool direct = a == TermKind::direct || b == TermKind::direct;
        return falling(tuning::kSkyPower, tuning::kSkyFall, l) + tuning::kSunPower * (direct ? 0.5 : 1);
    });
}

void add_natural_share(LightMetric& metric) {
    LightMetric natural = natural_metric(metric.layout);
    const Eigen::Index sky = of_sky_in(metric.layout);
    const double scale = matrix_of(metric).trace() / matrix_of(natural).diagonal().head(sky).sum();
    matrix_of(natural).topLeftCorner(sky, sky) *= tuning::kNaturalShare;
    matrix_of(metric) += scale * matrix_of(natural);
}

LightMetric metric_of_lights(std::span<const Lighting> lights, const TransferLayout& layout) {
    LightMetric metric = zero_metric(layout);
    const int rotations = exact_rotations(layout.order);
    for (const Lighting& given : lights) {
        const Lighting light = changed(given, [&](const Light& l) { return truncated(l, layout.order); });
        const double light_energy = energy(light);
        if (!(light_energy > 0))
            continue;
        for (int r = 0; r < rotations; ++r)
            add_outer_product(
                changed(light, [&](const Light& l) { return rotated_about_y(l, 2 * M_PI * r / rotations); }),
                1 / (light_energy * rotations), metric);
    }
    if (!(matrix_of(metric).trace() > 0))
        throw Error("all lights to compress for are black");
    add_natural_share(metric);
    return metric;
}

LightMetric metric_of_lights(std::span<const Light> lights, const TransferLayout& layout) {
    std::vector<Lighting> skies;
    for (const Light& light : lights)
        skies.push_back({light});
    return metric_of_lights(skies, layout);
}

LightMetric balanced(LightMetric metric, const TransferView& transfer, std::span<const float> areas,
                     int threads) {
    const std::vector<double> costs = costs_of_terms(metric, transfer, areas, threads);
    const std::span<const double> of_lamps = std::span(costs).subspan(1);
    const auto shining = std::ranges::count_if(of_lamps, [](double cost) { return cost > 0; });
    const double sky = costs[0], all = sky > 0 ? sky : std::reduce(of_lamps.begin(), of_lamps.end());
    Eigen::Index begin = of_sky_in(metric.layout);
    auto cost = of_lamps.begin();
    for (const TransferTerm& lamp : metric.layout.lamp_terms()) {
        const Eigen::Index size = lamp.channels;
        if (*cost > 0)
            matrix_of(metric).block(begin, begin, size, size) *= all / (*cost * static_cast<double>(shining));
        begin += size;
        ++cost;
    }
    return metric;
}

double expected_lit_rms(const TransferView& reference, const TransferView& approximation,
                        std::span<const float> areas, const LightMetric& metric, int threads) {
    if (reference.layout() != approximation.layout() || metric.layout != reference.layout() ||
        reference.receivers() != approximation.receivers())
        throw Error("the transfers or the metric have different orders, terms or numbers of receivers");
    const Eigen::Map<const Matrix> moments = matrix_of(metric);
    constexpr std::size_t kGrain = 1024;
    const std::size_t blocks = (reference.receivers() + kGrain - 1) / kGrain;
    std::vector<double> errors(blocks, 0), norms(blocks, 0);
    parallel_for(reference.receivers(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
        const auto count = static_cast<Eigen::Index>(end - begin);
        const Matrix t = columns_of(reference, begin, end).cast<double>(),
                     d = t - columns_of(approximation, begin, end).cast<double>();
        const Matrix cost_of_error = moments * d, cost = moments * t;
        for (Eigen::Index p = 0; p < count; ++p) {
            const auto area = static_cast<double>(areas[begin + static_cast<std::size_t>(p)]);
            errors[begin / kGrain] += area * d.col(p).dot(cost_of_error.col(p));
            norms[begin / kGrain] += area * t.col(p).dot(cost.col(p));
        }
    });
    double error = 0, norm = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
        error += errors[b];
        norm += norms[b];
    }
    if (norm > 0)
        return std::sqrt(std::max(error, 0.0) / norm);
    return error > 0 ? std::numeric_limits<double>::infinity() : 0;
}

} // namespace prt
