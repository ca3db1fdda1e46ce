// Writes the comparison as a Markdown page.

#include "report.h"

#include "compress/study/receiver_colors.h"
#include "prt/render/tone_map.h"

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
        for (const std::string_view wanted :
             {"unshadowed irradiance", "SSAO, with normals", "baked AO", "PRT, order 3",
              "PRT, order 6, 12 bytes", "PRT, 8 bytes, sun by shadow map"})
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

/// Tiles of one size side by side, two rows of them.
class Sheet {
public:
    Sheet(int columns, int tile_width, int tile_height)
        : width_(columns * tile_width), tile_width_(tile_width), tile_height_(tile_height),
          pixels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(2 * tile_height),
                  glm::u8vec3(255)) {}

    void paste(const std::vector<glm::u8vec3>& tile, int column, int row) {
        for (int y = 0; y < tile_height_; ++y)
            std::copy_n(tile.begin() + y * tile_width_, tile_width_,
                        pixels_.begin() + (row * tile_height_ + y) * width_ + column * tile_width_);
    }
    void write(const std::filesystem::path& path) const {
        prt::write_png(path, width_, 2 * tile_height_, pixels_);
    }

private:
    int width_, tile_width_, tile_height_;
    std::vector<glm::u8vec3> pixels_;
};

double mean(const Row& row) {
    double sum = 0;
    for (const prt::PictureError& error : row.errors)
        sum += error.relative_l2;
    return sum / static_cast<double>(row.errors.size());
}

/// Mean error over the skies of the methods that matter, a scene a column.
std::string summary(const std::vector<SceneResult>& scenes) {
    std::string table = "Mean error over all skies. The tables below list each sky.\n\n| method |";
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

std::string explanation(const SceneResult& scene, const Options& options) {
    return fmt::format(
        "The page is written by `prt-comparison`; the command is at the end.\n\n"
        "* Error: relative L2 error of exit radiance for base color 1, over all pixels that show the scene, "
        "{} x {} pixels, against path tracing with the whole environment map and endless bounces. Two "
        "independent references of {} paths per pixel are used, so that their noise cancels: the squared "
        "error is the mean of (p - a)(p - b).\n"
        "* FLIP: mean HDR-FLIP of the whole picture against the mean of both references, 67 pixels per "
        "degree; 0 means equal. It includes the noise of the references.\n"
        "* Bytes: per vertex, in addition to position and normal. Compressed transfer includes its bases, "
        "divided by the number of vertices. Raw transfer is float16. AO covers direct light and has 8 bits. "
        "Lightmaps ({} x {} texels, separate charts, drawn by rays, not timed) have bytes per texel.\n"
        "* Times: measured on {}, for a frame and for one change of the lighting.\n"
        "* Lighting: all methods except PRT use three bands of the environment, as games do. SSAO uses 16 "
        "samples and the best of five radii for each scene.\n"
        "* Rows with a sun by shadow map or by rays: the brightest sun of the sky, if it has one, is removed "
        "from it (`--suns 1`) and added at each pixel. Their pictures are those of `prt render` and are not "
        "timed.\n"
        "* Bake: {} rays per vertex, endless bounces.\n",
        options.width, options.height, options.passes, options.lightmap_size, options.lightmap_size,
        scene.device, options.bake_rays);
}

std::string milliseconds(const std::optional<double>& time, int digits) {
    return time ? fmt::format(" {:.{}f} ms |", *time, digits) : " |";
}

std::string table(const SceneResult& scene, const std::vector<Sky>& skies) {
    std::string table = "| method | bytes per vertex |";
    for (const Sky& sky : skies)
        table += " error, " + sky.name + " | FLIP |";
    table += " frame | light change |\n| --- | --- |";
    for (std::size_t i = 0; i < 2 * skies.size() + 2; ++i)
        table += " --- |";
    table += "\n";
    for (const Row& row : scene.rows) {
        table += fmt::format("| {} | {:.4g} |", row.method, row.bytes_per_vertex);
        for (const prt::PictureError& error : row.errors)
            table += fmt::format(" {:.2f} % | {:.3f} |", 100 * error.relative_l2, error.flip_mean);
        table += milliseconds(row.frame_milliseconds, 1) + milliseconds(row.relight_milliseconds, 3) + "\n";
    }
    table += "\nNoise of one reference:";
    for (std::size_t i = 0; i < skies.size(); ++i)
        table += fmt::format("{} {:.2f} %", i > 0 ? "," : "", 100 * scene.reference_noise[i]);
    return table + ".\n";
}

std::string section(const SceneResult& scene, const std::vector<Sky>& skies, const std::string& images) {
    std::string text =
        fmt::format("\n## {}\n\n{} vertices, {} triangles, {}.\n\n", scene.name, scene.vertices,
                    scene.triangles, scene.channels == 1 ? "one channel" : "three channels");
    text += fmt::format("![{}: reference, methods and their errors]({}/{}.png)\n\n", scene.name, images,
                        scene.name);
    text += "*Path tracing";
    for (const Row* row : shown(scene))
        text += "; " + row->method;
    text += fmt::format(". Environment: {}. Lower row: the error (white: {:.0f} % of the mean).*\n\n",
                        skies.front().name, 100 * kWhite);
    return text + table(scene, skies);
}

} // namespace

void write_pictures(const std::vector<SceneResult>& scenes, const Options& options,
                    const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    const int factor = std::max(1, options.width / kTileWidth), width = options.width / factor,
              height = options.height / factor;
    for (const SceneResult& scene : scenes) {
        const auto light = [&](const prt::Image& image) {
            return prt::tone_mapped(image, factor, scene.exposure, prt::ToneMap::filmic);
        };
        const auto colors = [](const prt::Image& image) {
            return prt::tone_mapped(image, 1, 1, prt::ToneMap::srgb);
        };
        Sheet sheet(1 + static_cast<int>(shown(scene).size()), width, height);
        sheet.paste(light(scene.reference), 0, 0);
        sheet.paste(colors(ramp(width, height)), 0, 1);
        int column = 0;
        for (const Row* row : shown(scene)) {
            sheet.paste(light(row->picture), ++column, 0);
            sheet.paste(colors(heat_of(scene, row->picture, factor)), column, 1);
        }
        sheet.write(folder / (scene.name + ".png"));
    }
}

std::string report(const std::vector<SceneResult>& scenes, const std::vector<Sky>& skies,
                   const Options& options, const std::string& images, const std::string& note) {
    std::string page = "# Precomputed radiance transfer compared with other methods\n\n";
    page += summary(scenes) + explanation(scenes.front(), options);
    for (const SceneResult& scene : scenes)
        page += section(scene, skies, images);
    page += "\n## Command\n\n    prt-comparison";
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
