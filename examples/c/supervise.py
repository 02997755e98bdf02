# SPDX-License-Identifier: GPL-3.0-or-later
"""A tank that begins to leak, supervised through ctypes: supervise.py [tank.json]

Nothing but Python is needed. CORDON_C_LIBRARY is the library, where the system does not find it.
"""
import ctypes
import math
import os
import sys
from ctypes import byref, c_char_p, c_double, c_int, c_int64, c_void_p

cordon = ctypes.CDLL(os.environ.get("CORDON_C_LIBRARY", "libcordon_c.so.1"))
# ctypes takes results and numbers for int where nothing else is said
numbers = ctypes.POINTER(c_double)
for name, result, *arguments in (
    ("cordon_open", c_void_p, c_char_p, c_char_p, c_char_p),
    ("cordon_last_error", c_char_p),
    ("cordon_step", c_int, c_void_p, numbers, c_int, numbers, c_int),
    ("cordon_change_count", c_int, c_void_p),
    ("cordon_change_text", c_char_p, c_void_p, c_int),
    ("cordon_result_bounds", c_int, c_void_p, c_int, numbers, numbers, c_int),
    ("cordon_result_mode", c_int, c_void_p, c_int),
    ("cordon_mode_name", c_char_p, c_void_p, c_int),
    ("cordon_last_k", c_int64, c_void_p),
    ("cordon_close", None, c_void_p),
):
    function = getattr(cordon, name)
    function.restype, function.argtypes = result, arguments

OK, NONE = 0, -1


def expect(is_well):
    if not is_well:
        sys.exit(cordon.cordon_last_error().decode())


study = sys.argv[1] if len(sys.argv) > 1 else "tank.json"
session = cordon.cordon_open(study.encode(), None, None)
expect(session)
level = 1.0
for k in range(60):
    inflow = c_double(0.2 + 0.05 * math.sin(0.3 * k))
    gauge = c_double(level + 0.015 * math.sin(1.7 * k))
    expect(cordon.cordon_step(session, byref(inflow), 1, byref(gauge), 1) == OK)
    for i in range(cordon.cordon_change_count(session)):
        print(cordon.cordon_change_text(session, i).decode())
    level = (0.8 if k < 40 else 0.7) * level + inflow.value  # a leak from k = 40 on
lower, upper = c_double(), c_double()
expect(cordon.cordon_result_bounds(session, 0, byref(lower), byref(upper), 1) == OK)
mode = cordon.cordon_result_mode(session, 0)
name = "unknown" if mode == NONE else cordon.cordon_mode_name(session, mode).decode()
k = cordon.cordon_last_k(session)
print(f"k = {k}: mode {name}, level from {lower.value:.2f} to {upper.value:.2f} m")
cordon.cordon_close(session)
