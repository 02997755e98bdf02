/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For MATLAB's loadlibrary, which wants every type defined: handles are pointers to void. */
#define CORDON_PLAIN_HANDLES
#include "cordon.h"
