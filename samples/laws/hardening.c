/* samples/laws/hardening.c - a force custom law: a spring that gets harder the deeper the hand is.
 *
 *     F = k d (1 + d / d0)        d: depth, k: the stiffness that is set, d0: from the settings
 *
 *     gcc -O2 -shared -fPIC -I SRC samples/laws/hardening.c -o hardening.so    SRC: src, or the installed include
 *     burr verify law hardening.so --law-settings hardening.txt                with the line  d0_mm = 1
 *     burr mill phantom:block --motion touch --law hardening.so --law-settings hardening.txt
 *
 * It says nothing about cutting, so burr's own law of removal works on, with the force of this one.
 */
#include <stdio.h>
#include <stdlib.h>

#include "burr/tick/law_v1.h"

struct hardening {
  double d0; /* [m] */
};

void* burr_law_v1_new(const char* settings) {
  double d0_mm = 1;
  if (settings[0] != 0 && (sscanf(settings, "d0_mm = %lf", &d0_mm) != 1 || !(d0_mm > 0)))
    return NULL; /* burr says that the settings are wrong */
  struct hardening* law = (struct hardening*)malloc(sizeof *law);
  if (law != NULL) law->d0 = 1e-3 * d0_mm;
  return law;
}

void burr_law_v1_delete(void* state) { free(state); }

int burr_law_v1(void* state, const burr_law_in_v1* in, burr_law_out_v1* out) {
  const struct hardening* law = (const struct hardening*)state;
  const double force = in->stiffness * in->depth * (1 + in->depth / law->d0);
  for (int axis = 0; axis < 3; ++axis) out->force[axis] = force * in->normal[axis];
  return 0;
}
