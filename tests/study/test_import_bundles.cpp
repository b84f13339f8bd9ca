#include <csignal>
#include <doctest/doctest.h>
#include <filesystem>
#include <map>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "files/json.h"
#include "files/sha256.h"
#include "files/text.h"
#include "study/import_bundles.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

using Texts = std::vector<std::pair<std::string, std::string>>;

std::string run_file(const std::string& code, const std::string& ending) {
    return "sub-" + code + "/beh/sub-" + code + "_task-palpation_run-01" + ending;
}

fs::path write_bundle(const fs::path& path, const Texts& texts) {
    Json files = Json::array();
    for (const auto& [name, text] : texts)
        files.push_back({{"name", name}, {"sha256", sha256_hex(text)}, {"text", text}});
    write_text_atomically(path, Json{{"palpa_bundle", 1}, {"files", files}}.dump());
    return path;
}

// Every file below the folder.
std::map<std::string, std::string> tree(const fs::path& folder) {
    std::map<std::string, std::string> out;
    if (!fs::exists(folder)) return out;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) out[fs::relative(entry.path(), folder).string()] = read_text(entry.path());
    }
    return out;
}

const std::string kHeader =
    "participant_id\tage\tsex\thandedness\tvision\tpalpation_experience\tvr_experience\tgroup\n";
std::string people(const std::string& lines) { return kHeader + lines; }
const std::string kAnna = "sub-01\t30\tf\tright\tn/a\tn/a\tn/a\ta\n";
const std::string kBert = "sub-02\t31\tm\tleft\tn/a\tn/a\tn/a\ta\n";
const std::string kProtocolSha256 = sha256_hex("{}");
std::string study_file(const std::string& sha, const std::string& program) {
    return R"({"protocol": "p", "version": "1", "sha256": ")" + sha +
           R"(", "simulated": false, "simulation_seed": 0, "program": ")" + program + "\"}";
}

}  // namespace

TEST_CASE("import bundles: tablets' logs become one study; a second time nothing happens") {
    const TemporaryFolder folder;
    const auto a = write_bundle(folder / "a", {{run_file("01", "_events.tsv"), "e1\n"},
                                               {run_file("01", "_samples.tsv"), "s1\n"},
                                               {"participants.tsv", people(kAnna)},
                                               {"study.json", study_file(sha256_hex("{}"), "tablet")},
                                               {"protocol.json", "{}"}});
    const auto b = write_bundle(folder / "b", {{run_file("02", "_events.tsv"), "e2\n"},
                                               {"participants.tsv", people(kBert)},
                                               {"study.json", study_file(sha256_hex("{}"), "another tablet")},
                                               {"protocol.json", "{}"}});
    const BundleReport first = import_bundles({a, b}, folder / "study");
    CHECK(first.written.size() == 5);
    CHECK(first.already_there.empty());
    CHECK(first.people_added == 2);
    const auto made = tree(folder / "study");
    CHECK(made.at(run_file("01", "_events.tsv")) == "e1\n");
    CHECK(made.at(run_file("01", "_samples.tsv")) == "s1\n");
    CHECK(made.at(run_file("02", "_events.tsv")) == "e2\n");
    CHECK(made.at("participants.tsv") == people(kAnna + kBert));
    CHECK(made.at("study.json") == study_file(sha256_hex("{}"), "tablet"));
    CHECK(made.count("task-palpation_events.json") == 1);
    const BundleReport again = import_bundles({b, a}, folder / "study");
    CHECK(again.written.empty());
    CHECK(again.already_there.size() == 4);
    CHECK(again.people_added == 0);
    CHECK(tree(folder / "study") == made);
}

