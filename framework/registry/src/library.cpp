// SPDX-License-Identifier: GPL-3.0-or-later
#include "library.hpp"

#include <dlfcn.h>
#include <link.h>

#include <boost/dll/shared_library.hpp>

namespace cordon::registry {

class Library {
 public:
  explicit Library(boost::dll::shared_library&& handle) : handle_(std::move(handle)) {}
  const boost::dll::shared_library& handle() const { return handle_; }

 private:
  boost::dll::shared_library handle_;
};

LibraryPtr open_library(const std::filesystem::path& file, std::string& why) {
  ::dlerror();  // forget older messages
  std::error_code error;
  boost::dll::shared_library handle(file, boost::dll::load_mode::rtld_now, error);
  if (!error && handle.is_loaded()) return std::make_shared<const Library>(std::move(handle));
  const char* message = ::dlerror();
  why = message ? message : error.message();
  return nullptr;
}

const void* find_symbol(const Library& library, const char* name) {
  if (!library.handle().has(name)) return nullptr;
  const void* address = &library.handle().get<const unsigned char>(name);
  link_map *owner = nullptr, *own = nullptr;
  Dl_info info{};
  if (!::dladdr1(address, &info, reinterpret_cast<void**>(&owner), RTLD_DL_LINKMAP)) return nullptr;
  if (::dlinfo(library.handle().native(), RTLD_DI_LINKMAP, &own) != 0) return nullptr;
  return owner == own ? address : nullptr;
}

}  // namespace cordon::registry
