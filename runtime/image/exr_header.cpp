// Validates the headers of OpenEXR files before they are read.
#include "runtime/image/exr_header.h"

#include "prt/core/environment.h"
#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/printable.h"
#include "runtime/image/image_limits.h"

#include <OpenEXR/openexr.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace prt {
namespace {

/// State for the callbacks of the core library.
struct Source {
    std::span<const std::byte> file;
    std::string trouble; ///< last message of the library
};

std::int64_t read_source(exr_const_context_t, void* user, void* to, std::uint64_t size, std::uint64_t offset,
                         exr_stream_error_func_ptr_t) {
    const std::span<const std::byte> file = static_cast<Source*>(user)->file;
    const std::uint64_t begin = std::min<std::uint64_t>(offset, file.size());
    const std::uint64_t count = std::min<std::uint64_t>(size, file.size() - begin);
    if (count > 0)
        std::memcpy(to, &file[begin], count);
    return static_cast<std::int64_t>(count);
}

std::int64_t size_of_source(exr_const_context_t, void* user) {
    return static_cast<std::int64_t>(static_cast<Source*>(user)->file.size());
}

void keep_message(exr_const_context_t context, exr_result_t, const char* message) {
    void* user = nullptr;
    if (message && exr_get_user_data(context, &user) == EXR_ERR_SUCCESS && user)
        static_cast<Source*>(user)->trouble = message;
}

/// The open headers of a file.
class Headers {
public:
    explicit Headers(std::span<const std::byte> file) : source_{file, {}} {
        exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
        setup.user_data = &source_;
        setup.read_fn = read_source;
        setup.size_fn = size_of_source;
        setup.error_handler_fn = keep_message;
        if (const exr_result_t result = exr_start_read(&context_, "EXR", &setup); result != EXR_ERR_SUCCESS)
            refuse(result);
    }
    ~Headers() { exr_finish(&context_); }
    Headers(const Headers&) = delete;
    Headers& operator=(const Headers&) = delete;

