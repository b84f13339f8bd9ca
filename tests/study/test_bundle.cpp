#include <algorithm>
#include <doctest/doctest.h>

#include "files/json.h"
#include "files/sha256.h"
#include "study/bundle.h"
#include "study/random.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

const std::string kName = "sub-01/beh/sub-01_task-palpation_run-01_events.tsv";

Json file_json(const std::string& name, const std::string& text) {
    return {{"name", name}, {"sha256", sha256_hex(text)}, {"text", text}};
}
std::string bundle_text(const std::vector<Json>& files) { return Json{{"palpa_bundle", 1}, {"files", files}}.dump(); }
std::string refusal(const std::string& bytes) {
    return message_of([&] { read_bundle(bytes, "b.json"); });
}

}  // namespace

TEST_CASE("bundle: files come out as they went in, whatever their text") {
    const std::string odd = "onset\ttrial\n\"quoted\" \\ \r\n\xc3\xa4\t\x01 0.5\n";
    const Bundle bundle =
        read_bundle(bundle_text({file_json(kName, odd), file_json("participants.tsv", "")}), "b.json");
    REQUIRE(bundle.files.size() == 2);
    CHECK(bundle.files[0].name == kName);
    CHECK(bundle.files[0].kind == LogFileKind::trial);
    CHECK(bundle.files[0].text == odd);
    CHECK(bundle.files[0].sha256 == sha256_hex(odd));
    CHECK(bundle.files[1].kind == LogFileKind::people);
    CHECK(bundle.files[1].text.empty());
}

TEST_CASE("bundle: names of logs and no others") {
    for (const char* name :
         {"sub-01/beh/sub-01_task-palpation_run-01_samples.tsv", "sub-aB9/beh/sub-aB9_task-softer_run-100_events.tsv",
          "sub-01/beh/sub-01_task-palpation_run-01_settings.json",
          "sub-1/beh/sub-1_task-palpation_run-2_performance.json"}) {
        CAPTURE(name);
        CHECK(kind_of_log_file(name) == LogFileKind::trial);
    }
    CHECK(kind_of_log_file("sub-01/beh/sub-01_task-ratings_beh.tsv") == LogFileKind::trial);
    CHECK_FALSE(kind_of_log_file("sub-01/beh/sub-02_task-ratings_beh.tsv").has_value());
    CHECK_FALSE(kind_of_log_file("sub-NA/beh/sub-NA_task-ratings_beh.tsv").has_value());
    CHECK_FALSE(kind_of_log_file("sub-01/beh/sub-01_task-ratings_beh.tsv/").has_value());
    CHECK_FALSE(kind_of_log_file("sub-01/now.json").has_value());
    CHECK(kind_of_log_file("study.json") == LogFileKind::identity);
    CHECK(kind_of_log_file("protocol.json") == LogFileKind::dataset);
    CHECK(kind_of_log_file(".bidsignore") == LogFileKind::dataset);
    const std::string nul = kName.substr(0, 10) + '\0' + kName.substr(10);
    for (const std::string& name :
         {std::string(),
          std::string("/etc/passwd"),
          "../" + kName,
          "sub-01/../" + kName,
          "/" + kName,
          kName + "/",
          kName + "x",
          "x" + kName,
          kName + "\n",
          nul,
          std::string("sub-01\\beh\\sub-01_task-palpation_run-01_events.tsv"),
          std::string("sub-01/beh/sub-02_task-palpation_run-01_events.tsv"),
          std::string("sub-01/beh/sub-01_task-palpation_run-_events.tsv"),
          std::string("sub-01/beh/sub-01_task-palpation_run-01_events.sh"),
          std::string("sub-/beh/sub-_task-palpation_run-01_events.tsv"),
          std::string("sub-../beh/sub-.._task-palpation_run-01_events.tsv"),
          std::string("sub-01/anat/sub-01_task-palpation_run-01_events.tsv"),
          std::string("SUB-01/beh/SUB-01_task-palpation_run-01_events.tsv"),
          std::string(".bashrc"),
          std::string("sub-01"),
          "sub-" + std::string(65, 'a') + "/beh/sub-" + std::string(65, 'a') + "_task-palpation_run-01_events.tsv",
          std::string("sub-01/beh/sub-01_task-palpation_run-1234567_events.tsv"),
          std::string("sub-01/beh/sub-01_task-palpation_run-01_events.tsv.part-7")}) {
        CAPTURE(name);
        CHECK_FALSE(kind_of_log_file(name).has_value());
        if (name.find('\0') == std::string::npos)
            CHECK(contains(refusal(bundle_text({file_json(name, "x")})), "files[0].name"));
    }
}