TEST_CASE("import bundles: what does not fit is refused before anything is written") {
    const TemporaryFolder folder;
    const auto good = write_bundle(folder / "good", {{run_file("01", "_events.tsv"), "e1\n"},
                                                     {"participants.tsv", people(kAnna)},
                                                     {"study.json", study_file(kProtocolSha256, "x")}});
    import_bundles({good}, folder / "study");
    const auto before = tree(folder / "study");
    const std::string fresh = run_file("09", "_events.tsv");
    const auto refused = [&](const Texts& texts, const std::string& why) {
        Texts with_fresh{{fresh, "fresh\n"}};
        with_fresh.insert(with_fresh.end(), texts.begin(), texts.end());
        const auto bundle = write_bundle(folder / "bad", with_fresh);
        const std::string message = message_of([&] { import_bundles({bundle}, folder / "study"); });
        CAPTURE(message);
        CHECK(contains(message, why));
        CHECK(tree(folder / "study") == before);
    };
    const std::pair<std::string, std::string> of_study{"study.json", study_file(kProtocolSha256, "x")};
    refused({{run_file("01", "_events.tsv"), "other\n"}, of_study}, "nothing is overwritten");
    refused({{"participants.tsv", people("sub-01\t99\tf\tright\tn/a\tn/a\tn/a\ta\n")}}, "described otherwise");
    refused({{"participants.tsv", people("../x\n")}}, "no participant");
    refused({{"participants.tsv", people("sub-03\tcut")}}, "no participant");
    refused({{"participants.tsv", people("sub-../x\t1\tf\tright\tn/a\tn/a\tn/a\ta\n")}}, "letters and digits");
    refused({{"study.json", study_file("bb", "x")}}, "two studies never share a folder");
    refused({{"study.json", "{}"}}, "study.json: protocol: found nothing");
    refused({{"protocol.json", "{ }"}}, "as in study.json");
    refused({{"../evil", "x"}}, "files[1].name");
    const auto twice = write_bundle(folder / "twice", {{fresh, "another fresh\n"}, of_study});
    const auto once = write_bundle(folder / "once", {{fresh, "fresh\n"}, of_study});
    CHECK(contains(message_of([&] { import_bundles({once, twice}, folder / "study"); }), "other content than in"));
    write_text_atomically(folder / "trial", "onset\n");
    CHECK(contains(message_of([&] { import_bundles({once, folder / "trial"}, folder / "study"); }), "not valid JSON"));
    CHECK(contains(message_of([&] { import_bundles({once, folder / "none"}, folder / "study"); }), "cannot be read"));
    CHECK(tree(folder / "study") == before);
}

TEST_CASE("import bundles: links are not followed") {
    const TemporaryFolder folder;
    fs::create_directories(folder / "elsewhere");
    const auto bundle = write_bundle(folder / "b", {{run_file("01", "_events.tsv"), "e1\n"},
                                                    {"participants.tsv", people(kAnna)},
                                                    {"study.json", study_file(kProtocolSha256, "x")}});
    const auto refused = [&] {
        return contains(message_of([&] { import_bundles({bundle}, folder / "study"); }), "a link in the way");
    };
    fs::create_directories(folder / "study");
    fs::create_symlink(folder / "elsewhere", folder / "study" / "sub-01");
    CHECK(refused());
    fs::remove(folder / "study" / "sub-01");
    fs::create_directories(folder / "study" / "sub-01" / "beh");
    fs::create_symlink(folder / "elsewhere" / "new", folder / "study" / run_file("01", "_events.tsv"));
    CHECK(refused());
    fs::remove_all(folder / "study" / "sub-01");
    for (const char* name : {"participants.tsv", "study.json"}) {
        fs::create_symlink(folder / "elsewhere" / "new", folder / "study" / name);
        CHECK(refused());
        fs::remove(folder / "study" / name);
    }
    CHECK(fs::is_empty(folder / "elsewhere"));
    import_bundles({bundle}, folder / "study");
    CHECK(read_text(folder / "study" / run_file("01", "_events.tsv")) == "e1\n");
}

