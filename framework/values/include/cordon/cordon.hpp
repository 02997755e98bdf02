// SPDX-License-Identifier: GPL-3.0-or-later
// What programs that embed Cordon need: sets as values, models, and the registry that makes
// observers, diagnosers and designers. Studies are in cordon/study/, which link cordon::study.
#pragma once

#include "cordon/interfaces/diagnoser.hpp"
#include "cordon/interfaces/input_designer.hpp"
#include "cordon/interfaces/observer.hpp"
#include "cordon/registry/registry.hpp"
#include "cordon/values/convex_set.hpp"