    exr_context_t context() const { return context_; }
    /// Throws `Error` for a failure. The library reports damaged attributes but continues with default
    /// values, so that messages count as failures.
    void check(exr_result_t result) const {
        if (result != EXR_ERR_SUCCESS || !source_.trouble.empty())
            refuse(result);
    }

private:
    [[noreturn]] void refuse(exr_result_t result) const {
        constexpr std::size_t kMaxReport = 200; // bytes: the message may quote arbitrary data of the file
        throw Error("is a damaged or unsupported EXR: " +
                    printable(one_line(source_.trouble.empty() ? exr_get_default_error_message(result)
                                                               : source_.trouble),
                              kMaxReport));
    }
    Source source_;
    exr_context_t context_ = nullptr;
};

/// Sizes in bytes of attribute types with a fixed size: `Imf::InputFile` reads that number regardless of the
/// header.
constexpr std::pair<std::string_view, std::size_t> kSizes[] = {{"box2f", 16},
                                                               {"box2i", 16},
                                                               {"chromaticities", 32},
                                                               {"compression", 1},
                                                               {"deepImageState", 1},
                                                               {"double", 8},
                                                               {"envmap", 1},
                                                               {"float", 4},
                                                               {"int", 4},
                                                               {"keycode", 28},
                                                               {"m33d", 72},
                                                               {"m33f", 36},
                                                               {"m44d", 128},
                                                               {"m44f", 64},
                                                               {"lineOrder", 1},
                                                               {"v2d", 16},
                                                               {"rational", 8},
                                                               {"tiledesc", 9},
                                                               {"timecode", 8},
                                                               {"v2f", 8},
                                                               {"v2i", 8},
                                                               {"v3d", 24},
                                                               {"v3f", 12},
                                                               {"v3i", 12}};

/// Returns whether a channel list ends exactly where its attribute does: `Imf::InputFile` reads to the end of
/// the list. Each name is followed by 16 bytes; an empty name ends the list.
bool ends_with_its_channels(std::string_view list) {
    while (!list.empty() && list.front() != 0) {
        constexpr std::size_t kChannel = 16;
        const std::size_t name = list.find('\0');
        if (name == std::string_view::npos || list.size() - name - 1 < kChannel)
            return false;
        list.remove_prefix(name + 1 + kChannel);
    }
    return list.size() == 1;
}

/// Returns whether the value has width, height and four bytes per pixel.
bool is_preview(std::string_view value) {
    std::uint32_t size[2] = {};
    if (value.size() < sizeof(size))
        return false;
    std::memcpy(size, value.data(), sizeof(size));
    return (value.size() - sizeof(size)) / 4 == std::uint64_t{size[0]} * size[1] && value.size() % 4 == 0;
}

/// Returns whether `Imf::InputFile` will read exactly the bytes of `value`.
bool has_size_of_its_type(std::string_view type, std::string_view value) {
    if (type == "chlist")
        return ends_with_its_channels(value);
    if (type == "preview")
        return is_preview(value);
    const auto* known = std::ranges::find(kSizes, type, &std::pair<std::string_view, std::size_t>::first);
    return known == std::end(kSizes) || known->second == value.size();
}

/// Removes a zero-terminated text from the front of `rest`.
std::string_view take_text(std::string_view& rest) {
    const std::string_view text = rest.substr(0, rest.find('\0'));
    rest.remove_prefix(std::min(text.size() + 1, rest.size()));
    return text;
}

/// Removes the header of a part from the front of `rest`.
void skip_header(std::string_view& rest) {
    while (!rest.empty() && rest.front() != 0) {
        take_text(rest); // attribute name
        const std::string_view type = take_text(rest);
        std::uint32_t size = 0;
        if (rest.size() < sizeof(size))
            throw Error("is a damaged EXR: it ends inside its header");
        std::memcpy(&size, rest.data(), sizeof(size));
        rest.remove_prefix(sizeof(size));
        if (size > rest.size())
            throw Error("is a damaged EXR: an attribute claims " + std::to_string(size) +
                        " bytes, but only " + std::to_string(rest.size()) + " remain");
        if (!has_size_of_its_type(type, rest.substr(0, size)))
            throw Error("is a damaged EXR: an attribute of type '" + printable(type) +
                        "' has the wrong size, " + counted(size, "byte"));
        rest.remove_prefix(size);
    }
    rest.remove_prefix(std::min(rest.size(), std::size_t{1}));
}

/// Throws unless the values of all attributes are inside the file. The core library and `Imf::InputFile`
/// disagree about the end of damaged headers, so that a check by one does not cover the other. A header
/// consists of names, types, sizes and values, and ends with an empty name ("OpenEXR File Layout",
/// openexr.com).
void check_attributes(std::span<const std::byte> file) {
    constexpr std::size_t kVersion = 4, kFirstHeader = 8;
    constexpr std::uint32_t kMultiPart = 0x1000;
    if (file.size() < kFirstHeader)
        return;
    std::uint32_t version = 0;
    std::memcpy(&version, &file[kVersion], sizeof(version));
    std::string_view rest(reinterpret_cast<const char*>(file.data()), file.size());
    rest.remove_prefix(kFirstHeader);
    do
        skip_header(rest);
    while ((version & kMultiPart) != 0 && !rest.empty() && rest.front() != 0);
}

/// Checks the chunk tables, which have 8 bytes per chunk.
void check_chunk_tables(const Headers& headers, std::size_t file_bytes) {
    int parts = 0;
    headers.check(exr_get_count(headers.context(), &parts));
    std::uint64_t chunks = 0;
    for (int part = 0; part < parts; ++part) {
        std::int32_t count = 0;
        headers.check(exr_get_chunk_count(headers.context(), part, &count));
        chunks += static_cast<std::uint64_t>(std::max(count, 0));
    }
    if (chunks > file_bytes / 8)
        throw Error("claims " + std::to_string(chunks) + " chunks of pixels, more than fit into a file of " +
                    std::to_string(file_bytes) + " bytes");
}

/// Throws unless a file of `file_bytes` may allocate memory for the pixels of a part.
void check_window(const Headers& headers, int part, std::size_t file_bytes) {
    exr_attr_box2i_t window{};
    headers.check(exr_get_data_window(headers.context(), part, &window));
    std::uint64_t chunk = 0;
    headers.check(exr_get_chunk_unpacked_size(headers.context(), part, &chunk));
    // A chunk is held packed, unpacked and in an intermediate form; chroma is reconstructed from about 32
    // rows of halves.
    constexpr std::uint64_t kChromaRows = 40, kHalves = 8;
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    check_image_size(width, std::int64_t{window.max.y} - window.min.y + 1, sizeof(glm::vec3), file_bytes,
                     3 * chunk + kChromaRows * kHalves *
                                     static_cast<std::uint64_t>(std::max<std::int64_t>(width, 0)));
}

} // namespace

void check_exr_header(std::span<const std::byte> file) {
    check_attributes(file);
    const Headers headers(file);
    check_chunk_tables(headers, file.size());
    int parts = 0;
    headers.check(exr_get_count(headers.context(), &parts));
    for (int part = 0; part < parts; ++part)
        check_window(headers, part, file.size());
}

} // namespace prt
