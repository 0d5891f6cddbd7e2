#include "browser.hpp"

#include "insym/error.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace insym::app {
namespace {

namespace fs = std::filesystem;

/// Desktops have it; it finds the browser and, as a rule, ends at once.
constexpr const char* kOpener = "xdg-open";

[[noreturn]] void run_opener(const std::string& path) {
    setsid();  // Ctrl-C in the terminal is not for the browser
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, standard);
    execlp(kOpener, kOpener, path.c_str(), static_cast<char*>(nullptr));
    _exit(127);
}

}  // namespace

std::string temporary_page(const std::string& input) {
    std::error_code error;
    fs::path folder = fs::temp_directory_path(error);
    if (error) folder = "/tmp";
    std::string name = (folder / "insym-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
        throw Error(ErrorCode::cannot_write,
                    name + ": cannot be made: " + std::generic_category().message(errno));
    const std::string stem = input == "-" ? "points" : fs::path(input).stem().string();
    return (fs::path(name) / (stem + ".html")).string();
}

bool open_in_browser(const std::string& path) {
    const pid_t id = fork();
    if (id < 0) return false;
    if (id == 0) run_opener(path);
    // Some openers stay as long as the browser does: one that has not failed soon has not failed.
    constexpr auto kSoon = std::chrono::seconds(2);
    const auto end = std::chrono::steady_clock::now() + kSoon;
    while (std::chrono::steady_clock::now() < end) {
        int status = 0;
        if (waitpid(id, &status, WNOHANG) == id) return WIFEXITED(status) && WEXITSTATUS(status) == 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
}

}  // namespace insym::app
