// The files that a person names on the command line: inputs and outputs that are none, results that cannot be written.

#include <algorithm>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "files/text.h"
#include "tests/error_message.h"
#include "tests/shell.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

const std::string kShipped = PALPA_SOURCE_DIR "/assets/";
const std::string kMap = kShipped + "maps/silicone.map";

// In the folder; `after` is what the shell does with the output.
Called palpa_in(const TemporaryFolder& folder, const std::string& arguments, const std::string& after = ">/dev/null") {
    return shell("cd " + folder.path().string() + " && timeout 60 " PALPA_PROGRAM " " + arguments + " " + after);
}

void make_fifo(const fs::path& path) {
    if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error(path.string() + ": no FIFO");
}

void replace_all(const std::string& what, const std::string& by, std::string& text) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

// Inputs under their names; copies, so that a result that replaced one would be seen.
void fill(const TemporaryFolder& folder) {
    fs::copy(kMap, folder / "in.map");
    fs::copy_file(kShipped + "phantoms/silicone.json", folder / "phantom.json");
    fs::copy_file(kShipped + "traces/raster.tsv", folder / "trace.tsv");
    fs::copy_file(kShipped + "traces/raster.json", folder / "trace.json");
    write_text_atomically(folder / "points.csv",
                          "level,force_N\n0.1,0.2\n0.2,0.45\n0.4,1.1\n0.6,2\n0.8,3.1\n0.9,3.9\n1,4.4\n");
    write_text_atomically(folder / "case.json", R"({"mesh": {"box": {"size_mm": [10, 10, 10], "elements": [2, 2, 2]}},
        "materials": {"gel": {"young_Pa": 2500, "poisson": 0.45}}, "supports": [{"face": "zmin", "fix": "xyz"}],
        "loads": [{"face": "zmax", "traction_Pa": 10}]})");
    write_text_atomically(folder / "scene.json", R"({"name": "s", "tissue": {"map": "in.map"}})");
    write_text_atomically(folder / "protocol.json", R"({"name": "p", "version": "1", "seed": 1, "order": "fixed",
        "conditions": [{"id": "pen", "modality": "pen", "scene": "scene.json"}]})");
    // that these name others is read before anything else of them
    write_text_atomically(folder / "part.json", R"({"shape": [{"add": {"all": [{"stl": {"file": "body.stl"}}]}},
        {"runs": "body.npy"}], "button": {"support": {"curve": "curve.tsv"}}})");
    write_text_atomically(folder / "device.json", R"({"mesh": {"file": "mesh.msh"}})");
    fs::create_directory(folder / "session");
    for (const char* name : {"body.stl", "body.npy", "curve.tsv", "mesh.msh", "session/points.csv"})
        write_text_atomically(folder / name, "an input\n");
    write_text_atomically(folder / "session/session.json", "{\"level\": \"pressure\"}\n");
}

// Everything in the folder but what the test itself keeps there.
std::string listed(const TemporaryFolder& folder) {
    std::vector<std::string> lines;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
        const std::string name = entry.path().lexically_relative(folder.path()).string();
        if (name == "err" || entry.is_directory()) continue;
        lines.push_back(name + (entry.is_regular_file() && !entry.is_symlink() ? " " + std::to_string(entry.file_size())
                                                                               : " none"));
    }
    std::sort(lines.begin(), lines.end());
    std::string out;
    for (const std::string& line : lines) out += line + "\n";
    return out;
}

// Writes OUT, a file; reads what stands behind.
struct Writer {
    const char* arguments;
    const char* ending;
    std::vector<const char*> inputs;
};
const std::vector<Writer> kWriters{
    {"run --headless --replay trace.tsv scene.json --screenshot OUT",
     "",
     {"scene.json", "trace.tsv", "trace.json", "in.map/normal_N.npy"}},
    {"run in.map --headless --replay trace.tsv --screenshot OUT", "", {"trace.tsv", "in.map/normal_N.npy"}},
    {"maps export in.map -o OUT", ".npy", {"in.map/normal_N.npy"}},
    {"maps export in.map -o OUT", ".csv", {}},
    {"maps export in.map -o OUT", ".mat", {}},
    {"maps plot in.map -o OUT", ".png", {}},
    {"maps compare in.map in.map -o OUT", ".svg", {}},
    {"calibrate fit points.csv -o OUT", "", {"points.csv"}},
    {"calibrate fit points.csv -o profile.json --plot OUT", ".pdf", {}},
    {"calibrate fit session/points.csv -o OUT", "", {"session/points.csv", "session/session.json"}},
    {"fem solve case.json -o OUT", "", {"case.json"}},
    {"tangible fit device.json points.csv -o OUT", "", {"device.json", "mesh.msh"}},
    {"part evaluate part.json -o OUT", "", {"part.json", "body.stl", "body.npy", "curve.tsv"}},
    {"part button part.json -o OUT", "", {"part.json", "curve.tsv"}},
    {"part edit part.json --undo 1 -o OUT", "", {"part.json", "body.npy"}},
    {"part export part.json -o OUT", ".npy", {"body.npy"}},
    {"bench trace scene.json --seconds 1 -o OUT", ".tsv", {}},
};

