#pragma once
// The app, run as a person runs it, in a folder of the test's own (settings, home) under tests/platform/xorg/with-xorg.

#include <chrono>
#include <cstdio>
#include <doctest/doctest.h>
#include <filesystem>
#include <functional>
#include <stdlib.h>
#include <string>
#include <sys/wait.h>
#include <thread>

#include "files/text.h"
#include "tests/temporary_folder.h"

namespace palpa::test {

// The command's exit status, -1 if it did not end by itself.
inline int shell(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

inline void sleep_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Plays FOLDER/script.tsv on the X server.
inline int play_script(const TemporaryFolder& folder) {
    return shell("timeout 900 " PALPA_XORG_PEN " " + (folder / "script.tsv").string());
}

// Sends `signal` ("TERM") to the program that was given a path in `folder`, not to the shell that waits for it.
inline void end_program(const TemporaryFolder& folder, const std::string& signal) {
    shell("for p in $(pgrep -x palpa); do grep -q '" + folder.path().string() + "' /proc/$p/cmdline && kill -" +
          signal + " $p; done");
}

// Runs `palpa ARGUMENTS >FOLDER/out.json` and does `meanwhile` once `sign` is there, and with it the window.
// Returns its exit status. PALPA_KEEP_PICTURE names a copy of FOLDER/p.png.
inline int run_program(const TemporaryFolder& folder, const std::string& arguments, const std::filesystem::path& sign,
                       const std::function<void()>& meanwhile) {
    const std::string home = folder.path().string();
    int status = -1;
    std::thread app([&] {
        status = shell("XDG_CONFIG_HOME=" + home + "/config HOME=" + home + " timeout 900 " PALPA_PROGRAM " " +
                       arguments + " >" + home + "/out.json 2>" + home + "/err.txt");
    });
    for (int i = 0; i < 600 && !std::filesystem::exists(sign); ++i) sleep_s(0.05);
    sleep_s(1.5);
    meanwhile();
    app.join();
    if (status != 0) std::fputs(files::read_text(folder / "err.txt").c_str(), stderr);
    const char* keep = ::getenv("PALPA_KEEP_PICTURE");
    if (keep != nullptr && std::filesystem::exists(folder / "p.png"))
        files::write_text_atomically(keep, files::read_text(folder / "p.png"));
    return status;
}

// `palpa run`; the recording is opened after the window, so input may come once it is there.
inline int run_app(const TemporaryFolder& folder, const std::string& arguments,
                   const std::function<void()>& meanwhile) {
    const std::string trace = (folder / "t.tsv").string();
    return run_program(folder, "run --json --record " + trace + " " + arguments, trace, meanwhile);
}

// Runs `palpa study run ARGUMENTS`, plays the script, and ends the program once the study is at the step `last`.
inline int run_study_to(const std::string& last, const TemporaryFolder& folder, const std::string& arguments) {
    const std::filesystem::path now = folder / "log/sub-01/now.json";
    return run_program(folder, arguments + " --quit-after-s 240", now, [&] {
        CHECK(play_script(folder) == 0);
        const std::string step = "\"step\": \"" + last + "\"";
        for (int i = 0; i < 1000 && files::read_text(now).find(step) == std::string::npos; ++i) sleep_s(0.05);
        end_program(folder, "TERM");
    });
}

}  // namespace palpa::test
