// What an error of transfer costs, by second moments of lighting (docs/math.md, eq. 22); natural lighting
// after Dror, Willsky and Adelson (2004, "Statistical characterization of real-world illumination").

#include "prt/light_metric.h"

#include "prt/sh.h"
#include "prt/support/error.h"
#include "prt/support/parallel.h"
#include "tuning.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <string>

namespace prt {
namespace {

/// A metric without correlations in which band l has the power `power(l)`.
template <class Power>
LightMetric banded_metric(int order, int channels, Power&& power) {
    check_order(order);
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    LightMetric metric{order, channels,
                       std::vector<double>(static_cast<std::size_t>(channels) * count * count)};
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
        for (int l = 0; l < order; ++l)
            for (auto i = static_cast<std::size_t>(l * l); i < static_cast<std::size_t>((l + 1) * (l + 1));
                 ++i)
                metric.moments[(c * count + i) * count + i] = power(l);
    return metric;
}

/// Turning by 2N - 1 equal angles integrates the products of two coefficients exactly: their frequencies
/// about the axis are below N each.
int exact_rotations(int order) {
    return 2 * order - 1;
}

void add_outer_product(const Light& light, double scale, int channels, std::span<double> moments) {
    const std::size_t count = light.coefficients.size();
    for (std::size_t c = 0; c < 3; ++c) {
        // One channel serves all colors: its metric is the mean over them.
        double* block = &moments[(channels == 3 ? c : 0) * count * count];
        const double share = channels == 3 ? scale : scale / 3;
        const auto color = static_cast<glm::length_t>(c);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < count; ++j)
                block[i * count + j] += share * static_cast<double>(light.coefficients[i][color]) *
                                        static_cast<double>(light.coefficients[j][color]);
    }
}

double energy(const Light& light) {
    double sum = 0;
    for (const glm::vec3& c : light.coefficients)
        sum += static_cast<double>(c.x) * static_cast<double>(c.x) +
               static_cast<double>(c.y) * static_cast<double>(c.y) +
               static_cast<double>(c.z) * static_cast<double>(c.z);
    return sum;
}

double trace(const LightMetric& metric) {
    const auto count = static_cast<std::size_t>(coefficient_count(metric.order));
    double sum = 0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(metric.channels); ++c)
        for (std::size_t i = 0; i < count; ++i)
            sum += metric.moments[(c * count + i) * count + i];
    return sum;
}

} // namespace

LightMetric plain_metric(int order, int channels) {
    return banded_metric(order, channels, [](int) { return 1.0; });
}

LightMetric natural_metric(int order, int channels) {
    return banded_metric(order, channels, [](int l) { return l == 0 ? 1.0 : 0.25 / l; });
}

LightMetric metric_of_lights(std::span<const Light> lights, int order, int channels) {
    LightMetric metric = banded_metric(order, channels, [](int) { return 0.0; });
    const int rotations = exact_rotations(order);
    for (const Light& given : lights) {
        const Light light = truncated(given, order);
        const double light_energy = energy(light);
        if (!(light_energy > 0))
            continue;
        for (int r = 0; r < rotations; ++r)
            add_outer_product(rotated_about_y(light, 2 * M_PI * r / rotations),
                              1 / (light_energy * rotations), channels, metric.moments);
    }
    const double given = trace(metric);
    if (!(given > 0))
        throw Error("the lights to compress for are all black");
    const LightMetric natural = natural_metric(order, channels);
    const double natural_share = tuning::kNaturalShare * given / trace(natural);
    for (std::size_t i = 0; i < metric.moments.size(); ++i)
        metric.moments[i] += natural_share * natural.moments[i];
    return metric;
}

double expected_lit_rms(const Transfer& reference, const Transfer& approximation,
                        std::span<const float> areas, const LightMetric& metric, int threads) {
    if (reference.order != approximation.order || reference.channels != approximation.channels ||
        reference.receivers() != approximation.receivers() || metric.order != reference.order ||
        metric.channels != reference.channels)
        throw Error("the transfers or the metric have different orders, channels or numbers of receivers");
    const auto count = static_cast<Eigen::Index>(coefficient_count(reference.order));
    constexpr std::size_t kGrain = 4096;
    const std::size_t blocks = (reference.receivers() + kGrain - 1) / kGrain;
    std::vector<double> errors(blocks, 0), norms(blocks, 0);
    parallel_for(reference.receivers(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
        Eigen::VectorXd t(count), d(count);
        for (std::size_t p = begin; p < end; ++p)
            for (int c = 0; c < reference.channels; ++c) {
                const Eigen::Map<const Eigen::MatrixXd> moments(
                    &metric.moments[static_cast<std::size_t>(c * count * count)], count, count);
                for (Eigen::Index i = 0; i < count; ++i) {
                    const auto at = static_cast<std::size_t>(c * count + i);
                    t[i] = static_cast<double>(reference.vector(p)[at]);
                    d[i] = t[i] - static_cast<double>(approximation.vector(p)[at]);
                }
                const auto area = static_cast<double>(areas[p]);
                errors[begin / kGrain] += area * d.dot(moments * d);
                norms[begin / kGrain] += area * t.dot(moments * t);
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
