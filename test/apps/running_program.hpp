// One of the executables, run as by a user: with arguments, files for its output, signals and an exit code.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "folders.hpp"

namespace pmg::test {

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

/// What a program that has ended leaves.
struct Finished {
  int exit_code = -1;  ///< or minus the signal that ended it
  std::string out, err;
};

/// A child process; killed when the object is destroyed.
class RunningProgram {
 public:
  RunningProgram(const std::string& name, std::vector<std::string> arguments, const std::filesystem::path& folder)
      : out_(folder / (name + ".out")), err_(folder / (name + ".err")) {
    std::string program = pmg::test::program_folder() + "/" + name;
    std::vector<char*> argv{program.data()};
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
      if (std::freopen(out_.c_str(), "w", stdout) == nullptr || std::freopen(err_.c_str(), "w", stderr) == nullptr) {
        _exit(126);
      }
      execv(program.c_str(), argv.data());
      _exit(127);
    }
  }
  ~RunningProgram() {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void send(int signal) const { kill(child_, signal); }
  /// The exit code, or minus the signal that ended it.
  int wait() {
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  Finished finish() {
    const int exit_code = wait();
    return {exit_code, out(), err()};
  }
  /// True if the condition holds while the program runs. It looks every 2 ms: spinning would take the program's
  /// processor.
  bool until(const std::function<bool()>& condition, double deadline_s = 60.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(deadline_s);
    while (!condition()) {
      if (waitpid(child_, nullptr, WNOHANG) != 0) {
        child_ = 0;
        return false;
      }
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  std::string out() const { return text_of(out_); }
  std::string err() const { return text_of(err_); }
  pid_t id() const { return child_; }

 private:
  std::filesystem::path out_, err_;
  pid_t child_ = 0;
};

/// "pmg_sil --list" => what it leaves; a shell parts the words.
inline Finished run_in_shell(const std::string& command, const std::filesystem::path& folder) {
  const std::filesystem::path out = folder / "stdout", err = folder / "stderr";
  const std::string line =
      pmg::test::program_folder() + "/" + command + " >" + out.string() + " 2>" + err.string() + " </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err)};
}

}  // namespace pmg::test
