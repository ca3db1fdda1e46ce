// Computes FLIP and HDR-FLIP: filters pictures by the resolution of the eye, then compares colors, edges and
// points.

#include "runtime/render/flip.h"

#include "prt/core/error.h"
#include "prt/core/light.h"
#include "runtime/core/support/parallel.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Constants of the papers.
constexpr float kColorExponent = 0.7f;         ///< q_c
constexpr float kKnee = 0.4f, kAtKnee = 0.95f; ///< p_c, p_t
constexpr float kFeatureExponent = 0.5f;       ///< q_f
constexpr float kFeatureWidth = 0.082f;        ///< w, degrees
constexpr double kShown = 0.85;                ///< t: level to which exposures map a luminance
constexpr double kDarkestMedian = 0x1p-20;     ///< relative to the brightest pixel; the papers define no
                                               ///< limit

/// Matrix from linear Rec. 709 to CIE XYZ (IEC 61966-2-1); the columns are red, green, blue.
const glm::mat3 kToXyz(0.41238656f, 0.21263682f, 0.01933062f, 0.35759149f, 0.71518298f, 0.11919716f,
                       0.18045049f, 0.0721802f, 0.95037259f);

glm::vec3 white() {
    return kToXyz * glm::vec3(1);
}

/// Converts to a linear opponent space: L*, red-green and blue-yellow, without the cube roots of CIELab.
glm::vec3 to_opponent(const glm::vec3& rgb) {
    const glm::vec3 v = kToXyz * rgb / white();
    return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}

glm::vec3 from_opponent(const glm::vec3& c) {
    const float y = (c.x + 16) / 116;
    static const glm::mat3 to_rgb = glm::inverse(kToXyz);
    return to_rgb * (glm::vec3(y + c.y / 500, y, y - c.z / 200) * white());
}

/// Converts to CIELab with chroma reduced in dark regions (Hunt effect).
glm::vec3 hunt_adjusted_lab(const glm::vec3& rgb) {
    const auto root = [](float t) {
        constexpr float kDelta = 6.0f / 29;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
    };
    const glm::vec3 v = kToXyz * rgb / white();
    const float x = root(v.x), y = root(v.y), z = root(v.z), lightness = 116 * y - 16;
    return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

/// Returns the HyAB distance (Abasi et al., 2020): city-block distance of lightness and chroma.
float hyab(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

/// Maps the distance to 0..1; the maximum of the gamut (green to blue) maps to 1.
float redistributed(float distance) {
    static const float most =
        std::pow(hyab(hunt_adjusted_lab({0, 1, 0}), hunt_adjusted_lab({0, 0, 1})), kColorExponent);
    const float error = std::pow(distance, kColorExponent), knee = kKnee * most;
    return error < knee ? kAtKnee / knee * error
                        : std::min(1.0f, kAtKnee + (error - knee) / (most - knee) * (1 - kAtKnee));
}

/// A filter along one axis, [2 radius + 1].
using Kernel = std::vector<float>;

/// Returns values of exp(-x² / (2 sd²)), not normalised.
Kernel gaussian(float standard_deviation, int radius) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x)
        kernel.push_back(
            std::exp(-0.5f * static_cast<float>(x * x) / (standard_deviation * standard_deviation)));
    return kernel;
}

Kernel scaled(Kernel kernel, float factor) {
    for (float& value : kernel)
        value *= factor;
    return kernel;
}

float sum_of(const Kernel& kernel) {
    float sum = 0;
    for (const float value : kernel)
        sum += value;
    return sum;
}

/// A separable filter: the outer product of kernels along x and y.
struct Separable {
    Kernel along_x, along_y;
};

/// Calls `row(y)` for all rows.
template <class Row>
void for_rows(int height, int threads, Row row) {
    parallel_for(static_cast<std::size_t>(height), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            row(static_cast<int>(y));
    });
}

/// One channel of a picture.
struct Plane {
    int width, height;
    std::vector<float> values; ///< [height][width]

    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(std::clamp(x, 0, width - 1));
    }
};

