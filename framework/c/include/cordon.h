/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cordon beside a plant: a session takes samples one by one and answers each with proven bounds of
 * the state or with the modes that are left, and keeps alarms. For C, and for whatever calls C
 * (docs/c_api.md).
 *
 * Numbers. Functions that do something return a code, CORDON_OK or why not. Functions that tell a
 * number return CORDON_NONE where there is none, and CORDON_REFUSED where they were asked wrongly;
 * functions that tell a text return "" then. Indices count from 0. NULL, indices out of range and
 * wrong sizes are refused, and no exception leaves the library.
 *
 * Lifetimes. A text belongs to the session, and lives until the next call that changes it: step,
 * take, acknowledge, reset, restore, close. Names and warnings live as long as the session.
 *
 * Threads. Several threads may work at the same time, each with sessions of its own; one session is
 * for one thread at a time. The last error is that of the calling thread.
 *
 * Arithmetic. Calls work with the default floating-point environment, and put that of the caller
 * back: results do not depend on rounding modes, traps or flushed subnormal numbers of the program.
 */
#ifndef CORDON_H
#define CORDON_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Functions and numbers are only ever added under the same version. */
#define CORDON_C_ABI_VERSION 1

enum cordon_code {
  CORDON_OK = 0,
  CORDON_DIMENSION = 1,    /* sizes do not fit together */
  CORDON_NOT_FINITE = 2,   /* NaN or infinity where a number is needed */
  CORDON_INVALID = 3,      /* a value outside its domain, a study with errors, damaged bytes */
  CORDON_UNSUPPORTED = 4,  /* a component does not offer it */
  CORDON_NOT_ENCLOSED = 5, /* values of formulas have no bounded enclosure */
  CORDON_SOLVER = 6,       /* a solver left no sound answer */
  CORDON_TIME_LIMIT = 7,   /* a limit of time was reached */
  CORDON_PLUGIN = 8,       /* a plugin was refused or broke its contract; a session has ended */
  CORDON_IO = 9,           /* reading or writing failed */
  CORDON_VIOLATED = 10,    /* a component said something that is proven false */
  CORDON_INTERNAL = 11,    /* a defect of Cordon */
  CORDON_NO_MEMORY = 12,   /* there is not enough memory */
  CORDON_NULL = 13         /* a pointer is NULL that must not be */
};

enum { CORDON_NONE = -1, CORDON_REFUSED = -2 };

enum cordon_answer { CORDON_NO = 0, CORDON_YES = 1, CORDON_UNKNOWN = 2 };

enum cordon_decision {
  CORDON_MONITORING = 0, /* the plant is in the mode: assumed at the start, or the only one left */
  CORDON_ISOLATING = 1,  /* that mode is excluded, several are possible */
  CORDON_AMBIGUOUS = 2,  /* several are still possible after the waiting time */
  CORDON_UNKNOWN_FAULT = 3 /* every mode of the bank is excluded */
};

enum cordon_how {
  CORDON_TAKEN = 0,     /* it was the next sample */
  CORDON_FILLED = 1,    /* the times before it were taken without outputs */
  CORDON_CORRECTED = 2, /* an earlier time was taken again, and all that followed */
  CORDON_LATE = 3,      /* outputs of an earlier time were left out */
  CORDON_REPEATED = 4   /* it brought nothing that was not known */
};

enum cordon_cause {
  CORDON_CONTRADICTION = 0, /* no state explains the samples */
  CORDON_OUTLIER = 1,       /* outputs missed the prediction, and were left out */
  CORDON_FAULT = 2          /* the nominal mode is excluded */
};

enum cordon_change {
  CORDON_RAISED = 0,       /* it stands from now on */
  CORDON_AGAIN = 1,        /* its cause has come again */
  CORDON_SPECIFIED = 2,    /* more is known of it: its text is another */
  CORDON_PASSED = 3,       /* its cause is gone; it stands until it is acknowledged */
  CORDON_ACKNOWLEDGED = 4, /* somebody has taken note; it stands while its cause lasts */
  CORDON_GONE = 5          /* it stands no longer */
};

