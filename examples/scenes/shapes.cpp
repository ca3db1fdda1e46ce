// Builds lofted surfaces, lathes, sweeps, boxes and tubes.

#include "shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace examples {
namespace {

using Rows = std::vector<std::vector<glm::vec3>>;

glm::vec3 difference(const std::vector<glm::vec3>& line, std::size_t i, bool closed) {
    const std::size_t last = line.size() - 1;
    if (closed)
        return line[i == last ? 1 : i + 1] - line[i == 0 ? last - 1 : i - 1];
    return line[std::min(i + 1, last)] - line[i == 0 ? 0 : i - 1];
}

std::vector<float> lengths_along(const std::vector<glm::vec3>& line) {
    std::vector<float> lengths = {0};
    for (std::size_t i = 1; i < line.size(); ++i)
        lengths.push_back(lengths.back() + glm::distance(line[i - 1], line[i]));
    return lengths;
}

std::vector<glm::vec3> column_of(const Rows& rows, std::size_t column) {
    std::vector<glm::vec3> line;
    for (const auto& row : rows)
        line.push_back(row[column]);
    return line;
}

/// Returns the unit normals of the grid; at a pole, the mean normal of the adjacent row.
std::vector<glm::vec3> grid_normals(const Rows& rows) {
    const std::size_t columns = rows[0].size();
    const bool closed = std::all_of(rows.begin(), rows.end(), [](const auto& row) {
        return glm::distance(row.front(), row.back()) < 1e-5f;
    });
    std::vector<glm::vec3> normals(rows.size() * columns);
    for (std::size_t column = 0; column < columns; ++column) {
        const std::vector<glm::vec3> line = column_of(rows, column);
        for (std::size_t row = 0; row < rows.size(); ++row)
            normals[row * columns + column] =
                glm::cross(difference(rows[row], column, closed), difference(line, row, false));
    }
    for (glm::vec3& normal : normals)
        if (glm::length(normal) > 1e-12f)
            normal = glm::normalize(normal);
    for (const std::size_t row : {std::size_t(0), rows.size() - 1}) {
        if (glm::distance(rows[row][0], rows[row][columns / 2]) > 1e-6f)
            continue;
        const std::size_t beside = row == 0 ? 1 : row - 1;
        glm::vec3 mean(0);
        for (std::size_t column = 0; column < columns; ++column)
            mean += normals[beside * columns + column];
        std::fill_n(normals.begin() + static_cast<std::ptrdiff_t>(row * columns), columns,
                    glm::normalize(mean));
    }
    return normals;
}

void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto& p = mesh.positions;
    if (glm::length(glm::cross(p[b] - p[a], p[c] - p[a])) > 1e-10f) // else it lies at a pole
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

/// Splits the outline at its edges, each piece with points at most kShapeSpacing from the next.
std::vector<Outline> smooth_pieces(const Outline& outline) {
    std::vector<Outline> pieces(1);
    for (const glm::vec2& point : outline) {
        Outline& piece = pieces.back();
        if (!piece.empty() && glm::distance(piece.back(), point) < 1e-6f) {
            pieces.push_back({point});
            continue;
        }
        if (!piece.empty()) {
            const glm::vec2 from = piece.back();
            const int steps = static_cast<int>(std::ceil(glm::distance(from, point) / kShapeSpacing));
            for (int i = 1; i < steps; ++i)
                piece.push_back(glm::mix(from, point, static_cast<float>(i) / static_cast<float>(steps)));
        }
        piece.push_back(point);
    }
    return pieces;
}

/// From `low` to `high` through `stops`, with steps of about `spacing`.
std::vector<float> ruled(float low, float high, std::vector<float> stops, float spacing) {
    stops.insert(stops.end(), {low, high});
    std::sort(stops.begin(), stops.end());
    std::vector<float> lines = {low};
    for (const float stop : stops) {
        const float from = lines.back();
        if (stop - from < 1e-5f || stop > high)
            continue;
        const int steps = std::max(1, static_cast<int>(std::lround((stop - from) / spacing)));
        for (int i = 1; i <= steps; ++i)
            lines.push_back(std::lerp(from, stop, static_cast<float>(i) / static_cast<float>(steps)));
    }
    return lines;
}

/// Only the vertices that triangles have.
Mesh without_unused(const Mesh& mesh) {
    constexpr std::uint32_t kUnused = 0xffffffff;
    std::vector<std::uint32_t> renamed(mesh.positions.size(), kUnused);
    Mesh used;
    for (const std::uint32_t index : mesh.indices) {
        if (renamed[index] == kUnused) {
            renamed[index] = static_cast<std::uint32_t>(used.positions.size());
            used.positions.push_back(mesh.positions[index]);
            used.normals.push_back(mesh.normals[index]);
            used.texcoords.push_back(mesh.texcoords[index]);
        }
        used.indices.push_back(renamed[index]);
    }
    return used;
}

} // namespace

