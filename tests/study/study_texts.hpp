// SPDX-License-Identifier: GPL-3.0-or-later
// Studies of the fake components, in which the tests exchange pieces.
#pragma once

namespace study_test {

/// A valid study, one member per line, in which the tests exchange pieces.
extern const char* const valid_study;

/// The same for a study with modes, faults and diagnosers.
extern const char* const diagnosis_study;

/// The same with interval matrices, additive faults and a gain.
extern const char* const uncertain_study;

/// The same with designers, a diagnoser for experiments and an x0 that is drawn from a set.
extern const char* const design_study;

/// The same with a sweep over generators (of two of three pipelines), a bound of W, and seeds.
extern const char* const sweep_study;

}  // namespace study_test
