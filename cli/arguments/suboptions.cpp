// Parses options with settings.

#include "cli/arguments/suboptions.h"

#include "cli/arguments/options.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace prt::cli {

Suboptions::Suboptions(std::string name, std::string value, std::string text, Take take)
    : name_(std::move(name)), value_(std::move(value)), text_(std::move(text)), take_(std::move(take)) {}

Suboptions& Suboptions::key(const std::string& name, const std::string& value, const std::string& text,
                            Take take) {
    details_ += fmt::format("\n{}{}={}: {}", value_.empty() ? "" : ",", name, value, text);
    listed_ += fmt::format("{}{}={}", listed_.empty() ? "" : ", ", name, value);
    settings_.push_back({name, true, std::move(take)});
    return *this;
}

Suboptions& Suboptions::number(const std::string& name, double low, double high, const std::string& text,
                               std::function<void(double)> take) {
    return key(name, "X", text, [=, option = name_, take = std::move(take)](const std::string& value) {
        const std::optional<double> number = real_number(value);
        if (!number || !(*number >= low && *number <= high))
            throw CLI::ValidationError(
                option, fmt::format("{}={}: expected a number from {:g} to {:g}", name, value, low, high));
        take(*number);
    });
}

Suboptions& Suboptions::whole_number(const std::string& name, int low, int high, const std::string& text,
                                     std::function<void(int)> take) {
    return key(name, "N", text, [=, option = name_, take = std::move(take)](const std::string& value) {
        const std::optional<int> number = cli::whole_number(value);
        if (!number || *number < low || *number > high)
            throw CLI::ValidationError(
                option, fmt::format("{}={}: expected a whole number from {} to {}", name, value, low, high));
        take(*number);
    });
}

Suboptions& Suboptions::flag(const std::string& name, const std::string& text, std::function<void()> take) {
    details_ += fmt::format("\n{}{}: {}", value_.empty() ? "" : ",", name, text);
    listed_ += (listed_.empty() ? "" : ", ") + name;
    settings_.push_back({name, false, [take = std::move(take)](const std::string&) { take(); }});
    return *this;
}

Suboptions& Suboptions::repeatable() {
    settings_.back().repeatable = true;
    return *this;
}

Suboptions& Suboptions::detail(const std::string& text) {
    details_ += "\n" + text;
    return *this;
}

const Suboptions::Setting* Suboptions::setting_at(const std::string& text, std::size_t at) const {
    for (const Setting& setting : settings_) {
        const std::size_t end = at + setting.name.size();
        if (text.compare(at, setting.name.size(), setting.name) != 0)
            continue;
        if (setting.has_value ? end < text.size() && text[end] == '='
                              : end == text.size() || text[end] == ',')
            return &setting;
    }
    return nullptr;
}

std::size_t Suboptions::next_setting(const std::string& text, std::size_t from) const {
    for (std::size_t comma = text.find(',', from); comma != std::string::npos;
         comma = text.find(',', comma + 1))
        if (setting_at(text, comma + 1))
            return comma;
    return text.size();
}

void Suboptions::take_value(const std::string& piece) const {
    try {
        take_(piece);
    } catch (const CLI::ValidationError& error) {
        if (listed_.empty() || piece.find(',') == std::string::npos)
            throw;
        throw CLI::ValidationError(std::string(error.what()) + "; settings after the value are " + listed_);
    }
}

void Suboptions::parse(const std::string& text, std::set<std::string>& given) const {
    for (std::size_t at = 0; at <= text.size();) {
        const Setting* setting = setting_at(text, at);
        const std::size_t end = next_setting(text, at);
        const std::string piece = text.substr(at, end - at);
        if (!setting && (at > 0 || value_.empty()))
            throw CLI::ValidationError(
                name_,
                fmt::format("'{}' is not a setting; settings are {}; a value comes first", piece, listed_));
        if (!given.insert(setting ? setting->name : "").second && !(setting && setting->repeatable))
            throw CLI::ValidationError(name_, setting ? setting->name + " is given twice"
                                                      : "'" + piece + "' is a second value");
        if (setting)
            setting->take(setting->has_value ? piece.substr(setting->name.size() + 1) : "");
        else
            take_value(piece);
        at = end + 1;
    }
}

CLI::Option* Suboptions::add(CLI::App* command) const {
    return command
        ->add_option_function<std::vector<std::string>>(
            name_,
            [self = *this](const std::vector<std::string>& texts) {
                std::set<std::string> given;
                for (const std::string& text : texts)
                    self.parse(text, given);
            },
            text_ + details_)
        ->allow_extra_args(false)
        ->type_name(value_.empty()      ? "SETTING,..."
                    : settings_.empty() ? value_
                                        : value_ + "[,...]");
}

} // namespace prt::cli
