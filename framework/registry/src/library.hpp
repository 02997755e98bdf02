// SPDX-License-Identifier: GPL-3.0-or-later
// An open shared library. The one place that knows Boost.DLL is library.cpp.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace cordon::registry {

/// Closed when the last pointer to it goes; whoever holds code or objects of a plugin holds one.
class Library;
using LibraryPtr = std::shared_ptr<const Library>;

/// Opens a library with all its symbols resolved. `file` is absolute: nothing is searched. Null,
/// and the loader's words in `why`, if the loader refuses. The library's static constructors run
/// here; one that throws ends the process, since exceptions do not pass the loader (trial.hpp).
LibraryPtr open_library(const std::filesystem::path& file, std::string& why);

/// Address of a symbol defined in this very library (not in one it depends on), or null.
const void* find_symbol(const Library& library, const char* name);

}  // namespace cordon::registry