#ifdef CORDON_PLAIN_HANDLES /* for readers of headers that want every type defined */
typedef void cordon_session;
#else
typedef struct cordon_session cordon_session;
#endif

/* ---- the library ---- */

/* Of the library that was loaded; a program compares it with CORDON_C_ABI_VERSION. */
int cordon_abi_version(void);
/* "0.1.0" */
const char* cordon_version(void);

/* ---- the last call of this thread that was refused; calls that succeed leave it ---- */

int cordon_last_code(void);
/* What, where, why and what to do: "cordon_step: sample 3 has …". "": no call was refused yet. */
const char* cordon_last_error(void);
/* All problems of a study, each with its place as a JSON pointer, "" for the whole of it, and its
 * line, 0 where that is not known. */
int cordon_problem_count(void);
const char* cordon_problem_place(int i);
int cordon_problem_line(int i);
const char* cordon_problem_message(int i);
const char* cordon_problem_suggestion(int i);

/* ---- sessions ---- */

/* A session with a pipeline of a study. `pipeline` may be NULL or "" where the study has one only.
 * `plugins`: directories that are searched first, with ":" between them, or NULL; then those of
 * CORDON_PLUGIN_PATH and those that Cordon was installed with. Plugins are programs: directories
 * that a study names are refused unless they are among these. Returns NULL where it is refused. */
cordon_session* cordon_open(const char* study_file, const char* pipeline, const char* plugins);
/* The same of a study that is a text. `folder` is where files are looked for that it names, or
 * NULL: the working directory. */
cordon_session* cordon_open_text(const char* study_text, const char* folder, const char* pipeline,
                                 const char* plugins);
/* NULL is left alone. */
void cordon_close(cordon_session* session);

/* What is not wrong with the study, but should be known, as a plugin that was refused. */
int cordon_warning_count(const cordon_session* session);
const char* cordon_warning(const cordon_session* session, int i);

int cordon_states(const cordon_session* session);
int cordon_inputs(const cordon_session* session);
int cordon_outputs(const cordon_session* session);
/* Of a pipeline with a diagnoser, the nominal mode first; 0: it has an observer. */
int cordon_modes(const cordon_session* session);

const char* cordon_pipeline_name(const cordon_session* session);
const char* cordon_state_name(const cordon_session* session, int i);
const char* cordon_input_name(const cordon_session* session, int i);
const char* cordon_output_name(const cordon_session* session, int i);
const char* cordon_mode_name(const cordon_session* session, int i);

/* ---- samples ---- */

/* Takes the sample of the next time; the first one is that of time 0. `n_u` and `n_y` are the
 * numbers of entries, those of the model. NaN in y: the output is missing.
 *
 * A sample that does not fit is refused, and nothing has happened: CORDON_NULL, CORDON_DIMENSION,
 * CORDON_NOT_FINITE, CORDON_INVALID. Errors of components end the session, as cordon_has_ended
 * tells: it takes no samples until it is reset or restored. Refused calls leave no results. */
int cordon_step(cordon_session* session, const double* u, int n_u, const double* y, int n_y);
/* The sample of time k ≥ 0, by the study's rules ("online") for samples that do not come one after
 * another: none, one or several results come out. The first one is of any time. */
int cordon_take(cordon_session* session, int64_t k, const double* u, int n_u, const double* y,
                int n_y);
/* The same of a sample that was taken at t seconds on the plant's clock. With a k of CORDON_NONE,
 * in studies with a "sampling_time", k is told by how long after the last one that was: what misses
 * a whole number of sampling times is refused (CORDON_INVALID). With a k the clock is set. */
int cordon_take_at(cordon_session* session, int64_t k, double t, const double* u, int n_u,
                   const double* y, int n_y);
/* What became of the last sample, a cordon_how; CORDON_NONE: there was none. */
int cordon_take_how(const cordon_session* session);
/* The rule that was followed, in words; "" for CORDON_TAKEN. */
const char* cordon_take_said(const cordon_session* session);

/* Time of the last sample, or CORDON_NONE. */
int64_t cordon_last_k(const cordon_session* session);
/* 1: a step has ended with an error of a component, or of memory; else 0. */
int cordon_has_ended(const cordon_session* session);
/* Begins anew, at any time. Alarms stay until they are acknowledged; their causes are gone, which
 * the changes tell. */
