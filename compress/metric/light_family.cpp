// Computes second moments of families of lightings (docs/math.md, section 4).

#include "compress/metric/light_family.h"

#include "compress/metric/color_blocks.h"
#include "compress/metric/natural_share.h"
#include "compress/metric/standard_skies.h"
#include "compress/tuning/tuning.h"
#include "prt/core/sh.h"

#include <Eigen/Dense>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

using Matrix = Eigen::MatrixXd;
using std::numbers::pi;

void add_clear_day(double elevation, double turbidity, double weight, int order, FamilyModel& model) {
    model.members.push_back({daylight(order, {.sun_elevation = elevation, .turbidity = turbidity}), weight});
}

FamilyModel outdoor_model(int order) {
    FamilyModel model;
    for (const double degrees : {6.0, 15.0, 30.0, 45.0, 65.0, 85.0})
        for (const double turbidity : {2.5, 6.0})
            add_clear_day(glm::radians(degrees), turbidity, 1, order, model);
    model.members.push_back({overcast_day(order), 2});
    return model;
}

/// Returns an equinox at 45 degrees north, hour by hour: the sine of the sun's elevation is cos(latitude)
/// cos(hour angle).
FamilyModel day_model(int order) {
    FamilyModel model;
    for (int hour = 0; hour < 6; ++hour)
        add_clear_day(std::asin(std::cos(pi / 4) * std::cos(hour * pi / 12)), 3, hour == 0 ? 1 : 2, order,
                      model);
    return model;
}

/// Returns rooms with light from low windows to lamps overhead.
FamilyModel indoor_model(int order) {
    FamilyModel model;
    for (const double degrees : {15.0, 40.0, 65.0, 88.0})
        model.members.push_back({room_light(order, glm::radians(degrees))});
    return model;
}

/// Joint moments of the direct and other coefficients, [2 order²][2 order²], of one color.
class PairMoments {
public:
    explicit PairMoments(int order)
        : order_(order), size_(coefficient_count(order)), sums_(Matrix::Zero(2 * size_, 2 * size_)) {}

    /// Adds the mean over all rotations: 2N - 1 rotations are exact, because two coefficients have
    /// frequencies about +Y below N each.
    void add_rotations(const Light& direct, const Light& other, double scale) {
        const int rotations = 2 * order_ - 1;
        Matrix pairs(2 * size_, rotations);
        for (int k = 0; k < rotations; ++k) {
            const double angle = 2 * pi * k / rotations;
            pairs.col(k) << red(rotated_about_y(direct, angle)), red(rotated_about_y(other, angle));
        }
        sums_ += scale / rotations * pairs * pairs.transpose();
    }

    /// Adds texture, which lights all terms.
    void add_texture(const std::vector<double>& powers, double scale) {
        for (int l = 0; l < order_; ++l)
            for (Eigen::Index i = l * l; i < (l + 1) * (l + 1); ++i)
                for (const Eigen::Index row : {i, size_ + i})
                    for (const Eigen::Index column : {i, size_ + i})
                        sums_(row, column) += scale * powers[static_cast<std::size_t>(l)];
    }

    double operator()(Eigen::Index row, Eigen::Index column) const { return sums_(row, column); }

private:
    static Eigen::VectorXd red(const Light& light) {
        Eigen::VectorXd values(static_cast<Eigen::Index>(light.coefficients.size()));
        for (Eigen::Index i = 0; i < values.size(); ++i)
            values[i] = static_cast<double>(light.coefficients[static_cast<std::size_t>(i)].x);
        return values;
    }

    int order_;
    Eigen::Index size_;
    Matrix sums_;
};

/// Adds draws of one use of a member: `direct` lights direct transfer, and `all` lights the other terms.
void add_draws(const Light& direct, const Light& all, double weight, const std::vector<double>& texture,
               PairMoments& moments) {
    const double scale = weight / open_square(direct, texture);
    moments.add_rotations(direct, all, scale);
    moments.add_texture(texture, scale);
}

