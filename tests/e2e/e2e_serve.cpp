// The desk as a process, with tablets over real TLS, bad clients, kills.

#include <algorithm>
#include <atomic>
#include <doctest/doctest.h>
#include <filesystem>
#include <map>
#include <set>

#include "study/random.h"
#include "tests/e2e/run_desk.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

struct Place {
    TemporaryFolder folder;
    Place() {
        make_certificate(folder);
        fs::create_directories(folder / "web" / "sub");
        write_text_atomically(folder / "web" / "index.html", "<!doctype html><title>Palpa</title>");
        write_text_atomically(folder / "web" / "app.wasm", std::string(300000, 'w'));
        write_text_atomically(folder / "web" / "sub" / "a.js", "1;");
        write_text_atomically(folder / "secret", "SECRET");
        fs::create_symlink(folder / "secret", folder / "web" / "link");
        fs::create_directory_symlink(folder.path(), folder / "web" / "up");
    }
    std::string in() const { return (folder / "in").string(); }
    std::vector<std::string> arguments(std::vector<std::string> more = {}) const {
        std::vector<std::string> all{"--port", "0", "--web", (folder / "web").string(), "--collect", in()};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    std::vector<std::string> with_tls(std::vector<std::string> more = {}) const {
        more.insert(more.end(),
                    {"--tls-cert", (folder / "cert.pem").string(), "--tls-key", (folder / "key.pem").string()});
        return arguments(more);
    }
    // Uploads under their final names: name to text.
    std::map<std::string, std::string> uploads() const {
        std::map<std::string, std::string> out;
        for (const auto& entry : fs::directory_iterator(folder / "in")) {
            if (entry.path().extension() == ".upload") out[entry.path().filename().string()] = read_text(entry.path());
        }
        return out;
    }
    std::size_t asides() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder / "in" / "aside"), {}));
    }
};

