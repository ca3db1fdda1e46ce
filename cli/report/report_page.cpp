#include "report/report_page.h"

#include "report/report_files.h"

namespace prt::cli {

std::string filled_page(const std::map<std::string, std::string>& parts) {
    const std::string& page = report_files().at("page.html");
    std::string result;
    std::size_t at = 0;
    for (std::size_t open; (open = page.find("{{", at)) != std::string::npos;) {
        const std::size_t close = page.find("}}", open);
        result += page.substr(at, open - at) + parts.at(page.substr(open + 2, close - open - 2));
        at = close + 2;
    }
    return result + page.substr(at);
}

} // namespace prt::cli
