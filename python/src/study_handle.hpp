// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cordon/study/study.hpp"

namespace cordon::python {

/// A study that was read, shared by what is made of it.
using StudyHandle = std::shared_ptr<const Study>;

}  // namespace cordon::python
