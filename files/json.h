#pragma once
// Hand-written JSON files: `//` comments are allowed, unknown and repeated keys are errors, and every message names
// the file and the key.

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::files {

using Json = nlohmann::ordered_json;

// Read JSON. Throw InputError, which names file, line and column where the text is not JSON, or the key that appears
// twice; read_json() also for a file above 64 MiB.
Json read_json(const std::filesystem::path& path);
Json parse_json(std::string_view text, const std::string& file_name);

// A number that is not finite becomes null.
Json number_or_null(double value);

// The range of a number. Messages give it as "> 0" or "from 0 to 1".
struct Bounds {
    double lowest;
    double highest;
    bool lowest_excluded = false;
};
inline constexpr Bounds kAnyNumber{-1e300, 1e300};
inline constexpr Bounds kPositive{0.0, 1e300, true};
inline constexpr Bounds kNotNegative{0.0, 1e300};

// Reads one JSON object. The caller asks for each key by name, and its value is checked; finish() then refuses the keys
// that were not asked for. All errors are InputError. A missing key without a default is an error.
class JsonReader {
  public:
    // The value must outlive its reader.
    JsonReader(const Json& value, std::string file, std::string where = "");
    JsonReader(const Json&& value, std::string file, std::string where = "") = delete;

    bool has(std::string_view key) const;
    double number(std::string_view key, Bounds bounds);
    double number(std::string_view key, Bounds bounds, double otherwise);
    int integer(std::string_view key, int lowest, int highest);
    int integer(std::string_view key, int lowest, int highest, int otherwise);
    bool boolean(std::string_view key, bool otherwise);
    std::string text(std::string_view key);
    std::string text(std::string_view key, std::string otherwise);
    // An array of texts, at least `fewest`; `what` names them in the messages ("names of actuators").
    std::vector<std::string> texts(std::string_view key, std::size_t fewest, const std::string& what);
    // Returns the index of the text in `choices`.
    std::size_t choice(std::string_view key, std::initializer_list<std::string_view> choices);
    // `count` = 0 means any number of values, at least one.
    std::vector<double> numbers(std::string_view key, std::size_t count, Bounds bounds);
    JsonReader object(std::string_view key);
    std::optional<JsonReader> optional_object(std::string_view key);
    std::vector<JsonReader> objects(std::string_view key);  // an array of objects; empty if absent
    const Json& any(std::string_view key);                  // the value, unchecked

    // Refuses all other keys at once, so that the message names a misspelt key (young_kPa), and not the required key
    // that is then missing.
    void only(std::initializer_list<std::string_view> keys) const;

    void finish() const;
    [[noreturn]] void fail(std::string_view key, std::string_view found, std::string_view expected) const;
    const std::string& file() const { return file_; }

  private:
    const Json& need(std::string_view key, std::string_view expected);
    const Json* find(std::string_view key);
    std::string text_in(const Json& value, std::string_view key, const std::string& expected) const;
    std::string where_of(std::string_view key) const;

    const Json* value_;
    std::string file_;
    std::string where_;
    std::vector<std::string> asked_;
};

// Returns the text for files and standard output: indented, with a newline at its end. Bytes that are not UTF-8 are
// replaced.
std::string json_text(const Json& value);

// Returns how a message describes a value: "3.5", "'left'", "an array of 3", "null".
std::string described(const Json& value);

}  // namespace palpa::files
