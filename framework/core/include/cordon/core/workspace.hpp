// SPDX-License-Identifier: GPL-3.0-or-later
// Memory that kernels use again in their next call in the same thread.
#pragma once

#include <cstddef>
#include <vector>

#include "cordon/core/types.hpp"

namespace cordon {

/// Matrices between two calls of a kernel; their entries mean nothing. They belong to the
/// framework's library: a thread_local object of a plugin would keep the plugin mapped for as long
/// as the thread lives.
struct Workspace {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<Matrix> matrices;
  std::vector<Rows> rows;
  std::vector<Vector> vectors;
  std::vector<std::vector<Index>> numbers;
};

enum class WorkspaceOf { constraint_elimination, generator_reduction };
/// Of the calling thread; as large as the largest set that it worked on.
Workspace& workspace(WorkspaceOf kernel);

/// Swaps the members of an object with what is kept for them, each type in the order of the calls.
class WorkspaceExchange {
 public:
  explicit WorkspaceExchange(Workspace& memory) : memory_(memory) {}

  template <class... Members>
  void swap(Members&... members) {
    (one(members), ...);
  }

 private:
  void one(Matrix& member) { exchange(member, memory_.matrices, matrices_); }
  void one(Workspace::Rows& member) { exchange(member, memory_.rows, rows_); }
  void one(Vector& member) { exchange(member, memory_.vectors, vectors_); }
  void one(std::vector<Index>& member) { exchange(member, memory_.numbers, numbers_); }

  template <class Member>
  static void exchange(Member& member, std::vector<Member>& kept, std::size_t& place) {
    if (place == kept.size()) kept.emplace_back();
    member.swap(kept[place++]);
  }

  Workspace& memory_;
  std::size_t matrices_ = 0, rows_ = 0, vectors_ = 0, numbers_ = 0;
};

/// A kernel's object, with void exchange(WorkspaceExchange&), for one call: it has the memory of
/// the last one, and leaves it to the next. One within another has memory of its own.
template <class Object>
class WithWorkspace {
 public:
  explicit WithWorkspace(WorkspaceOf kernel) : memory_(workspace(kernel)) { exchange(); }
  ~WithWorkspace() { exchange(); }
  WithWorkspace(const WithWorkspace&) = delete;
  WithWorkspace& operator=(const WithWorkspace&) = delete;

  Object& operator*() { return object_; }
  Object* operator->() { return &object_; }

 private:
  void exchange() {
    WorkspaceExchange exchange(memory_);
    object_.exchange(exchange);
  }

  Workspace& memory_;
  Object object_;
};

}  // namespace cordon