int run(const std::string& arguments, const TemporaryFolder& folder, std::string* message = nullptr) {
    const std::string err = (folder / "err.txt").string();
    const int status = std::system(
        ("timeout 100 " PALPA_PROGRAM " " + arguments + " >" + (folder / "out.txt").string() + " 2>" + err).c_str());
    if (message != nullptr) *message = read_text(err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// 0 for no answer at all.
int status_of(const httplib::Result& result) { return result ? result->status : 0; }

std::string noise(Random& random, std::size_t size) {
    std::string out(size, ' ');
    for (char& c : out) c = static_cast<char>(random.bits());
    return out;
}

}  // namespace

TEST_CASE("serve: a tablet pairs, takes its files and leaves a log") {
    const Place place;
    DeskProcess desk(place.with_tls());
    CHECK(desk.code.size() == 6);
    const auto client = tablet(place.folder, desk.port);

    auto health = client->Get("/api/health");
    REQUIRE(health);
    CHECK(health->status == 200);
    CHECK(Json::parse(health->body)["pairing"] == true);
    CHECK(Json::parse(health->body)["paired"] == false);
    CHECK(client->Get("/")->body == "<!doctype html><title>Palpa</title>");
    for (const char* header :
         {"Content-Security-Policy", "Cross-Origin-Opener-Policy", "Cross-Origin-Embedder-Policy",
          "Cross-Origin-Resource-Policy", "X-Content-Type-Options", "Referrer-Policy", "Cache-Control"}) {
        CAPTURE(header);
        for (const char* path : {"/", "/api/health", "/none", "/api/files"})
            CHECK(client->Get(path)->get_header_value_count(header) == 1);
    }
    CHECK(contains(health->get_header_value("Content-Security-Policy"), "script-src 'self' 'wasm-unsafe-eval'"));
    CHECK(health->get_header_value("Cache-Control") == "no-store");

    const auto wasm = client->Get("/app.wasm", {{"Accept-Encoding", "gzip, br"}, {"Range", "bytes=0-9"}});
    CHECK(wasm->status == 200);
    CHECK(wasm->get_header_value("Content-Type") == "application/wasm");
    CHECK(wasm->body == std::string(300000, 'w'));
    const std::string etag = wasm->get_header_value("ETag");
    CHECK(status_of(client->Get("/app.wasm", {{"If-None-Match", etag}})) == 304);
    CHECK(client->Head("/app.wasm")->get_header_value("Content-Length") == "300000");
    CHECK(status_of(client->Get("/sub/")) == 404);  // no listing
    CHECK(status_of(client->Get("/sub")) == 404);
    CHECK(status_of(client->Get("/link")) == 404);
    CHECK(status_of(client->Get("/up/secret")) == 404);

    CHECK(status_of(client->Get("/api/files")) == 401);
    CHECK(status_of(client->Get("/files/scenes/default.json")) == 401);
    CHECK(status_of(upload("a", "x", "", *client)) == 401);
    const std::string token = token_of(desk.code, *client);
    REQUIRE(token.size() == 64);
    const httplib::Headers paired{{"Authorization", "Bearer " + token}};
    CHECK(Json::parse(client->Get("/api/health", paired)->body)["paired"] == true);
    const Json files = Json::parse(client->Get("/api/files", paired)->body);
    bool found = false;
    for (const char* kind : {"scenes", "maps", "profiles", "phantoms", "protocols"}) CHECK(files[kind].size() > 0);
    for (const Json& map : files["maps"]) {
        for (const Json& file : map["files"]) {
            const auto got = client->Get(file["path"].get<std::string>(), paired);
            CHECK(got->status == 200);
            CHECK(got->body.size() == file["bytes"].get<std::size_t>());
            found = found || got->body == read_text(PALPA_SOURCE_DIR "/assets/maps/silicone.map/map.json");
        }
    }
    CHECK(found);
    CHECK(status_of(client->Get("/files/cases/slab.json", paired)) == 404);
    CHECK(status_of(client->Get("/files/scenes/", paired)) == 404);

    const std::string log = R"({"palpa_bundle": 1, "files": []})";
    const auto stored = upload("tablet%20seven", log, token, *client);
    CHECK(stored->status == 201);
    CHECK(Json::parse(stored->body)["sha256"] == sha256_hex(log));
    const std::string name = Json::parse(stored->body)["name"];
    CHECK(status_of(upload("tablet%20seven", log, token, *client)) == 200);
    CHECK(place.uploads() == std::map<std::string, std::string>{{name, log}});
    const std::string index = read_text(place.folder / "in" / "index.tsv");
    CHECK(contains(index, "\ttablet_seven\t1\t127.0.0.1\n"));
    CHECK(std::count(index.begin(), index.end(), '\n') == 2);

    CHECK(desk.end() == 0);
    CHECK(desk.count("paired") == 1);
    CHECK(desk.count("upload") == 2);
    CHECK(desk.events().back()["event"] == "ended");
}

TEST_CASE("serve: SIGTERM ends it at whatever moment of its start") {
    // the first line is printed just before it begins to accept: a moment after that is where it is most easily missed
    const auto ends = [](bool from_first_line, int pause_us) {
        int out[2];
        REQUIRE(::pipe2(out, O_CLOEXEC) == 0);
        const pid_t pid = ::fork();
        if (pid == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            ::dup2(out[1], 1);
            ::execl(PALPA_PROGRAM, PALPA_PROGRAM, "serve", "--json", "--port", "0", nullptr);
            ::_exit(127);
        }
        ::close(out[1]);
        char byte = 0;
        if (from_first_line) REQUIRE(::read(out[0], &byte, 1) == 1);
        ::usleep(static_cast<useconds_t>(pause_us));
        ::kill(pid, SIGTERM);
        int status = 0;
        pid_t ended = 0;
        for (int i = 0; i < 400 && ended == 0; ++i) {
            ended = ::waitpid(pid, &status, WNOHANG);
            if (ended == 0) sleep_s(0.05);
        }
        if (ended == 0) {
            ::kill(pid, SIGKILL);
            ::waitpid(pid, &status, 0);
        }
        ::close(out[0]);
        // before it minds signals it is ended by this one, as any program
        const bool by_signal = WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM && !from_first_line;
        return ended == pid && (by_signal || (WIFEXITED(status) && WEXITSTATUS(status) == 0));
    };
    for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        CHECK(ends(true, i < 20 ? 0 : 20 * (i - 20)));
    }
    for (int i = 0; i < 20; ++i) {
        CAPTURE(i);
        CHECK(ends(false, 5000 * i));
    }
}

