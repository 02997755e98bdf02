// SPDX-License-Identifier: GPL-3.0-or-later
// The components that are known, by kind and name, and the registrar that adds them all or none.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cordon/registry/plugin.hpp"

namespace cordon::registry {

template <class Entry>
struct Provided {
  Entry entry;
  std::string plugin;  ///< "" for components of the host
};
template <class Entry>
using Shelf = std::map<std::string, Provided<Entry>, std::less<>>;

/// Entries hold code of their plugins: a catalogue dies before the libraries are closed.
struct Catalogue {
  Shelf<BackendEntry> backends;
  Shelf<ObserverEntry> observers;
  Shelf<MetricEntry> metrics;
  Shelf<DiagnoserEntry> diagnosers;
  Shelf<PlantEntry> plants;
  Shelf<GainEntry> gains;
  Shelf<DesignerEntry> designers;

  void remove(std::string_view plugin);
};

/// Collects what one plugin registers. Nothing reaches the catalogue before `commit`, so rolling
/// back is dropping the batch.
class Batch final : public Registrar {
 public:
  Batch(const Catalogue& known, std::string plugin) : known_(known), plugin_(std::move(plugin)) {}

  void backend(BackendEntry entry) override;
  void observer(ObserverEntry entry) override;
  void metric(MetricEntry entry) override;
  void diagnoser(DiagnoserEntry entry) override;
  void plant(PlantEntry entry) override;
  void gain(GainEntry entry) override;
  void designer(DesignerEntry entry) override;

  const std::vector<std::string>& problems() const {
    return problems_;
  }  ///< broken rules; none: may be committed
  const std::vector<std::string>& components() const {
    return components_;
  }  ///< "backend zonotope", …
  /// Components whose names somebody else has, with the reason: they are no part of what is
  /// committed.
  const std::vector<std::string>& left_out() const { return left_out_; }
  void commit(Catalogue& catalogue);

 private:
  template <class Entry>
  void add(Shelf<Entry>& mine, const Shelf<Entry>& known, const std::string& kind, Entry entry);

  const Catalogue& known_;
  std::string plugin_;
  Catalogue mine_;
  std::vector<std::string> problems_, components_, left_out_;
};

}  // namespace cordon::registry
