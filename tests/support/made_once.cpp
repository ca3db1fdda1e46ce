// Makes files once per process.

#include "made_once.h"

#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace prt::test {

std::filesystem::path made_once(const std::string& key, const std::filesystem::path& to,
                                const std::function<void(const std::filesystem::path&)>& make) {
    static const TemporaryFolder folder;
    std::string name =
        std::string(testing::UnitTest::GetInstance()->current_test_suite()->name()) + " " + key;
    std::replace(name.begin(), name.end(), '/', ' ');
    const std::filesystem::path kept = folder / name, made = folder / "making";
    if (!std::filesystem::exists(kept)) {
        make(made);
        std::filesystem::rename(made, kept);
    }
    std::filesystem::copy_file(kept, to, std::filesystem::copy_options::overwrite_existing);
    return to;
}

} // namespace prt::test