// Writes OUT, a folder.
const std::vector<const char*> kFolderWriters{
    "run --headless --replay trace.tsv in.map --log OUT",
    "study simulate protocol.json --participants 1 -o OUT",
    "study analyse " PALPA_SOURCE_DIR "/assets/none -o OUT",
    "study import none.json -o OUT",
    "calibrate record --sensor typed --levels none -o OUT",
    "bench accuracy mechanics --quick -o OUT",
    "serve --port 0 --collect OUT",
    "maps generate phantom.json --method analytic -o OUT",
};

std::string with(const char* arguments, const std::string& out) {
    std::string text = arguments;
    replace_all("OUT", out, text);
    return text;
}

}  // namespace

TEST_CASE("files: an input that is no regular file is refused at once by every command that reads one") {
    const TemporaryFolder folder;
    fill(folder);
    make_fifo(folder / "fifo");
    fs::create_symlink("/dev/zero", folder / "zero");
    for (const char* call : {"run IN",
                             "run --headless --replay IN",
                             "explain IN",
                             "explain --measure --trace IN",
                             "maps info IN",
                             "maps sample IN --x-mm 1 --y-mm 1 --force-N 1",
                             "maps import IN -o n.map",
                             "maps generate IN -o n.map",
                             "maps plot IN -o f.png",
                             "maps compare in.map IN",
                             "maps detect IN",
                             "maps export IN -o x.csv",
                             "calibrate fit IN -o p.json",
                             "calibrate check IN points.csv",
                             "calibrate compare IN IN",
                             "fem solve IN",
                             "study order IN --participants 1",
                             "study simulate IN --participants 1 -o n",
                             "study analyse IN",
                             "study import IN -o n",
                             "bench trace IN -o t.tsv",
                             "bench pens IN",
                             "serve --port 0 --tls-cert IN --tls-key IN"}) {
        for (const auto& [name, kind] : {std::pair{"fifo", "found a FIFO"}, {"zero", "found a character device"}}) {
            std::string arguments = call;
            replace_all("IN", name, arguments);
            CAPTURE(arguments);
            const Called called = palpa_in(folder, arguments);
            CAPTURE(called.err);
            CHECK(called.status == 2);
            CHECK(contains(called.err, name));
            CHECK(contains(called.err, kind));
        }
    }
    CHECK_FALSE(fs::exists(folder / "n.map"));
    CHECK_FALSE(fs::exists(folder / "n"));
}

TEST_CASE("files: an input that another input names is a regular file too") {
    const TemporaryFolder folder;
    fill(folder);
    make_fifo(folder / "fifo");
    fs::create_directory(folder / "fifo.map");
    make_fifo(folder / "fifo.map/map.json");
    std::string with_mesh = read_text(folder / "case.json");
    replace_all(R"("box": {"size_mm": [10, 10, 10], "elements": [2, 2, 2]})", R"("file": "fifo")", with_mesh);
    write_text_atomically(folder / "mesh.json", with_mesh);
    write_text_atomically(folder / "tissue.json", R"({"name": "s", "tissue": {"map": "fifo.map"}})");
    write_text_atomically(folder / "profile.json",
                          R"({"name": "s", "profile": "./fifo", "tissue": {"map": "in.map"}})");
    for (const char* arguments :
         {"fem solve mesh.json", "explain tissue.json", "explain profile.json", "maps info fifo.map"}) {
        CAPTURE(arguments);
        const Called called = palpa_in(folder, arguments);
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err, "found a FIFO, expected a regular file"));
    }
}