TEST_CASE("serve: only who asks from here, as he should, changes anything") {
    const Place place;
    DeskProcess desk(place.with_tls());
    const auto client = tablet(place.folder, desk.port);
    const std::string here = "https://127.0.0.1:" + std::to_string(desk.port);
    const auto pair_from = [&](const httplib::Headers& headers) {
        return client->Post("/api/pair", headers, "{\"code\": \"" + desk.code + "\"}", "application/json");
    };
    CHECK(status_of(pair_from({{"Origin", here}})) == 200);
    CHECK(status_of(pair_from({{"Origin", "https://evil.test"}})) == 403);
    CHECK(status_of(pair_from({{"Origin", "null"}})) == 403);
    CHECK(status_of(pair_from({{"Origin", "http://127.0.0.1:" + std::to_string(desk.port)}})) == 403);
    CHECK(status_of(pair_from({{"Host", "evil.test"}, {"Origin", "https://evil.test"}})) == 421);
    CHECK(status_of(pair_from({{"Host", "desk.test"}, {"Origin", "https://desk.test"}})) ==
          200);  // the certificate's name
    CHECK(status_of(client->Get("/", {{"Host", "evil.test"}})) == 421);
    CHECK(status_of(client->Delete("/api/logs/a")) == 405);
    CHECK(status_of(client->Options("/api/logs/a")) == 405);
    CHECK(status_of(client->Put("/index.html", "x", "text/html")) == 405);
    CHECK(status_of(client->Post("/api/pair", "{}", "application/json")) == 400);
    CHECK(status_of(client->Post("/api/pair", "{\"code\": 123456}", "application/json")) == 400);
    CHECK(status_of(client->Post("/api/pair", std::string(2000, ' '), "application/json")) == 413);
    CHECK(status_of(client->Post("/api/pair", std::string(1000, '['), "application/json")) == 400);
    CHECK(desk.end() == 0);
}

TEST_CASE("serve: protocols of one's own are served from a folder that is named") {
    const Place place;
    std::string message;
    const std::filesystem::path mine = place.folder / "mine";
    std::filesystem::create_directories(mine);
    CHECK(run("serve --port 0 --assets " + mine.string(), place.folder, &message) == 2);
    CHECK(contains(message, "--assets: found '" + mine.string() + "', expected a folder with one of"));
    std::filesystem::create_directories(mine / "protocols");
    files::write_text_atomically(mine / "protocols/own.json", "{}");
    DeskProcess desk(place.arguments({"--assets", mine.string()}));
    httplib::Client client("127.0.0.1", desk.port);
    const Json files = Json::parse(client.Get("/api/files")->body);
    REQUIRE(files["protocols"].size() == 1);
    CHECK(files["protocols"][0]["path"] == "/files/protocols/own.json");
    CHECK(client.Get("/files/protocols/own.json")->body == "{}");
    CHECK(desk.end() == 0);
}

TEST_CASE("serve: without TLS this machine alone, without a code") {
    const Place place;
    std::string message;
    CHECK(run("serve --bind 0.0.0.0 --port 0", place.folder, &message) == 2);
    CHECK(contains(message, "--tls-cert"));
    CHECK(run("serve --bind somewhere", place.folder, &message) == 2);
    CHECK(run("serve --tls-cert " + (place.folder / "cert.pem").string(), place.folder, &message) == 2);
    CHECK(run("serve --tls-cert " + (place.folder / "key.pem").string() + " --tls-key " +
                  (place.folder / "key.pem").string(),
              place.folder, &message) == 2);
    CHECK(contains(message, "key.pem"));
    CHECK(run("serve --web " + place.folder.path().string(), place.folder, &message) == 2);
    DeskProcess desk(place.arguments());
    CHECK(desk.code.empty());
    CHECK(run("serve --port 0 --collect " + place.in(), place.folder, &message) == 2);
    CHECK(contains(message, "another palpa serve"));
    CHECK(run("serve --port " + std::to_string(desk.port), place.folder, &message) == 1);
    httplib::Client client("127.0.0.1", desk.port);
    const std::string log = "onset\ttrial\n";
    const httplib::Headers hash{{"X-Content-SHA256", sha256_hex(log)}};
    CHECK(status_of(client.Put("/api/logs/a", hash, log, "text/plain")) == 201);
    CHECK(status_of(client.Post("/api/pair", "{\"code\": \"0\"}", "application/json")) == 200);
    CHECK(status_of(client.Put("/api/logs/a", {{"X-Content-SHA256", sha256_hex(log)}, {"Origin", "http://evil.test"}},
                               log, "text/plain")) == 403);
    CHECK(desk.end(SIGINT) == 0);
}

