#include "desk/routes.h"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <openssl/x509v3.h>

#include "desk/request_head.h"
#include "desk/static_files.h"
#include "files/clock.h"
#include "files/input_error.h"
#include "files/sha256.h"

namespace palpa::desk {
namespace {

namespace fs = std::filesystem;
using httplib::Request;
using httplib::Response;

constexpr std::size_t kLargestPairing_bytes = 1024;
constexpr std::array<const char*, 5> kAssetFolders{"scenes", "maps", "profiles", "phantoms", "protocols"};

double unix_s() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

std::string dumped(const files::Json& json) {
    return json.dump(-1, ' ', false, files::Json::error_handler_t::replace) + "\n";
}

void answer(int status, const files::Json& json, Response& res) {
    res.status = status;
    res.set_content(dumped(json), "application/json");
}

void refuse(int status, const std::string& why, Response& res) { answer(status, {{"error", why}}, res); }

bool changes_state(const Request& req) { return req.method != "GET" && req.method != "HEAD"; }

// What is refused for every client, before anything else is checked.
bool refused_outright(const Request& req, const Desk& desk, Response& res) {
    const std::string host = req.get_header_value("Host");
    if (req.get_header_value_count("Host") != 1 || !own_host(host, desk.certificate)) {
        refuse(421, "this desk goes by its IP address or the names in its certificate", res);
    } else if (changes_state(req) && req.has_header("Origin") &&
               req.get_header_value("Origin") != (desk.certificate != nullptr ? "https://" : "http://") + host) {
        refuse(403, "asked for by a page from elsewhere", res);
    } else if (changes_state(req) && !(req.method == "POST" && req.path == "/api/pair") &&
               !(req.method == "PUT" && req.path.rfind("/api/logs/", 0) == 0)) {
        refuse(405, "GET and HEAD; POST /api/pair; PUT /api/logs/LABEL", res);
    } else {
        return false;
    }
    return true;
}

// Returns the number of the tablet that asks, 0 if the desk asks for no code, nothing if the tablet has to pair first.
std::optional<int> device_of(const Request& req, const Desk& desk) {
    constexpr std::string_view kBearer = "Bearer ";
    const std::string header = req.get_header_value("Authorization");
    std::optional<int> device;
    if (header.rfind(kBearer, 0) == 0)
        device = desk.sessions.device_of(std::string_view(header).substr(kBearer.size()), unix_s());
    if (!device && !desk.pairs) device = 0;
    return device;
}

void ask_to_pair(Response& res) {
    res.set_header("WWW-Authenticate", "Bearer");
    refuse(401, "pair first: POST /api/pair with the code that the desk shows", res);
}

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

std::uint64_t announced_bytes(const Request& req) { return req.get_header_value<std::uint64_t>("Content-Length"); }

// Checks before a body is read whether its upload can be taken.
bool upload_refused(const Request& req, Desk& desk, Response& res) {
    if (!device_of(req, desk)) {
        ask_to_pair(res);
    } else if (!desk.uploads) {
        refuse(503, "this desk takes no logs: it was started without --collect", res);
    } else if (!files::is_sha256_hex(lower_case(req.get_header_value("X-Content-SHA256")))) {
        refuse(400, "X-Content-SHA256: expected 64 hexadecimal digits", res);
    } else if (announced_bytes(req) > desk.options.uploads.upload_bytes) {
        refuse(413, "at most " + std::to_string(desk.options.uploads.upload_bytes) + " bytes in one upload", res);
    } else {
        return false;
    }
    return true;
}

// ---- pairing

// Returns the code in {"code": "123456"}, or nothing if the text is not of this form.
std::optional<std::string> code_in(const std::string& body) {
    try {
        const files::Json root = files::parse_json(body, "pair");
        files::JsonReader json(root, "pair");
        std::string code = json.text("code");
        json.finish();
        return code;
    } catch (const files::InputError&) {
        return std::nullopt;
    }
}

void tell_lock(const CodeGuard::Result& result, const std::string& address, Desk& desk) {
    const int wait_s = static_cast<int>(std::ceil(result.wait_s));
    const std::string who = result.everybody ? "everybody" : address;
    desk.events.tell("locked", "too many wrong codes: " + who + " waits for " + std::to_string(wait_s) + " s",
                     {{"who", who}, {"wait_s", wait_s}});
}

void pair(const Request& req, const std::string& body, Desk& desk, Response& res) {
    const auto code = code_in(body);
    if (!code) return refuse(400, "expected {\"code\": \"123456\"}", res);
    if (desk.pairs) {
        const CodeGuard::Result result = desk.codes.try_code(*code, req.remote_addr, files::steady_s());
        if (result.lock_began) tell_lock(result, req.remote_addr, desk);
        if (result.answer == CodeGuard::Answer::wrong) {
            desk.events.tell_refused("a wrong code from " + req.remote_addr,
                                     {{"why", "wrong code"}, {"address", req.remote_addr}});
            return refuse(401, "another code", res);
        }
        if (result.answer == CodeGuard::Answer::locked) {
            const int wait_s = static_cast<int>(std::ceil(result.wait_s));
            res.set_header("Retry-After", std::to_string(wait_s));
            return answer(429, {{"error", "too many wrong codes"}, {"wait_s", wait_s}}, res);
        }
    }
    const Sessions::Opened opened = desk.sessions.open(unix_s());
    desk.events.tell("paired", "tablet " + std::to_string(opened.device) + " at " + req.remote_addr,
                     {{"device", opened.device}, {"address", req.remote_addr}});
    answer(200, {{"token", opened.token}, {"expires_s", desk.sessions.lasts_s()}}, res);
}

// ---- uploads

void take_upload(const Request& req, const httplib::ContentReader& read_content, Desk& desk, Response& res) {
    const std::uint64_t bytes = announced_bytes(req);
    const Sender sender{sane_label(req.path.substr(std::string_view("/api/logs/").size())),
                        device_of(req, desk).value_or(0), req.remote_addr};
    files::Json fields{
        {"label", sender.label}, {"device", sender.device}, {"address", sender.address}, {"bytes", bytes}};
    const std::string who = sender.label + " (" + std::to_string(bytes) + " bytes) from tablet " +
                            std::to_string(sender.device) + " at " + sender.address;
    std::optional<UploadRefused> refused;
    try {
        const std::string sha256 = lower_case(req.get_header_value("X-Content-SHA256"));
        const auto incoming = desk.uploads->begin(bytes, sha256);
        const bool whole = read_content([&](const char* data, std::size_t size) {
            try {
                incoming->add({data, size});
            } catch (const UploadRefused& reason) {
                refused = reason;
            }
            return !refused;
        });
        if (refused) throw UploadRefused(*refused);
        if (!whole) throw UploadRefused(400, "cut off on its way");
        const auto stored = incoming->finish(sha256, sender);
        fields["name"] = stored.name;
        fields["fresh"] = stored.fresh;
        desk.events.tell("upload", who + (stored.fresh ? " -> " : ", there already: ") + stored.name, fields);
        answer(stored.fresh ? 201 : 200, {{"sha256", stored.sha256}, {"name", stored.name}}, res);
    } catch (const UploadRefused& reason) {
        fields["why"] = reason.what();
        desk.events.tell_refused(who + ": " + reason.what(), fields);
        refuse(reason.status, reason.what(), res);
    }
}

// ---- files

void hand_out(const Request& req, const fs::path& folder, const std::vector<std::string>& names, Response& res) {
    auto file = std::make_shared<StaticFile>(open_static(folder, names));
    if (!file->is_open()) return refuse(404, "no such file", res);
    res.set_header("ETag", file->etag());
    res.set_header("Cache-Control", "no-cache");  // browsers may keep it but must ask again: names carry no version
    if (req.get_header_value("If-None-Match") == file->etag()) {
        res.status = 304;
        return;
    }
    const std::string type = mime_type(names.back());
    if (file->bytes() == 0) return res.set_content("", type);
    res.set_content_provider(file->bytes(), type,
                             [file](std::size_t offset, std::size_t left, httplib::DataSink& sink) {
                                 std::array<char, 1 << 16> buffer;
                                 const long n = file->read(offset, buffer.data(), std::min(left, buffer.size()));
                                 return n > 0 && sink.write(buffer.data(), static_cast<std::size_t>(n));
                             });
}

void get(const Request& req, Desk& desk, Response& res) {
    const auto names = names_of_path(req.target);
    if (!names) return refuse(400, "no plain path", res);
    const std::string& first = names->front();
    if (first == "api") {
        if (*names == std::vector<std::string>{"api", "health"}) {
            return answer(200,
                          {{"ok", true},
                           {"program", "palpa " PALPA_VERSION},
                           {"pairing", desk.pairs},
                           {"paired", device_of(req, desk).has_value()},
                           {"collects", desk.uploads.has_value()}},
                          res);
        }
        if (*names != std::vector<std::string>{"api", "files"}) return refuse(404, "no such thing", res);
        if (!device_of(req, desk)) return ask_to_pair(res);
        return answer(200, files_json(desk.options.assets), res);
    }
    if (first == "files") {
        if (!device_of(req, desk)) return ask_to_pair(res);
        const bool known = names->size() > 2 &&
                           std::find(kAssetFolders.begin(), kAssetFolders.end(), (*names)[1]) != kAssetFolders.end();
        if (!known) return refuse(404, "no such file", res);
        return hand_out(req, desk.options.assets, {names->begin() + 1, names->end()}, res);
    }
    if (desk.options.web.empty()) return refuse(404, "no web app is built: the desk has only /api and /files", res);
    hand_out(req, desk.options.web, *names, res);
}

httplib::Headers strict_headers() {
    return {{"Content-Security-Policy",
             "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; img-src "
             "'self' data: blob:; "
             "connect-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"},
            {"Cross-Origin-Opener-Policy", "same-origin"},
            {"Cross-Origin-Embedder-Policy", "require-corp"},
            {"Cross-Origin-Resource-Policy", "same-origin"},
            {"Accept-Ranges", "none"},
            {"X-Content-Type-Options", "nosniff"},
            {"Referrer-Policy", "no-referrer"},
            {"Permissions-Policy", "camera=(), microphone=(), geolocation=()"}};
}

}  // namespace

bool own_host(std::string_view host, X509* certificate) {
    if (!host.empty() && host.front() == '[') {
        const auto end = host.find(']');
        in6_addr six{};
        return end != std::string_view::npos &&
               ::inet_pton(AF_INET6, std::string(host.substr(1, end - 1)).c_str(), &six) == 1;
    }
    const std::string name(host.substr(0, host.find(':')));
    in_addr four{};
    if (::inet_pton(AF_INET, name.c_str(), &four) == 1 || name == "localhost") return true;
    return !name.empty() && certificate != nullptr &&
           X509_check_host(certificate, name.data(), name.size(), 0, nullptr) == 1;
}

files::Json files_json(const fs::path& assets) {
    const auto plain = [](const fs::directory_entry& entry) {
        return !entry.is_symlink() && entry.path().filename().string().front() != '.';
    };
    const auto listed = [&](const fs::path& folder) {
        std::vector<fs::path> paths;
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(folder, none)) {
            if (plain(entry)) paths.push_back(entry.path());
        }
        std::sort(paths.begin(), paths.end());
        return paths;
    };
    const auto file_json = [&](const fs::path& path) {
        return files::Json{{"path", "/files/" + fs::relative(path, assets).generic_string()},
                           {"bytes", fs::file_size(path)}};
    };
    files::Json json;
    for (const std::string kind : kAssetFolders) {
        json[kind] = files::Json::array();
        for (const fs::path& path : listed(assets / kind)) {
            if (fs::is_regular_file(path)) json[kind].push_back(file_json(path));
            if (!fs::is_directory(path)) continue;
            files::Json files = files::Json::array();
            for (const fs::path& part : listed(path)) {
                if (fs::is_regular_file(part)) files.push_back(file_json(part));
            }
            json[kind].push_back({{"name", path.filename().string()}, {"files", files}});
        }
    }
    return json;
}