/// Filters a plane; pixels beyond the border repeat the border pixel.
Plane filtered(const Plane& plane, const Separable& filter, int threads) {
    Plane across{plane.width, plane.height, std::vector<float>(plane.values.size())}, result = across;
    const auto pass = [&](const Plane& from, Plane& to, const Kernel& kernel, int dx, int dy) {
        const int radius = static_cast<int>(kernel.size() / 2);
        for_rows(plane.height, threads, [&](int y) {
            for (int x = 0; x < plane.width; ++x) {
                float sum = 0;
                for (int k = -radius; k <= radius; ++k)
                    sum += kernel[static_cast<std::size_t>(k + radius)] *
                           from.values[from.at(x + k * dx, y + k * dy)];
                to.values[to.at(x, y)] = sum;
            }
        });
    };
    pass(plane, across, filter.along_x, 1, 0);
    pass(across, result, filter.along_y, 0, 1);
    return result;
}

/// A contrast sensitivity function as the sum of two Gaussians over degrees: a sqrt(pi / b) exp(-pi² x² / b).
struct Sensitivity {
    float a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivities = {
    {{1, 0.0047f, 0, 1e-5f}, {1, 0.0053f, 0, 1e-5f}, {34.1f, 0.04f, 13.5f, 0.025f}}};

/// Filters one channel with the contrast sensitivity of the eye, normalised to sum 1.
Plane as_seen(const Plane& plane, const Sensitivity& s, const FlipOptions& options) {
    const auto deviation = [&](float b) {
        return options.pixels_per_degree * std::sqrt(b / (2 * kPi * kPi));
    };
    const int radius = std::max(1, static_cast<int>(std::ceil(3 * deviation(0.04f))));
    std::vector<Separable> terms;
    float total = 0;
    for (const auto& [a, b] : {std::pair(s.a1, s.b1), std::pair(s.a2, s.b2)})
        if (a > 0) {
            const Kernel kernel = gaussian(deviation(b), radius);
            const float height = a * std::sqrt(kPi / b);
            terms.push_back({scaled(kernel, height), kernel});
            total += height * sum_of(kernel) * sum_of(kernel);
        }
    Plane sum{plane.width, plane.height, std::vector<float>(plane.values.size(), 0.0f)};
    for (const Separable& term : terms) {
        const Plane part = filtered(plane, term, options.threads);
        for (std::size_t i = 0; i < sum.values.size(); ++i)
            sum.values[i] += part.values[i] / total;
    }
    return sum;
}

struct FeatureKernels {
    Kernel smooth, first, second; ///< a Gaussian and its derivatives
};

/// Returns the kernels. The positive values of each derivative sum to 1 and the negative ones to -1; the
/// smoothing kernel sums to 1.
FeatureKernels feature_kernels(float pixels_per_degree) {
    const float deviation = std::max(0.5f * kFeatureWidth * pixels_per_degree, 1e-3f);
    const int radius = std::max(1, static_cast<int>(std::ceil(3 * deviation)));
    FeatureKernels kernels{gaussian(deviation, radius), {}, {}};
    kernels.smooth = scaled(kernels.smooth, 1 / sum_of(kernels.smooth));
    for (int x = -radius; x <= radius; ++x) {
        const auto t = static_cast<float>(x);
        const float g = kernels.smooth[static_cast<std::size_t>(x + radius)];
        kernels.first.push_back(-t * g);
        kernels.second.push_back((t * t / (deviation * deviation) - 1) * g);
    }
    for (Kernel* kernel : {&kernels.first, &kernels.second}) {
        float positive = 0, negative = 0;
        for (const float value : *kernel)
            (value > 0 ? positive : negative) += std::abs(value);
        for (float& value : *kernel)
            value /= value > 0 ? std::max(positive, 1e-30f) : std::max(negative, 1e-30f);
    }
    return kernels;
}

/// Returns the strength of edges or points of a lightness in 0..1, [height][width].
std::vector<float> features(const Plane& lightness, const FeatureKernels& kernels, const Kernel& derivative,
                            int threads) {
    const Plane x = filtered(lightness, {derivative, kernels.smooth}, threads),
                y = filtered(lightness, {kernels.smooth, derivative}, threads);
    std::vector<float> strength(x.values.size());
    for (std::size_t i = 0; i < strength.size(); ++i)
        strength[i] = std::hypot(x.values[i], y.values[i]);
    return strength;
}

/// Features of one picture for the comparison.
struct SeenPicture {
    std::vector<glm::vec3> lab; ///< after the contrast sensitivity
    std::vector<float> edges, points;
};

SeenPicture seen_picture(const Image& image, const FlipOptions& options) {
    const std::size_t pixels = image.pixels.size();
    std::array<Plane, 3> planes;
    planes.fill({image.width, image.height, std::vector<float>(pixels)});
    for (std::size_t i = 0; i < pixels; ++i) {
        const glm::vec3 opponent = to_opponent(glm::clamp(image.pixels[i], 0.0f, 1.0f));
        for (int c = 0; c < 3; ++c)
            planes[static_cast<std::size_t>(c)].values[i] = opponent[c];
    }
    Plane lightness = planes[0];
    for (float& value : lightness.values)
        value = (value + 16) / 116;
    SeenPicture seen;
    const FeatureKernels kernels = feature_kernels(options.pixels_per_degree);
    seen.edges = features(lightness, kernels, kernels.first, options.threads);
    seen.points = features(lightness, kernels, kernels.second, options.threads);
    for (std::size_t c = 0; c < 3; ++c)
        planes[c] = as_seen(planes[c], kSensitivities[c], options);
    for (std::size_t i = 0; i < pixels; ++i)
        seen.lab.push_back(hunt_adjusted_lab(glm::clamp(
            from_opponent({planes[0].values[i], planes[1].values[i], planes[2].values[i]}), 0.0f, 1.0f)));
    return seen;
}

void check_sizes(const Image& reference, const Image& test) {
    if (reference.width != test.width || reference.height != test.height)
        throw Error("the pictures cannot be compared: their sizes differ");
    if (reference.pixels.empty())
        throw Error("the pictures cannot be compared: they have no pixels");
}

/// Returns the tone curve of HDR-FLIP: the fit of Narkowicz (2016) after a factor of 0.6.
float tone_curve(float x) {
    const float v = 0.6f * x;
    return std::clamp(v * (2.51f * v + 0.03f) / (v * (2.43f * v + 0.59f) + 0.14f), 0.0f, 1.0f);
}

/// Returns the input at which the tone curve is `kShown`.
double input_of_shown() {
    const double a = 2.51 - kShown * 2.43, b = 0.03 - kShown * 0.59, c = -kShown * 0.14;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / 0.6;
}

Image exposed(const Image& image, double stops) {
    Image result = image;
    for (glm::vec3& pixel : result.pixels)
        for (int c = 0; c < 3; ++c) // far above white the curve is constant
            pixel[c] = tone_curve(static_cast<float>(
                std::min(1e6, static_cast<double>(std::max(0.0f, pixel[c])) * std::exp2(stops))));
    return result;
}

} // namespace

