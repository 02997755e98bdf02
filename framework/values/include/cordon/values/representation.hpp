// SPDX-License-Identifier: GPL-3.0-or-later
// The components that are installed with the library, for programs that compose no registry.
#pragma once

#include <memory>
#include <string_view>

#include "cordon/interfaces/backend.hpp"
#include "cordon/registry/registry.hpp"

namespace cordon {

/// One registry for the whole process, with the plugins of `default_search_path()`: loaded at the
/// first call, by one thread, never unloaded. Add and load while no other thread uses it.
Registry& installed_components();

/// The backend of that name with these parameters ("zonotope", {"rounding": "outward"}): those of
/// `cordon info backend NAME`. One object per name where no parameters are given. Throws as
/// `Registry::make` does: Errc::invalid with a suggestion for a name that there is none of.
std::shared_ptr<const SetBackend> representation(std::string_view name, const Params& params = {});

}  // namespace cordon
