// Reads .gltf and .glb with buffers and images into one document, and writes .glb.
#include "prt/gltf/gltf.h"

#include "bake/gltf/compressed_views.h"
#include "bake/gltf/contents.h"
#include "bake/gltf/draco_primitives.h"
#include "bake/gltf/encode_glb.h"
#include "bake/gltf/encode_vertices.h"
#include "bake/gltf/lights.h"
#include "bake/gltf/mesh_file.h"
#include "bake/gltf/repair_vertices.h"
#include "bake/gltf/reparse.h"
#include "bake/gltf/side_files.h"
#include "bake/gltf/smooth_primitives.h"
#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/file.h"
#include "runtime/core/support/lfs_pointer.h"
#include "runtime/core/support/printable.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/check_data.h"
#include "runtime/load/check_shape.h"
#include "runtime/load/coded_vertices.h"
#include "runtime/load/deduplicated_meshes.h"
#include "runtime/load/expand_nodes.h"
#include "runtime/load/fallback.h"
#include "runtime/load/glb.h"
#include "runtime/load/json_text.h"
#include "runtime/load/meshopt_views.h"
#include "runtime/load/receiver_sets.h"
#include "runtime/load/supported_extensions.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <climits>
#include <cstdint>
#include <cstring>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace prt {
namespace {

/// Returns the name of another scene format by suffix.
std::string_view other_format(const std::filesystem::path& path) {
    static constexpr std::pair<std::string_view, std::string_view> kFormats[] = {
        {".fbx", "FBX"}, {".stl", "STL"},     {".dae", "COLLADA"}, {".blend", "Blender"},
        {".usd", "USD"}, {".usda", "USD"},    {".usdc", "USD"},    {".usdz", "USD"},
        {".3ds", "3ds"}, {".abc", "Alembic"}, {".max", "3ds Max"}, {".ma", "Maya"},
        {".mb", "Maya"}, {".x", "DirectX"},   {".gltf2", "glTF"}};
    std::string suffix = path.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    for (const auto& [end, name] : kFormats)
        if (suffix == end)
            return name;
    return {};
}

/// Removes the header of a 3D Tiles 1.0 tile. A tile begins with a magic word and 32-bit lengths; the lengths
/// of four tables before the glTF start at byte 12 ("3D Tiles Specification", sections on Batched and
/// Instanced 3D Models).
std::span<const std::byte> without_tile(std::span<const std::byte> file, std::vector<std::string>& notices) {
    const auto begins = [&](std::string_view magic) {
        return file.size() >= 32 && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
    };
    const bool batched = begins("b3dm"), instanced = begins("i3dm");
    if (begins("cmpt") || begins("pnts"))
        throw Error(
            "is a composite or point cloud tile of 3D Tiles, not glTF; extract its models as .glb files");
    if (!batched && !instanced)
        return file;
    std::size_t begin = batched ? 28 : 32;
    for (std::size_t at = 12; at < 28; at += 4) {
        std::uint32_t length = 0;
        std::memcpy(&length, &file[at], sizeof(length));
        begin += length;
    }
    if (begin >= file.size() || !is_glb(file.subspan(begin)))
        throw Error("is a tile of 3D Tiles that does not contain a GLB");
    if (instanced)
        throw Error(
            "is an instanced model of 3D Tiles (.i3dm), whose instances are not supported; extract the GLB "
            "that begins at byte " +
            std::to_string(begin));
    notices.emplace_back("is a tile of 3D Tiles (.b3dm); only the GLB that it contains is read");
    return file.subspan(begin);
}

/// Rejects files that are not glTF before any parser reads them.
void check_is_gltf(std::span<const std::byte> file, const std::filesystem::path& path) {
    if (is_glb(file))
        return;
    if (is_lfs_pointer(file))
        throw Error(kLfsRemedy);
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (first != std::string_view::npos && text[first] == '{')
        return;
    const std::string_view format = other_format(path);
    throw Error((format.empty() ? std::string("is not glTF") : "is " + std::string(format) + ", not glTF") +
                "; export the scene as glTF 2.0 (.glb)");
}

/// Converts JSON that deviates from glTF, or uses newer names, to the form that the reader expects. Returns
/// whether anything was changed.
bool accept_deviations(GltfContents& contents) {
    const std::size_t nulls = remove_nulls(contents.json);
    if (nulls > 0)
        contents.notices.push_back(counted(nulls, "member of its JSON is null and is ignored",
                                           "members of its JSON are null and are ignored"));
    if (extension_of(contents.json, kCesiumExtension))
        contents.notices.emplace_back("the offset in CESIUM_RTC is ignored; it does not change the lighting");
    const bool meshopt = use_ext_meshopt(contents.json), spots = complete_spots(contents.json);
    return meshopt || spots || nulls > 0;
}

/// Keeps the encoded file of an image with a URI. Images in buffer views are read later, with bounds checks.
void keep_encoded(std::vector<std::vector<std::byte>>& images, std::size_t i, const tinygltf::Image& image,
                  std::span<const std::byte> bytes) {
    if (images.size() <= i)
        images.resize(i + 1);
    if (image.bufferView < 0)
        images[i].assign(bytes.begin(), bytes.end());
}

/// Reads images in buffer views; tinygltf has read those in files.
void take_images(GltfContents& contents, const SideFiles& files) {
    double total = 0;
    contents.images.resize(contents.parsed.images.size());
    contents.image_troubles.resize(contents.images.size());
    for (std::size_t i = 0; i < contents.images.size(); ++i) {
        const tinygltf::Image& image = contents.parsed.images[i];
        if (image.bufferView >= 0) {
            const auto bytes = buffer_view_bytes(contents.model, image.bufferView);
            total += static_cast<double>(bytes.size()); // several images may use one view
            check_allowed(2 * total, contents.file_bytes, "the encoded images");
            contents.images[i].assign(bytes.begin(), bytes.end());
        }
        if (!contents.images[i].empty())
            continue;
        contents.image_troubles[i] = image.uri.empty() ? "is empty" : files.trouble_of(image.uri);
        contents.notices.push_back("image " + std::to_string(i) +
                                   (image.uri.empty() ? "" : " '" + printable(image.uri) + "'") + ' ' +
                                   contents.image_troubles[i]);
    }
}

/// Reads buffers, images, materials and animations.
void parse(GltfContents& contents, std::span<const std::byte> file, std::string_view text, bool binary,
           const GltfOptions& options) {
    if (file.size() > UINT_MAX)
        throw Error("is larger than 4 GB");
    tinygltf::TinyGLTF loader;
    const auto keep = [](tinygltf::Image* image, int index, auto... rest) { // tinygltf's nine parameters
        const auto [error, warning, width, height, bytes, size, images] = std::tuple(rest...);
        keep_encoded(*static_cast<std::vector<std::vector<std::byte>>*>(images),
                     static_cast<std::size_t>(index), *image,
                     std::as_bytes(std::span(bytes, static_cast<std::size_t>(std::max(size, 0))))); // up to 2
                                                                                                    // GB
        return true;
    };
    loader.SetImageLoader(keep, &contents.images);
    SideFiles files(contents.path, file.size(), options);
    loader.SetFsCallbacks(files.callbacks());
    std::string error, warning;
    const bool loaded = binary
                            ? loader.LoadBinaryFromMemory(&contents.parsed, &error, &warning,
                                                          reinterpret_cast<const unsigned char*>(file.data()),
                                                          static_cast<unsigned>(file.size()))
                            : loader.LoadASCIIFromString(&contents.parsed, &error, &warning, text.data(),
                                                         static_cast<unsigned>(text.size()), "");
    files.check_outputs();
    if (!loaded)
        throw Error(error.empty() ? warning : error);
    contents.model = read_model(contents.json);
    for (tinygltf::Buffer& buffer : contents.parsed.buffers) {
        if (!buffer.uri.empty())
            contents.file_bytes += buffer.data.size();
        contents.model.buffers.push_back({std::exchange(buffer.data, {})});
    }
    contents.notices.insert(contents.notices.end(), files.notices().begin(), files.notices().end());
    take_images(contents, files);
}

/// Joins all buffers into the first and redirects the buffer views.
void join_buffers(GltfContents& contents) {
    std::vector<GltfBuffer>& buffers = contents.model.buffers;
    if (buffers.empty())
        buffers.emplace_back();
    std::vector<std::size_t> begin(1, 0);
    std::vector<unsigned char>& all = buffers.front().data;
    for (std::size_t b = 1; b < buffers.size(); ++b) {
        all.resize((all.size() + 7) / 8 * 8);
        begin.push_back(all.size());
        all.insert(all.end(), buffers[b].data.begin(), buffers[b].data.end());
        buffers[b].data = {};
    }
    for (GltfBufferView& view : contents.model.bufferViews) {
        const auto buffer = static_cast<std::size_t>(view.buffer);
        if (view.buffer < 0 || buffer >= begin.size())
            throw Error("a buffer view refers to buffer " + std::to_string(view.buffer) +
                        ", which does not exist");
        view.byteOffset += begin[buffer];
        view.buffer = 0;
    }
    if (contents.json.contains("bufferViews"))
        for (Json& view : contents.json["bufferViews"]) {
            view["byteOffset"] =
                view.value("byteOffset", std::size_t{0}) + begin.at(view.value("buffer", std::size_t{0}));
            view["buffer"] = 0;
        }
    buffers.resize(1);
    contents.json.erase("buffers");
}

/// Container of a file.
struct FileForm {
    bool binary;  ///< GLB
    bool rewrite; ///< tinygltf gets another JSON than that of the file
};

/// Loads the model, and decompresses its data into the one buffer.
void decompress_model(GltfContents& contents, std::span<const std::byte> file, std::string_view text,
                      FileForm form, const GltfOptions& options) {
    const bool meshopt = has_meshopt_views(contents.json), draco = has_draco_primitives(contents.json);
    if (meshopt || draco || form.rewrite) {
        Json plain = without_unread(contents.json);
        if (meshopt)
            plain = without_meshopt(std::move(plain));
        if (draco)
            plain = without_draco_indices(std::move(plain));
        check_views(plain);
        const std::string plain_text = plain.dump();
        plain = {};
        const std::vector<std::byte> rebuilt =
            form.binary ? make_glb(plain_text, glb_binary(file)) : std::vector<std::byte>{};
        parse(contents, rebuilt, plain_text, form.binary, options);
    } else {
        check_views(contents.json);
        parse(contents, file, text, form.binary, options);
    }
    if (meshopt)
        decompress_views(contents);
    if (draco)
        decompress_primitives(contents);
    check_data(contents);
    const bool coded = decode_vertices(contents);
    join_buffers(contents);
    if (draco || coded)
        contents.cut_unused_bytes();
}

/// Returns the media type of an encoded image by its first bytes.
const char* mime_type(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG"))
        return "image/png";
    if (text.starts_with("\xABKTX 20"))
        return "image/ktx2";
    if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP"))
        return "image/webp";
    if (text.substr(0, 8).ends_with("ftyp")) // no other container of this kind is a glTF image
        return "image/avif";
    if (text.starts_with("DDS "))
        return "image/vnd-ms.dds";
    return "image/jpeg";
}

/// Embeds images from external files.
void embed_images(GltfContents& contents) {
    for (std::size_t i = 0; i < contents.images.size(); ++i) {
        Json& image = contents.json["images"][i];
        const std::string uri = image.value("uri", "");
        const auto& bytes = contents.images[i];
        if (uri.empty() || uri.starts_with("data:") || bytes.empty())
            continue;
        image.erase("uri");
        image["mimeType"] = mime_type(bytes);
        image["bufferView"] = contents.add_buffer_view(bytes);
        if (!image.contains("name"))
            image["name"] = std::filesystem::path(uri).stem().string();
    }
}

/// Returns the complete file for these views.
std::vector<std::byte> glb_bytes(const GltfContents& contents, Json json, std::span<const std::byte> binary) {
    put_meshes_back(contents.separate, json);
    if (!binary.empty() && !json.contains("buffers"))
        json["buffers"] = Json::array({Json{{"byteLength", binary.size()}}});
    return make_glb(json.dump(-1, ' ', false, Json::error_handler_t::replace), binary);
}

/// Returns the complete file with compressed views.
std::vector<std::byte> compressed_glb(const GltfContents& contents) {
    CompressedGlb glb = compress_views(contents);
    return glb_bytes(contents, std::move(glb.json), glb.binary);
}

/// Returns the smaller of the files with coded words and with compressed attributes.
std::vector<std::byte> smallest_glb(const GltfContents& contents) {
    std::vector<std::byte> file = compressed_glb(contents);
    if (!find_set(contents, ReceiverKind::vertices, Coding::clustered))
        return file;
    GltfData current;
    current.json = contents.json;
    current.model = read_model(contents.json);
    current.model.buffers = {{.outside = contents.binary()}};
    const auto coded = with_coded_vertices(contents, current);
    if (!coded)
        return file;
    std::vector<std::byte> other = compressed_glb(*coded);
    return other.size() < file.size() ? other : file;
}

} // namespace

