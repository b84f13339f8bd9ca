#pragma once
// A simulator as a process of its own, ended with the test.

#include <cstdio>
#include <fcntl.h>
#include <signal.h>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace palpa::test {

class SimulatorProcess {
  public:
    SimulatorProcess(const std::string& program, std::vector<std::string> arguments) {
        int ends[2];
        if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
        arguments.insert(arguments.begin(), program);
        std::vector<char*> argv;
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        pid_ = ::fork();
        if (pid_ == 0) {
            ::dup2(ends[1], 1);
            ::close(ends[0]);
            ::close(ends[1]);
            ::execv(program.c_str(), argv.data());
            ::_exit(127);
        }
        ::close(ends[1]);
        out_ = ::fdopen(ends[0], "r");
        const std::string first = line();
        if (first.rfind("port ", 0) != 0) throw std::runtime_error("the simulator said: " + first);
        port_ = first.substr(5);
    }
    ~SimulatorProcess() {
        end();
        std::fclose(out_);
    }
    SimulatorProcess(const SimulatorProcess&) = delete;
    SimulatorProcess& operator=(const SimulatorProcess&) = delete;

    const std::string& port() const { return port_; }
    // The next line that it prints, without the newline; waits for it.
    std::string line() {
        std::string text;
        for (int c = std::fgetc(out_); c != EOF && c != '\n'; c = std::fgetc(out_))
            text.push_back(static_cast<char>(c));
        return text;
    }
    void end() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGTERM);
        ::waitpid(pid_, nullptr, 0);
        pid_ = -1;
    }

  private:
    pid_t pid_ = -1;
    std::FILE* out_ = nullptr;
    std::string port_;
};

}  // namespace palpa::test
