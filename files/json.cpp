#include "files/json.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "files/input_error.h"
#include "files/printable.h"
#include "files/text.h"

namespace palpa::files {
namespace {

std::string place_in(std::string_view text, std::size_t byte) {
    const auto before = text.substr(0, std::min(byte, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const auto last_newline = before.rfind('\n');
    const auto column = last_newline == std::string_view::npos ? before.size() : before.size() - last_newline - 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(std::max<std::size_t>(column, 1));
}

std::string bounds_text(Bounds bounds) {
    const bool from_below = bounds.lowest > -1e299;
    const bool to_above = bounds.highest < 1e299;
    if (from_below && to_above) {
        return "a number " + std::string(bounds.lowest_excluded ? "> " : "from ") + short_number(bounds.lowest) +
               " to " + short_number(bounds.highest);
    }
    if (from_below) return (bounds.lowest_excluded ? "a number > " : "a number >= ") + short_number(bounds.lowest);
    return "a number";
}

bool inside(double value, Bounds bounds) {
    if (!std::isfinite(value) || value > bounds.highest) return false;
    return bounds.lowest_excluded ? value > bounds.lowest : value >= bounds.lowest;
}

}  // namespace

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string described(const Json& value) {
    if (value.is_null()) return "null";
    if (value.is_array()) return "an array of " + std::to_string(value.size());
    if (value.is_object()) return "an object";
    if (value.is_string()) return shown(value.get_ref<const std::string&>());
    return value.dump();
}

std::string json_text(const Json& value) { return value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json parse_json(std::string_view text, const std::string& file_name) {
    // nlohmann silently keeps the last of two equal keys; here they are an error
    std::vector<std::set<std::string>> open_objects;
    const auto refuse_repeated_keys = [&](int, nlohmann::json::parse_event_t event, const Json& parsed) {
        using Event = nlohmann::json::parse_event_t;
        if (event == Event::object_start) open_objects.emplace_back();
        if (event == Event::object_end) open_objects.pop_back();
        if (event == Event::key) {
            auto& keys = open_objects.back();
            const auto& key = parsed.get_ref<const std::string&>();
            if (!keys.insert(key).second) {
                throw bad_input(file_name, key, "the key twice", "it once");
            }
        }
        return true;
    };
    try {
        return Json::parse(text.begin(), text.end(), refuse_repeated_keys, true, true);
    } catch (const Json::parse_error& error) {
        std::string what = error.what();  // "[json.exception.parse_error.101] parse error at line 1, ...: ..."
        const auto detail = what.find(": ");
        what = detail == std::string::npos ? what : what.substr(detail + 2);
        throw InputError(printable(file_name + ": " + place_in(text, error.byte) + ": not valid JSON: " + what));
    } catch (const Json::out_of_range& error) {
        throw bad_input(file_name, "", error.what(), "numbers that fit a double");
    }
}

Json read_json(const std::filesystem::path& path) { return parse_json(read_text(path, 64 << 20), path.string()); }

JsonReader::JsonReader(const Json& value, std::string file, std::string where)
    : value_(&value), file_(std::move(file)), where_(std::move(where)) {
    if (!value.is_object()) throw bad_input(file_, where_, described(value), "an object { ... }");
}

std::string JsonReader::where_of(std::string_view key) const {
    if (key.empty()) return where_;
    if (where_.empty() || key.empty()) return where_ + std::string(key);
    return where_ + "." + std::string(key);
}

void JsonReader::fail(std::string_view key, std::string_view found, std::string_view expected) const {
    throw bad_input(file_, where_of(key), found, expected);
}

bool JsonReader::has(std::string_view key) const { return value_->contains(std::string(key)); }

const Json* JsonReader::find(std::string_view key) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
    const auto it = value_->find(std::string(key));
    return it == value_->end() ? nullptr : &*it;
}

const Json& JsonReader::need(std::string_view key, std::string_view expected) {
    const Json* value = find(key);
    if (value == nullptr) fail(key, "nothing", expected);
    return *value;
}

double JsonReader::number(std::string_view key, Bounds bounds) {
    const std::string expected = bounds_text(bounds);
    const Json& value = need(key, expected);
    if (!value.is_number() || !inside(value.get<double>(), bounds)) fail(key, described(value), expected);
    return value.get<double>();
}

double JsonReader::number(std::string_view key, Bounds bounds, double otherwise) {
    if (find(key) != nullptr) return number(key, bounds);
    return otherwise;
}

int JsonReader::integer(std::string_view key, int lowest, int highest) {
    const std::string expected =
        lowest == highest ? std::to_string(lowest)
                          : "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
    const Json& value = need(key, expected);
    if (!value.is_number()) fail(key, described(value), expected);
    const double number = value.get<double>();
    if (!(number >= lowest && number <= highest) || number != std::floor(number)) {
        fail(key, described(value), expected);
    }
    return static_cast<int>(number);
}

int JsonReader::integer(std::string_view key, int lowest, int highest, int otherwise) {
    if (find(key) != nullptr) return integer(key, lowest, highest);
    return otherwise;
}

bool JsonReader::boolean(std::string_view key, bool otherwise) {
    const Json* value = find(key);
    if (value == nullptr) return otherwise;
    if (!value->is_boolean()) fail(key, described(*value), "true or false");
    return value->get<bool>();
}

std::string JsonReader::text_in(const Json& value, std::string_view key, const std::string& expected) const {
    if (!value.is_string()) fail(key, described(value), expected);
    const auto& text = value.get_ref<const std::string&>();
    // a zero byte would end the text if it is used as a file's name, so that another file would be opened
    if (text.find('\0') != std::string::npos)
        fail(key, described(value) + " with a zero byte (\\u0000)", expected + " without it");
    return text;
}

std::string JsonReader::text(std::string_view key) { return text_in(need(key, "a text"), key, "a text"); }

std::string JsonReader::text(std::string_view key, std::string otherwise) {
    if (find(key) != nullptr) return text(key);
    return otherwise;
}

std::vector<std::string> JsonReader::texts(std::string_view key, std::size_t fewest, const std::string& what) {
    const std::string expected =
        "an array of " + (fewest > 1 ? std::to_string(fewest) + " " + what + " or more" : what);
    const Json& value = need(key, expected);
    if (!value.is_array() || value.size() < fewest) fail(key, described(value), expected);
    std::vector<std::string> out;
    for (const Json& item : value) out.push_back(text_in(item, key, what));
    return out;
}

std::size_t JsonReader::choice(std::string_view key, std::initializer_list<std::string_view> choices) {
    std::string expected = "one of";
    for (const auto choice : choices) expected.append(" ").append(choice);
    const Json& value = need(key, expected);
    if (value.is_string()) {
        const auto it = std::find(choices.begin(), choices.end(), value.get_ref<const std::string&>());
        if (it != choices.end()) return static_cast<std::size_t>(it - choices.begin());
    }
    fail(key, described(value), expected);
}

std::vector<double> JsonReader::numbers(std::string_view key, std::size_t count, Bounds bounds) {
    const std::string expected = "an array of " +
                                 (count > 0 ? std::to_string(count) + " numbers" : std::string("numbers")) + ", each " +
                                 bounds_text(bounds);
    const Json& value = need(key, expected);
    if (!value.is_array() || value.empty() || (count > 0 && value.size() != count)) {
        fail(key, described(value), expected);
    }
    std::vector<double> out;
    for (const Json& item : value) {
        if (!item.is_number() || !inside(item.get<double>(), bounds)) fail(key, described(item), expected);
        out.push_back(item.get<double>());
    }
    return out;
}

JsonReader JsonReader::object(std::string_view key) {
    return JsonReader(need(key, "an object { ... }"), file_, where_of(key));
}

std::optional<JsonReader> JsonReader::optional_object(std::string_view key) {
    const Json* value = find(key);
    if (value == nullptr) return std::nullopt;
    return JsonReader(*value, file_, where_of(key));
}

std::vector<JsonReader> JsonReader::objects(std::string_view key) {
    const Json* value = find(key);
    std::vector<JsonReader> out;
    if (value == nullptr) return out;
    if (!value->is_array()) fail(key, described(*value), "an array of objects");
    for (std::size_t i = 0; i < value->size(); ++i) {
        out.emplace_back((*value)[i], file_, where_of(key) + "[" + std::to_string(i) + "]");
    }
    return out;
}

const Json& JsonReader::any(std::string_view key) { return need(key, "a value"); }

namespace {

// Returns how many letters must be added, removed or exchanged to turn one word into the other (Levenshtein's
// distance).
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t before = row[0]++;  // the entry above and to the left
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t exchanged = before + (a[i] == b[j] ? 0 : 1);
            before = row[j + 1];
            row[j + 1] = std::min({exchanged, row[j] + 1, before + 1});
        }
    }
    return row.back();
}

template <class Keys>
void refuse_unknown(const Json& object, const Keys& keys, const std::string& file, const std::string& where) {
    for (const auto& item : object.items()) {
        const std::string& found = item.key();
        if (std::find(keys.begin(), keys.end(), found) != keys.end()) continue;
        std::string expected = "one of";
        std::string_view nearest;
        std::size_t least = std::min<std::size_t>(found.size(), 40) / 3 + 1;  // a greater distance is another word
        for (const auto& key : keys) {
            expected.append(" ").append(key);
            const std::size_t apart = found.size() <= 40 ? distance(found, key) : least + 1;
            if (apart > least || (apart == least && !nearest.empty())) continue;
            least = apart;
            nearest = key;
        }
        if (!nearest.empty()) expected.append(" (is ").append(nearest).append(" meant?)");
        throw bad_input(file, where.empty() ? found : where + "." + found, "an unknown key", expected);
    }
}

}  // namespace

void JsonReader::only(std::initializer_list<std::string_view> keys) const {
    refuse_unknown(*value_, keys, file_, where_);
}

void JsonReader::finish() const { refuse_unknown(*value_, asked_, file_, where_); }

}  // namespace palpa::files
