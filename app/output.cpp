#include "output.hpp"

#include "insym/error.hpp"

#include <cerrno>
#include <filesystem>
#include <streambuf>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "interrupt.hpp"

namespace insym::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& target, int error) {
    const std::string name = target == "-" ? "standard output" : target;
    throw Error(ErrorCode::cannot_write,
                name + ": cannot be written: " + std::generic_category().message(error));
}

/// A buffered stream onto a file descriptor that remembers why a write failed.
class DescriptorBuffer : public std::streambuf {
public:
    explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor), buffer_(std::size_t{1} << 16) {
        setp(buffer_.data(), buffer_.data() + buffer_.size());
    }
    int error() const { return error_; }

protected:
    int_type overflow(int_type c) override {
        if (sync() != 0) return traits_type::eof();
        return traits_type::eq_int_type(c, traits_type::eof()) ? traits_type::not_eof(c)
                                                               : sputc(traits_type::to_char_type(c));
    }

    int sync() override {
        for (const char* at = pbase(); at < pptr() && error_ == 0;) {
            const ssize_t written = ::write(descriptor_, at, static_cast<std::size_t>(pptr() - at));
            if (written >= 0) at += written;
            if (written < 0 && errno != EINTR) error_ = errno;
        }
        setp(buffer_.data(), buffer_.data() + buffer_.size());
        return error_ == 0 ? 0 : -1;
    }

private:
    int descriptor_;
    int error_ = 0;
    std::vector<char> buffer_;
};

/// Writes everything; returns the error number, 0 if all is well.
int write_all(int descriptor, const Writer& write) {
    DescriptorBuffer buffer(descriptor);
    std::ostream stream(&buffer);
    write(stream);
    stream.flush();
    return buffer.error();
}

/// A file under a name of its own beside `target`; gone again unless it is renamed.
class TemporaryFile {
public:
    explicit TemporaryFile(const fs::path& target) {
        const std::string start = (target.parent_path() / (".insym-" + std::to_string(getpid()))).string();
        for (int i = 0; descriptor_ < 0 && i < 100; ++i) {
            path_ = start + "-" + std::to_string(i) + ".tmp";
            descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (descriptor_ < 0 && errno != EEXIST) break;
        }
        if (const int error = errno; descriptor_ < 0) fail(target.string(), error);
        remove_on_interrupt(path_.c_str());
    }
    ~TemporaryFile() {
        if (descriptor_ >= 0) close(descriptor_);
        if (!path_.empty()) unlink(path_.c_str());
        remove_on_interrupt(nullptr);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    int descriptor() const { return descriptor_; }

    /// Puts the whole file in the place of `target`; returns the error number, 0 if all is well.
    int rename_to(const fs::path& target) {
        struct stat old {};
        if (stat(target.c_str(), &old) == 0) fchmod(descriptor_, old.st_mode & 07777U);
        if (close(std::exchange(descriptor_, -1)) != 0) return errno;  // delayed write errors (NFS, quotas)
        if (rename(path_.c_str(), target.c_str()) != 0) return errno;
        path_.clear();
        return 0;
    }

private:
    std::string path_;
    int descriptor_ = -1;
};

bool exists(const std::string& target) {
    std::error_code ignored;
    return fs::exists(target, ignored);
}

/// Pipes, terminals and devices: nothing that could be replaced.
bool is_direct(const std::string& target) {
    std::error_code ignored;
    return exists(target) && !fs::is_regular_file(target, ignored);
}

/// The file behind symbolic links, so that a link stays a link.
fs::path real_path(const std::string& target) {
    std::error_code error;
    const fs::path real = fs::canonical(target, error);
    return error ? fs::path(target) : real;
}

}  // namespace

void check_output(const std::string& target) {
    if (target == "-") {
        const int flags = fcntl(STDOUT_FILENO, F_GETFL);
        if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) fail(target, EBADF);
        return;
    }
    std::error_code ignored;
    if (fs::is_directory(target, ignored)) fail(target, EISDIR);
    if (exists(target) && access(target.c_str(), W_OK) != 0) fail(target, errno);
    if (!is_direct(target)) const TemporaryFile probe(real_path(target));
}

void write_output(const std::string& target, const Writer& write) {
    int error = 0;
    if (target == "-") {
        error = write_all(STDOUT_FILENO, write);
    } else if (is_direct(target)) {
        const int descriptor = open(target.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor < 0) fail(target, errno);
        error = write_all(descriptor, write);
        if (close(descriptor) != 0 && error == 0) error = errno;
    } else {
        const fs::path real = real_path(target);
        TemporaryFile file(real);
        error = write_all(file.descriptor(), write);
        if (error == 0) error = file.rename_to(real);
    }
    if (error != 0 && error != EPIPE) fail(target, error);
}

}  // namespace insym::app
