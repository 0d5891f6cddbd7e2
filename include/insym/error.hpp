// Every failure of the library is an Error: a stable code and one sentence for the user.
#pragma once

#include "insym/export.hpp"

#include <stdexcept>
#include <string>

namespace insym {

/// Stable codes; the command line maps them to its exit statuses.
enum class ErrorCode {
    invalid_option,  ///< an option is out of its range (exit status 2)
    cannot_read,     ///< the input cannot be opened or parsed (exit status 3)
    invalid_input,   ///< the input was read but cannot be used (exit status 4)
    cannot_write,    ///< an output cannot be written (exit status 2)
};

/// what() is one clear sentence that names the option, the file or the line.
class INSYM_EXPORT Error : public std::runtime_error {
public:
    Error(ErrorCode code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
    ErrorCode code() const { return code_; }

private:
    ErrorCode code_;
};

}  // namespace insym
