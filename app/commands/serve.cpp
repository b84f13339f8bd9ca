// palpa serve

#include "desk/serve.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/assets.h"
#include "app/commands/command_line.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::app {
namespace {

struct ServeArguments {
    desk::ServeOptions options;
    std::string web;
    std::string assets;
    double hours = 12.0;
    double upload_MB = 64.0;
    double total_MB = 16384.0;
};

// `asked`: empty for the installed one.
std::filesystem::path served_folder(const std::string& asked, const std::filesystem::path& installed) {
    if (asked.empty()) return installed;
    for (const char* kind : {"protocols", "scenes", "maps", "profiles", "phantoms"})
        if (std::filesystem::is_directory(std::filesystem::path(asked) / kind)) return asked;
    throw files::bad_input("--assets", "", files::shown(asked),
                           "a folder with one of the folders protocols, scenes, maps, profiles, phantoms");
}

void start(const ServeArguments& arguments) {
    desk::ServeOptions options = arguments.options;
    const std::filesystem::path installed = assets_folder();
    options.assets = served_folder(arguments.assets, installed);
    options.web = arguments.web.empty() ? desk::web_folder_beside(installed) : std::filesystem::path(arguments.web);
    options.sessions.lasts_s = 3600.0 * arguments.hours;
    options.uploads.upload_bytes = static_cast<std::uint64_t>(1e6 * arguments.upload_MB);
    options.uploads.total_bytes = static_cast<std::uint64_t>(1e6 * arguments.total_MB);
    if (!options.collect.empty()) {
        files::check_output_folder(options.collect);
        if (std::filesystem::exists(std::filesystem::path(options.collect) / "study.json"))
            throw files::bad_input(options.collect, "", "the folder of a study (study.json)",
                                   "a folder of its own, from which `palpa study import` adds the logs to the study");
    }
    desk::serve(options);
}

}  // namespace

void add_serve(CLI::App& app) {
    auto arguments = std::make_shared<ServeArguments>();
    desk::ServeOptions& options = arguments->options;
    CLI::App* command =
        app.add_subcommand("serve", "Serve the web app and its files to tablets and collect their logs");
    command
        ->add_option("--bind", options.bind,
                     "IP address to listen on; any other than the loopback address requires TLS; 0.0.0.0 or :: means "
                     "all addresses")
        ->capture_default_str();
    command->add_option("--port", options.port, "port to listen on; 0 chooses a free port")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    command->add_option(
        "--tls-cert", options.tls_cert,
        "certificate in PEM; with TLS, tablets have to pair by a code that the desk prints at its start");
    command->add_option("--tls-key", options.tls_key, "the certificate's private key in PEM");
    command->add_option("--collect", options.collect,
                        "folder for the logs of tablets; without this option no logs are taken");
    command->add_option("--web", arguments->web,
                        "folder of the built web app (default: build/web/site or web beside the assets, if it exists)");
    command->add_option(
        "--assets", arguments->assets,
        "folder whose protocols, scenes, maps, profiles and phantoms (folders of these names) are served; "
        "default: those that came with Palpa");
    command->add_option("--session-h", arguments->hours, "how long a paired tablet stays paired, in hours")
        ->check(CLI::Range(0.0001, 8760.0))
        ->capture_default_str();
    command
        ->add_option("--lock-s", options.tries.first_lock_s,
                     "first lock-out after five wrong codes, in seconds; doubles with each further wrong code")
        ->check(CLI::Range(0.1, 3600.0))
        ->capture_default_str();
    command
        ->add_option("--patience-s", options.patience.wait_s,
                     "how long the desk waits for a silent or slow client, in seconds")
        ->check(CLI::Range(0.1, 600.0))
        ->capture_default_str();
    command->add_option("--upload-MB", arguments->upload_MB, "largest size of one upload, in MB")
        ->check(CLI::Range(0.001, 1000.0))
        ->capture_default_str();
    command->add_option("--total-MB", arguments->total_MB, "largest size of all uploads together, in MB")
        ->check(CLI::Range(0.001, 1e9))
        ->capture_default_str();
    command->add_flag(
        "--json", options.json,
        "print one JSON object per line on standard output: first the addresses and the code, then each event");
    command->callback([arguments] { start(*arguments); });
}

}  // namespace palpa::app