Mesh lofted(const Rows& rows) {
    Mesh mesh;
    mesh.normals = grid_normals(rows);
    const auto longest = std::max_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
        return lengths_along(a).back() < lengths_along(b).back();
    });
    const std::vector<float> across = lengths_along(*longest), up = lengths_along(column_of(rows, 0));
    for (std::size_t row = 0; row < rows.size(); ++row)
        for (std::size_t column = 0; column < rows[row].size(); ++column) {
            mesh.positions.push_back(rows[row][column]);
            mesh.texcoords.emplace_back(across[column], -up[row]);
        }
    const auto stride = static_cast<std::uint32_t>(rows[0].size());
    for (std::uint32_t row = 0; row + 1 < rows.size(); ++row)
        for (std::uint32_t column = 0; column + 1 < stride; ++column) {
            const std::uint32_t a = row * stride + column, b = a + 1, c = b + stride, d = a + stride;
            add_triangle(mesh, a, b, c);
            add_triangle(mesh, a, c, d);
        }
    return without_unused(mesh); // poles have more than they need
}

Mesh lathe(const glm::vec3& base, const Outline& outline, int segments) {
    Mesh mesh;
    for (const Outline& piece : smooth_pieces(outline)) {
        Rows rows;
        for (const glm::vec2& point : piece) {
            auto& row = rows.emplace_back();
            for (int i = 0; i <= segments; ++i) {
                const float angle = kTurn * static_cast<float>(i % segments) / static_cast<float>(segments);
                row.push_back(base +
                              glm::vec3(point.x * std::sin(angle), point.y, point.x * std::cos(angle)));
            }
        }
        append(mesh, lofted(rows));
    }
    return mesh;
}

Mesh polygonal_lathe(const glm::vec3& base, const Outline& outline, int sides) {
    const auto corner = [&](int i) {
        const float half = kTurn / 2 / static_cast<float>(sides),
                    angle = half * static_cast<float>(2 * i + 1);
        return glm::vec3(std::sin(angle), 0, std::cos(angle)) / std::cos(half);
    };
    const auto widest = std::max_element(outline.begin(), outline.end(),
                                         [](const auto& a, const auto& b) { return a.x < b.x; });
    const float side = widest->x * glm::distance(corner(0), corner(1));
    const int steps = std::max(1, static_cast<int>(std::lround(side / kShapeSpacing)));
    Mesh mesh;
    for (int i = 0; i < sides; ++i) {
        std::vector<Station> way;
        for (int step = 0; step <= steps; ++step) {
            const float along = static_cast<float>(step) / static_cast<float>(steps);
            way.push_back({base, glm::mix(corner(i), corner(i + 1), along), {0, 1, 0}});
        }
        append(mesh, moulding(outline, way));
    }
    return mesh;
}

Mesh moulding(const Outline& outline, std::span<const Station> way) {
    Mesh mesh;
    for (const Outline& piece : smooth_pieces(outline)) {
        Rows rows;
        for (const glm::vec2& point : piece) {
            auto& row = rows.emplace_back();
            for (const Station& station : way)
                row.push_back(station.origin + point.x * station.out + point.y * station.up);
        }
        append(mesh, lofted(rows));
    }
    return mesh;
}

