#define BURR_KERNEL scalar
#include "rt/lanes_checks.inc"