TEST_CASE("files: no result replaces what is no regular file") {
    const TemporaryFolder folder;
    fill(folder);
    for (const Writer& writer : kWriters) {
        const std::string ending = writer.ending;
        make_fifo(folder / ("fifo" + ending));
        fs::create_symlink("/dev/null", folder / ("null" + ending));
        fs::create_directory(folder / ("dir" + ending));
        const std::string before = listed(folder);
        for (const auto& [name, kind] :
             {std::pair{"fifo", "a FIFO"}, {"null", "a character device"}, {"dir", "a folder"}}) {
            const std::string arguments = with(writer.arguments, name + ending);
            const Called called = palpa_in(folder, arguments);
            CAPTURE(arguments);
            CAPTURE(called.err);
            CHECK(called.status == 2);
            const bool new_folder = ending.empty() && std::string(writer.arguments).rfind("maps export", 0) == 0;
            CHECK(contains(called.err, new_folder ? "something of that name" : "found " + std::string(kind)));
            CHECK(listed(folder) == before);
        }
        for (const char* name : {"fifo", "null", "dir"}) fs::remove(folder / (name + ending));
    }
}

TEST_CASE("files: no result replaces an input, under whatever name") {
    const TemporaryFolder folder;
    fill(folder);
    for (const Writer& writer : kWriters) {
        for (const std::string input : writer.inputs) {
            const std::string ending = writer.ending;
            fs::create_symlink(input, folder / ("link" + ending));
            fs::create_hard_link(folder / input, folder / ("hard" + ending));
            const std::string before = listed(folder);
            for (const std::string& name :
                 {input, "./in.map/../" + input, (folder / input).string(), "link" + ending, "hard" + ending}) {
                const std::string arguments = with(writer.arguments, name);
                const Called called = palpa_in(folder, arguments);
                CAPTURE(arguments);
                CAPTURE(called.err);
                CHECK(called.status == 2);
                CHECK(contains(called.err, "found the input"));
                CHECK(listed(folder) == before);
            }
            fs::remove(folder / ("link" + ending));
            fs::remove(folder / ("hard" + ending));
        }
    }
}

TEST_CASE("files: results that are a folder go to no file, FIFO or device") {
    const TemporaryFolder folder;
    fill(folder);
    make_fifo(folder / "fifo");
    fs::create_symlink("/dev/null", folder / "null");
    write_text_atomically(folder / "file", "mine");
    const std::string before = listed(folder);
    for (const char* writer : kFolderWriters) {
        for (const char* name : {"fifo", "null", "file"}) {
            const std::string arguments = with(writer, name);
            const Called called = palpa_in(folder, arguments);
            CAPTURE(arguments);
            CAPTURE(called.err);
            CHECK(called.status == 2);
            CHECK(contains(called.err, name));
            CHECK(listed(folder) == before);
        }
    }
}

TEST_CASE("files: tables of counts are analysed beside themselves only where no table gets their name") {
    const std::string counts = "condition\ttp\tfn\tfp\npen\t5\t1\t0\n";
    for (const std::string name : {"sensitivity.tsv", "report.md", "counts.tsv"}) {
        const TemporaryFolder folder;
        CAPTURE(name);
        write_text_atomically(folder / name, counts);
        const Called called = palpa_in(folder, "study analyse " + name + " -o .");
        CAPTURE(called.err);
        CHECK(called.status == (name == "counts.tsv" ? 0 : 2));
        CHECK(contains(called.err, name == "counts.tsv" ? "" : "found the input"));
        CHECK(read_text(folder / name) == counts);
    }
}

TEST_CASE("files: what cannot be printed is told, by every command that prints") {
    const TemporaryFolder folder;
    fill(folder);
    const std::string profile = kShipped + "profiles/s-pen.json";
    for (const std::string& arguments : std::vector<std::string>{
             "--help", "--version", "run --help", "maps --help", "maps info in.map", "maps info in.map --json",
             "maps sample in.map --x-mm 1 --y-mm 1 --force-N 1", "maps detect in.map", "maps compare in.map in.map",
             "explain in.map", "explain in.map --json", "fem solve case.json", "fem solve case.json --json",
             "calibrate compare " + profile + " " + profile,
             "calibrate fit points.csv --bootstrap 0 -o profile.json --json",
             "study order protocol.json --participants 2", "run in.map --headless --replay trace.tsv --json"}) {
        CAPTURE(arguments);
        for (const char* out : {">/dev/full", ">&-"}) {
            CAPTURE(out);
            const Called called = palpa_in(folder, arguments, out);
            CAPTURE(called.err);
            CHECK(called.status == 1);
            CHECK(contains(called.err, "standard output cannot be written"));
        }
    }
}