TEST_CASE("import bundles: logs of single runs and a study do not mix") {
    const TemporaryFolder folder;
    import_bundles({write_bundle(folder / "a", {{run_file("01", "_events.tsv"), "e1\n"}})}, folder / "logs");
    const auto of_study = write_bundle(
        folder / "b", {{run_file("02", "_events.tsv"), "e2\n"}, {"study.json", study_file(kProtocolSha256, "x")}});
    CHECK(contains(message_of([&] { import_bundles({of_study}, folder / "logs"); }), "which has no study.json"));
    CHECK_FALSE(fs::exists(folder / "logs" / "sub-02"));
}

TEST_CASE("import bundles: answers grow from bundle to bundle, in any order; other answers are refused") {
    const TemporaryFolder folder;
    const std::string name = "sub-01/beh/sub-01_task-ratings_beh.tsv";
    const std::string one = "condition\titem\tvalue\npen\teffort\t3\n";
    const std::string two = one + "hand\teffort\t5\n";
    const std::string three = two + "off\teffort\t1\n";
    const auto bundle = [&](const char* file, const std::string& text) {
        return write_bundle(folder / file, {{name, text}, {"study.json", study_file(kProtocolSha256, "x")}});
    };
    const auto a = bundle("a", one), b = bundle("b", two), c = bundle("c", three);
    CHECK(import_bundles({b, a}, folder / "study").grown.empty());
    CHECK(read_text(folder / "study" / name) == two);
    const BundleReport later = import_bundles({a, c, b}, folder / "study");
    CHECK(later.grown == std::vector<std::string>{name});
    CHECK(later.written.empty());
    CHECK(read_text(folder / "study" / name) == three);
    CHECK(import_bundles({a}, folder / "study").already_there.size() == 1);
    CHECK(read_text(folder / "study" / name) == three);
    const auto other = bundle("d", one + "hand\teffort\t6\n");
    CHECK(contains(message_of([&] { import_bundles({other}, folder / "study"); }), "other answers than in"));
    CHECK(contains(message_of([&] { import_bundles({other, b}, folder / "fresh"); }), "other answers than in"));
    CHECK_FALSE(fs::exists(folder / "fresh"));
    CHECK(read_text(folder / "study" / name) == three);
}

TEST_CASE("import bundles: a withdrawal that was noted at the desk keeps no later bundle of that person out") {
    const TemporaryFolder folder;
    const std::string name = "sub-01/beh/sub-01_task-ratings_beh.tsv";
    const std::string one = "condition\titem\tvalue\npen\teffort\t3\n";
    const std::string row = "n/a\twithdrawal\tdata may be used\n";
    const auto bundle = [&](const char* file, const std::string& text) {
        return write_bundle(folder / file, {{name, text}, {"study.json", study_file(kProtocolSha256, "x")}});
    };
    const auto a = bundle("a", one), b = bundle("b", one + "hand\teffort\t5\n");
    import_bundles({a}, folder / "study");
    write_text_atomically(folder / "study" / name, one + row);
    CHECK(import_bundles({a}, folder / "study").grown.empty());
    CHECK(import_bundles({b}, folder / "study").grown.size() == 1);
    CHECK(read_text(folder / "study" / name) == one + row + "hand\teffort\t5\n");
    CHECK(import_bundles({b, a}, folder / "study").grown.empty());
    CHECK(read_text(folder / "study" / name) == one + row + "hand\teffort\t5\n");
    const auto other = bundle("d", one + "hand\teffort\t6\n");
    CHECK(contains(message_of([&] { import_bundles({other}, folder / "study"); }), "other answers than in"));
    // said on the tablet too: the same adds nothing, and data that were taken back there are taken back here
    const std::string two = one + "hand\teffort\t5\n";
    const auto same = bundle("e", two + row);
    CHECK(import_bundles({same}, folder / "study").grown.empty());
    const std::string taken = "n/a\twithdrawal\tdata must not be used\n";
    const auto back = bundle("f", two + taken);
    CHECK(import_bundles({back}, folder / "study").grown.size() == 1);
    CHECK(import_bundles({back}, folder / "study").grown.empty());
    CHECK(read_text(folder / "study" / name) == one + row + "hand\teffort\t5\n" + taken);
    CHECK(import_bundles({same}, folder / "study").grown.empty());              // and stay so
    const std::string changed = one + row + "hand\teffort\t5\n" + taken + row;  // said anew, knowing what was said
    const auto anew = bundle("g", changed);
    CHECK(import_bundles({anew}, folder / "study").grown.size() == 1);
    CHECK(read_text(folder / "study" / name) == changed);
}

