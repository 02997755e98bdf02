// SPDX-License-Identifier: GPL-3.0-or-later
// Loaded before cddlib: generators of a polyhedron are said to be its inequalities.
extern "C" {
void* dd_CopyInequalities(void* polyhedron);
void* dd_CopyGenerators(void* polyhedron) { return dd_CopyInequalities(polyhedron); }
}
