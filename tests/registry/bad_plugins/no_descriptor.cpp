// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace.hpp"

extern "C" int cordon_test_some_function() { return 1; }