TEST_CASE("import bundles: single runs that a tablet took beside a study are passed over, and alone they are taken") {
    const TemporaryFolder folder;
    const auto single = write_bundle(folder / "s", {{run_file("tablet1", "_events.tsv"), "e\n"},
                                                    {run_file("tablet1", "_settings.json"), R"({"scene": "x"})"}});
    const auto of_study = write_bundle(folder / "b", {{run_file("02", "_settings.json"), R"({"study": {}})"},
                                                      {"study.json", study_file(kProtocolSha256, "x")}});
    const BundleReport report = import_bundles({single, of_study}, folder / "study");
    CHECK(report.passed_over == std::vector<std::string>{single.string()});
    CHECK_FALSE(fs::exists(folder / "study" / "sub-tablet1"));
    CHECK(fs::exists(folder / "study" / "sub-02"));
    CHECK(import_bundles({single}, folder / "study").passed_over.size() == 1);  // the folder is the study's already
    CHECK(import_bundles({single}, folder / "logs").written.size() == 2);
    // an interrupted run has no settings
    const auto interrupted = write_bundle(folder / "i", {{run_file("tablet2", "_events.tsv"), "e\n"}});
    CHECK(import_bundles({interrupted, of_study}, folder / "study2").passed_over ==
          std::vector<std::string>{interrupted.string()});
    CHECK_FALSE(fs::exists(folder / "study2/sub-tablet2"));
}

TEST_CASE("import bundles: several people of one tablet in one file") {
    const TemporaryFolder folder;
    const auto file = write_bundle(folder / "b", {{"participants.tsv", people(kAnna)},
                                                  {"participants.tsv", people(kBert)},
                                                  {"study.json", study_file(kProtocolSha256, "x")}});
    CHECK(import_bundles({file}, folder / "study").people_added == 2);
    CHECK(read_text(folder / "study" / "participants.tsv") == people(kAnna + kBert));
}

TEST_CASE("import bundles: a file where a folder must be, and the other way round") {
    const TemporaryFolder folder;
    const auto bundle =
        write_bundle(folder / "b", {{run_file("01", "_samples.tsv"), "s1\n"}, {run_file("02", "_events.tsv"), "e2\n"}});
    fs::create_directories(folder / "study");
    write_text_atomically(folder / "study" / "sub-02", "in the way");
    const auto refused = [&] {
        return contains(message_of([&] { import_bundles({bundle}, folder / "study"); }), "in the way, expected");
    };
    CHECK(refused());
    fs::remove(folder / "study" / "sub-02");
    fs::create_directories(folder / "study" / run_file("02", "_events.tsv"));
    CHECK(refused());
    CHECK(tree(folder / "study").empty());
}

TEST_CASE("import bundles: what a full disk interrupts is taken back") {
    const TemporaryFolder folder;
    const auto bundle = write_bundle(folder / "b", {{run_file("01", "_samples.tsv"), "s1\n"},
                                                    {run_file("02", "_samples.tsv"), std::string(20000, 'x')}});
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    CHECK_THROWS_AS(import_bundles({bundle}, folder / "study"), std::runtime_error);
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK(tree(folder / "study").empty());
    import_bundles({bundle}, folder / "study");
    CHECK(tree(folder / "study").at(run_file("01", "_samples.tsv")) == "s1\n");
}

TEST_CASE("import bundles: a protocol that is not the one of study.json is refused, since it would stop the analysis") {
    const TemporaryFolder folder;
    const auto bundle = write_bundle(folder / "bad", {{run_file("01", "_events.tsv"), "e1\n"},
                                                      {"participants.tsv", people(kAnna)},
                                                      {"study.json", study_file(kProtocolSha256, "x")},
                                                      {"protocol.json", "{ }"}});
    const std::string message = message_of([&] { import_bundles({bundle}, folder / "study"); });
    CAPTURE(message);
    CHECK(contains(message, "protocol.json: found sha256"));
    CHECK(contains(message, "as in study.json"));
    CHECK_FALSE(fs::exists(folder / "study"));
}

