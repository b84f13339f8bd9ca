#include "app/commands/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <iostream>
#include <new>
#include <signal.h>
#include <string>
#include <sys/resource.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "app/commands/option_checks.h"
#include "app/commands/part.h"
#include "files/input_error.h"
#include "mechanics/error.h"

namespace palpa::app {
namespace {

// `palpa SCENE.json` means `palpa run SCENE.json`, `palpa` alone opens the app.
std::vector<std::string> with_default_command(int argc, char** argv, CLI::App& app) {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    const std::string first = arguments.empty() ? "" : arguments.front();
    std::vector<std::string> commands;
    for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
    const bool known = first == "-h" || first == "--help" || first == "--version" ||
                       std::find(commands.begin(), commands.end(), first) != commands.end();
    const std::string ending = std::filesystem::path(first).extension().string();
    const bool names_file = first.rfind('-', 0) == 0 || first.find('/') != std::string::npos || ending == ".json" ||
                            ending == ".map" || std::filesystem::exists(first);
    if (!known && !first.empty() && !names_file)
        throw files::InputError("found " + files::shown(first) +
                                ", expected a scene, a map or a command: " + listed(commands));
    if (!known) arguments.insert(arguments.begin(), "run");
    check_subcommands(app, arguments);
    return {arguments.rbegin(), arguments.rend()};  // CLI11 reads the vector from its end
}

int fail(const char* message, int status) {
    std::fprintf(stderr, "palpa: %s\n", message);
    return status;
}

// If standard input, output or error is closed, the next file to be opened would take its descriptor, and printed text
// would end up in that file. Each is therefore opened the wrong way round, so that using it fails as if it were closed.
void keep_standard_streams_apart() {
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(fd, F_GETFD) >= 0) continue;
        const int opened = ::open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        if (opened >= 0 && opened != fd) ::close(opened);
    }
}

// Ends the process at once: if OpenBLAS could not start its threads, its destructor would wait for them for ever.
[[noreturn]] void end_without_memory(const char* message) {
    fail(message, 1);
    std::fflush(nullptr);
    std::_Exit(1);
}

// Functions of a loop do not throw; where one of them gets no memory for its first use, the program ends here.
[[noreturn]] void end_on_terminate() {
    try {
        if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
        end_without_memory("not enough memory");
    } catch (const std::exception& error) {
        fail(error.what(), 1);
    } catch (...) {
    }
    std::abort();
}

int call(int argc, char** argv, CLI::App& app) {
    try {
        app.parse(with_default_command(argc, argv, app));
        return 0;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::bad_alloc&) {
        end_without_memory("not enough memory: a smaller model, or a machine with more");
    } catch (const mechanics::OutOfMemory& error) {
        end_without_memory(error.what());
    } catch (const files::InputError& error) {
        return fail(error.what(), 2);
    } catch (const std::filesystem::filesystem_error& error) {
        const std::string name = files::shown(error.path1().string());
        if (error.code() == std::errc::filename_too_long)
            return fail((name + ": found a name that is too long, expected one that the system takes").c_str(), 2);
        return fail((name + ": " + error.code().message()).c_str(), 1);
    } catch (const std::exception& error) {
        return fail(error.what(), 1);
    }
}

// Output counts as printed only once all of it has been written.
int with_all_printed(int status) {
    errno = 0;
    std::cout.flush();
    const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
    if (!lost) return status;
    const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : std::string();
    const int failed = fail(("standard output cannot be written" + reason).c_str(), 1);
    return status != 0 ? status : failed;
}

// In a limited address space a thread of OpenBLAS may ask for its memory for ever, and the end of the process would wait for it.
int ended(int status) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return status;
    std::fflush(nullptr);
    std::_Exit(status);
}

}  // namespace

int run_command_line(int argc, char** argv) {
    keep_standard_streams_apart();
    std::set_terminate(end_on_terminate);
    // a closed pipe, and a file that may grow no more, are reported as any output that cannot be written
    ::signal(SIGPIPE, SIG_IGN);
    ::signal(SIGXFSZ, SIG_IGN);
    CLI::App app(
        "Palpa: feel stiffness on a touch screen. `palpa` alone opens the app on the scene last chosen in its menu.",
        "palpa");
    app.set_version_flag("--version", "palpa " PALPA_VERSION);
    app.require_subcommand(1);
    add_run(app);
    add_explain(app);
    add_devices(app);
    add_maps(app);
    add_calibrate(app);
    add_fem(app);
    add_study(app);
    add_part(app);
    add_serve(app);
    add_tactile(app);
#ifdef PALPA_TANGIBLE
    add_tangible(app);
#endif
    add_bench(app);
    refuse_what_is_no_value(app);
    return ended(with_all_printed(call(argc, argv, app)));
}

}  // namespace palpa::app