GltfDocument::GltfDocument(std::unique_ptr<GltfContents> contents) : contents_(std::move(contents)) {}
GltfDocument::GltfDocument(GltfDocument&&) noexcept = default;
GltfDocument& GltfDocument::operator=(GltfDocument&&) noexcept = default;
GltfDocument::~GltfDocument() = default;

GltfDocument load_gltf(const std::filesystem::path& path, const GltfOptions& options) {
    return parse_gltf(read_file(path), path, options);
}

/// Parses a file as `parse_gltf` does, and adds smooth normals to primitives without normals.
GltfDocument parse_smoothed(std::span<const std::byte> file, const std::filesystem::path& path,
                            const GltfOptions& options) {
    GltfOptions plain = options;
    plain.smooth_normals_degrees.reset();
    plain.instancing = Instancing::nodes;
    GltfDocument document = parse_gltf(file, path, plain);
    bool smoothed = false;
    try {
        smoothed = smooth_primitives(document.contents(), *options.smooth_normals_degrees);
    } catch (const std::exception& error) {
        throw Error(path.string() + ": " + in_plain_words(error));
    }
    if (smoothed)
        return reparse(document, options.instancing);
    plain.instancing = options.instancing;
    return options.instancing == Instancing::nodes ? std::move(document) : parse_gltf(file, path, plain);
}

