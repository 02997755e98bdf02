// SPDX-License-Identifier: GPL-3.0-or-later
// Holds no tests: the precompiled header of all test programs belongs to this one.