void set_routes(Desk& desk, DeskServer& server) {
    server.set_default_headers(strict_headers());
    server.set_payload_max_length(std::max<std::uint64_t>(desk.options.uploads.upload_bytes, kLargestPairing_bytes));
    server.set_pre_routing_handler([&desk](const Request& req, Response& res) {
        const bool refused =
            refused_outright(req, desk, res) || (req.method == "PUT" && upload_refused(req, desk, res));
        if (refused && changes_state(req)) {
            desk.events.tell_refused(req.method + " from " + req.remote_addr + ": status " + std::to_string(res.status),
                                     {{"why", "status " + std::to_string(res.status)}, {"address", req.remote_addr}});
        }
        return refused ? httplib::Server::HandlerResponse::Handled : httplib::Server::HandlerResponse::Unhandled;
    });
    // refuses before the body is sent if the client waits for "100 Continue"
    server.set_expect_100_continue_handler([&desk](const Request& req, Response& res) {
        const bool refused =
            refused_outright(req, desk, res) || (req.method == "PUT" && upload_refused(req, desk, res));
        return refused ? res.status : 100;
    });
    server.Get(".*", [&desk](const Request& req, Response& res) { get(req, desk, res); });
    server.Post("/api/pair", [&desk](const Request& req, Response& res, const httplib::ContentReader& read_content) {
        std::string body;
        if (announced_bytes(req) > kLargestPairing_bytes) return refuse(413, "at most 1024 bytes", res);
        const bool whole = read_content([&](const char* data, std::size_t size) {
            body.append(data, size);
            return true;
        });
        if (!whole) return refuse(400, "cut off on its way", res);
        pair(req, body, desk, res);
    });
    server.Put("/api/logs/.*", [&desk](const Request& req, Response& res, const httplib::ContentReader& read_content) {
        take_upload(req, read_content, desk, res);
    });
    server.set_post_routing_handler([](const Request& req, Response& res) {
        if (!res.has_header("Cache-Control")) res.set_header("Cache-Control", "no-store");
        // does not wait for the rest of a large body
        const bool closes = res.status >= 400 && announced_bytes(req) > kSkipped_bytes;
        if (closes && !res.has_header("Connection")) res.set_header("Connection", "close");
    });
    server.set_error_handler([](const Request& req, Response& res) {
        if (!res.body.empty()) return;
        // what the library refuses by itself: methods, versions and requests that it does not know
        refuse(res.status, res.status == 404 ? "no such thing" : why_refused(res.status), res);
        if (req.method == "HEAD") res.body.clear();
    });
    server.set_exception_handler([&desk](const Request& req, Response& res, std::exception_ptr trouble) {
        std::string what = "unknown";
        try {
            std::rethrow_exception(trouble);
        } catch (const std::exception& error) {
            what = error.what();
        } catch (...) {
        }
        desk.events.tell("failed", req.method + " from " + req.remote_addr + ": " + what,
                         {{"why", what}, {"address", req.remote_addr}});
        refuse(500, "the desk failed; it says why", res);
    });
}

}  // namespace palpa::desk