GltfDocument parse_gltf(std::span<const std::byte> whole_file, const std::filesystem::path& path,
                        const GltfOptions& options) {
    if (options.smooth_normals_degrees)
        return parse_smoothed(whole_file, path, options);
    auto contents = std::make_unique<GltfContents>();
    contents->path = path;
    contents->scene_limit = options.scene_limit;
    contents->leave_out_lobes = options.leave_out_lobes;
    contents->limit_remedy = "; raise it with --memory-limit";
    try {
        std::span<const std::byte> file = without_tile(whole_file, contents->notices);
        std::vector<std::byte> converted;
        if (is_mesh_file(path) && !is_glb(file)) {
            if (is_lfs_pointer(file))
                throw Error(kLfsRemedy);
            converted = mesh_glb(read_mesh_file(file, path, contents->notices), path.stem().string());
            file = converted;
        }
        check_is_gltf(file, path);
        const bool binary = is_glb(file);
        const std::string_view text =
            binary ? glb_json(file)
                   : std::string_view(reinterpret_cast<const char*>(file.data()), file.size());
        contents->json = parse_json(text);
        const bool edited = accept_deviations(*contents);
        const bool small = check_shape(contents->json, text.size());
        check_required_extensions(contents->json);
        contents->file_bytes = file.size();
        decompress_model(*contents, file, text, {binary, edited || !small}, options);
        repair_vertices(*contents);
        for (const int material : set_fallback_aside(*contents))
            contents->parsed.materials.at(static_cast<std::size_t>(material))
                .extensions.erase(kUnlitExtension);
        if (options.instancing == Instancing::separate)
            deduplicate_meshes(*contents);
        scale_lights(contents->json, options.lamp_scale);
        expand_instances(*contents);
        embed_images(*contents);
    } catch (const std::exception& error) { // errors of prtkit, the standard library and the JSON library
        throw Error(path.string() + ": " + in_plain_words(error));
    }
    return GltfDocument(std::move(contents));
}

std::vector<std::byte> encode_glb(const GltfDocument& document, BufferCompression compression) {
    try {
        const GltfContents& contents = document.contents();
        return compression == BufferCompression::meshopt
                   ? smallest_glb(contents)
                   : glb_bytes(contents, contents.json, contents.binary());
    } catch (const std::exception& error) { // errors of prtkit, the standard library and the JSON library
        throw Error(in_plain_words(error));
    }
}

void save_glb(const GltfDocument& document, const std::filesystem::path& path,
              BufferCompression compression) {
    OutputFile output(path);
    std::vector<std::byte> file;
    try {
        file = encode_glb(document, compression);
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
    output.write(file);
    output.commit();
}

void discard_transfer(GltfDocument& document) {
    document.contents().remove_transfer();
}

void discard_lobes(GltfDocument& document) {
    document.contents().remove_lobes();
}

} // namespace prt