std::vector<Station> straight_way(const glm::vec3& from, const glm::vec3& to) {
    const glm::vec3 up(0, 1, 0), out = glm::cross(glm::normalize(to - from), up);
    const int steps = std::max(1, static_cast<int>(std::lround(glm::distance(from, to) / kShapeSpacing)));
    std::vector<Station> way;
    for (int i = 0; i <= steps; ++i)
        way.push_back({glm::mix(from, to, static_cast<float>(i) / static_cast<float>(steps)), out, up});
    return way;
}

Mesh box(const glm::vec3& low, const glm::vec3& high, float spacing) {
    const glm::vec3 size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    Mesh mesh;
    append(mesh, rectangle(low + z, x, y, spacing));
    append(mesh, rectangle(low + x, -x, y, spacing));
    append(mesh, rectangle(low + x + z, -z, y, spacing));
    append(mesh, rectangle(low, z, y, spacing));
    append(mesh, rectangle(low + y + z, x, -z, spacing));
    append(mesh, rectangle(low, x, z, spacing));
    return mesh;
}

Mesh bar(std::span<const glm::vec3> points, std::span<const float> radii, int segments) {
    Rows rows;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec3 along =
            glm::normalize(points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1]);
        // A reference direction that is parallel to no bar of the scenes, so that rings do not twist.
        const glm::vec3 side = glm::normalize(glm::cross(along, glm::vec3(0.28f, 0.11f, 0.95f))),
                        other = glm::cross(along, side);
        auto& row = rows.emplace_back();
        for (int j = 0; j <= segments; ++j) {
            const float angle = kTurn * static_cast<float>(j % segments) / static_cast<float>(segments);
            row.push_back(points[i] + radii[i] * (std::cos(angle) * side + std::sin(angle) * other));
        }
    }
    return lofted(rows);
}

Mesh bar(const glm::vec3& from, const glm::vec3& to, float radius, int segments) {
    return bar(std::array{from, to}, std::array{radius, radius}, segments);
}

Mesh sphere(const glm::vec3& center, float radius, int segments) {
    Outline outline;
    const int rows = segments / 2;
    for (int i = 0; i <= rows; ++i) {
        const float angle = kTurn / 2 * static_cast<float>(i) / static_cast<float>(rows);
        outline.emplace_back(radius * std::abs(std::sin(angle)), -radius * std::cos(angle));
    }
    outline.front().x = outline.back().x = 0;
    return lathe(center, outline, segments);
}

Mesh wall_with_openings(const glm::vec2& low, const glm::vec2& high, std::span<const Opening> openings,
                        float spacing) {
    std::vector<float> stops_x, stops_y;
    for (const Opening& opening : openings) {
        stops_x.insert(stops_x.end(), {opening.low.x, opening.high.x});
        stops_y.insert(stops_y.end(), {opening.low.y, opening.high.y});
    }
    const std::vector<float> xs = ruled(low.x, high.x, stops_x, spacing),
                             ys = ruled(low.y, high.y, stops_y, spacing);
    Rows rows;
    for (const float y : ys)
        for (auto& row = rows.emplace_back(); const float x : xs)
            row.emplace_back(x, y, 0);
    Mesh mesh = lofted(rows);
    std::vector<std::uint32_t> kept;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const auto* corners = &mesh.indices[t];
        const glm::vec3 middle =
            (mesh.positions[corners[0]] + mesh.positions[corners[1]] + mesh.positions[corners[2]]) / 3.0f;
        const bool open = std::any_of(openings.begin(), openings.end(), [&](const Opening& o) {
            return middle.x > o.low.x && middle.x < o.high.x && middle.y > o.low.y && middle.y < o.high.y;
        });
        if (!open)
            kept.insert(kept.end(), corners, corners + 3);
    }
    mesh.indices = std::move(kept);
    return without_unused(mesh);
}

} // namespace examples
