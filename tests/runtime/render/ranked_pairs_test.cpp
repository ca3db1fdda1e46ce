// Ten pairs of pictures, ranked by eye from slight to severe errors: a floor with a lamp 5 cm above one
// corner, four hundred times as bright as the rest, and a ball with a contact shadow. The visible error has
// an equal ranking; relative L2, which the lamp dominates, does not.

#include "prt/core/error_measures.h"
#include "runtime/render/flip.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <string>

namespace prt {
namespace {

constexpr int kSize = 48;   ///< pixels, which are the receivers, too
constexpr double kSide = 4; ///< metres

struct Floor {
    double lamp, ceiling, sky, open; ///< open: fraction of the sky that the ball leaves visible
    double light(double ambient_visibility) const { return lamp + ceiling + sky * ambient_visibility; }
};

Floor floor_at(const glm::dvec2& p) {
    const auto from = [&](double x, double y) { return (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y); };
    const double height = 0.05, radius = 0.55, d = from(2.4, 2.2) + radius * radius;
    return {.lamp = 0.4 * height / std::pow(height * height + from(0.5, 0.5), 1.5),
            .ceiling = 5.6 / std::pow(4 + from(2.5, 1.2), 2),
            .sky = 0.15,
            .open = 1 - std::pow(radius * radius / d, 1.5)}; // form factor of a sphere on the floor
}

/// Waves of lengths about 0.4 m in random directions, of variance 1.
class Waves {
public:
    explicit Waves(unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi), length(0.3, 0.6);
        for (Wave& wave : waves_) {
            const double direction = angle(random), number = 2 * std::numbers::pi / length(random);
            wave = {number * glm::dvec2(std::cos(direction), std::sin(direction)), angle(random)};
        }
    }
    double operator()(const glm::dvec2& p) const {
        double sum = 0;
        for (const Wave& wave : waves_)
            sum += std::cos(glm::dot(wave.vector, p) + wave.phase);
        return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));
    }

private:
    struct Wave {
        glm::dvec2 vector{0};
        double phase = 0;
    };
    std::array<Wave, 24> waves_;
};

const glm::dvec3 kTint(1, 0.93, 0.85);

using Radiance = std::function<glm::dvec3(const glm::dvec2&)>;

glm::dvec3 truth(const glm::dvec2& p) {
    const Floor floor = floor_at(p);
    return floor.light(floor.open) * kTint;
}

Image picture_of(const Radiance& radiance) {
    Image image{kSize, kSize, {}};
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            image.pixels.emplace_back(radiance(kSide / kSize * glm::dvec2(x + 0.5, y + 0.5)));
    return image;
}

/// How bad a pair looks.
enum class Look { same, slight, visible, obvious, ruined };

struct Pair {
    std::string name;
    Look look;
    Radiance radiance;
};

Radiance scaled(const std::function<double(const glm::dvec2&)>& factor) {
    return [factor](const glm::dvec2& p) { return factor(p) * truth(p); };
}

/// Returns white noise of this standard deviation, different for each call.
std::function<double(const glm::dvec2&)> noise(double deviation, unsigned seed) {
    return [random = std::mt19937(seed), normal = std::normal_distribution<double>(0, deviation)](
               const glm::dvec2&) mutable { return 1 + normal(random); };
}

glm::dvec3 colored_waves(const glm::dvec2& p, unsigned seed) {
    return {Waves(seed)(p), Waves(seed + 1)(p), Waves(seed + 2)(p)};
}

std::vector<Pair> pairs() {
    return {
        {"the lamp's own spot 10 % too bright", Look::same,
         scaled([](const glm::dvec2& p) { return glm::distance(p, glm::dvec2(0.5)) < 0.12 ? 1.1 : 1.0; })},
        {"1 % too dark", Look::same, scaled([](const glm::dvec2&) { return 0.99; })},
        {"noise of 1 %", Look::same, scaled(noise(0.01, 1))},
        {"bands of 5 %", Look::slight,
         [](const glm::dvec2& p) { return glm::exp(glm::round(glm::log(truth(p)) / 0.05) * 0.05); }},
        {"a seam of 5 %", Look::slight, scaled([](const glm::dvec2& p) { return p.x > 1.9 ? 1.05 : 1.0; })},
        {"no contact shadow", Look::visible,
         [](const glm::dvec2& p) { return floor_at(p).light(1) * kTint; }},
        {"colored stains where light is faint", Look::obvious,
         [](const glm::dvec2& p) { return truth(p) + 0.035 * colored_waves(p, 8); }},
        {"noise of 10 %", Look::obvious, scaled(noise(0.1, 2))},
        {"blotches of 15 %", Look::obvious,
         scaled([](const glm::dvec2& p) { return 1 + 0.15 * Waves(3)(p); })},
        {"colored blotches of 30 %", Look::ruined,
         [](const glm::dvec2& p) { return (1.0 + 0.3 * colored_waves(p, 5)) * truth(p); }},
    };
}

std::vector<Edge> grid_edges() {
    std::vector<Edge> edges;
    for (std::uint32_t y = 0; y < kSize; ++y)
        for (std::uint32_t x = 0; x < kSize; ++x) {
            if (x + 1 < kSize)
                edges.push_back({y * kSize + x, y * kSize + x + 1});
            if (y + 1 < kSize)
                edges.push_back({y * kSize + x, (y + 1) * kSize + x});
        }
    return edges;
}

/// True if every pair that looks worse than a second one has the greater number.
bool ranked(const std::vector<double>& numbers) {
    const std::vector<Pair> all = pairs();
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = 0; j < all.size(); ++j)
            if (all[i].look < all[j].look && numbers[i] >= numbers[j])
                return false;
    return true;
}

TEST(RankedPairs, AreRankedByVisibleErrorAndByFlipAndNotByRelativeL2) {
    const Image reference = picture_of(truth);
    const std::vector<float> areas(reference.pixels.size(), 1.0f);
    const std::vector<Edge> edges = grid_edges();
    std::vector<double> l2, visible, flips;
    for (const Pair& pair : pairs()) {
        const Image image = picture_of(pair.radiance);
        const LitError error = lit_error(reference.pixels, image.pixels, areas, edges, std::nullopt);
        l2.push_back(error.rms);
        visible.push_back(error.visible.mean);
        const std::vector<float> flip = hdr_flip(reference, image, {.pixels_per_degree = 12, .threads = 1});
        flips.push_back(std::accumulate(flip.begin(), flip.end(), 0.0) / static_cast<double>(flip.size()));
    }
    EXPECT_TRUE(ranked(visible));
    EXPECT_TRUE(ranked(flips));
    EXPECT_FALSE(ranked(l2));
}

} // namespace
} // namespace prt