TEST_CASE("files: a reader that went away is told, and ends nothing by a signal") {
    const TemporaryFolder folder;
    fill(folder);
    int ends[2];
    REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
    constexpr int kPipe = 9;  // the shell knows one digit
    REQUIRE(::dup2(ends[1], kPipe) == kPipe);
    ::close(ends[0]);
    ::close(ends[1]);
    for (const char* arguments : {"--help", "maps info in.map"}) {
        const Called called = palpa_in(folder, arguments, ">&9");
        CAPTURE(arguments);
        CHECK(called.status == 1);
        CHECK(contains(called.err, "standard output cannot be written: Broken pipe"));
    }
    ::close(kPipe);
}

TEST_CASE("files: with standard output closed nothing that is printed gets into a result") {
    const TemporaryFolder folder;
    fill(folder);
    // more than the buffer of standard output holds is printed, so some of it goes out before the program ends
    write_text_atomically(folder / "long.json",
                          R"({"name": ")" + std::string(6000, 'x') + R"(", "tissue": {"map": "in.map"}})");
    const std::string call = "run long.json --headless --replay trace.tsv --json --log ";
    palpa_in(folder, call + "open");
    palpa_in(folder, call + "closed", ">&-");
    const std::string samples = "sub-01/beh/sub-01_task-palpation_run-01_samples.tsv";
    CHECK(read_text(folder / ("closed/" + samples)) == read_text(folder / ("open/" + samples)));
}

TEST_CASE("files: words and numbers that an option does not take are told in words") {
    const TemporaryFolder folder;
    fill(folder);
    const auto refused = [&](const std::string& arguments, const char* word) {
        const Called called = palpa_in(folder, arguments, ">&2");
        CAPTURE(arguments);
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err, word));
    };
    refused("run --screen map",
            "--screen: found 'map', expected trial, devices, scale, calibrate, maps, history, tactile or tangible");
    refused("run --headless --replay trace.tsv in.map --screenshot p.jpg",
            "--screenshot: found 'p.jpg', expected FILE.png");
    refused("maps generate phantom.json --method analytic --check -o f.map",
            "--check: found with --method analytic, expected --method fem");
    refused("maps plot in.map -o f.png --what all_of_it",
            "expected all, matrices, stiffness, slice, curves or nodules");
    refused("maps sample in.map --x-mm nan --y-mm 1 --force-N 1", "--x-mm: found 'nan', expected a finite number");
    refused("bench trace in.map -o t.tsv --seconds nan", "--seconds: found 'nan'");
    refused("bench trace in.map -o t.tsv --seconds -1", "--seconds");
    refused("bench trace in.map -o t.tsv --force-N 100", "--force-N: found 100, expected at most 6.777");
    refused("bench trace in.map -o t.tsv --seconds 100000 --rate-Hz 100000", "expected at most 2e7 samples");
    write_text_atomically(folder / "pens.csv", "inventory_id,tablet,date,pressure_norm,force_N\na,b,c,0.5,-1\n");
    refused("bench pens pens.csv", "line 2, force_N: found '-1', expected a force of 0 or more");
    write_text_atomically(folder / "pens.csv", "inventory_id,tablet,date,pressure_norm,force_N\na,b,c,2,1\n");
    refused("bench pens pens.csv", "line 2, pressure_norm: found '2', expected a pressure from 0 to 1");
    refused("maps generate phantom.json -o n.map --jobs -1", "--jobs");
    refused("maps plot in.map -o f.png --force-N inf", "--force-N");
    refused("study order protocol.json --participants -2", "--participants");
    write_text_atomically(folder / "mapp.json", R"({"name": "s", "tissue": {"mapp": "in.map"}})");
    refused(
        "explain mapp.json",
        "tissue.mapp: found an unknown key, expected one of map linear part force_curve block stiffness_scale (is map "
        "meant?)");
}