TEST_CASE("serve: a wrong code a thousand times") {
    const Place place;
    DeskProcess desk(place.with_tls({"--lock-s", "10"}));
    const auto client = tablet(place.folder, desk.port);
    const std::string wrong = desk.code == "000000" ? "000001" : "000000";
    std::map<int, int> statuses;
    double wait_s = 0.0;
    const double before_MB = desk.memory_MB("VmHWM");
    for (int i = 0; i < 1000; ++i) {
        const auto result = pair_with(wrong, *client);
        REQUIRE(result);
        ++statuses[result->status];
        if (result->status == 429) wait_s = std::stod(result->get_header_value("Retry-After"));
    }
    CHECK(statuses[401] >= 5);
    CHECK(statuses[401] <= 10);  // a try after each lock-out that ended meanwhile
    CHECK(statuses[401] + statuses[429] == 1000);
    const auto locked = pair_with(desk.code, *client);
    CHECK(locked->status == 429);
    wait_s = std::stod(locked->get_header_value("Retry-After"));
    CHECK(wait_s > 0.0);
    CHECK(desk.count("locked") >= 1);
    sleep_s(wait_s + 0.2);
    CHECK(token_of(desk.code, *client).size() == 64);
    const double grown_MB = desk.memory_MB("VmHWM") - before_MB;
    MESSAGE("", statuses[401], " compared, ", statuses[429], " locked out, memory grown by ", grown_MB, " MB");
#ifndef __SANITIZE_ADDRESS__  // which keeps freed memory for a while
    CHECK(grown_MB < 20.0);
#endif
    CHECK(desk.count("refused") <= 130);
}

TEST_CASE("serve: sessions end") {
    const Place place;
    DeskProcess desk(place.with_tls({"--session-h", "0.001"}));  // 3.6 s
    const auto client = tablet(place.folder, desk.port);
    const std::string token = token_of(desk.code, *client);
    const httplib::Headers paired{{"Authorization", "Bearer " + token}};
    CHECK(status_of(client->Get("/api/files", paired)) == 200);
    sleep_s(4.0);
    CHECK(status_of(client->Get("/api/files", paired)) == 401);
    CHECK(status_of(upload("a", "x", token, *client)) == 401);
    CHECK(place.uploads().empty());
    CHECK(token_of(desk.code, *client) != token);
}

