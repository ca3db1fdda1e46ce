// Centers and solid angles of texels for each layout (docs/math.md, section 3).
#include "runtime/fit/texels.h"

#include "runtime/fit/gauss_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {

using std::numbers::pi;

namespace {

/// Returns the solid angle of the part of a cube face between its center and (u, v).
double solid_angle_to(double u, double v) {
    return std::atan2(u * v, std::sqrt(1 + u * u + v * v));
}

} // namespace

Texels::Texels(const Environment& environment)
    : layout_(environment.layout), center_(environment.center),
      width_(static_cast<std::size_t>(environment.image.width)),
      height_(static_cast<std::size_t>(environment.image.height)) {
    if (layout_ == EnvironmentLayout::lat_long)
        set_lat_long();
    else
        set_square(layout_);
}

void Texels::set_lat_long() {
    const auto width = static_cast<double>(width_), height = static_cast<double>(height_);
    spacing_ = pi * std::max(1 / height, 2 / width);
    for (std::size_t y = 0; y < height_; ++y) {
        const double theta = pi * (static_cast<double>(y) + 0.5) / height;
        polar_.push_back({std::cos(theta), std::sin(theta)});
        // cos(a) - cos(b) as a product, which avoids cancellation in small texels.
        row_solid_angle_.push_back(2 * pi / width * 2 * std::sin(theta) * std::sin(0.5 * pi / height));
    }
    for (std::size_t x = 0; x < width_; ++x) {
        const double longitude = 2 * pi * (0.5 - (static_cast<double>(x) + 0.5) / width);
        azimuth_.push_back({std::cos(longitude), std::sin(longitude)});
    }
}

void Texels::set_square(EnvironmentLayout layout) {
    const auto size = static_cast<double>(width_);
    spacing_ = 2 / size * (layout == EnvironmentLayout::angular ? pi : 1);
    for (std::size_t i = 0; i < width_; ++i) {
        const auto at = static_cast<double>(i);
        if (layout != EnvironmentLayout::cube || width_ == 1)
            cells_.push_back({2 * at / size - 1, 2 * (at + 1) / size - 1});
        else // the centers of border texels are on the border
            cells_.push_back({std::max(-1.0, (2 * at - 1) / (size - 1) - 1),
                              std::min(1.0, (2 * at + 1) / (size - 1) - 1)});
    }
}

Texels::CellPair Texels::square(std::size_t texel) const {
    return {cells_[texel % width_], cells_[texel / width_ % width_]};
}

glm::dvec3 Texels::direction(std::size_t texel) const {
    if (layout_ == EnvironmentLayout::lat_long) {
        const Rotation &polar = polar_[texel / width_], &azimuth = azimuth_[texel % width_];
        const double left = polar.sine * azimuth.sine, ahead = polar.sine * azimuth.cosine;
        return center_ == LatLongCenter::z ? glm::dvec3(left, polar.cosine, ahead)
                                           : glm::dvec3(ahead, polar.cosine, -left);
    }
    const auto [u, v] = square(texel);
    const int face = static_cast<int>(texel / (width_ * width_));
    if (layout_ == EnvironmentLayout::angular)
        return angular_direction(u.middle(), v.middle());
    return layout_ == EnvironmentLayout::cube ? cube_direction(face, u.middle(), v.middle())
                                              : cube_face_direction(face, u.middle(), v.middle());
}

double Texels::solid_angle(std::size_t texel) const {
    if (layout_ == EnvironmentLayout::lat_long)
        return row_solid_angle_[texel / width_];
    const auto [u, v] = square(texel);
    if (layout_ != EnvironmentLayout::angular)
        return solid_angle_to(u.end, v.end) - solid_angle_to(u.begin, v.end) -
               solid_angle_to(u.end, v.begin) + solid_angle_to(u.begin, v.begin);
    // Integrates sin(angle) dangle over r dr in area coordinates, over the part of each line inside the
    // circle.
    double sum = 0;
    for (const GaussPoint& line : gauss_points(v.begin, v.end)) {
        const double reach = std::sqrt(std::max(0.0, 1 - line.at * line.at));
        const double begin = std::max(u.begin, -reach), end = std::min(u.end, reach);
        if (begin < end)
            for (const GaussPoint& point : gauss_points(begin, end)) {
                const double r = std::hypot(point.at, line.at);
                sum += line.weight * point.weight * (r > 0 ? std::sin(pi * r) / r : pi) * pi;
            }
    }
    return sum;
}

} // namespace prt