std::vector<float> flip(const Image& reference, const Image& test, const FlipOptions& options) {
    check_sizes(reference, test);
    const SeenPicture a = seen_picture(reference, options), b = seen_picture(test, options);
    std::vector<float> result(a.lab.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const float color = redistributed(hyab(a.lab[i], b.lab[i]));
        const float feature =
            std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
        const float exponent =
            1 - std::min(1.0f, std::pow(feature / std::numbers::sqrt2_v<float>, kFeatureExponent));
        result[i] = std::pow(color, exponent);
    }
    return result;
}

FlipExposures flip_exposures(const Image& reference) {
    std::vector<double> luminances;
    for (const glm::vec3& pixel : reference.pixels)
        luminances.push_back(std::max(0.0, luminance(glm::dvec3(pixel))));
    if (luminances.empty())
        return {};
    const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
    std::nth_element(luminances.begin(), middle, luminances.end());
    const double brightest = *std::max_element(middle, luminances.end()),
                 median = std::max(*middle, kDarkestMedian * brightest);
    if (!(brightest > 0))
        return {};
    const double start = std::log2(input_of_shown() / brightest), stop = std::log2(input_of_shown() / median);
    return {start, stop, std::max(2, static_cast<int>(std::ceil(stop - start)))};
}

std::vector<float> hdr_flip(const Image& reference, const Image& test, const FlipOptions& options) {
    check_sizes(reference, test);
    for (const Image* image : {&reference, &test})
        for (const glm::vec3& pixel : image->pixels)
            if (!std::isfinite(pixel.r + pixel.g + pixel.b))
                throw Error("the pictures cannot be compared: a pixel is not finite");
    const FlipExposures exposures = flip_exposures(reference);
    std::vector<float> greatest(reference.pixels.size(), 0.0f);
    for (int i = 0; i < exposures.count; ++i) {
        const double stops = exposures.start + (exposures.stop - exposures.start) * i / (exposures.count - 1);
        const std::vector<float> one = flip(exposed(reference, stops), exposed(test, stops), options);
        std::ranges::transform(greatest, one, greatest.begin(),
                               [](float a, float b) { return std::max(a, b); });
    }
    return greatest;
}

} // namespace prt
