#include "program.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <thread>

namespace backlight::test {
namespace {

namespace fs = std::filesystem;

constexpr auto longest_run = std::chrono::minutes(2);

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Waits, and kills a process that hangs.
int wait_for(pid_t child) {
  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() - start > longest_run) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

void redirect(const fs::path& path, int descriptor) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || dup2(file, descriptor) < 0) _exit(127);
  close(file);
}

}  // namespace

void ProgramTest::SetUp() {
  std::string name = (fs::temp_directory_path() / "backlight-cli-XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  folder = name;
  fs::create_directory(folder / "work");
}

void ProgramTest::TearDown() {
  std::error_code ignored;
  fs::permissions(folder / "work", fs::perms::owner_all, ignored);
  fs::remove_all(folder, ignored);
}

Outcome ProgramTest::run(const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment) {
  const auto before = in_child;
  in_child = [&] {
    for (const std::string& variable : environment) putenv(const_cast<char*>(variable.c_str()));
    if (before) before();
  };
  const Outcome outcome = run_and(arguments, [](int) {});
  in_child = before;
  return outcome;
}

int ProgramTest::start(const std::vector<std::string>& arguments, const std::string& label) {
  std::vector<char*> argv{const_cast<char*>(BACKLIGHT_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const fs::path out = folder / (label + ".stdout");
  const fs::path err = folder / (label + ".stderr");
  const pid_t child = fork();
  if (child == 0) {
    redirect("/dev/null", STDIN_FILENO);
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    for (const char* name : {"NO_COLOR", "SOURCE_DATE_EPOCH", "SLURM_CPUS_PER_TASK"}) unsetenv(name);
    if (chdir((folder / "work").c_str()) != 0) _exit(127);
    if (in_child) in_child();
    execv(argv[0], argv.data());
    _exit(127);
  }
  return child;
}

Outcome ProgramTest::finish(int process, const std::string& label) {
  Outcome outcome;
  outcome.code = wait_for(process);
  outcome.out = contents(folder / (label + ".stdout"));
  outcome.err = contents(folder / (label + ".stderr"));
  return outcome;
}

Outcome ProgramTest::run_and(const std::vector<std::string>& arguments,
                             const std::function<void(int)>& while_running) {
  const auto began = std::chrono::steady_clock::now();
  const int child = start(arguments, "run");
  while_running(child);
  Outcome outcome = finish(child, "run");
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return outcome;
}

void ProgramTest::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder / "work" / name, std::ios::binary) << text;
}

void ProgramTest::write_scene(const std::string& name, const std::string& more) const {
  write(name,
        "[film]\nresolution = [32, 20]\n"
        "[camera]\nposition = [0, 0, -5]\nlook_at = [0, 0, 0]\n"
        "[[light]]\ntype = \"distant\"\ndirection = [1, -1, 1]\nirradiance = 3\n"
        "[[object]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\nmaterial = { color = [0.8, 0.4, 0.2] "
        "}\n" +
            more);
}

std::string ProgramTest::read(const std::string& name) const {
  return contents(folder / "work" / name);
}

bool ProgramTest::exists(const std::string& name) const {
  return fs::exists(folder / "work" / name);
}

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "work")) {
    if (!entry.is_directory()) names.push_back(fs::relative(entry.path(), folder / "work").string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace backlight::test
