// SPDX-License-Identifier: GPL-3.0-or-later
// The components that are known, by kind and name, and the registrar that adds them all or none.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "cordon/registry/registry.hpp"

namespace cordon::registry {

using Provided = ProvidedComponent;
using Shelf = std::map<std::string, Provided, std::less<>>;

/// Entries hold code of their plugins: a catalogue dies before the libraries are closed.
class Catalogue {
 public:
  static const std::vector<std::string>& kinds();

  Shelf& shelf(const ComponentEntry& entry) { return shelves_[entry.index()]; }
  const Shelf& shelf(const ComponentEntry& entry) const { return shelves_[entry.index()]; }
  const Shelf* shelf(std::string_view kind) const;  ///< null: no such kind
  const Provided* find(std::string_view kind, std::string_view name) const;

  const std::array<Shelf, std::variant_size_v<ComponentEntry>>& shelves() const { return shelves_; }

  void take(Catalogue&& other);
  void remove(std::string_view plugin);

 private:
  std::array<Shelf, std::variant_size_v<ComponentEntry>> shelves_;  ///< as in the list of kinds
};

/// Collects what one plugin registers. Nothing reaches the catalogue before `commit`, so rolling
/// back is dropping the batch.
class Batch final : public Registrar {
 public:
  Batch(const Catalogue& known, std::string plugin) : known_(known), plugin_(std::move(plugin)) {}

  void add(ComponentEntry entry) override;

  const std::vector<std::string>& problems() const {
    return problems_;
  }  ///< broken rules; none: may be committed
  const std::vector<std::string>& components() const {
    return components_;
  }  ///< "backend zonotope", …
  /// Components whose names somebody else has, with the reason: they are no part of what is
  /// committed.
  const std::vector<std::string>& left_out() const { return left_out_; }
  /// Copies what was registered: a process in which a text is damaged ends here, not where somebody
  /// lists it.
  void read_all() const noexcept;
  void commit(Catalogue& catalogue) { catalogue.take(std::move(mine_)); }

 private:
  const Catalogue& known_;
  std::string plugin_;
  Catalogue mine_;
  std::vector<std::string> problems_, components_, left_out_;
};

}  // namespace cordon::registry
