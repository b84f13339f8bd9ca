#include "study/bundle.h"

#include <algorithm>
#include <array>
#include <map>

#include "files/input_error.h"
#include "files/json.h"
#include "files/sha256.h"
#include "study/names.h"

namespace palpa::study {
namespace {

constexpr std::size_t kLongestLabel = 64;
constexpr std::size_t kLongestRun = 6;
constexpr std::size_t kLongestMessage = 400;
constexpr int kMostFiles = 100000;

constexpr std::array<std::string_view, 10> kTrialEndings{
    "_events.tsv",   "_events.json",   "_marks.tsv",        "_marks.json",  "_samples.tsv",
    "_samples.json", "_settings.json", "_performance.json", "_tactile.tsv", "_tangible.tsv"};
constexpr std::array<std::string_view, 12> kDatasetNames{"dataset_description.json",
                                                         ".bidsignore",
                                                         "protocol.json",
                                                         "README",
                                                         "participants.json",
                                                         "exclusions.json",
                                                         "replacements.json",
                                                         "task-palpation_events.json",
                                                         "task-palpation_marks.json",
                                                         "task-palpation_samples.json",
                                                         "task-softer_events.json",
                                                         "task-ratings_beh.json"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_plain(char c) { return is_digit(c) || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

bool take(std::string_view word, std::string_view& rest) {
    if (rest.substr(0, word.size()) != word) return false;
    rest.remove_prefix(word.size());
    return true;
}

// Takes the leading characters for which `wanted` is true from `rest`. Returns false if there are none, or more than
// `longest`.
bool take_all(bool (*wanted)(char), std::size_t longest, std::string_view& out, std::string_view& rest) {
    const auto end = static_cast<std::size_t>(std::find_if_not(rest.begin(), rest.end(), wanted) - rest.begin());
    out = rest.substr(0, end);
    rest.remove_prefix(end);
    return !out.empty() && out.size() <= longest;
}

// True for the name of a file of one run, or of a participant's ratings.
bool is_trial_file(std::string_view rest) {
    std::string_view subject, again, task, run;
    const bool of_subject = take("sub-", rest) && take_all(is_plain, kLongestLabel, subject, rest) &&
                            take("/beh/sub-", rest) && take_all(is_plain, kLongestLabel, again, rest) &&
                            again == subject && is_code(subject) && take("_task-", rest);
    if (!of_subject || rest == "ratings_beh.tsv") return of_subject;
    return take_all(is_plain, kLongestLabel, task, rest) && take("_run-", rest) &&
           take_all(is_digit, kLongestRun, run, rest) &&
           std::find(kTrialEndings.begin(), kTrialEndings.end(), rest) != kTrialEndings.end();
}

std::string one_line(std::string_view text) {
    std::string out(text.substr(0, kLongestMessage));
    for (char& c : out) {
        // bytes beyond ASCII are replaced too, since some of them are control characters of terminals
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    }
    return text.size() > kLongestMessage ? out.substr(0, kLongestMessage - 3) + "..." : out;
}

BundleFile read_file(files::JsonReader& json) {
    json.only({"name", "sha256", "text"});
    BundleFile file;
    file.name = json.text("name");
    const auto kind = kind_of_log_file(file.name);
    if (!kind)
        json.fail("name", files::shown(file.name),
                  "a file of a study's log, such as sub-01/beh/sub-01_task-palpation_run-01_events.tsv");
    file.kind = *kind;
    file.sha256 = json.text("sha256");
    file.text = json.text("text");
    const std::string is = files::sha256_hex(file.text);
    if (file.sha256 != is)
        json.fail("sha256", files::shown(file.sha256), is + ", the text's own: it was changed on its way");
    return file;
}

Bundle read_checked(std::string_view bytes, const std::string& file_name) {
    const files::Json root = files::parse_json(bytes, file_name);
    files::JsonReader json(root, file_name);
    json.only({"palpa_bundle", "files"});
    json.integer("palpa_bundle", 1, 1);
    if (!json.has("files")) json.fail("files", "nothing", "an array of files");
    std::vector<files::JsonReader> files = json.objects("files");
    if (files.empty() || files.size() > kMostFiles)
        json.fail("files", std::to_string(files.size()) + " files", "1 to " + std::to_string(kMostFiles));
    Bundle bundle;
    std::map<std::string, std::string> hashes;
    for (files::JsonReader& json_file : files) {
        BundleFile file = read_file(json_file);
        const auto [it, fresh] = hashes.emplace(file.name, file.sha256);
        // participants of several bundles are merged, and answers grow, so their lines are compared at import
        const bool again = !fresh && it->second != file.sha256;
        if (again && file.kind != LogFileKind::people && !grows(file.name)) {
            json_file.fail("name", files::shown(file.name) + " again with other content", "each file once");
        }
        if (fresh || again) bundle.files.push_back(std::move(file));
    }
    return bundle;
}

}  // namespace

std::optional<LogFileKind> kind_of_log_file(std::string_view name) {
    if (is_trial_file(name)) return LogFileKind::trial;
    if (name == "participants.tsv") return LogFileKind::people;
    if (name == "study.json") return LogFileKind::identity;
    if (std::find(kDatasetNames.begin(), kDatasetNames.end(), name) != kDatasetNames.end()) return LogFileKind::dataset;
    return std::nullopt;
}

bool grows(std::string_view name) {
    const auto ends = [&](std::string_view ending) {
        return name.size() > ending.size() && name.substr(name.size() - ending.size()) == ending;
    };
    return ends("_task-ratings_beh.tsv") ||
           (name.find("_task-softer_run-") != std::string_view::npos && ends("_events.tsv"));
}

Bundle read_bundle(std::string_view bytes, const std::string& file_name) {
    try {
        return read_checked(bytes, file_name);
    } catch (const files::InputError& error) {
        throw files::InputError(one_line(error.what()));
    }
}

}  // namespace palpa::study
