// Showing a page: a place for it that nobody else has, and the user's browser.
#pragma once

#include <string>

namespace insym::app {

/// A path for a page about `input` in a new folder among the temporary files, which stays.
/// Throws Error(cannot_write).
std::string temporary_page(const std::string& input);

/// Opens `path` in the user's browser without waiting for it; false where there is none.
bool open_in_browser(const std::string& path);

}  // namespace insym::app
