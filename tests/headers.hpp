// SPDX-License-Identifier: GPL-3.0-or-later
// What nearly all tests include: precompiled for all test programs.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "cordon/interfaces/model.hpp"
#include "cordon/registry/registry.hpp"
