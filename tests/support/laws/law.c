/* tests/support/laws/law.c - laws that behave, and laws that do not: one library for each, by a macro. */
#include <math.h>
#include <stdlib.h>

#include "burr/tick/law_v1.h"

#if defined(LAW_TWICE) /* a spring of twice the stiffness; remembers how often it was asked */
void* burr_law_v1_new(const char* settings) { return calloc(1, sizeof(double) + (settings == NULL)); }
void burr_law_v1_delete(void* state) { free(state); }
int burr_law_v1(void* state, const burr_law_in_v1* in, burr_law_out_v1* out) {
  *(double*)state += 1;
  for (int axis = 0; axis < 3; ++axis)
    out->force[axis] = 2 * in->stiffness * in->depth * in->normal[axis];
  return 0;
}
#elif defined(LAW_PAYS) /* burr's force, and a fifth of a watt for the cut */
int burr_law_v1(void* state, const burr_law_in_v1* in, burr_law_out_v1* out) {
  (void)state;
  out->energy_j = 0.2 * in->dt;
  return 0;
}
#elif defined(LAW_NAN) /* not a number, once it touches */
int burr_law_v1(void* state, const burr_law_in_v1* in, burr_law_out_v1* out) {
  (void)state;
  if (in->touching) out->force[1] = NAN;
  return 0;
}
#elif defined(LAW_CRASHES)
int burr_law_v1(void* state, const burr_law_in_v1* in, burr_law_out_v1* out) {
  (void)state;
  (void)out;
  if (in->depth > 0) abort();
  return 0;
}
#elif defined(LAW_HANGS)
int burr_law_v1(void* state, const burr_law_in_v1* in, burr_law_out_v1* out) {
  (void)state;
  volatile double depth = in->depth;
  while (depth > 0) out->force[0] = depth;
  return 0;
}
#elif defined(LAW_SHARES) /* its states share a counter */
static int asked;
int burr_law_v1(void* state, const burr_law_in_v1* in, burr_law_out_v1* out) {
  (void)state;
  (void)in;
  out->force[2] *= 1 + 1e-9 * (++asked % 997);
  return 0;
}
#elif defined(LAW_PUSHES) /* along the hand's own motion: gives it energy */
int burr_law_v1(void* state, const burr_law_in_v1* in, burr_law_out_v1* out) {
  (void)state;
  for (int axis = 0; axis < 3; ++axis) out->force[axis] += 4 * in->velocity[axis];
  return 0;
}
#elif defined(LAW_IS_NONE) /* no law at all */
int something_else(void) { return 0; }
#endif
