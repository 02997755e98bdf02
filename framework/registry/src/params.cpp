// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters by name, of the type that they are asked for.
#include <fmt/format.h>

#include "cordon/registry/schema.hpp"
#include "type_names.hpp"

namespace cordon {

namespace {

template <class T>
const T& get(const Params& params, std::string_view name) {
  const auto found = params.values().find(name);
  if (found == params.values().end())
    throw Error(Errc::invalid,
                fmt::format("no parameter \"{}\" was given and it has no default", name));
  if (const T* value = std::get_if<T>(&found->second)) return *value;
  throw Error(Errc::invalid, fmt::format("parameter \"{}\" is {}, asked for as {}", name,
                                         registry::type_names[found->second.index()],
                                         registry::type_names[Params::Value(T{}).index()]));
}

}  // namespace

Params& Params::set(std::string name, Value value) {
  values_.insert_or_assign(std::move(name), std::move(value));
  return *this;
}

bool Params::has(std::string_view name) const { return values_.find(name) != values_.end(); }

std::int64_t Params::integer(std::string_view name) const { return get<std::int64_t>(*this, name); }
double Params::real(std::string_view name) const { return get<double>(*this, name); }
bool Params::flag(std::string_view name) const { return get<bool>(*this, name); }
const std::string& Params::text(std::string_view name) const {
  return get<std::string>(*this, name);
}
const Vector& Params::vector(std::string_view name) const { return get<Vector>(*this, name); }
const Matrix& Params::matrix(std::string_view name) const { return get<Matrix>(*this, name); }
const LineForm& Params::set_form(std::string_view name) const { return get<LineForm>(*this, name); }
const std::vector<Matrix>& Params::matrices(std::string_view name) const {
  return get<std::vector<Matrix>>(*this, name);
}
const ComponentSpec& Params::component(std::string_view name) const {
  return *get<std::shared_ptr<const ComponentSpec>>(*this, name);
}

}  // namespace cordon
