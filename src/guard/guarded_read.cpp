#include "insym/guarded_read.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "guard/wire.hpp"

namespace insym {
namespace {

using Clock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitMemory = false;  // their shadow takes terabytes of addresses
#else
constexpr bool kLimitMemory = true;
#endif

constexpr int kOutOfMemory = 77;  ///< exit status of a child that could not even say so

[[noreturn]] void fail(const std::string& name, const std::string& why) {
    throw Error(ErrorCode::cannot_read, name + ": " + why);
}

std::string number_text(double value) {
    std::array<char, 32> buffer{};
    const auto [end, error] =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 4);
    return error == std::errc() ? std::string(buffer.data(), end) : "?";
}

// The child -----------------------------------------------------------------------------------

/// Address space in use, which the limit comes on top of.
std::size_t used_bytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t pages = 0;
    file >> pages;
    return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void set_limit(__rlimit_resource resource, rlim_t value) {
    rlimit limit{};
    getrlimit(resource, &limit);
    limit.rlim_cur = std::min(value, limit.rlim_max);
    setrlimit(resource, &limit);
}

void confine(const ReadLimits& limits) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a child without its parent has nobody to stop it
    set_limit(RLIMIT_CORE, 0);
    if (kLimitMemory) set_limit(RLIMIT_AS, used_bytes() + limits.memory_bytes);
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    if (kLimitMemory) dup2(nowhere, STDERR_FILENO);  // a sanitizer's findings are for people
}

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) return false;
        if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

/// Has the address space come near its limit? Readers tend to call a file damaged when memory runs out.
bool ran_short_of_memory(std::size_t before, const ReadLimits& limits) {
    constexpr double kNear = 0.8;
    std::ifstream file("/proc/self/status");
    std::size_t peak_kib = 0;
    for (std::string word; file >> word;)
        if (word == "VmPeak:" && file >> peak_kib) break;
    return kLimitMemory && static_cast<double>(peak_kib) * 1024 >
                               static_cast<double>(before) + kNear * static_cast<double>(limits.memory_bytes);
}

Outcome outcome_of(const std::string& name, const std::function<Input()>& read) {
    try {
        return read();
    } catch (const Error& error) {
        return error;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        return Error(ErrorCode::cannot_read, name + ": reading failed: " + failure.what());
    } catch (...) {
        return Error(ErrorCode::cannot_read, name + ": reading failed for an unknown reason");
    }
}

[[noreturn]] void run_child(int descriptor, const std::string& name, const std::function<Input()>& read,
                            const ReadLimits& limits) {
    int status = 1;
    try {
        const std::size_t before = used_bytes();
        confine(limits);
        const Outcome outcome = outcome_of(name, read);
        const Error* error = std::get_if<Error>(&outcome);
        if (error != nullptr && error->code() == ErrorCode::cannot_read &&
            ran_short_of_memory(before, limits))
            throw std::bad_alloc();
        status = write_all(descriptor, to_bytes(outcome)) ? 0 : 1;
    } catch (const std::bad_alloc&) {
        status = kOutOfMemory;
    } catch (...) {
    }
    _exit(status);
}

// The parent ----------------------------------------------------------------------------------

/// The child process; killed, if it still runs, and gone when this is.
class Child {
public:
    explicit Child(pid_t id) : id_(id) {}
    ~Child() {
        if (id_ <= 0) return;
        kill(id_, SIGKILL);
        wait();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Its status as of waitpid().
    int wait() {
        int status = 0;
        while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
        }
        id_ = 0;
        return status;
    }

private:
    pid_t id_;
};

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { reset(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return number_; }
    void reset() {
        if (number_ >= 0) close(std::exchange(number_, -1));
    }

private:
    int number_;
};

/// All bytes up to the end of the pipe; none if the deadline came first.
std::optional<std::string> read_until(int descriptor, Clock::time_point deadline) {
    std::string bytes;
    std::array<char, std::size_t{1} << 16> buffer{};
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0) return std::nullopt;
        constexpr std::int64_t kLongest = 3600000;
        pollfd wait{descriptor, POLLIN, 0};
        if (poll(&wait, 1, static_cast<int>(std::min<std::int64_t>(left, kLongest))) <= 0) continue;
        const ssize_t size = ::read(descriptor, buffer.data(), buffer.size());
        if (size == 0) return bytes;
        if (size > 0) bytes.append(buffer.data(), static_cast<std::size_t>(size));
        if (size < 0 && errno != EINTR) return bytes;
    }
}

std::string memory_text(const ReadLimits& limits) {
    return "reading it needs more memory than the import limit of " +
           number_text(static_cast<double>(limits.memory_bytes) / (std::size_t{1} << 20)) + " MiB";
}

/// Why a child ended without a result.
std::string death_of(int status, const ReadLimits& limits) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory) return memory_text(limits);
    if (WIFSIGNALED(status))
        return std::string("the reader crashed on it (") + strsignal(WTERMSIG(status)) +
               "); it is damaged or too large";
    return "the reader ended without a result; it is damaged or too large";
}

void check_limits(const ReadLimits& limits) {
    if (limits.memory_bytes == 0)
        throw Error(ErrorCode::invalid_option, "import memory limit: must be above 0");
    if (!(limits.time_s > 0)) throw Error(ErrorCode::invalid_option, "import time limit: must be above 0");
}

}  // namespace

Input read_guarded(const std::string& name, const std::function<Input()>& read, const ReadLimits& limits) {
    check_limits(limits);
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) fail(name, "no pipe can be made to read it through");
    Descriptor from(ends[0]), to(ends[1]);
    const auto start = Clock::now();
    const pid_t id = fork();
    if (id < 0) fail(name, "no process can be made to read it");
    if (id == 0) run_child(to.get(), name, read, limits);
    to.reset();
    Child child(id);

    constexpr double kForever = 1e9;  // more would overflow the clock
    const std::chrono::duration<double> time(std::min(limits.time_s, kForever));
    const auto bytes = read_until(from.get(), start + std::chrono::duration_cast<Clock::duration>(time));
    if (!bytes)
        fail(name, "reading it took longer than the import limit of " + number_text(limits.time_s) + " s");
    const int status = child.wait();
    std::optional<Outcome> outcome = from_bytes(*bytes);
    if (!outcome) fail(name, death_of(status, limits));
    if (const Error* error = std::get_if<Error>(&*outcome)) throw Error(*error);
    return std::get<Input>(std::move(*outcome));
}

}  // namespace insym
