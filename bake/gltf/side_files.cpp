// Finds and reads external files of a scene.
#include "bake/gltf/side_files.h"

#include "prt/core/error.h"
#include "runtime/core/support/file.h"
#include "runtime/core/support/lfs_pointer.h"
#include "runtime/core/support/printable.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <span>
#include <system_error>

namespace prt {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

/// Decodes the escapes of a URI.
std::string unescaped(std::string name) {
    for (std::size_t at = 0; (at = name.find('%', at)) != std::string::npos; ++at) {
        unsigned byte = 0;
        const char* digits = name.data() + at + 1;
        if (at + 2 < name.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2)
            name.replace(at, 3, 1, static_cast<char>(byte));
    }
    return name;
}

/// Upper case of ASCII as lower case; where it is a file's name, without escapes of URIs.
std::string folded(std::string name, bool escapes) {
    if (escapes)
        name = unescaped(std::move(name));
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(c < 128 ? std::tolower(c) : c); });
    return name;
}

/// Adds the files below `folder` that match `parts` except for case and escapes to `found`, until it has two.
void find_alike(const fs::path& folder, std::span<const fs::path> parts, std::vector<fs::path>& found) {
    std::error_code error;
    if (parts.empty()) {
        if (fs::is_regular_file(folder, error))
            found.push_back(folder);
        return;
    }
    const std::string wanted = folded(parts[0].string(), false), decoded = folded(parts[0].string(), true);
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end && found.size() < 2;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string(), plain = folded(name, true);
        if (folded(name, false) == wanted || plain == wanted || plain == decoded)
            find_alike(entry->path(), parts.subspan(1), found);
    }
}

/// Converts a URI to a path of this system: with slashes, without a query or a fragment.
std::string plain_name(std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    return name.substr(0, name.find_first_of("?#"));
}

/// Returns the only file below `folder` that an exporter can mean by `name`, as a relative path; empty if no
/// file matches. Throws `Error` if several match.
fs::path alike(const fs::path& folder, const std::string& name) {
    for (const std::string& variant : {name, plain_name(name)}) {
        const fs::path path = fs::path(variant).lexically_normal();
        const std::vector<fs::path> parts(path.begin(), path.end());
        if (path.is_absolute() || parts.empty() || std::find(parts.begin(), parts.end(), "..") != parts.end())
            continue;
        std::vector<fs::path> found;
        find_alike(folder, parts, found);
        if (found.size() > 1)
            throw Error("the file does not exist, and several names differ only in case: '" +
                        found[0].filename().string() + "', '" + found[1].filename().string() + "'");
        if (!found.empty())
            return found[0].lexically_relative(folder);
    }
    return {};
}

} // namespace

SideFiles::SideFiles(const fs::path& scene, std::size_t scene_bytes, const GltfOptions& options)
    : folder_(scene.parent_path().empty() ? fs::path(".") : scene.parent_path()), options_(options),
      bytes_there_(scene_bytes) {}

tinygltf::FsCallbacks SideFiles::callbacks() {
    const auto exists = [](const std::string&, void*) { return true; }; // otherwise tinygltf tries another
                                                                        // folder
    const auto expand = [](const std::string& name, void*) { return name; };
    const auto read = [](std::vector<unsigned char>* bytes, std::string* trouble, const std::string& name,
                         void* files) {
        auto& self = *static_cast<SideFiles*>(files);
        try {
            *bytes = self.read(name);
            return true;
        } catch (const Error& error) {
            *trouble = error.what();
            self.troubles_[name] = *trouble;
            return false;
        }
    };
    return {exists, expand, read, nullptr, this};
}

fs::path SideFiles::position_of(const std::string& name) {
    if (name.find('\0') != std::string::npos)
        throw Error("is not a valid file name");
    std::error_code error;
    const fs::path folder = fs::canonical(folder_, error);
    fs::path path = fs::weakly_canonical(folder / name, error);
    if (error)
        throw Error(error.message());
    constexpr int kMaxSearches = 1000; // each costs time proportional to the number of files in the folders
    if (!fs::exists(path) && is_below(path, folder) && searches_++ < kMaxSearches)
        if (const fs::path other = alike(folder, name); !other.empty()) {
            path = fs::weakly_canonical(folder / other, error);
            notices_.insert("'" + printable(name) + "' does not exist; '" + printable(other.string()) +
                            "' is read instead");
        }
    if (!options_.allow_outside && !is_below(path, folder))
        throw Error("is outside the folder of the scene; allow this with --allow-outside");
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status))
        throw Error("the file does not exist");
    if (!fs::is_regular_file(status))
        throw Error("is not a regular file");
    return path;
}

std::string SideFiles::trouble_of(const std::string& uri) const {
    const auto found = troubles_.find(unescaped(uri));
    return found == troubles_.end() ? "cannot be read" : "cannot be read: " + found->second;
}

void SideFiles::check_outputs() const {
    for (const fs::path& path : seen_)
        for (const fs::path& output : options_.outputs) {
            std::error_code error; // set if the output does not exist
            if (fs::equivalent(path, output, error))
                throw Error("reads " + path.string() +
                            ", which the output would overwrite; choose another output name");
        }
}

std::vector<unsigned char> SideFiles::read(const std::string& name) {
    const fs::path path = position_of(name);
    std::error_code error;
    const std::uint64_t size = fs::file_size(path, error);
    bytes_read_ += size;
    if (seen_.insert(path).second)
        bytes_there_ += size;
    constexpr std::uint64_t kFree = std::uint64_t{256} << 20, kTimes = 64;
    if (bytes_read_ > kFree + kTimes * bytes_there_)
        throw Error(
            "is referenced too often: the limit for all reads is 256 MB plus 64 times the size of the files");
    const std::vector<std::byte> bytes = read_file(path);
    if (is_lfs_pointer(bytes))
        throw Error(kLfsRemedy);
    const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
    return {begin, begin + bytes.size()};
}

} // namespace prt
