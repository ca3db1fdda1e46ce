#include "report.h"

#include "prt/receiver_colors.h"
#include "prt/tone_map.h"

#include <fmt/core.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <string_view>

namespace comparison {
namespace {

/// Error that is white, over the mean radiance of the reference.
constexpr double kWhite = 0.5;
constexpr int kTileWidth = 300;

/// The rows that the picture shows.
std::vector<const Row*> shown(const SceneResult& scene) {
    std::vector<const Row*> rows;
    for (const Row& row : scene.rows)
        for (const std::string_view wanted : {"unshadowed irradiance", "SSAO, with normals", "baked AO",
                                              "PRT, order 3", "PRT, order 6, 12 bytes"})
            if (row.method.starts_with(wanted))
                rows.push_back(&row);
    return rows;
}

/// Error as heat, of means over `factor` x `factor` pixels: single pixels of the reference are noisy.
prt::Image heat_of(const SceneResult& scene, const prt::Image& picture, int factor) {
    const prt::Image seen = prt::downsampled(picture, factor),
                     reference = prt::downsampled(scene.reference, factor);
    prt::Image covered = scene.reference;
    for (std::size_t i = 0; i < covered.pixels.size(); ++i)
        covered.pixels[i] = glm::vec3(scene.surfaces[i] ? 1 : 0);
    covered = prt::downsampled(covered, factor);
    double sum = 0, share = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        sum += static_cast<double>(glm::dot(reference.pixels[i], glm::vec3(covered.pixels[i].r / 3)));
        share += static_cast<double>(covered.pixels[i].r);
    }
    prt::Image heat = seen;
    for (std::size_t i = 0; i < heat.pixels.size(); ++i) {
        const glm::vec3 d = glm::abs(seen.pixels[i] - reference.pixels[i]);
        const double error = static_cast<double>(std::max({d.r, d.g, d.b})) / (kWhite * sum / share);
        heat.pixels[i] = covered.pixels[i].r > 0.99f ? prt::heat_color(error) : glm::vec3(0.2f);
    }
    return heat;
}

/// The legend: no error on the left, kWhite on the right.
prt::Image ramp(int width, int height) {
    prt::Image image{width, height,
                     std::vector<glm::vec3>(static_cast<std::size_t>(width * height), glm::vec3(1))};
    for (int y = height * 2 / 5; y < height * 3 / 5; ++y)
        for (int x = width / 10; x < width * 9 / 10; ++x)
            image.at(x, y) = prt::heat_color((x - 0.1 * width) / (0.8 * width));
    return image;
}

/// `image` as a tile whose left edge is at `x`.
void paste(const std::vector<glm::u8vec3>& tile, int tile_width, int tile_height,
           std::vector<glm::u8vec3>& sheet, int sheet_width, int x, int y) {
    for (int row = 0; row < tile_height; ++row)
        std::copy_n(tile.begin() + row * tile_width, tile_width, sheet.begin() + (y + row) * sheet_width + x);
}

double mean(const Row& row) {
    double sum = 0;
    for (const double error : row.errors)
        sum += error;
    return sum / static_cast<double>(row.errors.size());
}

/// Mean error over the skies of the methods that matter, a scene a column.
std::string summary(const std::vector<SceneResult>& scenes) {
    std::string table = "Mean error over the skies; the tables below have each.\n\n| method |";
    for (const SceneResult& scene : scenes)
        table += " " + scene.name + " |";
    table += "\n| --- |";
    for (std::size_t i = 0; i < scenes.size(); ++i)
        table += " --- |";
    table += "\n";
    for (std::size_t r = 0; r < scenes.front().rows.size(); ++r) {
        // Without the radius of SSAO, which differs.
        const std::string& method = scenes.front().rows[r].method;
        table += "| " + method.substr(0, method.find(" (")) + " |";
        for (const SceneResult& scene : scenes)
            table += fmt::format(" {:.1f} % |", 100 * mean(scene.rows[r]));
        table += "\n";
    }
    return table + "\n";
}

} // namespace