/// Adds a member. If `separate`, half of the draws exclude suns from direct light.
void add_member(const FamilyMember& member, const std::vector<double>& texture, bool separate,
                PairMoments& moments) {
    const Light& sky = member.lighting.sky;
    const auto of_band_0 = static_cast<double>(sky.coefficients[0].x);
    std::vector<double> powers = texture;
    for (double& power : powers)
        power *= of_band_0 * of_band_0;
    if (!member.lighting.suns)
        return add_draws(sky, sky, member.weight, powers, moments);
    const Light all = sum(sky, *member.lighting.suns);
    if (separate)
        add_draws(sky, all, member.weight / 2, powers, moments);
    add_draws(all, all, separate ? member.weight / 2 : member.weight, powers, moments);
}

/// Adds the moments for each color of distant light.
void spread(const PairMoments& moments, LightMetric& metric) {
    const TransferLayout& layout = metric.layout;
    const std::size_t size = static_cast<std::size_t>(coefficient_count(layout.order)),
                      dimension = layout.dimension();
    const auto place_in_pair = [&](std::size_t column) {
        const bool direct = layout.terms[column / size].kind == TermKind::direct;
        return static_cast<Eigen::Index>((direct ? 0 : size) + column % size);
    };

    // If no term has color, the metric is the mean over the three colors.
    const double share = layout.channels() == 3 ? 1 : 1.0 / 3;
    const std::size_t columns = layout.distant_terms().size() * size;
    for (int c = 0; c < 3; ++c) {
        const std::vector<std::size_t> numbers = numbers_of_color(layout, c);
        for (std::size_t i = 0; i < columns; ++i)
            for (std::size_t j = 0; j < columns; ++j)
                metric.moments[numbers[i] * dimension + numbers[j]] +=
                    share * moments(place_in_pair(i), place_in_pair(j));
    }
}

} // namespace

FamilyModel family_model(LightFamily family, int order) {
    FamilyModel model;
    double power = tuning::kTextureOutdoors, fall = tuning::kTextureFallOutdoors;
    switch (family) {
    case LightFamily::natural:
        return model;
    case LightFamily::outdoor:
        model = outdoor_model(order);
        break;
    case LightFamily::day:
        model = day_model(order);
        break;
    case LightFamily::indoor:
        model = indoor_model(order);
        power = tuning::kTextureIndoors;
        fall = tuning::kTextureFallIndoors;
        break;
    }
    model.texture.assign(static_cast<std::size_t>(order), 0);
    for (int l = 1; l < order; ++l)
        model.texture[static_cast<std::size_t>(l)] = power * std::pow(l, -fall);
    return model;
}

std::vector<Lighting> members_of_family(LightFamily family, int order) {
    std::vector<Lighting> lightings;
    for (FamilyMember& member : family_model(family, order).members)
        lightings.push_back(std::move(member.lighting));
    return lightings;
}

double open_square(const Light& light, const std::vector<double>& texture_powers) {
    double sum = 0;
    for (int l = 0; l < light.order; ++l) {
        double power = (2 * l + 1) * texture_powers[static_cast<std::size_t>(l)];
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
            const auto value = static_cast<double>(light.coefficients[static_cast<std::size_t>(i)].x);
            power += value * value;
        }
        const double factor = clamped_cosine_factor(l);
        sum += factor * factor * power;
    }
    return sum / (4 * pi);
}

LightMetric metric_of_family(LightFamily family, const TransferLayout& layout) {
    if (family == LightFamily::natural)
        return natural_metric(layout);
    check_layout(layout);
    LightMetric metric{layout, std::vector<double>(layout.dimension() * layout.dimension(), 0.0)};
    if (layout.distant_terms().empty())
        return natural_metric(layout);
    const FamilyModel model = family_model(family, layout.order);
    PairMoments moments(layout.order);
    double weights = 0;
    for (const FamilyMember& member : model.members) {
        add_member(member, model.texture, layout.has(TermKind::direct), moments);
        weights += member.weight;
    }
    spread(moments, metric);
    for (double& moment : metric.moments)
        moment /= weights;
    add_natural_share(metric);
    return metric;
}

} // namespace prt
