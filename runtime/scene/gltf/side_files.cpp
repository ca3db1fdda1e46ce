#include "gltf/side_files.h"

#include "prt/support/error.h"
#include "prt/support/file.h"

#include <algorithm>
#include <system_error>

namespace prt {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

} // namespace

SideFiles::SideFiles(const fs::path& scene, std::size_t scene_bytes, const GltfOptions& options)
    : folder_(scene.parent_path().empty() ? fs::path(".") : scene.parent_path()), options_(options),
      bytes_there_(scene_bytes) {}

tinygltf::FsCallbacks SideFiles::callbacks() {
    const auto exists = [](const std::string&, void*) { return true; }; // else another folder is tried
    const auto expand = [](const std::string& name, void*) { return name; };
    const auto read = [](std::vector<unsigned char>* bytes, std::string* trouble, const std::string& name,
                         void* files) {
        auto& self = *static_cast<SideFiles*>(files);
        try {
            *bytes = self.read(name);
            return true;
        } catch (const Error& error) {
            *trouble = error.what();
            if (self.first_trouble_.empty())
                self.first_trouble_ = *trouble;
            return false;
        }
    };
    return {exists, expand, read, nullptr, this};
}

fs::path SideFiles::place_of(const std::string& name) const {
    if (name.find('\0') != std::string::npos)
        throw Error("is no name of a file");
    std::error_code error;
    const fs::path folder = fs::canonical(folder_, error);
    fs::path path = fs::weakly_canonical(folder / name, error);
    if (error)
        throw Error(error.message());
    if (!options_.allow_outside && !is_below(path, folder))
        throw Error("lies outside the folder of the scene, where only --allow-outside reads it");
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status))
        throw Error("there is no such file");
    if (!fs::is_regular_file(status))
        throw Error("is no regular file");
    return path;
}

void SideFiles::check_outputs() const {
    for (const fs::path& path : seen_)
        for (const fs::path& output : options_.outputs) {
            std::error_code error; // that of an output that is not there
            if (fs::equivalent(path, output, error))
                throw Error("names " + path.string() +
                            ", which this run would replace: give the output another name");
        }
}

std::vector<unsigned char> SideFiles::read(const std::string& name) {
    const fs::path path = place_of(name);
    std::error_code error;
    const std::uint64_t size = fs::file_size(path, error);
    bytes_read_ += size;
    if (seen_.insert(path).second)
        bytes_there_ += size;
    constexpr std::uint64_t kFree = std::uint64_t{256} << 20, kTimes = 64;
    if (bytes_read_ > kFree + kTimes * bytes_there_)
        throw Error("is named too often: files are read to 256 MB and 64 times their size in all");
    const std::vector<std::byte> bytes = read_file(path);
    const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
    return {begin, begin + bytes.size()};
}

} // namespace prt