TEST_CASE("serve: uploads that are wrong leave nothing") {
    const Place place;
    DeskProcess desk(place.with_tls({"--upload-MB", "0.1", "--total-MB", "0.25", "--patience-s", "2"}));
    const auto client = tablet(place.folder, desk.port);
    const std::string token = token_of(desk.code, *client);
    const auto status_with = [&](const httplib::Headers& headers, const std::string& bytes) {
        return status_of(client->Put("/api/logs/a", headers, bytes, "application/json"));
    };
    CHECK(status_with(upload_headers(token, sha256_hex("y")), "x") == 422);
    CHECK(status_with(upload_headers(token, "abc"), "x") == 400);
    CHECK(status_with({{"Authorization", "Bearer " + token}}, "x") == 400);
    CHECK(status_with(upload_headers("f" + token.substr(1) + "0", sha256_hex("x")), "x") == 401);
    CHECK(status_with(upload_headers(token, sha256_hex(std::string(200000, 'x'))), std::string(200000, 'x')) == 413);
    auto gzip = upload_headers(token, sha256_hex("x"));
    gzip.emplace("Content-Encoding", "gzip");
    CHECK(status_with(gzip, "x") == 415);
    // chunked, so without a length
    const auto chunked = client->Put(
        "/api/logs/a", upload_headers(token, sha256_hex("x")),
        [](std::size_t, httplib::DataSink& sink) {
            sink.write("x", 1);
            sink.done();
            return true;
        },
        "application/json");
    CHECK((!chunked || chunked->status == 411));
    // a client that goes in the middle
    const std::string half(50000, 'h');
    const auto cut = client->Put(
        "/api/logs/a", upload_headers(token, sha256_hex(half)), half.size(),
        [&](std::size_t offset, std::size_t, httplib::DataSink& sink) {
            return offset < 20000 && sink.write(half.data() + offset, 10000);
        },
        "application/json");
    CHECK(!cut);
    const auto told_of_cut = [&] {
        const auto events = desk.events();
        return std::any_of(events.begin(), events.end(),
                           [](const Json& event) { return event.value("why", "") == "cut off on its way"; });
    };
    // the client can be gone before the desk has opened the upload: no upload aside then does not say that it is over
    for (int i = 0; i < 1200 && !told_of_cut(); ++i) sleep_s(0.05);
    CHECK(told_of_cut());
    CHECK(place.asides() == 0);
    CHECK(place.uploads().empty());
    CHECK(status_of(upload("../../../etc/passwd", "kept", token, *client)) == 201);
    CHECK(contains(read_text(place.folder / "in" / "index.tsv"), "\t.._.._.._etc_passwd\t"));
    // the total, then nothing more
    CHECK(status_of(upload("a", std::string(90000, 'a'), token, *client)) == 201);
    CHECK(status_of(upload("a", std::string(90000, 'b'), token, *client)) == 201);
    CHECK(status_of(upload("a", std::string(90000, 'c'), token, *client)) == 507);
    CHECK(status_of(upload("a", std::string(90000, 'a'), token, *client)) == 200);  // the desk has it already
    CHECK(place.uploads().size() == 3);
    CHECK(desk.end() == 0);
}