int cordon_reset(cordon_session* session);

/* ---- results of the last step or take, in the order of times ---- */

int cordon_result_count(const cordon_session* session);
/* Time of the sample. */
int64_t cordon_result_k(const cordon_session* session, int result);

/* Time of which the bounds are: of observers that lag an earlier one. CORDON_NONE: there are no
 * bounds, as while an observer that lags waits, and while no single mode is left. */
int64_t cordon_result_bounds_k(cordon_session* session, int result);
/* Bounds of each state; n is the length of both arrays, the number of states. They are infinite
 * where nothing is known, and lower > upper in every entry where the set is proven empty. Of a
 * diagnoser they hold in the mode that is monitored. */
int cordon_result_bounds(cordon_session* session, int result, double* lower, double* upper, int n);
/* Of an observer, a cordon_answer: CORDON_NO is the proof that no state explains the samples. */
int cordon_result_consistent(const cordon_session* session, int result);

/* 1: the observer has begun anew with this sample, as the pipeline wants it after an empty estimate
 * or where formulas had no bounded enclosure; else 0. */
int cordon_result_restarted(const cordon_session* session, int result);

/* 1: limits of work have left questions open, so that bounds may be wider and modes stay; else 0.
 */
int cordon_result_left_open(const cordon_session* session, int result);

/* Of a diagnoser: a cordon_decision; the mode that is monitored; and for each mode 1, or 0 for
 * those that are excluded, or not looked at as long as the monitored mode stands. */
int cordon_result_decision(const cordon_session* session, int result);
int cordon_result_mode(const cordon_session* session, int result);
int cordon_result_candidates(const cordon_session* session, int result, int* candidates, int n);

/* The whole step as JSON: the line of `cordon stream` without its alarms (docs/online.md). */
const char* cordon_result_json(cordon_session* session, int result);

/* What the step has changed in a diagnoser's decisions: what ("detected", "isolated", …), of which
 * mode, and all of it as JSON. */
int cordon_event_count(const cordon_session* session, int result);
const char* cordon_event_what(const cordon_session* session, int result, int event);
int cordon_event_mode(const cordon_session* session, int result, int event);
const char* cordon_event_json(cordon_session* session, int result, int event);

/* ---- alarms ---- */

/* What the last step, take or acknowledge has changed: a cordon_change, a cordon_cause, the time of
 * the sample, what the alarm says now, and all of it with its proof as JSON. */
int cordon_change_count(const cordon_session* session);
int cordon_change_what(const cordon_session* session, int change);
int cordon_change_cause(const cordon_session* session, int change);
int64_t cordon_change_k(const cordon_session* session, int change);
const char* cordon_change_text(const cordon_session* session, int change);
const char* cordon_change_json(cordon_session* session, int change);

/* The alarms that stand; of each cause one at most. */
int cordon_alarm_count(const cordon_session* session);
int cordon_alarm_cause(const cordon_session* session, int alarm);
int64_t cordon_alarm_raised_at(const cordon_session* session, int alarm);
int cordon_alarm_is_active(const cordon_session* session, int alarm);
int cordon_alarm_is_acknowledged(const cordon_session* session, int alarm);
const char* cordon_alarm_text(const cordon_session* session, int alarm);
/* Somebody has taken note of all that stand. */
int cordon_acknowledge(cordon_session* session);

/* ---- state ---- */

/* All that later steps depend on, with the alarms that stand. `size` receives the number of bytes;
 * a buffer of NULL asks for it only, and one that is shorter is CORDON_DIMENSION and left as it is.
 * CORDON_UNSUPPORTED: the components do not offer it. */
int cordon_save(cordon_session* session, void* buffer, size_t capacity, size_t* size);
/* Goes on from what a session of the same pipeline and version has saved, bit by bit. Damaged bytes
 * are CORDON_INVALID, and nothing has changed; where they are those of another pipeline or version,
 * the session has begun anew. */
int cordon_restore(cordon_session* session, const void* buffer, size_t size);

#ifdef __cplusplus
}
#endif

#endif
