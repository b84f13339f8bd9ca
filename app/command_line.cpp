#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "files/input_error.h"
#include "mechanics/error.h"

namespace palpa {
namespace {

// `palpa SCENE.json` means `palpa run SCENE.json`, `palpa` alone opens the app.
std::vector<std::string> with_default_command(int argc, char** argv, CLI::App& app) {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    const std::string first = arguments.empty() ? "" : arguments.front();
    bool known = first == "-h" || first == "--help" || first == "--version";
    for (const CLI::App* command : app.get_subcommands({})) known = known || command->get_name() == first;
    if (!known) arguments.insert(arguments.begin(), "run");
    return {arguments.rbegin(), arguments.rend()};  // CLI11 takes them from the back
}

int fail(const char* message, int status) {
    std::fprintf(stderr, "palpa: %s\n", message);
    return status;
}

// Ends here and now: OpenBLAS, whose threads could not be started, waits for them for ever in its destructor.
[[noreturn]] void end_without_memory(const char* message) {
    fail(message, 1);
    std::fflush(nullptr);
    std::_Exit(1);
}

}  // namespace

int run_command_line(int argc, char** argv) {
    CLI::App app("Palpa: feel stiffness on a touch screen. `palpa` alone opens the app on the default scene.");
    app.set_version_flag("--version", "palpa " PALPA_VERSION);
    app.require_subcommand(1);
    add_run(app);
    add_explain(app);
    add_devices(app);
    add_maps(app);
    add_calibrate(app);
    add_fem(app);
    add_study(app);
    add_serve(app);
    add_bench(app);
    try {
        app.parse(with_default_command(argc, argv, app));
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::bad_alloc&) {
        end_without_memory("not enough memory: a smaller model, or a machine with more");
    } catch (const mechanics::OutOfMemory& error) {
        end_without_memory(error.what());
    } catch (const InputError& error) {
        return fail(error.what(), 2);
    } catch (const std::exception& error) {
        return fail(error.what(), 1);
    }
    if (std::fflush(stdout) != 0) return fail("standard output cannot be written", 1);
    return 0;
}

}  // namespace palpa
