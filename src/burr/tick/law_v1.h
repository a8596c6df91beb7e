/* tick/law_v1.h - a custom law, compiled: what a shared library gives to burr. Plain C.
 *
 *     gcc -O2 -shared -fPIC -I SRC my_law.c -o my_law.so        SRC: the folder that holds burr/
 *     burr verify law my_law.so                                 tries it, in a process of its own
 *     burr mill phantom:block --motion pocket --law my_law.so   uses it
 *
 * docs/develop/how_to_add_a_force_law.md says how, with an example.
 *
 * burr calls burr_law_v1() once in each tick in which the hand holds a round burr and may feel it, also in
 * free air (`touching` is 0 then). In other ticks (a reading is lost, an undo is in progress, a piece or a
 * tool of the rack is in the hand) burr's own law acts.
 *
 * Units: SI. Frame: world (LPS: x to the patient's left, y to the back, z up). Thread: burr_law_v1() on the
 * thread of the ticks, the other two on another thread while no tick runs. Several states may live at once.
 *
 * Rules for burr_law_v1(): no memory from the heap, no lock, no file, no clock, no random number, no
 * exception, and no memory that states share. The same inputs since _new() give the same outputs to the bit:
 * a replay counts on it.
 */
#ifndef BURR_TICK_LAW_V1_H
#define BURR_TICK_LAW_V1_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* NOLINTBEGIN(readability-identifier-naming): names as in C */

/* What burr knows in this tick. No number in it is NaN or infinite. */
typedef struct burr_law_in_v1 {
  uint32_t size;      /* of this struct [byte]; a later burr may add fields at the end */
  uint32_t version;   /* 1 */
  double dt;          /* length of a tick [s] */
  double hand[3];     /* the tip as the hand holds it; may be inside bone [m] */
  double proxy[3];    /* middle of the burr where it rests; never inside bone [m] */
  double normal[3];   /* unit, out of the bone; zero while nothing is touched */
  double velocity[3]; /* of the hand, filtered (100 Hz, first order) [m/s] */
  double axis[3];     /* of the tool, unit, from the head to the hand */
  double depth;       /* from hand to proxy, along the normal; 0 in free air [m] */
  double radius;      /* of the burr [m] */
  double spin_rad_s;  /* of the spindle now; below 0: backwards [rad/s] */
  double stiffness;   /* of the spring that is set, limited by the device [N/m] */
  double damping;     /* that is set, limited by the device [N s/m] */
  double hu;          /* grey value of the bone under the contact; 0 where the bone has none */
  double
      price_j_m3; /* energy to cut a volume of the tissue under the contact; 0 in free air [J/m^3] */
  uint16_t tissue;   /* its number in the table of tissues; 0: air */
  uint16_t touching; /* 1: the burr touches bone */
  uint32_t unused;   /* 0 */
} burr_law_in_v1;

/* burr's own law decides how much is cut, and how the bone drags the burr. */
#define BURR_LAW_AS_BURR (-1.0)

/* What is beyond these, or not a number, switches the law off: the force fades to zero and stays there. */
#define BURR_LAW_MOST_FORCE 1000.0 /* [N] */
#define BURR_LAW_MOST_ENERGY 1.0   /* in a tick [J] */
#define BURR_LAW_MOST_TORQUE 10.0  /* [N m] */

/* The answer. burr has filled it with its own law's answer, so a law writes only what it changes. */
typedef struct burr_law_out_v1 {
  uint32_t size, version;
  double force
      [3]; /* on the hand; guard, limits, ramp and fade of burr act on it as on any other [N] */
  double
      energy_j; /* to spend on cutting in this tick. The bone costs price_j_m3, so no more is removed
                       than is paid for. It counts while the spindle turns and the force presses on bone;
                       burr lowers it to what the motor can give in a tick, and in the proportion in which
                       it shortens the force. burr's drag is then left out: `force` is all of it. Or
                       BURR_LAW_AS_BURR, which it is at first. */
  double
      torque_nm; /* of the bone on the burr, >= 0, which brakes the spindle; with energy_j [N m] */
} burr_law_out_v1;

/* Needed. 0: fine. Other numbers: the law cannot answer, and is switched off as above. */
int burr_law_v1(void* state, const burr_law_in_v1* in, burr_law_out_v1* out);

/* Both or neither. settings: the text of the file given with --law-settings, "" without one; burr does
 * not look into it. A new session, and a session that starts over, get a new state. NULL: the settings are wrong.
 * Without these functions, `state` is NULL. */
void* burr_law_v1_new(const char* settings);
void burr_law_v1_delete(void* state);

/* NOLINTEND(readability-identifier-naming) */

#ifdef __cplusplus
}
#endif

#endif