TEST_CASE("serve: paths lead nowhere else") {
    const Place place;
    DeskProcess desk(place.arguments());
    std::vector<std::string> targets{"/../secret",
                                     "/%2e%2e/secret",
                                     "/..%2fsecret",
                                     "/sub/../../secret",
                                     "/sub/%2e%2e/%2e%2e/secret",
                                     "/..%5csecret",
                                     "/up/secret",
                                     "/link",
                                     "/link%00.js",
                                     "//etc/passwd",
                                     "/./secret",
                                     "/%252e%252e/secret",
                                     "/%u002e%u002e/secret",
                                     "/..;/secret",
                                     "/web/../secret",
                                     "/files/../../secret",
                                     "/files/scenes/../../../secret",
                                     "/files/maps/%2e%2e/%2e%2e/README.md",
                                     "/files//etc/passwd",
                                     "/files/traces/raster.tsv",
                                     "http://127.0.0.1/secret",
                                     "secret",
                                     "*",
                                     "/\x01",
                                     "/%c0%ae%c0%ae/secret",
                                     "/api/logs/../../secret",
                                     "/api/../index.html"};
    targets.push_back("/" + std::string(5000, 'a'));
    targets.push_back("/" + std::string(40000, 'a'));
    for (const std::string& target : targets) {
        CAPTURE(target.substr(0, 100));
        RawClient client(desk.port);
        client.send("GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
        const std::string answer = client.receive();
        CHECK(answer.substr(0, 10) == "HTTP/1.1 4");
        CHECK_FALSE(contains(answer, "SECRET"));
        CHECK_FALSE(contains(answer, "<!doctype"));
    }
    const auto status_raw = [&](const std::string& request) {
        RawClient client(desk.port);
        client.send(request);
        const std::string answer = client.receive();
        return answer.size() < 12 ? 0 : std::stoi(answer.substr(9, 3));
    };
    CHECK(status_raw("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n") == 200);
    CHECK(status_raw("GET / HTTP/1.1\r\nConnection: close\r\n\r\n") == 421);
    CHECK(status_raw("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n") == 421);
    CHECK(status_raw("BREW / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n") == 400);
    CHECK(status_raw("GET / HTTP/9.9\r\nHost: 127.0.0.1\r\n\r\n") == 400);
    CHECK(status_raw("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nA: " + std::string(20000, 'a') + "\r\n\r\n") == 431);
    CHECK(status_raw(std::string(20000, 'x')) == 431);
    CHECK(desk.end() == 0);
}

TEST_CASE("serve: whatever is refused has a body that says why") {
    const TemporaryFolder folder;
    DeskProcess desk({"--port", "0", "--collect", (folder / "logs").string()});
    const std::string host = " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n";
    const std::string long_path(2000, 'a');
    for (const std::string& request :
         {"GET /api" + host, "GET /api/nothing" + host, "GET /files/maps/none" + host, "GET /nothing" + host,
          "PUT /api/logs/a" + host, "POST /api/pair" + host + "Transfer-Encoding: chunked\r\n", "BREW /" + host,
          "PATCH /x" + host + "Content-Length: 0\r\n", "DELETE /api/logs/a" + host, "GET /" + long_path + host,
          "PUT /api/logs/a" + host + "Content-Length: 1\r\nContent-Encoding: gzip\r\n",
          "GET /" + host + "A: " + std::string(20000, 'a') + "\r\n", std::string("GET / HTTP/9.9\r\n"),
          std::string("GET /\r\n")}) {
        CAPTURE(request.substr(0, 100));
        RawClient client(desk.port);
        client.send(request + "\r\n");
        const std::string answer = client.receive();
        const auto body = answer.find("\r\n\r\n");
        REQUIRE(body != std::string::npos);
        const files::Json json = files::Json::parse(answer.substr(body + 4), nullptr, false);
        REQUIRE(json.is_object());
        CHECK(json["error"].get<std::string>().size() > 5);
    }
    for (const std::string& request : {"HEAD /nothing" + host, "HEAD /" + long_path + host}) {
        RawClient client(desk.port);
        client.send(request + "\r\n");
        CHECK(client.receive().ends_with("\r\n\r\n"));
    }
}

TEST_CASE("serve: a port that is taken leaves no folder") {
    const TemporaryFolder folder;
    DeskProcess desk({"--port", "0"});
    const std::string command = PALPA_PROGRAM " serve --port " + std::to_string(desk.port) + " --collect " +
                                (folder / "new").string() + " 2>/dev/null";
    CHECK(std::system(command.c_str()) != 0);
    CHECK_FALSE(std::filesystem::exists(folder / "new"));
}

TEST_CASE("serve: clients that are slow or silent hold nobody up") {
    const Place place;
    DeskProcess desk(place.with_tls({"--patience-s", "4"}));
    // more than there are threads, of two addresses: silent before TLS; half of them say something now and then
    std::vector<std::unique_ptr<RawClient>> slow;
    for (int i = 0; i < 200; ++i)
        slow.push_back(std::make_unique<RawClient>(desk.port, i % 2 == 0 ? "127.0.0.2" : "127.0.0.3"));
    const auto client = tablet(place.folder, desk.port);
    const auto health = client->Get("/api/health");
    REQUIRE(health);
    CHECK(health->status == 200);
    const std::string token = token_of(desk.code, *client);
    CHECK(status_of(upload("a", "through", token, *client)) == 201);
    CHECK(desk.threads() < 140);
    int closed = 0;
    for (auto& one : slow) {
        for (int i = 0; i < 3; ++i) one->send("\x16");
        one->receive(30.0);
        closed += one->closed() ? 1 : 0;
    }
    CHECK(closed == 200);
    CHECK(desk.end() == 0);
}

TEST_CASE("serve: a head or a body that drips ends, one that flows slowly comes through") {
    const Place place;
    DeskProcess desk(place.arguments({"--patience-s", "2"}));
    RawClient head(desk.port), body(desk.port);
    head.send("GET / HTTP/1.1\r\n");
    body.send("PUT /api/logs/a HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 100000\r\nX-Content-SHA256: " +
              sha256_hex("x") + "\r\n\r\n");
    int head_drops = 0, body_drops = 0;
    for (int i = 0; i < 150; ++i) {  // 15 s, a byte each 0.1 s: neither is ever silent
        head_drops += head.send("A") ? 1 : 0;
        body_drops += body.send("A") ? 1 : 0;
        sleep_s(0.1);
    }
    CHECK(head_drops < 149);
    CHECK(body_drops < 149);
    CHECK(place.asides() == 0);
    httplib::Client client("127.0.0.1", desk.port);
    const std::string log(40000, 's');
    const auto slow = client.Put(
        "/api/logs/a", {{"X-Content-SHA256", sha256_hex(log)}}, log.size(),
        [&](std::size_t offset, std::size_t, httplib::DataSink& sink) {
            sleep_s(0.2);
            return sink.write(log.data() + offset, 1000);
        },
        "application/json");
    REQUIRE(slow);
    CHECK(slow->status == 201);
    CHECK(desk.end() == 0);
}

TEST_CASE("serve: fifty tablets at once, none lost, none mixed up") {
    const Place place;
    DeskProcess desk(place.with_tls());
    constexpr int kTablets = 50, kLogs = 12;
    constexpr std::uint64_t kSeed = 5;
    CAPTURE(kSeed);
    std::mutex mutex;
    std::map<std::string, std::string> label_of;  // sha256 to who sent it
    std::atomic<int> failed = 0;
    std::vector<std::thread> tablets;
    for (int i = 0; i < kTablets; ++i) {
        tablets.emplace_back([&, i] {
            Random random(kSeed + static_cast<std::uint64_t>(i));
            const auto client = tablet(place.folder, desk.port);
            const std::string token = token_of(desk.code, *client);
            const std::string label = "tablet-" + std::to_string(i);
            for (int log = 0; log < kLogs; ++log) {
                const std::string bytes = noise(random, static_cast<std::size_t>(random.uniform(1000.0, 4e5)));
                const auto result = upload(label, bytes, token, *client);
                if (!result || result->status != 201 || Json::parse(result->body)["sha256"] != sha256_hex(bytes))
                    ++failed;
                const std::lock_guard lock(mutex);
                label_of[sha256_hex(bytes)] = label;
            }
        });
    }
    for (std::thread& one : tablets) one.join();
    CHECK(failed == 0);
    const double peak_MB = desk.memory_MB("VmHWM");
    MESSAGE("peak memory of the desk ", peak_MB, " MB, ", desk.threads(), " threads");
#ifndef __SANITIZE_ADDRESS__
    CHECK(peak_MB < 200.0);
#endif
    const auto uploads = place.uploads();
    CHECK(uploads.size() == kTablets * kLogs);
    for (const auto& [name, text] : uploads) CHECK(name == sha256_hex(text) + ".upload");
    const std::string index = read_text(place.folder / "in" / "index.tsv");
    CHECK(std::count(index.begin(), index.end(), '\n') == kTablets * kLogs + 1);
    int right = 0;
    for (const auto& [sha256, label] : label_of) {
        const auto at = index.find("\t" + sha256 + "\t");
        if (at == std::string::npos || uploads.count(sha256 + ".upload") == 0) continue;
        right += contains(index.substr(at, index.find('\n', at) - at), "\t" + label + "\t") ? 1 : 0;
    }
    CHECK(right == kTablets * kLogs);
    CHECK(place.asides() == 0);
    CHECK(desk.end() == 0);
}

TEST_CASE("serve: killed in the middle of uploads and started again, nothing is lost and nothing is half there") {
    const Place place;
    constexpr int kKills = 3, kTablets = 8;
    constexpr std::uint64_t kSeed = 21;
    CAPTURE(kSeed);
    Random random(kSeed);
    auto desk = std::make_unique<DeskProcess>(place.with_tls());
    const int port = desk->port;
    const std::string token = token_of(desk->code, *tablet(place.folder, port));
    std::atomic<bool> done = false;
    std::atomic<int> retries = 0;
    std::mutex mutex;
    std::set<std::string> acknowledged;
    std::vector<std::thread> tablets;
    for (int i = 0; i < kTablets; ++i) {
        tablets.emplace_back([&, i] {
            Random own(kSeed + 100 + static_cast<std::uint64_t>(i));
            while (!done) {
                const std::string bytes = noise(own, static_cast<std::size_t>(own.uniform(1e5, 3e6)));
                while (true) {  // as a tablet does: again and again until the desk has said that it has it
                    const auto result = upload("t", bytes, token, *tablet(place.folder, port));
                    if (result && (result->status == 200 || result->status == 201)) break;
                    ++retries;
                    sleep_s(0.1);
                }
                const std::lock_guard lock(mutex);
                acknowledged.insert(sha256_hex(bytes));
            }
        });
    }
    int interrupted = 0;
    for (int i = 0; i < kKills; ++i) {
        sleep_s(random.uniform(0.3, 1.2));
        for (int wait = 0; wait < 1000 && place.asides() == 0; ++wait) sleep_s(0.01);  // until one is under way
        desk->end(SIGKILL);
        interrupted += static_cast<int>(place.asides());
        for (const auto& [name, text] : place.uploads()) CHECK(name == sha256_hex(text) + ".upload");
        auto arguments = place.with_tls();
        arguments[1] = std::to_string(port);
        desk = std::make_unique<DeskProcess>(arguments);
    }
    done = true;
    for (std::thread& one : tablets) one.join();
    const auto uploads = place.uploads();
    for (const auto& [name, text] : uploads) CHECK(name == sha256_hex(text) + ".upload");
    const std::string index = read_text(place.folder / "in" / "index.tsv");
    for (const std::string& sha256 : acknowledged) {
        CHECK(uploads.count(sha256 + ".upload") == 1);
        CHECK(contains(index, "\t" + sha256 + "\t"));
    }
    CHECK(interrupted > 0);  // else the kills hit nothing
    MESSAGE("", kKills, " kills, ", interrupted, " uploads cut, ", retries.load(), " retries, ", acknowledged.size(),
            " logs");
    CHECK(desk->end() == 0);
    CHECK(place.asides() == 0);
}

TEST_CASE("serve: what was collected becomes a study") {
    const Place place;
    const auto bundle = [](const std::string& name, const std::string& text) {
        return Json{{"palpa_bundle", 1}, {"files", {{{"name", name}, {"sha256", sha256_hex(text)}, {"text", text}}}}}
            .dump();
    };
    const std::string name = "sub-01/beh/sub-01_task-palpation_run-01_events.tsv";
    std::string stored;
    {
        DeskProcess desk(place.with_tls());
        const auto client = tablet(place.folder, desk.port);
        const auto result = upload("t", bundle(name, "onset\n"), token_of(desk.code, *client), *client);
        stored = place.in() + "/" + Json::parse(result->body)["name"].get<std::string>();
        CHECK(desk.end() == 0);
    }
    const std::string study = (place.folder / "study").string();
    std::string message;
    CHECK(run("study import " + stored + " -o " + study, place.folder, &message) == 0);
    CHECK(read_text(study + "/" + name) == "onset\n");
    CHECK(run("study import " + stored + " -o " + study, place.folder) == 0);
    CHECK(contains(read_text(place.folder / "out.txt"), name + ": there already, the same"));
    write_text_atomically(place.folder / "other.json", bundle(name, "other\n"));
    CHECK(run("study import " + (place.folder / "other.json").string() + " -o " + study, place.folder, &message) == 2);
    CHECK(contains(message, "nothing is overwritten"));
    write_text_atomically(place.folder / "evil.json", bundle("../evil", "x"));
    CHECK(run("study import " + (place.folder / "evil.json").string() + " -o " + study, place.folder, &message) == 2);
    CHECK(contains(message, "files[0].name"));
    CHECK(read_text(study + "/" + name) == "onset\n");
    CHECK_FALSE(fs::exists(place.folder / "evil"));
}
