/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tank that begins to leak: supervise [tank.json] */
#include <cordon.h>
#include <math.h>
#include <stdio.h>

int main(int argc, char** argv) {
  cordon_session* session = cordon_open(argc > 1 ? argv[1] : "tank.json", NULL, NULL);
  double level = 1, lower, upper;
  for (int k = 0; session != NULL && k < 60; ++k) {
    double inflow = 0.2 + 0.05 * sin(0.3 * k), gauge = level + 0.015 * sin(1.7 * k);
    if (cordon_step(session, &inflow, 1, &gauge, 1) != CORDON_OK) break;
    for (int i = 0; i < cordon_change_count(session); ++i)
      printf("%s\n", cordon_change_text(session, i));
    level = (k < 40 ? 0.8 : 0.7) * level + inflow; /* a leak from k = 40 on */
  }
  if (session == NULL || cordon_result_bounds(session, 0, &lower, &upper, 1) != CORDON_OK) {
    fprintf(stderr, "%s\n", cordon_last_error());
    cordon_close(session);
    return 1;
  }
  const int mode = cordon_result_mode(session, 0);
  printf("k = %d: mode %s, level from %.2f to %.2f m\n", (int)cordon_last_k(session),
         mode == CORDON_NONE ? "unknown" : cordon_mode_name(session, mode), lower, upper);
  cordon_close(session);
  return 0;
}