TEST_CASE("bundle: what is refused, and how it is said") {
    Json changed = file_json(kName, "text");
    changed["text"] = "Text";
    Json upper = file_json(kName, "text");
    std::string hash = upper["sha256"];
    std::transform(hash.begin(), hash.end(), hash.begin(),
                   [](char c) { return c >= 'a' ? static_cast<char>(c - 32) : c; });
    upper["sha256"] = hash;
    Json more = file_json(kName, "text");
    more["mode"] = "0777";
    CHECK(contains(refusal(bundle_text({changed})), "files[0].sha256: found "));
    CHECK(contains(refusal(bundle_text({upper})), "files[0].sha256"));
    CHECK(contains(refusal(bundle_text({more})), "files[0].mode: found an unknown key"));
    CHECK(contains(refusal(bundle_text({file_json(kName, "a"), file_json(kName, "b")})), "files[1].name: found "));
    CHECK(read_bundle(bundle_text({file_json(kName, "a"), file_json(kName, "a")}), "b").files.size() == 1);
    CHECK(contains(refusal(bundle_text({})), "0 files"));
    CHECK(contains(refusal(R"({"palpa_bundle": 1})"), "files: found nothing"));
    CHECK(contains(refusal(R"({"palpa_bundle": 2, "files": []})"), "palpa_bundle: found 2"));
    CHECK(contains(refusal(R"({"palpa_bundle": 1, "files": {}})"), "found an object"));
    CHECK(contains(refusal(R"({"palpa_bundle": 1, "files": [3]})"), "files[0]: found 3"));
    CHECK(contains(refusal("onset\ttrial\n"), "not valid JSON"));
    CHECK(contains(refusal(""), "not valid JSON"));
    CHECK(contains(refusal("[]"), "b.json: found an array"));
}

TEST_CASE("bundle: a message is one short line that no terminal obeys") {
    const std::string key(5000, 'k');
    for (const std::string& bytes : {R"({")" + key + R"(": 1})", R"({"\u001b[2J\u009b": 1})" + std::string(),
                                     "{\"" + key, std::string("{\"\xc2\x9b\x1b\": 1}")}) {
        const std::string message = refusal(bytes);
        CHECK(!message.empty());
        CHECK(message.size() <= 400);
        CHECK(std::all_of(message.begin(), message.end(), [](char c) { return c >= 0x20 && c < 0x7f; }));
    }
    CHECK(contains(refusal(std::string(200000, '[')), "not valid JSON"));  // deep, but no deeper than the heap
}

TEST_CASE("bundle: damaged bytes give a bundle of checked files or a refusal, nothing else") {
    constexpr std::uint64_t kSeed = 7;
    CAPTURE(kSeed);
    Random random(kSeed);
    const std::string good = bundle_text({file_json(kName, "onset\ttrial\n0\t1\n"), file_json("study.json", "{}"),
                                          file_json("participants.tsv", "\xc3\xa4\n")});
    int taken = 0, refused = 0;
    for (int i = 0; i < 4000; ++i) {
        std::string bytes = good;
        for (int change = 1 + static_cast<int>(random.uniform(0.0, 3.0)); change > 0; --change) {
            const auto at = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(bytes.size())));
            const auto what = static_cast<int>(random.uniform(0.0, 4.0));
            if (what == 0) bytes[at] = static_cast<char>(random.uniform(0.0, 256.0));
            if (what == 1) bytes.erase(at, static_cast<std::size_t>(random.uniform(0.0, 20.0)));
            if (what == 2) bytes.insert(at, bytes.substr(at / 2, 10));
            if (what == 3) bytes[at] = "{}[]\",:0\\"[static_cast<std::size_t>(random.uniform(0.0, 9.0))];
            if (bytes.empty()) bytes = "x";
        }
        CAPTURE(i);
        try {
            for (const BundleFile& file : read_bundle(bytes, "b.json").files) {
                CHECK(kind_of_log_file(file.name) == file.kind);
                CHECK(sha256_hex(file.text) == file.sha256);
            }
            ++taken;
        } catch (const InputError&) {
            ++refused;
        }
    }
    CHECK(taken > 0);  // comments and blanks do no harm
    CHECK(refused > 3000);
}
