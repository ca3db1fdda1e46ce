#pragma once

// Options with settings: `--name VALUE,key=value,flag`.

#include <CLI/CLI.hpp>

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace prt::cli {

/// Builds an option whose text is a value, then settings, separated by commas. The option can be repeated to
/// add settings; a value or a setting that is given twice is an error. The value may contain commas if no
/// known setting follows them, as a file name.
class Suboptions {
public:
    using Take = std::function<void(const std::string&)>;

    /// `value`: name of the value in help; empty for an option without a value.
    Suboptions(std::string name, std::string value, std::string text, Take take);

    /// Adds a setting `key=value`. `take` may throw `CLI::ValidationError`.
    Suboptions& key(const std::string& name, const std::string& value, const std::string& text, Take take);
    /// Adds a numeric setting in [low, high].
    Suboptions& number(const std::string& name, double low, double high, const std::string& text,
                       std::function<void(double)> take);
    Suboptions& whole_number(const std::string& name, int low, int high, const std::string& text,
                             std::function<void(int)> take);
    /// Adds a setting without a value.
    Suboptions& flag(const std::string& name, const std::string& text, std::function<void()> take);
    /// Allows the last setting to be given several times.
    Suboptions& repeatable();
    /// Adds a line of details to the help.
    Suboptions& detail(const std::string& text);

    CLI::Option* add(CLI::App* command) const;

private:
    struct Setting {
        std::string name;
        bool has_value;
        Take take;
        bool repeatable = false;
    };
    /// Splits `text` before each known setting, and passes all pieces on. `given`: names of settings so far;
    /// empty for the value.
    void parse(const std::string& text, std::set<std::string>& given) const;
    void take_value(const std::string& piece) const;
    std::size_t next_setting(const std::string& text, std::size_t from) const;
    const Setting* setting_at(const std::string& text, std::size_t at) const;

    std::string name_, value_, text_, details_, listed_;
    Take take_;
    std::vector<Setting> settings_;
};

} // namespace prt::cli