void write_pictures(const std::vector<SceneResult>& scenes, const Options& options,
                    const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    const int factor = std::max(1, options.width / kTileWidth), width = options.width / factor,
              height = options.height / factor;
    for (const SceneResult& scene : scenes) {
        const auto rows = shown(scene);
        const int columns = 1 + static_cast<int>(rows.size()), sheet_width = columns * width;
        std::vector<glm::u8vec3> sheet(
            static_cast<std::size_t>(sheet_width) * static_cast<std::size_t>(2 * height), glm::u8vec3(255));
        paste(prt::tone_mapped(scene.reference, factor, scene.exposure, prt::ToneMap::filmic), width, height,
              sheet, sheet_width, 0, 0);
        paste(prt::tone_mapped(ramp(width, height), 1, 1, prt::ToneMap::srgb), width, height, sheet,
              sheet_width, 0, height);
        for (int c = 1; c < columns; ++c) {
            const prt::Image& picture = rows[static_cast<std::size_t>(c - 1)]->picture;
            paste(prt::tone_mapped(picture, factor, scene.exposure, prt::ToneMap::filmic), width, height,
                  sheet, sheet_width, c * width, 0);
            paste(prt::tone_mapped(heat_of(scene, picture, factor), 1, 1, prt::ToneMap::srgb), width, height,
                  sheet, sheet_width, c * width, height);
        }
        prt::write_png(folder / (scene.name + ".png"), sheet_width, 2 * height, sheet);
    }
}

std::string report(const std::vector<SceneResult>& scenes, const std::vector<Sky>& skies,
                   const Options& options, const std::string& images, const std::string& note) {
    std::string page = "# What precomputed transfer is worth\n\n";
    page += summary(scenes);
    page += fmt::format(
        "Made by `prt-comparison` (at the end). Error: relative L2 of exit radiance, base colour 1, "
        "over all pixels that show the "
        "scene, {} x {}, against path tracing under the whole environment map with endless "
        "bounces. Two independent references "
        "of {} paths per pixel are taken, so that their noise does not count: the mean of (p - "
        "a)(p - b). Bytes are those of a "
        "vertex beside position and normal, the bases of the compressed shared out; raw transfer "
        "as float16; AO, of direct light, 8 bits. Times "
        "are of {}: drawing a frame, and what a change of the light takes once. All methods but "
        "PRT light by three bands "
        "of the environment, as games do. SSAO has 16 samples and the best of five radii for "
        "each scene. The bake has {} rays, "
        "endless bounces.\n",
        options.width, options.height, options.passes, scenes.front().device, options.bake_rays);
    for (const SceneResult& scene : scenes) {
        page += fmt::format("\n## {}\n\n{} vertices, {} triangles, {}.\n\n", scene.name, scene.vertices,
                            scene.triangles, scene.channels == 1 ? "one channel" : "three channels");
        page += fmt::format("![{}: reference and methods, and their errors]({}/{}.png)\n\n", scene.name,
                            images, scene.name);
        page += "*Path tracing";
        for (const Row* row : shown(scene))
            page += "; " + row->method;
        page += fmt::format(". Under {}; below, the error (white: {:.0f} % of the mean).*\n\n",
                            skies.front().name, 100 * kWhite);
        page += "| method | bytes per vertex |";
        for (const Sky& sky : skies)
            page += " error, " + sky.name + " |";
        page += " frame | light change |\n| --- | --- |";
        for (std::size_t i = 0; i < skies.size() + 2; ++i)
            page += " --- |";
        page += "\n";
        for (const Row& row : scene.rows) {
            page += fmt::format("| {} | {:.4g} |", row.method, row.bytes_per_vertex);
            for (const double error : row.errors)
                page += fmt::format(" {:.2f} % |", 100 * error);
            page +=
                fmt::format(" {:.1f} ms | {:.3f} ms |\n", row.frame_milliseconds, row.relight_milliseconds);
        }
        page += "\nNoise of a reference:";
        for (std::size_t i = 0; i < skies.size(); ++i)
            page += fmt::format("{} {:.2f} %", i > 0 ? "," : "", 100 * scene.reference_noise[i]);
        page += ".\n";
    }
    page += "\n## Made by\n\n    prt-comparison";
    for (const SceneResult& scene : scenes)
        page += " " + scene.name + ".glb";
    for (const Sky& sky : skies)
        page += " --sky " + sky.name;
    page += fmt::format(" --passes {} --rays {} -o comparison.md --images {}\n", options.passes,
                        options.bake_rays, images);
    if (!note.empty())
        page += "\n" + note + "\n";
    return page;
}

} // namespace comparison