TEST_CASE("import bundles: killed in its middle, the same import goes on") {
    const TemporaryFolder folder;
    const auto bundle = write_bundle(folder / "b", {{run_file("01", "_events.tsv"), "e1\n"},
                                                    {run_file("01", "_marks.tsv"), "m1\n"},
                                                    {run_file("01", "_samples.tsv"), std::string(20000, 'x')},
                                                    {"participants.tsv", people(kAnna)},
                                                    {"study.json", study_file(kProtocolSha256, "x")}});
    const pid_t child = ::fork();
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_DFL);  // the system ends the process at the first large file
        const rlimit small{4096, 4096};
        setrlimit(RLIMIT_FSIZE, &small);
        import_bundles({bundle}, folder / "study");
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    CHECK(fs::exists(folder / "study" / run_file("01", "_marks.tsv")));
    CHECK(import_bundles({bundle}, folder / "study").people_added == 1);
    import_bundles({bundle}, folder / "fresh");
    for (const auto& [name, text] : tree(folder / "fresh")) {
        CAPTURE(name);
        CHECK(tree(folder / "study").at(name) == text);
    }
}

TEST_CASE("import bundles: two tablets on which one participant did a trial are refused, in one call and in two") {
    const TemporaryFolder folder;
    const auto events = [](int trial, double duration_s, const char* last) {
        return "onset\tduration\ttrial_type\ttrial\tcondition\tblock\ttp\tfp\tfn\n1\t" + short_number(duration_s) +
               "\t" + last + "\t" + std::to_string(trial) + "\ta\ttest\t0\t0\t1\n";
    };
    const auto run = [](int number) {
        return "sub-01/beh/sub-01_task-palpation_run-0" + std::to_string(number) + "_events.tsv";
    };
    const Texts study{{"participants.tsv", people(kAnna)}, {"study.json", study_file(kProtocolSha256, "x")}};
    const auto bundle = [&](const std::string& name, Texts texts) {
        texts.insert(texts.end(), study.begin(), study.end());
        return write_bundle(folder / name, texts);
    };
    const auto one = bundle("one", {{run(1), events(1, 2.0, "finish")}, {run(2), events(2, 2.0, "interrupted")}});
    const auto interval = [](int number) {  // both of a forced choice have its trial
        return "sub-01/beh/sub-01_task-interval_run-0" + std::to_string(number) + "_events.tsv";
    };
    const auto pair =
        bundle("pair", {{interval(1), events(9, 2.0, "finish")}, {interval(2), events(9, 3.0, "finish")}});
    CHECK(import_bundles({pair}, folder / "pairs").written.size() == 3);
    const auto rest = bundle("rest", {{run(3), events(2, 3.0, "finish")}, {run(4), events(3, 3.0, "finish")}});
    const auto other = bundle("other", {{run(5), events(1, 4.0, "finish")}});
    const auto refused = [&](const std::vector<fs::path>& bundles, const fs::path& into) {
        const std::string message = message_of([&] { import_bundles(bundles, into); });
        CAPTURE(message);
        CHECK(contains(message, "other: " + run(5) + ": found trial 1 of sub-01 finished a second time"));
        CHECK(contains(message, run(1) + " too"));
    };
    refused({one, other}, folder / "study");
    CHECK_FALSE(fs::exists(folder / "study"));
    import_bundles({one}, folder / "study");
    import_bundles({rest}, folder / "study");  // what was interrupted is done later
    import_bundles({one, rest}, folder / "study");
    const auto before = tree(folder / "study");
    CHECK(before.count(run(4)) == 1);
    refused({other}, folder / "study");
    CHECK(tree(folder / "study") == before);
}
