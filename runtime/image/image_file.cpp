// Reads images according to their file format.
#include "prt/image/image_file.h"

#include "prt/core/error.h"
#include "runtime/core/support/file.h"
#include "runtime/core/support/lfs_pointer.h"
#include "runtime/image/cube_cross.h"
#include "runtime/image/exr.h"
#include "runtime/image/image_kind.h"
#include "runtime/image/image_limits.h"
#include "runtime/image/image_size.h"
#include "runtime/image/stb_images.h"
#include "runtime/image/web_images.h"

#include <algorithm>
#include <array>
#include <string>
#include <system_error>

namespace prt {
namespace {

EnvironmentLayout layout_of(const Image& image, std::optional<EnvironmentLayout> stated) {
    if (stated)
        return *stated;
    if (image.width == 2 * image.height)
        return EnvironmentLayout::lat_long;
    if (image.height == 6 * image.width)
        return EnvironmentLayout::cube;
    throw Error(
        "the layout of the environment map is unknown: it has " + std::to_string(image.width) + " x " +
        std::to_string(image.height) +
        " pixels and no envmap attribute; use an image that is twice as wide as high (lat-long) or six "
        "square faces in a column (cube map), or choose the layout with --env-layout");
}

/// Converts 8-bit sRGB to linear radiance up to 1.
Image read_low_dynamic_range(std::span<const std::byte> file) {
    const ImageSize size = image_size(file);
    check_image_size(size.width, size.height, sizeof(glm::u8vec4) + sizeof(glm::vec3), file.size());
    const Image8 image = decode_image(file);
    std::array<float, 256> values;
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = srgb_decode(static_cast<float>(i) / 255);
    Image result{image.width, image.height, {}};
    result.pixels.reserve(image.pixels.size());
    for (const glm::u8vec4& pixel : image.pixels)
        result.pixels.emplace_back(values[pixel.r], values[pixel.g], values[pixel.b]);
    return result;
}

/// An image with its properties from the file.
struct AnyImage {
    Image image;
    std::optional<EnvironmentLayout> layout;
    bool low_dynamic_range = false;
    std::vector<std::string> notices = {};
};

AnyImage read_radiance(std::span<const std::byte> file) {
    RadianceImage radiance = decode_hdr(file);
    AnyImage result{std::move(radiance.image), {}};
    if (radiance.factor != glm::dvec3(1))
        result.notices.emplace_back("its pixels are divided by its EXPOSURE and COLORCORR");
    return result;
}

AnyImage read_any(const std::filesystem::path& path, const std::string& layer) {
    const std::vector<std::byte> file = read_file(path);
    try {
        if (is_exr(file)) {
            ExrFile exr = read_exr(file, layer);
            return {std::move(exr.image), exr.layout, false, std::move(exr.notices)};
        }
        if (!layer.empty())
            throw Error("is not an EXR file and has no layers; remove --layer");
        if (is_hdr(file))
            return read_radiance(file);
        if (is_png(file) || is_jpeg(file))
            return {read_low_dynamic_range(file), {}, true};
        if (is_lfs_pointer(file))
            throw Error(kLfsRemedy);
        throw Error("is not an image in a supported format (OpenEXR, Radiance HDR, PNG, JPEG)");
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
}

constexpr std::string_view kFaceMark = "{face}";

using FaceNames = std::array<const char*, 6>;

std::string with_face(std::string pattern, const char* face) {
    return pattern.replace(pattern.find(kFaceMark), kFaceMark.size(), face);
}

/// Returns the face names +X -X +Y -Y +Z -Z of the first scheme whose first file exists; else the first
/// scheme, for the error message.
const FaceNames& face_names(const std::string& pattern) {
    static constexpr FaceNames kNames[] = {{"px", "nx", "py", "ny", "pz", "nz"},
                                           {"PX", "NX", "PY", "NY", "PZ", "NZ"},
                                           {"posx", "negx", "posy", "negy", "posz", "negz"},
                                           {"+x", "-x", "+y", "-y", "+z", "-z"},
                                           {"right", "left", "top", "bottom", "front", "back"}};
    for (const FaceNames& names : kNames)
        if (std::error_code error; std::filesystem::exists(with_face(pattern, names[0]), error))
            return names;
    return kNames[0];
}

/// Reads the six faces of a cube map, of equal size, into a column.
Image read_faces(const std::string& pattern, const std::string& layer, EnvironmentFile& result) {
    Image column;
    for (const char* face : face_names(pattern)) {
        const std::string path = with_face(pattern, face);
        AnyImage file = read_any(path, layer);
        result.low_dynamic_range |= file.low_dynamic_range;
        for (const std::string& notice : file.notices)
            result.notices.push_back(std::filesystem::path(path).filename().string() + ": " + notice);
        const Image image = std::move(file.image);
        if (image.width != image.height || (column.width != 0 && image.width != column.width))
            throw Error(path + ": is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                        " pixels, but the faces of a cube map must be squares of the same size");
        column.width = image.width;
        column.height += image.height;
        column.pixels.insert(column.pixels.end(), image.pixels.begin(), image.pixels.end());
    }
    return column;
}

/// Converts a cross or a row to a column of cube faces.
std::optional<EnvironmentLayout> unfold_cross(EnvironmentFile& file) {
    std::optional<Image> faces = faces_of_cross(file.environment.image);
    if (!faces)
        return std::nullopt;
    file.environment.image = std::move(*faces);
    file.notices.emplace_back(
        "is read as a cube map because of its shape; choose another layout with --env-layout");
    return EnvironmentLayout::cube_faces;
}

} // namespace

ImageSize image_size(std::span<const std::byte> file) {
    return is_webp(file) ? webp_size(file) : is_avif(file) ? avif_size(file) : size_by_stb(file);
}

Image8 decode_image(std::span<const std::byte> file) {
    return is_webp(file) ? decode_webp(file) : is_avif(file) ? decode_avif(file) : decode_by_stb(file);
}

EnvironmentFile load_environment(const std::filesystem::path& path, const EnvironmentOptions& options) {
    EnvironmentFile result;
    std::optional<EnvironmentLayout> layout = options.layout;
    if (path.string().find(kFaceMark) != std::string::npos) {
        result.environment.image = read_faces(path.string(), options.layer, result);
        layout = layout.value_or(EnvironmentLayout::cube_faces);
    } else {
        AnyImage file = read_any(path, options.layer);
        result.low_dynamic_range = file.low_dynamic_range;
        result.notices = std::move(file.notices);
        result.environment.image = std::move(file.image);
        if (!layout)
            layout = file.layout;
        if (!layout)
            layout = unfold_cross(result);
        else if (*layout == EnvironmentLayout::cube_faces)
            if (std::optional<Image> faces = faces_of_cross(result.environment.image))
                result.environment.image = std::move(*faces);
    }
    try {
        result.environment.layout = layout_of(result.environment.image, layout);
        result.environment.center = options.center;
        check_environment(result.environment);
        result.repaired_pixels = repair_pixels(result.environment.image, options.bad_pixels);
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
    return result;
}

} // namespace prt
