#include "made_once.h"

#include "temporary_folder.h"

namespace prt::test {

std::filesystem::path made_once(const std::string& key, const std::filesystem::path& to,
                                const std::function<void(const std::filesystem::path&)>& make) {
    static const TemporaryFolder folder;
    const std::filesystem::path kept = folder / key;
    if (!std::filesystem::exists(kept))
        make(kept);
    std::filesystem::copy_file(kept, to, std::filesystem::copy_options::overwrite_existing);
    return to;
}

} // namespace prt::test
